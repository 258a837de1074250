/* A fabric by itself: the options that a name, a file or a folder gives, and what was read for them.
 *
 * Errors: TL_USAGE for an unknown name or a wrong value, TL_INPUT for a file. Lifetime: tl_fabric_release.
 * Threads: pure, but for the files. */
#ifndef TOILE_APP_FABRIC_FABRIC_H
#define TOILE_APP_FABRIC_FABRIC_H

#include "assets/fabric/fabric_file.h"
#include "assets/weave/weave.h"
#include "cloth/energy/fabric.h"
#include "render/brdf/options.h"
#include "render/construction/options.h"

struct tl_fabric {
    const char *source; /* as it was named; borrowed */
    struct tl_cloth_fabric mechanics;
    struct tl_weave_params weave;
    struct tl_material_params material;
    struct tl_construction_params construction;
    tl_fabric_file file; /* of another program; empty for options */
    bool is_foreign;     /* there is such a file */
};

bool tl_fabric_open(const char *source, struct tl_fabric *out, tl_error *error);
void tl_fabric_release(struct tl_fabric *fabric);

/* The bindings of a fabric's tables, in the order of the reference page. */
#define TL_FABRIC_TABLES 4
void tl_fabric_bind(struct tl_fabric *fabric, struct tl_binding bindings[TL_FABRIC_TABLES]);

/* Its name: of the file's own, or of the path's last part. */
const char *tl_fabric_name(const struct tl_fabric *fabric);

/* Writes the fabric in toile's own form, which --fabric reads back to the same: a folder with fabric.yaml, or
 * a file .yaml; its pictures are copied as they are where their names alone state what they mean, else
 * converted. Every file appears whole or not at all, the one of options last. Errors: TL_OUTPUT too. */
bool tl_fabric_write(struct tl_fabric *fabric, const char *path, tl_error *error);

#endif
