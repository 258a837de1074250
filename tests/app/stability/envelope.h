/* The cloth's envelope: stiffness x time step x mass ratio x size, for each solver.
 *
 * A cell is solved twice. A tube that hangs by its rim starts at rest under its own weight, which is known in
 * closed form (app/lab/experiments/closed_form.h), and should stay there: it is exact when no vertex leaves
 * its place by more than a thousandth of what it would sink, or of a free fall in the time that passes,
 * whichever is less (and a millionth of the tube, for its float positions). Otherwise it is bounded if no
 * vertex moves farther than a free fall plus twice the distance to the position where `preview` rests
 * (tl_tube_slack, which is large on needle triangles of little mass), and no farther than TL_STATED_SHARE of
 * the tube's length as it hangs. Then the same tube without weight
 * starts with every vertex displaced by a fifth of its cells: its energy must not exceed TL_ENVELOPE_GROWTH
 * times the initial energy (of `preview`: kinetic energy and the squared strain). A solver must refuse what
 * it cannot solve, with a message and the last good state. Times in CPU ms. */
#ifndef TOILE_TESTS_APP_STABILITY_ENVELOPE_H
#define TOILE_TESTS_APP_STABILITY_ENVELOPE_H

#include "app/lab/experiments/closed_form.h"
#include "tests/app/stability/outcome.h"

/* Verlet keeps kinetic + elastic (1 - (omega h)^2 / 4) energy, not their sum, and takes up to 0.9 of the
 * critical step: the sum may swing by 1 / (1 - 0.9^2). */
#define TL_ENVELOPE_GROWTH 5.3

struct tl_envelope_size {
    const char *name;
    int columns, row_count; /* of the tube; 0: one triangle */
    bool whole; /* all stiffnesses, steps and mass ratios; else a few of them, for one frame of a millisecond
                 */
    bool quick;
};
extern const struct tl_envelope_size tl_envelope_sizes[];
extern const size_t tl_envelope_size_count;

extern const double tl_envelope_stiffnesses[]; /* N/m */
extern const double tl_envelope_steps[];       /* s */
extern const double tl_envelope_ratios[];
enum { TL_ENVELOPE_STIFFNESSES = 12, TL_ENVELOPE_STEPS = 5, TL_ENVELOPE_RATIOS = 3 };

struct tl_envelope_cell {
    enum tl_outcome outcome;
    struct tl_cell_error error; /* mm that it strayed; of the tube's length as it hangs */
    double strayed;             /* displacement over the limit of exact */
    double growth;              /* largest energy of any frame over the initial one */
    double cpu_ms;
    tl_error message; /* why it was refused, or what is wrong */
};

/* The parameters of a cell. `height_m` is the tube's. */
struct tl_envelope_case {
    const struct tl_envelope_size *size;
    int solver;
    double stiffness, dt, mass_ratio, height_m;
    int caged_above; /* 0: the solver alone */
};
struct tl_envelope_cell tl_envelope_run(const struct tl_envelope_case *tested);

/* ---- What the extremes share ---- */

/* Whether the positions of `vertex_count` render vertices and the energies of a cloth are finite. */
bool tl_cloth_is_finite(const tl_cloth *cloth, size_t vertex_count);

/* How far the vertex that moved most is from where the garment has it, metres. */
double tl_cloth_farthest_from(const tl_cloth *cloth, const tl_garment *garment);

/* Simulates one frame. If it is refused: REFUSED where the message is clear and the state is that before the
 * frame, otherwise SILENT or NAN with the reason in `error`. If not: BOUNDED where all is finite, otherwise
 * NAN. */
enum tl_outcome tl_cloth_try_step(tl_cloth *cloth, const tl_collider *collider, size_t vertex_count,
                                  tl_error *error);

/* The outcome of a tl_cloth_create that failed. */
enum tl_outcome tl_refusal_outcome(const tl_error *error);

#endif
