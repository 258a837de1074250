#include "cloth/solvers/implicit/implicit_touch.h"

/* A particle nearer to its plane than this at the start is taken to touch it still. */
#define TOUCHING_M 1e-4

/* How far a way passes the plane; negative: not at all. */
static double trespass(const struct tl_contact_plane *plane, vec3d way)
{
    return plane->least - vec3d_dot(way, plane->normal);
}

static void resist(struct tl_touch *touch, double slip, const struct tl_contact_params *params)
{
    touch->resistance = touch->grip / fmax(slip, params->least_slip * params->h);
}

/* Slips are expected to grow or shrink as they did. */
static void expect_slip(struct tl_touch *touch, const struct tl_contact_params *params)
{
    resist(touch, fmax(2 * touch->slips[1] - touch->slips[0], touch->slips[1] / 2), params);
    touch->slips[0] = touch->slips[1];
    touch->slips[1] = 0;
}

/* One plane only is heeded: the one that would be passed the farthest. */
void tl_touch_begin(struct tl_touch *touch, struct tl_contacts *contacts,
                    const struct tl_contact_params *params, size_t particle, vec3d x, vec3d way)
{
    struct tl_contact_plane planes[TL_CONTACT_PLANES];
    size_t count = tl_contacts_planes(contacts, params, particle, x, planes);
    touch->near = count > 0;
    for (size_t k = 0; k < count; k++)
        if (k == 0 || trespass(&planes[k], way) > trespass(&touch->plane, way))
            touch->plane = planes[k];
    const struct tl_contact_plane *plane = &touch->plane;
    double gap = count > 0 ? vec3d_dot(plane->motion, plane->normal) - plane->least : HUGE_VAL;
    if (gap > TOUCHING_M)
        touch->kind = TL_FREE;
    else if (touch->kind == TL_FREE && trespass(plane, way) > 0)
        touch->kind = TL_STICKS;
    expect_slip(touch, params);
}

struct tl_filter tl_touch_filter(const struct tl_touch *touch, vec3d *given)
{
    const struct tl_contact_plane *plane = &touch->plane;
    enum tl_touch_kind kind = touch->near ? touch->kind : TL_FREE;
    *given = (vec3d){0};
    if (kind == TL_STICKS) {
        double closing = plane->least - vec3d_dot(plane->motion, plane->normal);
        *given = vec3d_muladd(plane->motion, plane->normal, closing);
        return (struct tl_filter){.freedom = TL_MOVES_NOT};
    }
    if (kind == TL_SLIPS) {
        *given = vec3d_scale(plane->normal, plane->least);
        return (struct tl_filter){TL_MOVES_ACROSS, plane->normal};
    }
    return (struct tl_filter){.freedom = TL_MOVES_FREELY};
}

/* Whether what resisted the last slip was no more than Coulomb allows, as nearly as it matters. */
static bool rubs_truly(const struct tl_touch *touch, double resisted)
{
    const double most = 1.02;
    return touch->kind != TL_SLIPS || resisted * touch->slips[1] <= most * touch->grip;
}

/* What a particle that touches its plane does. */
static enum tl_touch_kind judge_touching(struct tl_touch *touch, const struct tl_contact_params *params,
                                         vec3d step, vec3d reaction, double inertia)
{
    vec3d normal = touch->plane.normal;
    double pressed = vec3d_dot(reaction, normal);
    touch->slips[1] = 0;
    if (!(pressed > 0))
        return TL_FREE;
    touch->grip = params->friction * pressed;
    if (touch->kind == TL_STICKS) {
        double excess = vec3d_norm(vec3d_muladd(reaction, normal, -pressed)) - touch->grip;
        resist(touch, excess / inertia, params); /* as it would slip if it were alone */
        return excess > 0 ? TL_SLIPS : TL_STICKS;
    }
    vec3d slip = vec3d_sub(step, touch->plane.motion);
    touch->slips[1] = vec3d_norm(vec3d_muladd(slip, normal, -vec3d_dot(slip, normal)));
    resist(touch, touch->slips[1], params);
    return touch->slips[1] > params->least_slip * params->h || !(params->friction > 0) ? TL_SLIPS : TL_STICKS;
}

bool tl_touch_judge(struct tl_touch *touch, const struct tl_contact_params *params, vec3d step,
                    vec3d reaction, double inertia)
{
    enum tl_touch_kind before = touch->kind;
    double resisted = touch->resistance;
    if (!touch->near)
        return true;
    if (before != TL_FREE)
        touch->kind = judge_touching(touch, params, step, reaction, inertia);
    else if (trespass(&touch->plane, step) > 0)
        touch->kind = TL_STICKS;
    return touch->kind == before && rubs_truly(touch, resisted);
}
