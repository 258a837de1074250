/* The state of a tl_cloth, private to this room and the tests of cloth. */
#ifndef TOILE_CLOTH_STATE_H
#define TOILE_CLOTH_STATE_H

#include "cloth/cloth.h"
#include "cloth/contact/contact.h"
#include "cloth/contact/layers.h"
#include "cloth/drive/pins.h"
#include "cloth/drive/seams.h"
#include "cloth/self_contact/self_contact.h"
#include "cloth/solvers/strain_limit.h"

struct tl_cloth {
    const tl_garment *garment;
    struct tl_cloth_fabric fabric;
    struct tl_cloth_params params;
    struct tl_topology topology;
    vec2s (*rest)[3];     /* [triangle_count] flat rest shape of each physics triangle, metres */
    vec3d *made_at;       /* [particles.count] m, positions in the garment's file */
    double shortest_edge; /* m; shorter edges are not measured for strain */
    struct tl_energy energy;
    double critical_step; /* s, at rest */
    double wave_step_s;   /* mean of a free vertex's own step at rest, 2 / sqrt(w sum_j |K_ij|) */
    double
        refused_step; /* s, reference: the step that a crushed state needed and the budget refused; 0: none */
    struct tl_particles particles;
    vec3d *forces; /* [particles.count] N, elastic, valid within one step: reference, and preview's bending */
    vec3d *external;                /* [particles.count] N, of the wind; NULL: there was none yet */
    vec3d *good_x, *good_v;         /* [particles.count] at the frame's start, restored after a failure */
    struct tl_strain_limits limits; /* preview */
    struct tl_contacts contacts;
    struct tl_layers layers;             /* with params.self_contact */
    struct tl_self_contact self_contact; /* the same */
    struct tl_seams seams;
    bool hanging; /* settling has just begun: holds of height still draw */
    size_t pin_count;
    struct tl_pin *pins;
    bool grabbed;
    uint32_t grabbed_vertex;      /* render vertex */
    vec3d grab_from, grab_target; /* m, where the pull's spring ends at the start and the end of a frame */
    uint64_t jump_followed;       /* collider revision whose jump has been applied to the cloth */
    double time_s;
    struct tl_coarser *cage; /* caged.c; NULL: not made yet */
    void (*destroy_cage)(struct tl_coarser **cage);
    const tl_cloth *caged_cloth; /* of the cage */
    bool has_no_cage;            /* none can be made */
    bool cage_is_current;        /* it is where the cloth is, and set as the cloth is */
    bool was_caged;              /* a cage has moved the cloth since its contacts were found */
    vec3d cage_grab;             /* m, from the grabbed vertex to the cage's */
    uint64_t cage_revision;
    bool settled;
    struct tl_balance balance;
    double needle_share;        /* share of the triangles that are needles */
    uint64_t collider_revision; /* in the last frame in which something drove the cloth */
    bool undriven;              /* nothing has driven the cloth since min_energy was first taken */
    double min_energy;          /* J, smallest total energy since then: dissipated energy cannot return */
    double start_energy;        /* J, kinetic and elastic energy at that time */
    vec3d *start_x, *start_v;   /* [render vertex] the marked start; NULL: none was marked */
    bool *start_pinched;        /* [render vertex] the same of struct tl_contacts */
};

/* Logs that settling ended before the cloth was in balance. */
void tl_cloth_log_unsettled(const tl_cloth *cloth);

/* Whether `preview` follows each sweep by one in the opposite order, as meshes of needles require (xpbd.h). A
 * few needles among well-shaped triangles do no harm. */
#define TL_SYMMETRIC_NEEDLE_SHARE 0.01
static inline bool tl_cloth_uses_symmetric_sweep(const tl_cloth *cloth)
{
    return cloth->needle_share > TL_SYMMETRIC_NEEDLE_SHARE;
}

#endif
