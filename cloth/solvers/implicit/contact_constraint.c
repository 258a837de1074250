#include "cloth/solvers/implicit/contact_constraint.h"

/* A particle within this distance of its plane at the start keeps the contact state of the last step. */
#define TOUCHING_M 1e-4

/* The violation of the plane by a step, m; negative: not at all. */
static double violation(const struct tl_contact_plane *plane, vec3d step)
{
    return plane->min_normal_step - vec3d_dot(step, plane->normal);
}

static void set_resistance(struct tl_contact_constraint *constraint, double slip,
                           const struct tl_contact_params *params)
{
    constraint->resistance = constraint->max_friction / fmax(slip, params->min_slip_speed * params->h);
}

/* Extrapolates the slip linearly, bounded below by half the last one, so that the resistance stays finite. */
static void extrapolate_slip(struct tl_contact_constraint *constraint, const struct tl_contact_params *params)
{
    set_resistance(constraint,
                   fmax(2 * constraint->slips[1] - constraint->slips[0], constraint->slips[1] / 2), params);
    constraint->slips[0] = constraint->slips[1];
    constraint->slips[1] = 0;
}

/* Enforces one plane only, the one that the inertial step violates most. */
void tl_contact_constraint_begin(struct tl_contact_constraint *constraint, struct tl_contacts *contacts,
                                 const struct tl_contact_params *params, size_t particle, vec3d x, vec3d step)
{
    struct tl_contact_plane planes[TL_CONTACT_PLANES];
    size_t count = tl_contacts_planes(contacts, params, particle, x, planes);
    constraint->has_plane = count > 0;
    for (size_t k = 0; k < count; k++)
        if (k == 0 || violation(&planes[k], step) > violation(&constraint->plane, step))
            constraint->plane = planes[k];
    const struct tl_contact_plane *plane = &constraint->plane;
    double gap = count > 0 ? vec3d_dot(plane->motion, plane->normal) - plane->min_normal_step : HUGE_VAL;
    if (gap > TOUCHING_M)
        constraint->state = TL_CONTACT_FREE;
    else if (constraint->state == TL_CONTACT_FREE && violation(plane, step) > 0)
        constraint->state = TL_CONTACT_STICKS;
    extrapolate_slip(constraint, params);
}

struct tl_motion_filter tl_contact_constraint_filter(const struct tl_contact_constraint *constraint,
                                                     vec3d *prescribed)
{
    const struct tl_contact_plane *plane = &constraint->plane;
    enum tl_contact_state state = constraint->has_plane ? constraint->state : TL_CONTACT_FREE;
    *prescribed = (vec3d){0};
    if (state == TL_CONTACT_STICKS) {
        double closing = plane->min_normal_step - vec3d_dot(plane->motion, plane->normal);
        *prescribed = vec3d_muladd(plane->motion, plane->normal, closing);
        return (struct tl_motion_filter){.allowed = TL_DOF_NONE};
    }
    if (state == TL_CONTACT_SLIPS) {
        *prescribed = vec3d_scale(plane->normal, plane->min_normal_step);
        return (struct tl_motion_filter){TL_DOF_TANGENTIAL, plane->normal};
    }
    return (struct tl_motion_filter){.allowed = TL_DOF_ALL};
}

/* Whether the friction force of the last solve was within 2 % of Coulomb's bound or below it. */
static bool friction_is_consistent(const struct tl_contact_constraint *constraint, double resisted)
{
    const double slack = 1.02;
    return constraint->state != TL_CONTACT_SLIPS ||
           resisted * constraint->slips[1] <= slack * constraint->max_friction;
}

/* The state that the solution implies for a particle in contact: free if the plane would have to pull; from
 * sticking to slipping if the tangential reaction exceeds mu N, with the resistance that would hold if it
 * slipped alone; from slipping to sticking if it slips more slowly than min_slip_speed. */
static enum tl_contact_state next_state(struct tl_contact_constraint *constraint,
                                        const struct tl_contact_params *params, vec3d step, vec3d reaction,
                                        double inertia)
{
    vec3d normal = constraint->plane.normal;
    double pressure = vec3d_dot(reaction, normal);
    constraint->slips[1] = 0;
    if (!(pressure > 0))
        return TL_CONTACT_FREE;
    constraint->max_friction = params->friction * pressure;
    if (constraint->state == TL_CONTACT_STICKS) {
        double excess = vec3d_norm(vec3d_muladd(reaction, normal, -pressure)) - constraint->max_friction;
        set_resistance(constraint, excess / inertia, params);
        return excess > 0 ? TL_CONTACT_SLIPS : TL_CONTACT_STICKS;
    }
    vec3d slip = vec3d_sub(step, constraint->plane.motion);
    constraint->slips[1] = vec3d_norm(vec3d_muladd(slip, normal, -vec3d_dot(slip, normal)));
    set_resistance(constraint, constraint->slips[1], params);
    return constraint->slips[1] > params->min_slip_speed * params->h || !(params->friction > 0)
               ? TL_CONTACT_SLIPS
               : TL_CONTACT_STICKS;
}

bool tl_contact_constraint_update(struct tl_contact_constraint *constraint,
                                  const struct tl_contact_params *params, vec3d step, vec3d reaction,
                                  double inertia)
{
    enum tl_contact_state before = constraint->state;
    double resisted = constraint->resistance;
    if (!constraint->has_plane)
        return true;
    if (before != TL_CONTACT_FREE)
        constraint->state = next_state(constraint, params, step, reaction, inertia);
    else if (violation(&constraint->plane, step) > 0)
        constraint->state = TL_CONTACT_STICKS;
    return constraint->state == before && friction_is_consistent(constraint, resisted);
}
