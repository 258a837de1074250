/* Extreme cases of light: small scenes, each with one feature that may break a renderer, and the bound that
 * its image must meet. Generated; metres, linear radiance.
 *
 * Ownership: a scene owns all that its frame points to. Threads: one scene at a time. */
#ifndef TOILE_TESTS_APP_STABILITY_EXTREMES_LIGHT_H
#define TOILE_TESTS_APP_STABILITY_EXTREMES_LIGHT_H

#include "render/renderer.h"

struct tl_extreme_scene {
    size_t columns, rows; /* of the pleated curtain that comes first */
    tl_mesh mesh;
    tl_material material;
    tl_surface surface;
    tl_environment environment;
    struct tl_camera camera;
    bool ground;
};

/* Bounds are of the relative RMSE against the reference, by method: paper, review. TL_NO_WORSE is the weakest
 * bound: not worse than the same method without shadows. */
enum { TL_EXTREME_PAPER, TL_EXTREME_REVIEW, TL_EXTREME_METHODS };
#define TL_NO_WORSE (-1.0)

struct tl_extreme {
    const char *name;
    const char *assignments;                        /* "light.key=value light.key=value"; NULL: none */
    void (*change)(struct tl_extreme_scene *scene); /* makes the ordinary scene extreme; NULL: leaves it */
    double bounds[TL_EXTREME_METHODS];
    const char *why; /* of the bound, or of the refusal */
    /* Of a method whose bound is above TL_STATED_SHARE: settings, written like `assignments`, by which its
     * error is below that. */
    const char *remedies[TL_EXTREME_METHODS];
    bool refused;   /* a clear message is the promise */
    bool from_file; /* the environment comes from a file */
    bool slow;      /* takes seconds: left out by --quick */
};

extern const struct tl_extreme tl_extremes[];
extern const size_t tl_extreme_count;

/* The ordinary scene, then the change. */
bool tl_extreme_scene_make(const struct tl_extreme *extreme, struct tl_extreme_scene *out, tl_error *error);
void tl_extreme_scene_release(struct tl_extreme_scene *scene);

/* Valid while the scene is. Every scene made has a revision of its own. */
tl_frame tl_extreme_frame(struct tl_extreme_scene *scene);

#endif
