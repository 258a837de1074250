/* The steps of reading a pattern. Files' units until tl_pattern_outline makes metres of them. */
#ifndef TOILE_ASSETS_PATTERN_PATTERN_INTERNAL_H
#define TOILE_ASSETS_PATTERN_PATTERN_INTERNAL_H

#include "assets/pattern/pattern.h"

/* An edge as a file has it. */
struct pattern_line {
    size_t from, to; /* vertices */
    enum { PATTERN_LINE, PATTERN_QUADRATIC, PATTERN_CUBIC, PATTERN_ARC } kind;
    struct tl_point control[2]; /* of the curve, in the panel's axes */
    double radius;
    bool large, right; /* an arc of more than half a turn; one that bulges to the right of its direction */
    char *label;       /* moved into the outline */
};

struct pattern_draft {
    const char *where; /* for messages: file and panel */
    double scale;      /* metres per unit */
    size_t vertex_count;
    const struct tl_point *vertices;
    size_t line_count;
    struct pattern_line *lines;
};

/* Turns the drawn lines into the panel's edges: in the order of the outline, in metres, counter-clockwise.
 * place[i]: which edge line i became. Turns `panel->across` round where the outline had run clockwise: the
 * file shows that panel from its inner side. */
bool tl_pattern_outline(const struct pattern_draft *draft, struct tl_pattern_panel *panel, size_t *place,
                        tl_error *error);

/* Turns round, and reports, each stitch that alone would make its edges end where they begin, and would not
 * the other way round: collars come from files whose front and back are joined crosswise at the shoulder.
 * Edges that are rings either way, as those of cuffs, stay. */
void tl_pattern_untwist(tl_pattern *pattern);

#endif
