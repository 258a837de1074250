#include "render/inspect/aovs.h"

#include <string.h>

enum layer { NORMAL, POINT, UV, ALBEDO, VISIBILITY, STRAIN, GARMENT };

static const char *const normal_channels[] = {"N.x", "N.y", "N.z"};
static const char *const point_channels[] = {"P.x", "P.y", "P.z"};
static const char *const uv_channels[] = {"uv.u", "uv.v"};
static const char *const albedo_channels[] = {"albedo.R", "albedo.G", "albedo.B"};
static const char *const visibility_channels[] = {"visibility.Y"};
static const char *const strain_channels[] = {"strain.warp", "strain.weft", "strain.shear"};
static const char *const garment_channels[] = {TL_AOV_GARMENT};

static const struct aov_kind {
    const char *const *channels;
    int channel_count;
} kinds[TL_AOVS_MAX] = {[NORMAL] = {normal_channels, 3},
                        [POINT] = {point_channels, 3},
                        [UV] = {uv_channels, 2},
                        [ALBEDO] = {albedo_channels, 3},
                        [VISIBILITY] = {visibility_channels, 1},
                        [STRAIN] = {strain_channels, 3},
                        [GARMENT] = {garment_channels, 1}};

static bool is_garment(const struct tl_inspect_request *request, const tl_sample *sample)
{
    uint32_t corners[3];
    size_t index;
    const tl_surface *surface =
        tl_triangle_find(request->ranges, sample->triangle & ~TL_SAMPLE_BACK, corners, &index);
    return strcmp(surface->name, TL_SURFACE_GARMENT) == 0;
}

static void fill(const struct tl_inspect_request *request, size_t number, enum layer layer, float *texel)
{
    const tl_sample *sample = &request->samples->items[number];
    struct tl_inspection found;
    switch (layer) {
    case NORMAL:
        memcpy(texel, sample->normal.raw, sizeof sample->normal);
        return;
    case POINT:
        memcpy(texel, sample->point.raw, sizeof sample->point);
        return;
    case ALBEDO:
        memcpy(texel, sample->diffuse.raw, sizeof sample->diffuse);
        return;
    case GARMENT:
        *texel = is_garment(request, sample);
        return;
    case UV:
    case VISIBILITY:
    case STRAIN:
        break;
    }
    tl_inspect_sample(request, number, &found);
    const float strain[3] = {found.strain_warp, found.strain_weft, found.shear};
    if (layer == UV)
        memcpy(texel, found.uv.raw, sizeof found.uv);
    else if (layer == VISIBILITY)
        *texel = found.visibility;
    else
        memcpy(texel, strain, sizeof strain);
}

static tl_image read_layer(const struct tl_inspect_request *request, enum layer layer)
{
    const struct tl_image_params *size = request->image;
    int channels = kinds[layer].channel_count;
    tl_image image = tl_image_create(size->width, size->height, channels, TL_IMAGE_F32);
#pragma omp parallel for schedule(dynamic)
    for (int y = 0; y < size->height; y++)
        for (int x = 0; x < size->width; x++) {
            size_t number = tl_inspect_find(request->samples, size->width, size->height, x, y);
            float *texel =
                tl_image_floats(&image) + ((size_t)y * (size_t)size->width + (size_t)x) * (size_t)channels;
            if (number < request->samples->primary_count)
                fill(request, number, layer, texel);
        }
    return image;
}

void tl_aovs_make(const struct tl_inspect_request *request, bool has_strains, struct tl_aovs *out)
{
    *out = (struct tl_aovs){0};
    bool is_known[TL_AOVS_MAX] = {
        [NORMAL] = true, [POINT] = true, [UV] = true, [ALBEDO] = true, [GARMENT] = true};
    is_known[VISIBILITY] = request->points != NULL;
    is_known[STRAIN] = has_strains;
    for (int layer = 0; layer < TL_AOVS_MAX; layer++)
        if (is_known[layer])
            out->items[out->count++] = (struct tl_aov){.channels = kinds[layer].channels,
                                                       .image = read_layer(request, (enum layer)layer)};
}

tl_image tl_aovs_make_garment(const struct tl_inspect_request *request)
{
    return read_layer(request, GARMENT);
}

void tl_aovs_release(struct tl_aovs *aovs)
{
    for (int i = 0; i < aovs->count; i++)
        tl_image_release(&aovs->items[i].image);
    *aovs = (struct tl_aovs){0};
}
