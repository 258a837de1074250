/* The inside of a tl_cloth, for cloth.c, sew.c, settle.c and tests. */
#ifndef TOILE_CLOTH_STATE_H
#define TOILE_CLOTH_STATE_H

#include "cloth/cloth.h"
#include "cloth/contact/contact.h"
#include "cloth/contact/layers.h"
#include "cloth/contact/repulsion.h"
#include "cloth/drive/pins.h"
#include "cloth/drive/seams.h"
#include "cloth/solvers/implicit/implicit.h"
#include "cloth/solvers/strain_limit.h"

struct tl_cloth {
    const tl_garment *garment;
    struct tl_cloth_fabric fabric;
    struct tl_cloth_params params;
    struct tl_topology topology;
    vec2s (*rest)[3];     /* [triangle_count] flat rest shape of each physics triangle, metres */
    vec3d *made_at;       /* [particles.count] m, where the garment's file has them */
    double shortest_edge; /* m; strain says nothing of shorter ones */
    struct tl_energy energy;
    double critical_step; /* s, at rest */
    double refused_step;  /* s, reference: what a crushed state would have taken; 0: none did */
    struct tl_particles particles;
    vec3d *forces;          /* [particles.count] N, elastic; reference only, good within a step */
    vec3d *external;        /* [particles.count] N, of the wind; NULL: it never blew */
    vec3d *good_x, *good_v; /* [particles.count] at the frame's start: what a failure goes back to */
    tl_implicit *implicit;  /* settle only */
    struct tl_implicit_tally tally;
    struct tl_strain_limits limits; /* preview */
    struct tl_contacts contacts;
    struct tl_layers layers;       /* with params.self_repulsion */
    struct tl_repulsion repulsion; /* the same */
    struct tl_seams seams;
    size_t pin_count;
    struct tl_pin *pins;
    bool grabbed;
    uint32_t grabbed_vertex;      /* render vertex */
    vec3d grab_from, grab_target; /* the hand at the start of a frame and at its end */
    uint64_t jump_followed;       /* the collider's revision whose jump the cloth has gone along with */
    double time_s;
    bool settled;
    double needle_share;        /* of its triangles */
    uint64_t collider_revision; /* of the last frame that was driven */
    bool left_alone;            /* nothing has driven it since min_energy began */
    double min_energy;          /* J, all kinds: what has been lost cannot come back */
    double start_energy;        /* J, kinetic and elastic, when it was left alone */
    vec3d *start_x, *start_v;   /* [render vertex] what reset goes back to; NULL until a start is marked */
    bool *start_pinched;        /* [render vertex] the same: struct tl_contacts */
};

/* Whether `preview` sweeps back as well: xpbd.h. A few slivers among sound triangles need not. */
#define TL_SYMMETRIC_NEEDLE_SHARE 0.01
static inline bool tl_cloth_uses_symmetric_sweep(const tl_cloth *cloth)
{
    return cloth->needle_share > TL_SYMMETRIC_NEEDLE_SHARE;
}

#endif
