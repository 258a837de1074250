#include "cloth/solvers/implicit/implicit_press.h"

/* The spring is this many times stiffer than what it holds. */
#define FIRMER 10.0
/* What it gives beyond this was an impact, not a load. */
#define MOST_GIVEN_M 1e-4

/* What a push on a probe meets, from what its vertices resist; 0 when none moves. */
static double probe_inertia(const struct tl_probe *probe, const double *inertia)
{
    double mobility = 0;
    for (int i = 0; i < 3; i++) {
        double own = inertia[probe->vertices[i]];
        mobility += own > 0 ? probe->weights[i] * probe->weights[i] / own : 0;
    }
    return mobility > 0 ? 1 / mobility : 0;
}

/* One plane only is heeded: the one that lies nearest. */
static void begin_one(struct tl_press *press, struct tl_contacts *contacts,
                      const struct tl_contact_params *params, size_t probe, vec3d x)
{
    struct tl_contact_plane planes[TL_CONTACT_PLANES];
    size_t count = tl_contacts_planes(contacts, params, contacts->particle_count + probe, x, planes);
    press->near = count > 0;
    for (size_t k = 0; k < count; k++)
        if (k == 0 || planes[k].least > press->plane.least)
            press->plane = planes[k];
    press->presses = press->presses && press->near;
    press->gave = press->presses ? fmin(press->gave, MOST_GIVEN_M) : 0;
    press->plane.least += press->gave;
}

void tl_presses_begin(struct tl_press *presses, struct tl_contacts *contacts,
                      const struct tl_contact_params *params, const vec3d *x, const double *inertia,
                      double least_stiffness)
{
    for (size_t i = 0; i < contacts->probe_count; i++) {
        const struct tl_probe *probe = &contacts->probes[i];
        double resists = probe_inertia(probe, inertia);
        presses[i].near = presses[i].presses = presses[i].presses && resists > 0;
        presses[i].stiffness = FIRMER * resists + least_stiffness;
        if (resists > 0)
            begin_one(&presses[i], contacts, params, i, tl_probe_point(probe, x));
    }
}

/* sign 1: it presses from now on, -1: no more. */
static void add_one(const struct tl_press *press, const struct tl_probe *probe, double sign,
                    struct tl_stiffness *stiffness, vec3d *load)
{
    double k = sign * press->stiffness;
    for (int i = 0; i < 3; i++) {
        uint32_t v = probe->vertices[i];
        double share = k * probe->weights[i];
        load[v] = vec3d_muladd(load[v], press->plane.normal, share * press->plane.least);
        for (int j = 0; j < 3; j++)
            tl_stiffness_add(stiffness, v, probe->vertices[j], press->plane.normal,
                             share * probe->weights[j]);
    }
}

void tl_presses_add(const struct tl_press *presses, const struct tl_contacts *contacts,
                    struct tl_stiffness *stiffness, vec3d *load)
{
    for (size_t i = 0; i < contacts->probe_count; i++)
        if (presses[i].presses)
            add_one(&presses[i], &contacts->probes[i], 1, stiffness, load);
}

bool tl_presses_judge(struct tl_press *presses, const struct tl_contacts *contacts, const vec3d *step,
                      struct tl_stiffness *stiffness, vec3d *load)
{
    bool agreed = true;
    for (size_t i = 0; i < contacts->probe_count; i++) {
        struct tl_press *press = &presses[i];
        if (!press->near)
            continue;
        vec3d way = tl_probe_point(&contacts->probes[i], step);
        double gives = press->plane.least - vec3d_dot(way, press->plane.normal);
        bool should = gives > 0;
        press->gave = fmax(gives, 0);
        if (should == press->presses)
            continue;
        add_one(press, &contacts->probes[i], should ? 1 : -1, stiffness, load);
        press->presses = should;
        agreed = false;
    }
    return agreed;
}
