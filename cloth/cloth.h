/* The cloth: a triangle mesh with an elastic energy in physical units, in double precision, and a choice of
 * two solvers for its motion.
 *
 * Render vertices are welded into physics vertices where their start positions are equal to the bit (and
 * along seams, once these are closed), so that UV seams do not tear. Results do not depend on the number of
 * threads. Positions are in metres, in world axes. With params->self_contact
 * the cloth does not pass through itself: no two of its triangles cross.
 *
 * Lifetime: a tl_cloth borrows its garment, which must outlive it; it copies everything else that it is
 * given. Threads: calls for one cloth must not overlap; different cloths are independent. Errors: functions
 * that take a tl_error fill it when they fail; the others cannot fail. */
#ifndef TOILE_CLOTH_CLOTH_H
#define TOILE_CLOTH_CLOTH_H

#include "assets/garment.h"
#include "cloth/balance/residual.h"
#include "cloth/contact/collider.h"
#include "cloth/energy/fabric.h"
#include "config/options.h"

typedef struct tl_cloth tl_cloth;

/* A particle's mass is at least this share of the mean mass: the vertex of a sliver would weigh next to
 * nothing, and one iteration that corrects it would leave its neighbours where they are. */
#define TL_CLOTH_MIN_MASS 1e-4
/* Substeps of `preview`, per step. */
#define TL_CLOTH_MAX_SUBSTEPS 1000
/* A larger strain than this means that the solver has failed: the frame is refused. */
#define TL_CLOTH_MAX_STRAIN 10

/* Solvers of the motion. Table "cloth". preview: cloth/solvers/xpbd.h; reference: cloth/solvers/verlet.h. */
enum tl_cloth_solver { TL_CLOTH_PREVIEW, TL_CLOTH_REFERENCE, TL_CLOTH_SOLVER_COUNT };
extern const char *const tl_cloth_solver_names[]; /* NULL-terminated */
enum tl_pin_colour { TL_PIN_NO_COLOUR, TL_PIN_RED, TL_PIN_GREEN, TL_PIN_BLUE };
extern const char *const tl_pin_colour_names[]; /* NULL-terminated */
struct tl_cloth_params {
    int solver;             /* enum tl_cloth_solver */
    double dt;              /* s, longest step; a frame is made of equal steps: see frame_rate */
    double frame_rate;      /* frames per second of the animation */
    int substeps;           /* preview: per step; 0: as many as the mesh needs */
    int reference_substeps; /* reference: at most, per frame; a fabric that needs more is refused */
    double strain_limit;    /* preview: largest strain of an edge; 0: only the energy resists */
    double pin_above_m;     /* vertices that start higher are pinned to the avatar's nearest point; 0: none */
    int pin_colour;         /* enum tl_pin_colour; vertices of this colour in the file are pinned likewise */
    const char *pin_openings; /* names of openings whose vertices are pinned, with commas between
                                          them */
    bool self_contact;        /* the cloth does not pass through itself: cloth/self_contact/self_contact.h */
    double gravity;           /* m/s^2, along -Y */
    float wind[3];            /* m/s; 0: no aerodynamic force at all, fabric.damping alone slows the cloth */
    double gust;              /* 0 to 1: amplitude of the wind's speed, relative to it */
    double settle_s;          /* longest simulated time of settling before the first frame */
    double settle_speed;      /* m/s: tl_cloth_is_still */
    bool cages;               /* settling begins on coarser versions of a fine cloth: cloth/cage/coarser.h */
    int caged_above;          /* cloth of more vertices is moved by a cage: cloth/step/caged.c; 0: none is */
    float edge_m;             /* target edge length of built-in garments */
    int rest;                 /* enum tl_rest_choice: of garments from files */
    float longest_edge_m;     /* longer edges of garments from files are halved; 0: never */
};
extern const struct tl_option_table tl_cloth_options;

/* Measurements of the state, for tests, `toile plan` and the panel. */
struct tl_cloth_report {
    size_t vertex_count, edge_count, triangle_count; /* physics mesh */
    size_t piece_count;    /* connected components; without self_contact they pass through one another */
    size_t crossing_count; /* pairs of triangles that cross, as drawn: cloth/self_contact/crossings.h */
    size_t layer_count;    /* ordered while self_contact untangles what came crossed; 0: not, or off */
    size_t open_seams;     /* seam pairs that are not welded yet */
    double time_s;         /* simulated since creation or reset, without settling */
    double max_speed;      /* m/s */
    double max_strain; /* largest |length - rest length| / rest length over the triangles' sides. The divisor
                          is at least a quarter of the usual edge length: see cloth/measure.c */
    double rms_strain; /* root mean square of the same; both are a cage's where one has moved the cloth */
    double kinetic_energy;   /* J */
    double elastic_energy;   /* J */
    double potential_energy; /* J, of free particles in gravity; 0 at y = 0 */
    double critical_step_s;  /* the longest stable step of an explicit solver */
    double substep_s;        /* the chosen solver's substep */
    double deepest_m;        /* deepest penetration of the avatar's surface or the ground; 0: none */
    size_t inside_count;     /* particles inside the avatar or below the ground */
    size_t skin_count;       /* vertices of the avatar beyond the cloth, between the cloth's vertices */
    double skin_m;           /* by which the farthest of them is; 0: none */
    size_t caught_count;     /* particles caught between parts of the avatar in the last frame: moved back
                                outside, or slipped past one part, both at the price of strain */
    bool settled;
};

/* Creates the cloth of a garment, at rest at its start positions.
 *
 * Errors: TL_INPUT for a garment without triangles, with coordinates that are not finite, or with an index
 * out of range; TL_USAGE for a parameter outside its option's range. Returns NULL then. Lifetime: `garment`
 * must outlive the cloth; `fabric` and `params` are copied. End with tl_cloth_destroy. */
tl_cloth *tl_cloth_create(const tl_garment *garment, const struct tl_cloth_fabric *fabric,
                          const struct tl_cloth_params *params, tl_error *error);

/* Frees a cloth and sets the handle to NULL; a handle that is NULL already is ignored. */
void tl_cloth_destroy(tl_cloth **cloth);

/* Changes the material or the solver; positions and velocities are kept, contacts are searched again.
 *
 * Errors: TL_USAGE for a parameter outside its option's range; the cloth is then unchanged.
 * Lifetime: `fabric` and `params` are copied. */
bool tl_cloth_set(tl_cloth *cloth, const struct tl_cloth_fabric *fabric, const struct tl_cloth_params *params,
                  tl_error *error);

/* Stores the present positions and velocities as the start, and sets the clock to 0. */
void tl_cloth_mark_start(tl_cloth *cloth);

/* Returns to the marked start, or to the garment's own start positions if none was marked. The clock is at 0
 * again; a vertex that was grabbed or pinned by hand is free. */
void tl_cloth_reset(tl_cloth *cloth);

/* Whether the vertices went no faster than params.settle_speed over the last frame, root mean square: single
 * ones may tremble for ever between contact and their neighbours. Velocities do not show rest: a vertex that
 * oscillates by a tenth of a millimetre between substeps has a large one and goes nowhere. */
bool tl_cloth_is_still(const tl_cloth *cloth);

/* Whether settling has ended at rest; false for cloth that was not settled, or not long enough. */
bool tl_cloth_is_settled(const tl_cloth *cloth);

/* Closes the seams, without gravity, against a collider at rest; pairs that something holds apart stay open.
 * Cloth that is not settled after that hangs in the air as it was sewn.
 *
 * Errors and Lifetime: as tl_cloth_settle. */
bool tl_cloth_sew(tl_cloth *cloth, const tl_collider *collider, tl_error *error);

/* Closes the seams, resolves penetration at the start and simulates until the cloth is at rest, with strong
 * damping and against a collider at rest. The clock stays at 0. Reports progress; stops early when
 * tl_interrupted() is true.
 *
 * Errors: TL_UNSTABLE when the state became NaN or infinite or was strained by more than TL_CLOTH_MAX_STRAIN;
 * TL_USAGE when the reference solver's step does not fit its budget; TL_INTERRUPTED. The last good frame is
 * kept. A cloth that still moves after settle_s is no error: report.settled is false.
 * Lifetime: `collider` may be NULL; it is borrowed until the next call that takes a collider. */
bool tl_cloth_settle(tl_cloth *cloth, const tl_collider *collider, tl_error *error);

/* Advances by one frame, 1 / frame_rate seconds, during which the collider's surface moves linearly from its
 * previous to its current pose. Errors and Lifetime: as tl_cloth_settle. */
bool tl_cloth_step(tl_cloth *cloth, const tl_collider *collider, tl_error *error);

/* Pulls the physics vertex of a render vertex towards a target (metres) by a spring of bounded force, until
 * tl_cloth_release. During the next frame the spring's end moves evenly to `target`, from the last target or,
 * at first, from the vertex. A vertex out of range or a target that is not finite releases instead. */
void tl_cloth_grab(tl_cloth *cloth, uint32_t render_vertex, vec3s target);

/* Ends a pull; harmless when there is none. */
void tl_cloth_release(tl_cloth *cloth);

/* Pins the physics vertex of a render vertex where it is; the pin rides on the avatar if that is within reach
 * (cloth/drive/pins.h). tl_cloth_reset and tl_cloth_unpin remove it. A vertex out of range is ignored. */
void tl_cloth_pin(tl_cloth *cloth, uint32_t render_vertex);

/* Removes all pins that tl_cloth_pin has made; returns how many there were. */
size_t tl_cloth_unpin(tl_cloth *cloth);

/* Moves the render vertices of a cloth that is about to be settled to `positions` [mesh.vertex_count],
 * metres: another start. Its rest shape stays that of the garment, and pinned vertices stay where they are.
 */
void tl_cloth_start_at(tl_cloth *cloth, const vec3s *positions);

/* Writes the present position of every render vertex to `out` [mesh.vertex_count], metres. */
void tl_cloth_positions(const tl_cloth *cloth, vec3s *out);

/* The physics vertex of every render vertex [mesh.vertex_count], for tl_tangent_frames_create. It changes
 * when seams close: while settling, or in a step if something held them apart until then. Lifetime: owned by
 * the cloth, valid until the next call that is not const. */
const uint32_t *tl_cloth_weld(const tl_cloth *cloth);

/* The place on a cage of a cloth that it moves. */
struct tl_cage_places {
    uint32_t (*from)[3]; /* [mesh.vertex_count] render vertices: the corners of the triangle on which each
                            lies; of one that is a corner, or at the place of one, three times that */
    float (*shares)[3];  /* [mesh.vertex_count] of them; their sum is 1 */
};
/* Fills `out`, or only asks with NULL. Returns a number that changes with the cage; 0, and fills nothing,
 * where a cage has not moved the cloth since it was created, reset or set. */
uint64_t tl_cloth_cage(const tl_cloth *cloth, struct tl_cage_places *out);

/* Measures the state; penetration only against a collider that is not NULL. Takes longer than a substep. */
struct tl_cloth_report tl_cloth_measure(const tl_cloth *cloth, const tl_collider *collider);

/* Measures how far the cloth's forces are from balance where it is now, contact included; searches that, and
 * so takes as long as some substeps. `collider` may be NULL. Cloth that has moved by `preview` is far from it
 * even at rest: ripples of a micrometre, which a sweep leaves, take forces of many weights. */
struct tl_residual tl_cloth_residual(const tl_cloth *cloth, const tl_collider *collider);

/* States how settling ended: by how much the cloth was out of balance, and how far it then moved (m, rms)
 * until it rested in motion, too. Zeros if it was not settled. */
struct tl_balance {
    struct tl_residual residual;
    double moved_m;
};
struct tl_balance tl_cloth_balance(const tl_cloth *cloth);

#endif
