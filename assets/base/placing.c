#include "assets/base/placing.h"

const char *const tl_up_names[] = {"auto", "y", "z", NULL};

bool tl_placing_moves(const struct tl_placing *placing)
{
    const vec3s *move = &placing->move_m;
    return placing->z_up || placing->scale != 1 || placing->turn_deg != 0 || move->x != 0 || move->y != 0 ||
           move->z != 0;
}

static vec3s turned(const struct tl_placing *placing, float sine, float cosine, vec3s v)
{
    if (placing->z_up)
        v = (vec3s){{v.x, v.z, -v.y}};
    return (vec3s){{cosine * v.x + sine * v.z, v.y, cosine * v.z - sine * v.x}};
}

static vec3s placed(const struct tl_placing *placing, float sine, float cosine, vec3s point)
{
    return glms_vec3_add(turned(placing, sine, cosine, glms_vec3_scale(point, placing->scale)),
                         placing->move_m);
}

vec3s tl_placing_point(const struct tl_placing *placing, vec3s point)
{
    float angle = glm_rad(placing->turn_deg);
    return tl_placing_moves(placing) ? placed(placing, sinf(angle), cosf(angle), point) : point;
}

vec3s tl_placing_origin(const struct tl_placing *placing, vec3s placed)
{
    const struct tl_placing back = {.scale = 1, .turn_deg = -placing->turn_deg};
    vec3s at = tl_placing_point(&back, glms_vec3_sub(placed, placing->move_m));
    at = glms_vec3_divs(at, placing->scale);
    return placing->z_up ? (vec3s){{at.x, -at.z, at.y}} : at;
}

struct tl_placing tl_placing_about(const struct tl_placing *placing, vec3s point, float turn_deg,
                                   float factor)
{
    struct tl_placing changed = *placing;
    vec3s origin = tl_placing_origin(placing, point);
    changed.turn_deg += turn_deg;
    changed.scale *= factor;
    vec3s moved = tl_placing_point(&changed, origin);
    changed.move_m = glms_vec3_add(changed.move_m, glms_vec3_sub(point, moved));
    return changed;
}

struct tl_placing tl_placing_between(const struct tl_placing *from, const struct tl_placing *to)
{
    struct tl_placing between = {.scale = to->scale / from->scale, .turn_deg = to->turn_deg - from->turn_deg};
    between.move_m = glms_vec3_sub(to->move_m, tl_placing_point(&between, from->move_m));
    return between;
}

void tl_placing_apply(const struct tl_placing *placing, tl_mesh *mesh)
{
    float angle = glm_rad(placing->turn_deg), sine = sinf(angle), cosine = cosf(angle);
    if (!tl_placing_moves(placing))
        return;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        mesh->positions[i] = placed(placing, sine, cosine, mesh->positions[i]);
        mesh->normals[i] = turned(placing, sine, cosine, mesh->normals[i]);
        if (mesh->tangents) {
            vec4s *tangent = &mesh->tangents[i];
            vec3s along = turned(placing, sine, cosine, (vec3s){{tangent->x, tangent->y, tangent->z}});
            *tangent = (vec4s){{along.x, along.y, along.z, tangent->w}};
        }
    }
    for (size_t i = 0; i < mesh->part_count; i++)
        mesh->parts[i].uv_metres *= placing->scale;
}
