/* The worst deviation that one invariant measured in one frame, and where it is. Pure. */
#ifndef TOILE_APP_LAB_CHECK_FINDING_H
#define TOILE_APP_LAB_CHECK_FINDING_H

#include "render/renderer.h"

enum { TL_CHECK_PLACE_SIZE = 112 };

/* One invariant's result in one frame. */
struct tl_finding {
    bool is_measured;
    double worst; /* largest deviation, >= 0, in the invariant's own unit */
    double bound;
    char place[TL_CHECK_PLACE_SIZE]; /* a vertex, a pixel, a region; "": none */
    int x, y;                        /* the pixel, from the upper left; -1: none */
    int surface;                     /* the vertex and its surface; -1: none */
    size_t vertex;
};

/* Keeps the larger of `worst` and the deviation so far; a NaN is larger than any number. Returns whether
 * `worst` was kept: only then does the caller format its place. */
bool tl_finding_add(struct tl_finding *finding, double worst);
void tl_finding_place(struct tl_finding *finding, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void tl_finding_pixel(struct tl_finding *finding, int x, int y);
void tl_finding_vertex(struct tl_finding *finding, const tl_frame *frame, size_t surface, size_t vertex);

#endif
