/* The cloth: a mass-spring sheet in physical units, in double precision, with a choice of solvers over one
 * energy.
 *
 * Render vertices are welded into physics vertices (bitwise equal start position; seams once they are
 * closed), so UV seams do not tear. Results do not depend on the number of threads. Positions are metres,
 * world axes. Cloth collides with itself only where params ask for
 * it. Ownership: a tl_cloth borrows its garment and must not
 * outlive it. Threads: one at a time per cloth. */
#ifndef TOILE_CLOTH_CLOTH_H
#define TOILE_CLOTH_CLOTH_H

#include "assets/garment.h"
#include "cloth/contact/collider.h"
#include "cloth/energy/fabric.h"
#include "config/options.h"

typedef struct tl_cloth tl_cloth;

/* No particle weighs less than this share of their mean: one iteration would not move the others. */
#define TL_CLOTH_MIN_MASS 1e-4
/* What is strained beyond this is no longer cloth: refused. */
#define TL_CLOTH_MAX_STRAIN 10

/* How it is solved. Table "cloth". preview: cloth/solvers/xpbd.h; settle: cloth/solvers/implicit/implicit.h;
 * reference: cloth/solvers/verlet.h. */
enum tl_cloth_solver { TL_CLOTH_PREVIEW, TL_CLOTH_SETTLE, TL_CLOTH_REFERENCE, TL_CLOTH_SOLVER_COUNT };
extern const char *const tl_cloth_solver_names[]; /* NULL-terminated */
enum tl_pin_colour { TL_PIN_NO_COLOUR, TL_PIN_RED, TL_PIN_GREEN, TL_PIN_BLUE };
extern const char *const tl_pin_colour_names[]; /* NULL-terminated */
struct tl_cloth_params {
    int solver;             /* enum tl_cloth_solver */
    double dt;              /* s, one step; a frame is made of whole steps: see frame_rate */
    double frame_rate;      /* frames per second of the animation */
    int substeps;           /* preview: per step */
    int cg_iterations;      /* settle: most per solve */
    double cg_tolerance;    /* settle: of the residual, to the load */
    int reference_substeps; /* reference: most per frame, beyond which it is refused */
    double strain_limit;    /* preview: no edge gets longer than by this share; 0: as the energy has it */
    double pin_above_m;  /* vertices that start higher are pinned, on the avatar's nearest point; 0: none */
    int pin_colour;      /* enum tl_pin_colour; vertices of this colour in the file are pinned the same way */
    bool self_repulsion; /* layers of a garment, and folds, keep their distance: layers.h, repulsion.h */
    double gravity;      /* m/s^2, along -Y */
    float wind[3];       /* m/s; air at rest presses on nothing: then only fabric.damping slows the cloth */
    double gust;         /* 0 to 1, of the wind's speed */
    double settle_s;     /* longest simulated time spent settling before the first frame */
    double settle_speed; /* m/s: settled when no vertex goes further in a frame */
    float edge_m;        /* wanted edge length of built-in garments */
    float longest_edge_m; /* of garments from files, whose longer ones are halved; 0: as they are */
};
extern const struct tl_option_table tl_cloth_options;

/* What can be measured of the state; tests, `toile plan` and the panel read it. */
struct tl_cloth_report {
    size_t vertex_count, edge_count, triangle_count; /* physics mesh */
    size_t piece_count;       /* connected components; they and folds pass through one another without
                                 self_repulsion */
    size_t layer_count;       /* told apart by self_repulsion; 0: not yet, or off */
    size_t open_seams;        /* seam pairs not yet welded */
    double time_s;            /* simulated since creation or reset, settling excluded */
    double max_speed;         /* m/s */
    double max_strain;        /* largest |length / rest length - 1| over edges that are not seams; of one
                                 below a quarter of the usual length that is the share it is of */
    double rms_strain;        /* root mean square of the same over the triangles' sides */
    double kinetic_energy;    /* J */
    double elastic_energy;    /* J */
    double potential_energy;  /* J, in gravity, of what is not held; 0 at y = 0 */
    double critical_step_s;   /* the longest stable step of an explicit solver */
    double substep_s;         /* what the chosen solver takes */
    size_t unconverged_steps; /* settle: iterations cut short, since creation: bounded, not exact */
    size_t shortened_steps;   /* settle: would have gained energy */
    double deepest_m;         /* deepest penetration below the avatar's surface, 0 when none */
    size_t caught_count; /* particles pinched between parts of the avatar during the last frame: kept outside,
                            or slipped past one, at the price of strain */
    bool settled;
};

tl_cloth *tl_cloth_create(const tl_garment *garment, const struct tl_cloth_fabric *fabric,
                          const struct tl_cloth_params *params, tl_error *error);
void tl_cloth_destroy(tl_cloth **cloth);

/* Changes material or solver in place; the state is kept. */
bool tl_cloth_set(tl_cloth *cloth, const struct tl_cloth_fabric *fabric, const struct tl_cloth_params *params,
                  tl_error *error);

/* Remembers the state of now as the start, with its clock at 0; and goes back to it. Before the first mark
 * the start is the garment's own. */
void tl_cloth_mark_start(tl_cloth *cloth);
void tl_cloth_reset(tl_cloth *cloth);

/* Draws seams together, resolves starting penetration and lets the cloth come to rest against the collider,
 * at rest itself, with strong damping. Shows progress; stops early on tl_interrupted. The clock stays at 0.
 * TL_UNSTABLE when the state left its envelope (non-finite or strain beyond TL_CLOTH_MAX_STRAIN): the last
 * good state is kept.
 */
bool tl_cloth_settle(tl_cloth *cloth, const tl_collider *collider, tl_error *error);

/* Advances by one frame, 1/frame_rate seconds; the collider's surface moves linearly from its previous to its
 * current pose during it. Failure as above. */
bool tl_cloth_step(tl_cloth *cloth, const tl_collider *collider, tl_error *error);

/* Pull: draws the physics vertex of a render vertex to a target (metres) by a soft constraint, until it is
 * released. The hand goes there evenly during the next frame, from where it was or from the vertex. */
void tl_cloth_grab(tl_cloth *cloth, uint32_t render_vertex, vec3s target);
void tl_cloth_release(tl_cloth *cloth);

/* Holds the physics vertex of a render vertex where it is, as a pin that rides on the avatar where one is
 * near; reset and tl_cloth_unpin forget it. */
void tl_cloth_pin(tl_cloth *cloth, uint32_t render_vertex);
/* Lets go of all that tl_cloth_pin holds. Returns how many. */
size_t tl_cloth_unpin(tl_cloth *cloth);

/* Current positions of all render vertices, and the physics vertex of each (for tl_tangent_frames). The
 * latter changes when seams close: during settling, or in a step when there was none or something held them
 * apart.
 */
void tl_cloth_positions(const tl_cloth *cloth, vec3s *out);
const uint32_t *tl_cloth_weld(const tl_cloth *cloth);

struct tl_cloth_report tl_cloth_measure(const tl_cloth *cloth, const tl_collider *collider /* or NULL */);

#endif
