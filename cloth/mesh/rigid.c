#include "cloth/mesh/rigid.h"

#include "assets/topology/rotation.h"

static vec3d vector_of(const double v[3])
{
    return (vec3d){v[0], v[1], v[2]};
}

struct tl_rigid tl_rigid_fit(const vec3s *from, const vec3s *to, size_t count)
{
    const struct tl_rotation fit = tl_rotation_fit(from, to, count);
    return (struct tl_rigid){
        .from = vector_of(fit.from),
        .to = vector_of(fit.to),
        .rotation = {vector_of(fit.rows[0]), vector_of(fit.rows[1]), vector_of(fit.rows[2])}};
}

vec3d tl_rigid_turn(const struct tl_rigid *rigid, vec3d direction)
{
    return (vec3d){vec3d_dot(rigid->rotation[0], direction), vec3d_dot(rigid->rotation[1], direction),
                   vec3d_dot(rigid->rotation[2], direction)};
}

vec3d tl_rigid_point(const struct tl_rigid *rigid, vec3d point)
{
    return vec3d_add(rigid->to, tl_rigid_turn(rigid, vec3d_sub(point, rigid->from)));
}
