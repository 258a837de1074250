/* The cloth's envelope: stiffness x time step x mass ratio x size, for each solver.
 *
 * A cell is solved twice. A tube that hangs by its rim starts at rest under its own weight, which is known in
 * closed form (app/lab/experiments/closed_form.h), and should stay there: it is exact when no vertex leaves
 * its place by more than a thousandth of what it would sink, or of a free fall in the time that passes,
 * whichever is less (and a millionth of the tube, for its float positions). Else it is bounded if none falls
 * faster than free, but for the way to where `preview` rests and as far beyond (tl_tube_slack: much on
 * needles, which weigh little). Then the same tube without weight starts with every vertex moved by a fifth
 * of its cells: its energy must not grow beyond TL_ENVELOPE_GROWTH times what it began with (of `preview`:
 * its motion's, and its strain's by the square). What a solver cannot do it must refuse, with a message and
 * the last good state. Times in CPU ms. */
#ifndef TOILE_APP_LAB_STABILITY_ENVELOPE_H
#define TOILE_APP_LAB_STABILITY_ENVELOPE_H

#include "app/lab/experiments/closed_form.h"
#include "app/lab/stability/outcome.h"

/* Verlet keeps kinetic + elastic (1 - (omega h)^2 / 4) energy, not their sum, and takes up to 0.9 of the
 * critical step: the sum may swing by 1 / (1 - 0.9^2). */
#define TL_ENVELOPE_GROWTH 5.3

struct tl_envelope_size {
    const char *name;
    int columns, row_count; /* of the tube; 0: one triangle */
    bool whole; /* over all stiffnesses, steps and mass ratios; else a few of them, for a frame of a
                   millisecond */
    bool quick;
};
extern const struct tl_envelope_size tl_envelope_sizes[];
extern const size_t tl_envelope_size_count;

extern const double tl_envelope_stiffnesses[]; /* N/m */
extern const double tl_envelope_steps[];       /* s */
extern const double tl_envelope_ratios[];
enum { TL_ENVELOPE_STIFFNESSES = 12, TL_ENVELOPE_STEPS = 5, TL_ENVELOPE_RATIOS = 3 };

struct tl_envelope_cell {
    bool run; /* false: not asked for at this size */
    enum tl_outcome outcome;
    double strayed; /* of what is exact: 1 is the limit */
    double growth;  /* of the energy: most at any frame over what it began with */
    double cpu_ms;
    tl_error error; /* why it was refused, or what is wrong */
};

/* What a cell is about. `height_m` is the tube's. */
struct tl_envelope_case {
    const struct tl_envelope_size *size;
    int solver;
    double stiffness, dt, mass_ratio, height_m;
};
struct tl_envelope_cell tl_envelope_run(const struct tl_envelope_case *tested);

/* ---- What the extremes share ---- */

/* Whether all that a cloth tells of itself is finite: positions of `vertex_count` render vertices, energies.
 */
bool tl_cloth_is_finite(const tl_cloth *cloth, size_t vertex_count);

/* One frame. When it is refused: REFUSED if that was said clearly and the state is that before it, else
 * SILENT or NAN with the reason in `error`. When it is not: BOUNDED if all is finite, else NAN. */
enum tl_outcome tl_cloth_try_step(tl_cloth *cloth, const tl_collider *collider, size_t vertex_count,
                                  tl_error *error);

/* The outcome of a tl_cloth_create that gave nothing. */
enum tl_outcome tl_refusal_outcome(const tl_error *error);

#endif
