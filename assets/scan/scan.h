/* Body scans, and garments, in the formats of scanners: PLY (text and both binary forms), STL (text and
 * binary), OFF (text).
 *
 * OpenMesh reads these formats too and is not used: it reserves what a header claims (a 200-byte PLY asks for
 * gigabytes), takes the end of a file for zeros, prints to stderr, and leaves out faces at edges that are not
 * manifold, which a scan has. Threads: any. */
#ifndef TOILE_ASSETS_SCAN_SCAN_H
#define TOILE_ASSETS_SCAN_SCAN_H

#include "assets/base/model.h"
#include "config/base/error.h"

/* Whether a path ends in .ply, .stl or .off. */
bool scan_is_file(const char *path);

/* Reads a file into a model of which only the name is set. On failure the caller releases it. Vertices of an
 * STL file at one position are one; triangles with two equal corners are left out. The model's defects list
 * open borders, loose pieces and the like. */
bool scan_load_model(const char *path, enum tl_units wanted, tl_model *out, tl_error *error);

#endif
