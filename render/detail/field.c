#include "render/detail/field.h"

#include "render/detail/detail_terms.h"

#include <math.h>

#define MARCH_HALVINGS 12

struct tl_height_field tl_height_field_make(const tl_image *heights, float width_m, float height_m,
                                            bool clamp_u, bool clamp_v)
{
    struct tl_height_field field = {.heights = heights,
                                    .clamp_u = clamp_u,
                                    .clamp_v = clamp_v,
                                    .repeats_per_m = {1 / width_m, 0, 0, -1 / height_m},
                                    .low_m = INFINITY,
                                    .high_m = -INFINITY};
    for (size_t i = 0; i < (size_t)heights->width * (size_t)heights->height; i++) {
        field.low_m = fminf(field.low_m, tl_image_floats(heights)[i]);
        field.high_m = fmaxf(field.high_m, tl_image_floats(heights)[i]);
    }
    return field;
}

struct tl_height_field tl_height_field_back(const struct tl_height_field *field)
{
    struct tl_height_field back = *field;
    back.turned_over = !field->turned_over;
    back.low_m = -field->high_m;
    back.high_m = -field->low_m;
    return back;
}

static int wrapped(float at, int size, bool clamp)
{
    if (clamp)
        return (int)fminf(fmaxf(at, 0), (float)(size - 1));
    int index = (int)(at - floorf(at / (float)size) * (float)size);
    return index < 0 ? 0 : index >= size ? size - 1 : index;
}

float tl_field_height(const struct tl_height_field *field, vec2s uv)
{
    int width = field->heights->width, height = field->heights->height;
    float x = uv.x * (float)width - 0.5f, y = uv.y * (float)height - 0.5f;
    float left = floorf(x), top = floorf(y), across = x - left, down = y - top;
    const float *texels = tl_image_floats(field->heights);
    float rows[2];
    for (int j = 0; j < 2; j++) {
        const float *row = texels + (size_t)wrapped(top + (float)j, height, field->clamp_v) * (size_t)width;
        rows[j] = (1 - across) * row[wrapped(left, width, field->clamp_u)] +
                  across * row[wrapped(left + 1, width, field->clamp_u)];
    }
    float mean = (1 - down) * rows[0] + down * rows[1];
    return field->turned_over ? -mean : mean;
}

vec2s tl_field_moved(const struct tl_height_field *field, vec2s uv, float x_m, float y_m)
{
    const float *to = field->repeats_per_m;
    return (vec2s){{uv.x + to[0] * x_m + to[1] * y_m, uv.y + to[2] * x_m + to[3] * y_m}};
}

vec2s tl_field_parallax(const struct tl_height_field *field, vec2s uv, vec3s view, bool limited)
{
    float shift = tl_field_height(field, uv) * (limited ? 1 : detail_slant(view.z));
    return tl_field_moved(field, uv, shift * view.x, shift * view.y);
}

/* A ray through uv on the mesh. */
struct field_ray {
    const struct tl_height_field *field;
    vec2s uv;
    float x, y;     /* displacement along the surface per height */
    float height_m; /* its height at uv */
};

static vec2s place_at(const struct field_ray *ray, float height)
{
    float rise = height - ray->height_m;
    return tl_field_moved(ray->field, ray->uv, rise * ray->x, rise * ray->y);
}

static float clearance(const struct field_ray *ray, float height)
{
    return height - tl_field_height(ray->field, place_at(ray, height));
}

/* A segment of a ray from above the field to below it: heights of its ends and their clearances. */
struct bracket {
    float above, over, below, under;
};

static struct tl_relief refined(const struct field_ray *ray, struct bracket part, int refine)
{
    for (int i = 0; i < refine; i++) {
        float middle = 0.5f * (part.above + part.below), left = clearance(ray, middle);
        bool is_under = left <= 0;
        part.above = is_under ? part.above : middle;
        part.over = is_under ? part.over : left;
        part.below = is_under ? middle : part.below;
        part.under = is_under ? left : part.under;
    }
    float span = part.over - part.under, share = span > 0 ? fminf(part.over / span, 1) : 0;
    float hit = part.above + (part.below - part.above) * share;
    return (struct tl_relief){place_at(ray, hit), hit};
}

static struct field_ray view_ray(const struct tl_height_field *field, vec2s uv, vec3s view)
{
    float slant = detail_slant(view.z);
    return (struct field_ray){field, uv, slant * view.x, slant * view.y, 0};
}

/* The value of the nearest texel of the cone map, byte / 255. */
static float cone_at(const struct tl_height_field *field, vec2s uv)
{
    int column = wrapped(floorf(uv.x * (float)field->cones->width), field->cones->width, field->clamp_u);
    int row = wrapped(floorf(uv.y * (float)field->cones->height), field->cones->height, field->clamp_v);
    size_t texel = (size_t)row * (size_t)field->cones->width + (size_t)column;
    return (float)tl_image_bytes(field->cones)[2 * texel + (field->turned_over ? 1 : 0)] / 255;
}

/* Texels that a ray passes per metre of descent. */
static vec2s texels_down(const struct field_ray *ray)
{
    vec2s along = tl_field_moved(ray->field, (vec2s){{0, 0}}, ray->x, ray->y);
    return (vec2s){
        {-along.x * (float)ray->field->heights->width, -along.y * (float)ray->field->heights->height}};
}

static float to_next_line(const struct tl_height_field *field, vec2s at, vec2s speed)
{
    return fminf(detail_to_line(at.x * (float)field->heights->width - 0.5f, speed.x),
                 detail_to_line(at.y * (float)field->heights->height - 0.5f, speed.y));
}

struct tl_relief tl_field_relief(const struct tl_height_field *field, vec2s uv, vec3s view, int steps,
                                 int refine)
{
    const struct field_ray ray = view_ray(field, uv, view);
    vec2s speed = texels_down(&ray);
    float high = field->high_m, low = field->low_m, slant = glms_vec2_norm(speed) * (high - low);
    float over = clearance(&ray, high);
    struct bracket part = {high, over, high, over};
    for (int left = steps; left > 0 && part.under > 0; left--) {
        part.above = part.below;
        part.over = part.under;
        vec2s at = place_at(&ray, part.above);
        float step =
            fmaxf(part.over * detail_cone_step(cone_at(field, at), slant), to_next_line(field, at, speed));
        part.below = fmaxf(part.above - fmaxf(step, detail_due(part.above - low, (float)left)), low);
        part.under = clearance(&ray, part.below);
    }
    return refined(&ray, part, refine);
}

struct tl_relief tl_field_march(const struct tl_height_field *field, vec2s uv, vec3s view, int steps)
{
    const struct field_ray ray = view_ray(field, uv, view);
    float high = field->high_m, depth = high - field->low_m, over = clearance(&ray, high);
    struct bracket part = {high, over, high, over};
    for (int i = 1; i <= steps && part.under > 0; i++) {
        part.above = part.below;
        part.over = part.under;
        part.below = high - depth * (float)i / (float)steps;
        part.under = clearance(&ray, part.below);
    }
    return refined(&ray, part, MARCH_HALVINGS);
}

float tl_field_lit(const struct tl_height_field *field, vec2s uv, vec3s light, int steps)
{
    if (!(light.z > 0))
        return 0;
    float slant = detail_climb(light.z), depth = field->high_m - field->low_m;
    const struct field_ray ray = {field, uv, slant * light.x, slant * light.y, tl_field_height(field, uv)};
    vec2s along = tl_field_moved(field, (vec2s){{0, 0}}, ray.x, ray.y);
    float from = ray.height_m + DETAIL_LIFT * depth;
    float rise = fminf(field->high_m - from, DETAIL_REACH / fmaxf(glms_vec2_norm(along), 1e-6f));
    for (int i = 1; i <= steps && rise > 0; i++)
        if (clearance(&ray, from + rise * (float)i / (float)steps) < 0)
            return 0;
    return 1;
}

bool tl_field_is_outside(const struct tl_height_field *field, vec2s uv)
{
    return (field->clamp_u && !(uv.x >= 0 && uv.x <= 1)) || (field->clamp_v && !(uv.y >= 0 && uv.y <= 1));
}
