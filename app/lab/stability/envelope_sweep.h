/* All cells of the cloth's envelope, as a list, as letters and as a picture. */
#ifndef TOILE_APP_LAB_STABILITY_ENVELOPE_SWEEP_H
#define TOILE_APP_LAB_STABILITY_ENVELOPE_SWEEP_H

#include "app/lab/stability/envelope.h"
#include "assets/base/image.h"

struct tl_envelope_place {
    int solver, ratio, step, stiffness;
    size_t size;
};

struct tl_envelope_sweep {
    size_t count;
    struct tl_envelope_cell *cells; /* use tl_envelope_at */
};

/* `quick`: the smallest sizes, and few of all else. */
bool tl_envelope_sweep_run(bool quick, struct tl_envelope_sweep *out, tl_error *error);
void tl_envelope_sweep_release(struct tl_envelope_sweep *sweep);

const struct tl_envelope_cell *tl_envelope_at(const struct tl_envelope_sweep *sweep,
                                              struct tl_envelope_place at);
struct tl_envelope_place tl_envelope_place_of(size_t index);

void tl_envelope_print(const struct tl_envelope_sweep *sweep);
tl_image tl_envelope_picture(const struct tl_envelope_sweep *sweep);

#endif
