/* A kernel of the tests that follows rays through the tree of the graphics card, of the shaders as they are
 * or with edits, and its oracle: every triangle, in doubles. Every function fails the running test when what
 * it calls fails. Not for threads. */
#ifndef TOILE_TESTS_RENDER_TREE_RAYS_H
#define TOILE_TESTS_RENDER_TREE_RAYS_H

#include "render/trace/tree_buffers.h"
#include "tests/render/soup.h"

#define FAR_M 1e30f

struct card_ray {
    vec3s origin;
    float from;
    vec3s direction;
    float to;
};
struct card_found {
    float distance, u, v, through;
    uint32_t triangle, back, occluded; /* of casters */
    uint32_t seen;                     /* triangle, of all */
};

/* A text in a shader file, and another in its place. */
struct card_edit {
    const char *file, *text, *replacement;
};
#define CARD_EDITS_MAX 4
/* The program's shaders with edits, up to the first without a file; or NULL: as they are. A list to free;
 * `texts` own what was edited. */
struct tl_embedded *card_list_shaders(const struct card_edit edits[CARD_EDITS_MAX],
                                      char *texts[CARD_EDITS_MAX]);

/* A mesh of one list of vertices, with numbers of triangles as the tree has them. */
struct flat_mesh {
    vec3s *positions;
    uint32_t *corners;
    float *openness; /* NULL: closed */
    size_t vertex_count, triangle_count;
    size_t other_count; /* the last ones, which cast no shadow */
};
struct flat_mesh flat_mesh_of_soup(const struct soup *soup); /* borrows */
/* Copies: flat_mesh_release. */
struct flat_mesh flat_mesh_join(const tl_surface *const *surfaces, size_t count);
void flat_mesh_release(struct flat_mesh *mesh);

/* A mesh on the card, its tree, and rays. */
struct card {
    tl_gpu *gpu;
    struct tl_embedded *shaders;
    char *texts[CARD_EDITS_MAX];
    tl_program rays_program;
    struct tl_tree_buffers tree;
    tl_buffer positions, corners, rays, found;
};
/* `edits`: up to the first without a file; or NULL. `defines`: of the kernel, or NULL; ONLY a way to walk
 * lets it go only this way, and find only distances. */
void card_open(struct card *card, tl_gpu *gpu, const struct card_edit edits[CARD_EDITS_MAX],
               const char *defines);
void card_close(struct card *card);
void card_update(struct card *card, const struct flat_mesh *mesh);
void card_trace(struct card *card, const struct card_ray *rays, struct card_found *found, size_t count);

/* Measures what each ray meets in the mean, and the cost of the tree, with `order` in place of the call that
 * chooses the next child of a nearest hit. `walk`: a define for card_open. */
struct card_work {
    double nodes, triangles, cost;
};
#define CARD_ORDER "tree_first_slot(slots, octant)"
struct card_work card_measure_work(tl_gpu *gpu, const struct flat_mesh *mesh, const char *walk,
                                   const char *order, const struct card_ray *rays, size_t count);

/* Relative: hits of one distance may be either. */
#define DISTANCE_ROUNDING 1e-5
struct certain {
    double distance; /* INFINITY: none */
    double through;
    uint32_t triangle;
    bool back;
    bool is_doubtful; /* rounding may decide otherwise */
};
/* Tries the first triangles. */
struct certain card_try_all(const struct flat_mesh *mesh, const struct card_ray *ray, size_t triangle_count);
/* Traces rays and tries all triangles. Returns how many rays differ that rounding cannot explain. */
size_t card_count_faulty(struct card *card, const struct flat_mesh *mesh, const struct card_ray *rays,
                         size_t count, size_t *hits);

/* About a soup: some along axes, some that end on their way, some that begin later. */
void random_rays(struct card_ray *rays, size_t count, uint64_t seed);

/* cmocka group setup and teardown: a headless tl_gpu; teardown fails when GL logged a message, or when memory
 * is left. */
int card_gpu_open(void **state);
int card_gpu_close(void **state);

#endif
