#include "assets/environment/studio.h"

#include "assets/base/version.h"
#include "config/base/memory.h"
#include "config/cache/cache.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    STUDIO_WIDTH = 512,
    STUDIO_HEIGHT = 256,
    SUBSAMPLES = 6 /* a texel's side, so that edges are smooth */
};

/* The figure faces +Z and the camera's side. A white matt surface that faces the key light shows about 1:
 * half of that from the key, a quarter from the lamp, the rest from the room and the other boxes. */
const struct tl_studio_light tl_studio_lights[] = {
    {"key", -42, 32, 0.46f, 0.54f, 0.06f, {{2.45f, 2.34f, 2.20f}}},
    {"fill", 78, 12, 0.20f, 0.95f, 0.05f, {{0.86f, 0.93f, 1.02f}}},
    {"rim", -128, 22, 0.13f, 0.85f, 0.04f, {{1.75f, 1.85f, 2.00f}}},
    {"top", 0, 90, 0.30f, 0.26f, 0.06f, {{1.00f, 1.00f, 1.00f}}},
    {"lamp", 34, 48, 0.0155f, 0.0155f, 0.002f, {{860, 820, 760}}},
};
const size_t tl_studio_light_count = TL_COUNT(tl_studio_lights);

struct tl_studio_axes tl_studio_light_axes(const struct tl_studio_light *light)
{
    float azimuth = glm_rad(light->azimuth_deg), elevation = glm_rad(light->elevation_deg);
    struct tl_studio_axes axes = {.right = {{cosf(azimuth), 0, -sinf(azimuth)}}};
    axes.out = (vec3s){{sinf(azimuth) * cosf(elevation), sinf(elevation), cosf(azimuth) * cosf(elevation)}};
    axes.up = glms_vec3_cross(axes.out, axes.right);
    return axes;
}

static float smooth_step(float from, float to, float value)
{
    float t = glm_clamp((value - from) / (to - from), 0, 1);
    return t * t * (3 - 2 * t);
}

float tl_studio_room(vec3s direction)
{
    const float floor_grey = 0.095f, wall = 0.165f, ceiling = 0.11f, glow = 0.17f, glow_exponent = 5;
    float grey = floor_grey + (wall - floor_grey) * smooth_step(-0.55f, 0.25f, direction.y);
    grey += (ceiling - wall) * smooth_step(0.15f, 0.95f, direction.y);
    /* Behind the figure the wall is lit as a photographer lights it: a soft pool of light at chest height. */
    const vec3s backdrop = {{0, 0.0995f, -0.9950f}};
    return grey + glow * expf(glow_exponent * (glms_vec3_dot(direction, backdrop) - 1));
}

float tl_studio_backdrop(vec3s direction)
{
    float turn = glm_rad(TL_STUDIO_VIEW_DEG);
    return tl_studio_room((vec3s){{direction.x * cosf(turn) - direction.z * sinf(turn), direction.y,
                                   direction.x * sinf(turn) + direction.z * cosf(turn)}});
}

/* The coverage of a light in a direction: 1 inside, 0 outside, a smooth step across the edge. */
static float coverage(const struct tl_studio_light *light, const struct tl_studio_axes *axes, vec3s direction)
{
    float depth = glms_vec3_dot(direction, axes->out);
    if (depth <= 0.1f)
        return 0;
    float across = fabsf(glms_vec3_dot(direction, axes->right)) / depth;
    float along = fabsf(glms_vec3_dot(direction, axes->up)) / depth;
    return (1 - smooth_step(light->half_width - light->edge, light->half_width + light->edge, across)) *
           (1 - smooth_step(light->half_height - light->edge, light->half_height + light->edge, along));
}

/* Without `axes`: of the backdrop. */
static vec3s studio_radiance(vec3s direction, const struct tl_studio_axes *axes)
{
    float room = axes ? tl_studio_room(direction) : tl_studio_backdrop(direction);
    vec3s radiance = {{room, room, room}};
    for (size_t i = 0; axes && i < tl_studio_light_count; i++) {
        float seen = coverage(&tl_studio_lights[i], &axes[i], direction);
        radiance = glms_vec3_add(radiance, glms_vec3_scale(tl_studio_lights[i].radiance, seen));
    }
    return radiance;
}

/* Sine and cosine of the samples' azimuths, by column, and of their polar angles, by row. */
struct sample_angles {
    struct {
        float sine, cosine;
    } azimuth[STUDIO_WIDTH * SUBSAMPLES], polar[STUDIO_HEIGHT * SUBSAMPLES];
};

/* The convention of environment.h, inverted: u in [0, 1) from the left edge, v in [0, 1] from the top. */
static struct sample_angles *sample_angles(void)
{
    struct sample_angles *angles = TL_NEW(struct sample_angles);
    for (int i = 0; i < STUDIO_WIDTH * SUBSAMPLES; i++) {
        float u = ((float)(i / SUBSAMPLES) + ((float)(i % SUBSAMPLES) + 0.5f) / SUBSAMPLES) / STUDIO_WIDTH;
        float azimuth = 2 * (float)M_PI * (u - 0.5f);
        angles->azimuth[i].sine = sinf(azimuth);
        angles->azimuth[i].cosine = cosf(azimuth);
    }
    for (int i = 0; i < STUDIO_HEIGHT * SUBSAMPLES; i++) {
        float v = ((float)(i / SUBSAMPLES) + ((float)(i % SUBSAMPLES) + 0.5f) / SUBSAMPLES) / STUDIO_HEIGHT;
        float polar = (float)M_PI * v;
        angles->polar[i].sine = sinf(polar);
        angles->polar[i].cosine = cosf(polar);
    }
    return angles;
}

static vec3s studio_texel(int x, int y, const struct sample_angles *angles, const struct tl_studio_axes *axes)
{
    vec3s sum = glms_vec3_zero();
    for (int row = y * SUBSAMPLES; row < (y + 1) * SUBSAMPLES; row++) {
        for (int column = x * SUBSAMPLES; column < (x + 1) * SUBSAMPLES; column++) {
            const float across = angles->polar[row].sine;
            const vec3s direction = {{angles->azimuth[column].sine * across, angles->polar[row].cosine,
                                      -angles->azimuth[column].cosine * across}};
            sum = glms_vec3_add(sum, studio_radiance(direction, axes));
        }
    }
    return glms_vec3_scale(sum, 1.0f / (SUBSAMPLES * SUBSAMPLES));
}

static float peak_of(const tl_image *image)
{
    float peak = 0;
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < count; i++)
        peak = fmaxf(peak, tl_image_floats(image)[i]);
    return peak;
}

static void fill_image(const struct tl_studio_axes *axes, tl_image *image)
{
    struct sample_angles *angles = sample_angles();
    float *texels = tl_image_floats(image);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < STUDIO_HEIGHT; y++) {
        for (int x = 0; x < STUDIO_WIDTH; x++) {
            vec3s texel = studio_texel(x, y, angles, axes);
            for (int c = 0; c < 3; c++)
                texels[((size_t)y * STUDIO_WIDTH + (size_t)x) * 3 + (size_t)c] = texel.raw[c];
        }
    }
    free(angles);
}

/* Reads it from the cache, if one is used that has it. */
static tl_image studio_image(const struct tl_studio_axes *axes)
{
    const char *name = axes ? "studio" : "backdrop";
    const size_t bytes = (size_t)3 * STUDIO_WIDTH * STUDIO_HEIGHT * sizeof(float);
    struct tl_cache_key key = tl_cache_key_begin();
    tl_cache_key_add(&key, TL_BUILTIN_VERSION, sizeof TL_BUILTIN_VERSION);
    tl_cache_key_add(&key, name, strlen(name));
    tl_image image = tl_image_create(STUDIO_WIDTH, STUDIO_HEIGHT, 3, TL_IMAGE_F32);
    if (!tl_cache_read(&key, tl_image_floats(&image), bytes)) {
        fill_image(axes, &image);
        tl_cache_store(&key, tl_image_floats(&image), bytes);
    }
    return image;
}

tl_environment tl_environment_studio(void)
{
    struct tl_studio_axes axes[TL_COUNT(tl_studio_lights)];
    for (size_t i = 0; i < tl_studio_light_count; i++)
        axes[i] = tl_studio_light_axes(&tl_studio_lights[i]);
    tl_environment environment = {.name = tl_copy_string("studio"),
                                  .layout = TL_ENV_LATLONG,
                                  .image = studio_image(axes),
                                  .backdrop = studio_image(NULL)};
    environment.peak = peak_of(&environment.image);
    return environment;
}

/* Small, but a size that every consumer of lat-long maps accepts. */
enum { CONSTANT_WIDTH = 64, CONSTANT_HEIGHT = 32 };

tl_environment tl_environment_constant(float red, float green, float blue)
{
    tl_environment environment = {.name = tl_copy_string("constant"),
                                  .layout = TL_ENV_LATLONG,
                                  .image = tl_image_create(CONSTANT_WIDTH, CONSTANT_HEIGHT, 3, TL_IMAGE_F32)};
    float *texels = tl_image_floats(&environment.image);
    for (size_t i = 0; i < (size_t)CONSTANT_WIDTH * CONSTANT_HEIGHT; i++) {
        texels[3 * i] = red;
        texels[3 * i + 1] = green;
        texels[3 * i + 2] = blue;
    }
    environment.peak = peak_of(&environment.image);
    return environment;
}

bool tl_environment_find(const char *name, tl_environment *out)
{
    const float radiance = strcmp(name, "white") == 0 ? 1 : 0;
    if (strcmp(name, "studio") == 0)
        *out = tl_environment_studio();
    else if (radiance > 0 || strcmp(name, "none") == 0)
        *out = tl_environment_constant(radiance, radiance, radiance);
    else
        return false;
    return true;
}
