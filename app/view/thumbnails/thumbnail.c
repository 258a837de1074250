#include "app/view/thumbnails/thumbnail.h"

#include "app/scene/moving_light.h"
#include "app/scene/session.h"
#include "app/settings/settings.h"
#include "config/base/interrupt.h"
#include "config/base/memory.h"
#include "config/cache/cache.h"
#include "render/present/tone_map.h"
#include "render/reference/reference.h"

#include <stdlib.h>
#include <string.h>

/* ---- Fabrics ---- */

/* Few samples: the noise of the mean of 2 x 2 samples a pixel is below what 8 bits show of cloth. */
static bool load_sphere(const char *fabric, struct tl_settings *out, tl_error *error)
{
    char *named = tl_format("scene.fabric=%s", fabric);
    const char *const assignments[] = {
        "scene.garment=sphere",     "scene.avatar=none",     named,
        "cloth.edge_m=0.03",        "image.supersample=2",   "reference.strata=32",
        "reference.lobe_samples=2", "reference.replicates=1"};
    const struct tl_settings_source source = {.assignments = assignments,
                                              .assignment_count = TL_COUNT(assignments)};
    const bool loaded = tl_settings_load(out, &source, error);
    out->image.width = out->image.height = TL_THUMBNAIL_HEIGHT;
    free(named);
    return loaded;
}

static bool draw_sphere(const struct tl_settings *settings, tl_image *out, tl_error *error)
{
    tl_session *session = tl_session_create(settings, error);
    if (!session)
        return false;
    const tl_frame frame = tl_session_frame(session);
    const struct tl_reference_request request = {.frame = &frame,
                                                 .params = &settings->reference,
                                                 .detail = &settings->detail,
                                                 .lobe = settings->light.lobe,
                                                 .width = TL_THUMBNAIL_HEIGHT,
                                                 .height = TL_THUMBNAIL_HEIGHT,
                                                 .supersample = settings->image.supersample};
    tl_image light;
    struct tl_reference_report report;
    const bool drawn = tl_reference_draw(&request, &light, &report, error);
    if (drawn) {
        *out = tl_tone_map_image(&light, glms_vec3_one());
        tl_image_release(&light);
    }
    tl_session_destroy(&session);
    return drawn;
}

/* Everything that decides a thumbnail but for the program itself, of which its version and this number stand
 * in the key: the number rises with every change of the drawing above. */
#define REVISION "fabric thumbnail 1 " TOILE_VERSION

static struct tl_cache_key key_of(const struct tl_settings *settings)
{
    const uint64_t options = tl_settings_hash(settings, (struct tl_option_filter){.any_of = ~(uint64_t)0});
    struct tl_cache_key key = tl_cache_key_begin();
    tl_cache_key_add(&key, REVISION, sizeof REVISION);
    tl_cache_key_add(&key, &options, sizeof options);
    return key;
}

bool tl_thumbnail_of_fabric(const char *name, tl_image *out, tl_error *error)
{
    struct tl_settings settings;
    if (!load_sphere(name, &settings, error))
        return false;
    const struct tl_cache_key key = key_of(&settings);
    const size_t bytes = (size_t)4 * TL_THUMBNAIL_HEIGHT * TL_THUMBNAIL_HEIGHT;
    size_t size;
    void *kept;
    if (tl_cache_load(&key, &kept, &size) && size == bytes) {
        *out = (tl_image){.width = TL_THUMBNAIL_HEIGHT,
                          .height = TL_THUMBNAIL_HEIGHT,
                          .channels = 4,
                          .type = TL_IMAGE_U8,
                          .texels = kept};
        return true;
    }
    const bool is_drawn = draw_sphere(&settings, out, error);
    if (is_drawn && !tl_interrupted())
        tl_cache_store(&key, out->texels, bytes);
    return is_drawn;
}

/* ---- Environments ---- */

/* The mean of the texels of a lat-long map that fall into each pixel. */
static tl_image reduce(const tl_image *map, int width, int height)
{
    tl_image out = tl_image_create(width, height, 4, TL_IMAGE_F32);
    for (int i = 0; i < width * height; i++) {
        const int left = (int)((int64_t)(i % width) * map->width / width),
                  right = (int)((int64_t)(i % width + 1) * map->width / width),
                  top = (int)((int64_t)(i / width) * map->height / height),
                  bottom = (int)((int64_t)(i / width + 1) * map->height / height);
        double sums[3] = {0}, count = 0;
        for (int y = top; y < bottom || y == top; y++)
            for (int x = left; x < right || x == left; x++, count++)
                for (int c = 0; c < 3; c++)
                    sums[c] += (double)tl_image_floats(
                        map)[3 * ((size_t)y * (size_t)map->width + (size_t)x) + (size_t)c];
        for (int c = 0; c < 3; c++)
            tl_image_floats(&out)[4 * i + c] = (float)(sums[c] / count);
        tl_image_floats(&out)[4 * i + 3] = 1;
    }
    return out;
}

bool tl_thumbnail_of_environment(const char *name, tl_image *out, tl_error *error)
{
    struct tl_moving_light light = {0};
    if (!tl_moving_light_open(&light, name, 0, 0, error))
        return false;
    const vec3s factors = light.environment.shown;
    tl_image small = reduce(&light.environment.image, 2 * TL_THUMBNAIL_HEIGHT, TL_THUMBNAIL_HEIGHT);
    *out = tl_tone_map_image(&small, glms_vec3_max(factors) > 0 ? factors : glms_vec3_one());
    tl_image_release(&small);
    tl_moving_light_release(&light);
    return true;
}
