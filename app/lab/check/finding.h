/* The worst deviation that one invariant measured in one frame, and where it is. Pure. */
#ifndef TOILE_APP_LAB_CHECK_FINDING_H
#define TOILE_APP_LAB_CHECK_FINDING_H

#include "render/renderer.h"

enum { TL_CHECK_PLACE_SIZE = 112 };

/* What one invariant found in one frame. */
struct tl_finding {
    bool is_measured;
    double worst; /* 0 and above: how far off, in the invariant's own measure */
    double bound;
    char place[TL_CHECK_PLACE_SIZE]; /* where: a vertex, a pixel, a region; "" when nowhere in particular */
    int x, y;                        /* the pixel, from the upper left; -1: none */
    int surface;                     /* the vertex and its surface; -1: none */
    size_t vertex;
};

/* For the functions of the table: `worst` replaces what was found so far when it is worse. Returns whether it
 * is, so that a place is only put into words then. */
bool tl_finding_add(struct tl_finding *finding, double worst);
void tl_finding_place(struct tl_finding *finding, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void tl_finding_pixel(struct tl_finding *finding, int x, int y);
void tl_finding_vertex(struct tl_finding *finding, const tl_frame *frame, size_t surface, size_t vertex);

#endif
