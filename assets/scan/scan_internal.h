/* The form that all formats of scans are read into, and the steps after reading. */
#ifndef TOILE_ASSETS_SCAN_SCAN_INTERNAL_H
#define TOILE_ASSETS_SCAN_SCAN_INTERNAL_H

#include "assets/scan/scan.h"
#include "config/base/text.h"

#define SCAN_FACE_CORNERS 1024 /* at most; ear clipping takes their square */

struct scan_vertex {
    vec3s position; /* units of the file */
    vec3s normal;   /* not unit */
    vec2s uv;       /* v runs up */
    vec3s colour;   /* 0 to 1 */
};

/* Polygons as read: corners may be out of range, coordinates are finite. */
struct scan_soup {
    size_t vertex_count, vertex_capacity, corner_count, corner_capacity, face_count, face_capacity;
    struct scan_vertex *vertices;
    uint32_t *corners;
    size_t *face_ends;                      /* [face_count] one past the last corner of each */
    bool has_normals, has_uvs, has_colours; /* of vertices; set by the reader */
    bool has_face_colours, has_face_uvs;
};

/* Each reads a file that is open; on failure `soup` holds what was read so far. */
bool scan_read_ply(struct tl_text *text, struct scan_soup *soup, tl_error *error);
bool scan_read_stl(struct tl_text *text, struct scan_soup *soup, tl_error *error);
bool scan_read_off(struct tl_text *text, struct scan_soup *soup, tl_error *error);

/* (scan_soup.c) Adds a corner to the face that is being read. Refuses more than a mesh may have. */
bool scan_add_corner(const char *path, struct scan_soup *soup, uint32_t vertex, tl_error *error);
/* Ends that face; one of less than three corners is none. Refuses more corners than can be cut into
 * triangles. */
bool scan_end_face(const char *path, struct scan_soup *soup, tl_error *error);
/* Adds a vertex. Refuses coordinates that are not finite, and more vertices than a mesh may have. */
bool scan_add_vertex(const char *path, struct scan_soup *soup, const struct scan_vertex *vertex,
                     tl_error *error);

void scan_soup_release(struct scan_soup *soup);

/* Notes a model's open borders, edges of three triangles, loose pieces and faces that point inwards;
 * positions in metres. `weld` [vertex_count] numbers places, equal for vertices at one place.
 * (scan_inspect.c) */
void scan_inspect(tl_model *model, const uint32_t *weld);

#endif
