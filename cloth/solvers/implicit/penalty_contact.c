#include "cloth/solvers/implicit/penalty_contact.h"

/* The spring's stiffness relative to the inertia that it acts on. */
#define PENALTY_FACTOR 10.0
/* A larger compression comes from an impact, not from a steady load, and must not be kept as a shift. */
#define MAX_SHIFT_M 1e-4

/* The effective inertia of a sample, N/m, from its vertices' inertia; 0 if none is free. */
static double probe_inertia(const struct tl_contact_sample *sample, const double *inertia)
{
    double mobility = 0;
    for (int i = 0; i < 3; i++) {
        double own = inertia[sample->vertices[i]];
        mobility += own > 0 ? sample->weights[i] * sample->weights[i] / own : 0;
    }
    return mobility > 0 ? 1 / mobility : 0;
}

/* Enforces one plane only, the nearest. */
static void begin_one(struct tl_penalty_contact *penalty, struct tl_contacts *contacts,
                      const struct tl_contact_params *params, size_t sample, vec3d x)
{
    struct tl_contact_plane planes[TL_CONTACT_PLANES];
    size_t count = tl_contacts_planes(contacts, params, contacts->particle_count + sample, x, planes);
    penalty->has_plane = count > 0;
    for (size_t k = 0; k < count; k++)
        if (k == 0 || planes[k].min_normal_step > penalty->plane.min_normal_step)
            penalty->plane = planes[k];
    penalty->active = penalty->active && penalty->has_plane;
    penalty->shift = penalty->active ? fmin(penalty->shift, MAX_SHIFT_M) : 0;
    penalty->plane.min_normal_step += penalty->shift;
}

void tl_penalty_contacts_begin(struct tl_penalty_contact *penalties, struct tl_contacts *contacts,
                               const struct tl_contact_params *params, const vec3d *x, const double *inertia,
                               double min_stiffness)
{
    for (size_t i = 0; i < contacts->sample_count; i++) {
        const struct tl_contact_sample *sample = &contacts->samples[i];
        double inertia_at = probe_inertia(sample, inertia);
        penalties[i].has_plane = penalties[i].active = penalties[i].active && inertia_at > 0;
        penalties[i].stiffness = PENALTY_FACTOR * inertia_at + min_stiffness;
        if (inertia_at > 0)
            begin_one(&penalties[i], contacts, params, i, tl_contact_sample_position(sample, x));
    }
}

/* Adds (sign 1) or removes (sign -1) a spring in the matrix and the load. */
static void add_one(const struct tl_penalty_contact *penalty, const struct tl_contact_sample *sample,
                    double sign, struct tl_stiffness *stiffness, vec3d *load)
{
    double k = sign * penalty->stiffness;
    for (int i = 0; i < 3; i++) {
        uint32_t v = sample->vertices[i];
        double share = k * sample->weights[i];
        load[v] = vec3d_muladd(load[v], penalty->plane.normal, share * penalty->plane.min_normal_step);
        for (int j = 0; j < 3; j++)
            tl_stiffness_add(stiffness, v, sample->vertices[j], penalty->plane.normal,
                             share * sample->weights[j]);
    }
}

void tl_penalty_contacts_add(const struct tl_penalty_contact *penalties, const struct tl_contacts *contacts,
                             struct tl_stiffness *stiffness, vec3d *load)
{
    for (size_t i = 0; i < contacts->sample_count; i++)
        if (penalties[i].active)
            add_one(&penalties[i], &contacts->samples[i], 1, stiffness, load);
}

bool tl_penalty_contacts_update(struct tl_penalty_contact *penalties, const struct tl_contacts *contacts,
                                const vec3d *step, struct tl_stiffness *stiffness, vec3d *load)
{
    bool agreed = true;
    for (size_t i = 0; i < contacts->sample_count; i++) {
        struct tl_penalty_contact *penalty = &penalties[i];
        if (!penalty->has_plane)
            continue;
        vec3d way = tl_contact_sample_position(&contacts->samples[i], step);
        double depth = penalty->plane.min_normal_step - vec3d_dot(way, penalty->plane.normal);
        bool should = depth > 0;
        penalty->shift = fmax(depth, 0);
        if (should == penalty->active)
            continue;
        add_one(penalty, &contacts->samples[i], should ? 1 : -1, stiffness, load);
        penalty->active = should;
        agreed = false;
    }
    return agreed;
}
