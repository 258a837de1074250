#include "assets/base/image.h"

#include "config/base/memory.h"

#include <assert.h>
#include <stdlib.h>

tl_image tl_image_create(int width, int height, int channels, enum tl_image_type type)
{
    assert(width > 0 && height > 0 && width <= TL_LIMIT_IMAGE_SIDE && height <= TL_LIMIT_IMAGE_SIDE);
    assert(channels >= 1 && channels <= 4);
    size_t size = type == TL_IMAGE_U8 ? sizeof(uint8_t) : sizeof(float);
    return (tl_image){.width = width,
                      .height = height,
                      .channels = channels,
                      .type = type,
                      .texels = tl_alloc((size_t)width * (size_t)height * (size_t)channels, size)};
}

void tl_image_release(tl_image *image)
{
    free(image->texels);
    *image = (tl_image){0};
}

bool tl_image_size_check(const char *name, int64_t width, int64_t height, tl_error *error)
{
    if (width <= 0 || height <= 0)
        return tl_fail(error, TL_INPUT, "%s: the image is %lld x %lld texels: it must have at least one",
                       name, (long long)width, (long long)height);
    if (width > TL_LIMIT_IMAGE_SIDE || height > TL_LIMIT_IMAGE_SIDE ||
        (uint64_t)width * (uint64_t)height > TL_LIMIT_IMAGE_TEXELS)
        return tl_fail(error, TL_INPUT,
                       "%s: the image is %lld x %lld texels: scale it to at most %d a side and %zu in all",
                       name, (long long)width, (long long)height, TL_LIMIT_IMAGE_SIDE, TL_LIMIT_IMAGE_TEXELS);
    return true;
}
