/* An audit of a file: the problems that it would cause its recipient, as findings with codes, places and
 * severities that a supplier's gate can act on (`toile info --strict --json`).
 *
 * Codes are stable: a code keeps its name and its severity once it has been published. tl_audit_kinds is the
 * only list of them; `toile info findings`, the manual's page and docs/findings.md are printed from it.
 *
 * A fault that many triangles share (a seam that is open, a patch that is turned over) is one finding, whose
 * place is its first triangle. Lengths of places and messages in mm, of the garment as it is read: in metres
 * by its units, before it is turned upright. Errors: none. Lifetime: the audit owns what it points to, until
 * tl_audit_release. Threads: one per audit. */
#ifndef TOILE_APP_AUDIT_AUDIT_H
#define TOILE_APP_AUDIT_AUDIT_H

#include "assets/base/garment.h"
#include "assets/fabric/fabric_file.h"

#include <stdio.h>

enum tl_audit_code {
    TL_AUDIT_FILE_MISSING,
    TL_AUDIT_FILE_UNREADABLE,
    TL_AUDIT_UNITS_UNFIT,
    TL_AUDIT_UNITS_GUESSED,
    TL_AUDIT_UP_GUESSED,
    TL_AUDIT_SEAM_OPEN,
    TL_AUDIT_TRIANGLE_FLIPPED,
    TL_AUDIT_TRIANGLE_DEGENERATE,
    TL_AUDIT_TRIANGLE_REPEATED,
    TL_AUDIT_EDGE_CROWDED,
    TL_AUDIT_SURFACE_ONE_SIDED,
    TL_AUDIT_CROSSING,
    TL_AUDIT_UV_FLIPPED,
    TL_AUDIT_TEXTURE_UNSCALED,
    TL_AUDIT_PATTERN_UNCUT,
    TL_AUDIT_CODES
};

struct tl_audit_kind {
    const char *code; /* "seam-open" */
    bool is_error;    /* else a warning */
    const char *meaning;
    const char *remedy;
};
extern const struct tl_audit_kind tl_audit_kinds[TL_AUDIT_CODES];

#define TL_AUDIT_NOWHERE (-1)
struct tl_audit_place {
    int64_t part;          /* of the mesh, from 0: a glTF primitive, a run of one material in an OBJ */
    char *name;            /* of the part's material */
    int64_t triangle;      /* from 0, within the part */
    int64_t points[3];     /* the triangle's corners: points of the file, from 0 */
    double position_mm[3]; /* middle of the triangle */
    char *file;            /* a path; NULL: of no file */
};

struct tl_audit_finding {
    enum tl_audit_code code;
    struct tl_audit_place place; /* part TL_AUDIT_NOWHERE: of no triangle; owns its strings */
    char *message;
};

/* Findings of one code that are listed; the others are counted. */
#define TL_AUDIT_LISTED 100
typedef struct tl_audit {
    size_t finding_count;
    struct tl_audit_finding *findings;
    size_t counts[TL_AUDIT_CODES]; /* listed or not */
    size_t crossing_count;         /* pairs of triangles */
    bool crossings_complete;       /* false: at least so many (cloth/self_contact/crossings.h) */
} tl_audit;

/* Adds the findings of a garment's model, sewn if its file has stitches. */
void tl_audit_garment(tl_audit *audit, const tl_garment *garment);
/* Adds the findings of a fabric's file. */
void tl_audit_fabric(tl_audit *audit, const tl_fabric_file *fabric);
/* Adds one finding about a file as a whole; file NULL: that which is audited. */
void tl_audit_add_file(tl_audit *audit, enum tl_audit_code code, const char *file, const char *message);

/* Number of errors, or of warnings. */
size_t tl_audit_count(const tl_audit *audit, bool errors);
/* Prints a line for each finding. */
void tl_audit_print(const tl_audit *audit, FILE *out);

void tl_audit_release(tl_audit *audit); /* frees and zeroes */

#endif
