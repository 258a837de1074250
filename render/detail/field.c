#include "render/detail/field.h"

#include "render/detail/detail_terms.h"

#include <math.h>

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

/* A ray through uv on the mesh: where it is at a height, and how far it then is above the field. */
struct field_ray {
    const struct tl_height_field *field;
    vec2s uv;
    float x, y;     /* metres along the surface for a metre of height */
    float height_m; /* where it is at uv */
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

struct tl_relief tl_field_relief(const struct tl_height_field *field, vec2s uv, vec3s view, int steps,
                                 int refine)
{
    float slant = detail_slant(view.z), high = field->high_m, depth = high - field->low_m;
    const struct field_ray ray = {field, uv, slant * view.x, slant * view.y, 0};
    float above = high, over = clearance(&ray, above), below = above, under = over;
    for (int i = 1; i <= steps && under > 0; i++) {
        above = below;
        over = under;
        below = high - depth * (float)i / (float)steps;
        under = clearance(&ray, below);
    }
    for (int i = 0; i < refine; i++) {
        float middle = 0.5f * (above + below), left = clearance(&ray, middle);
        bool is_under = left <= 0;
        above = is_under ? above : middle;
        over = is_under ? over : left;
        below = is_under ? middle : below;
        under = is_under ? left : under;
    }
    float span = over - under, hit = span > 0 ? above + (below - above) * fminf(over / span, 1) : above;
    return (struct tl_relief){place_at(&ray, hit), hit};
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
