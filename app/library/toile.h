/* toile as a library: a garment is loaded, settles on its body, moves, and is drawn to an image.
 *
 *     cc example.c $(pkg-config --cflags --libs toile)
 *
 * Scenes and options are those of the program: `man toile` lists them.
 *
 * Units: metres, seconds; world axes are right-handed, +Y up. Images have linear Rec. 709 colours.
 *
 * Errors: a function that can fail returns false or NULL and fills the toile_error, which may be NULL: a code
 * and one line that names what, where and the remedy. Out of memory is no such error: one line on standard
 * error, and the process ends (exit status 2), as do the libraries below where they cannot go on.
 *
 * Ownership: toile_load makes a scene, toile_destroy frees it. Strings and buffers that are passed in are not
 * kept.
 *
 * Threads: a scene is used by one thread at a time, which may be any. Each function makes its GL context
 * current on the calling thread and leaves none current: a caller that draws by itself with EGL makes its own
 * current again. Work is spread over OpenMP's threads; results do not depend on their number. Where GL is
 * drawn by the CPU, OMP_WAIT_POLICY=passive in the environment keeps these threads from spinning.
 *
 * Stability: version 0. A function may change while SONAME has 0 in it. */
#ifndef TOILE_H
#define TOILE_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct toile_scene toile_scene;

enum toile_code {
    TOILE_OK,
    TOILE_USAGE,    /* an option or a scene's key that makes no sense */
    TOILE_INPUT,    /* a file that cannot be read */
    TOILE_OUTPUT,   /* a file that cannot be written */
    TOILE_DEVICE,   /* no OpenGL 4.5 */
    TOILE_UNSTABLE, /* the simulation left its bounds */
    TOILE_INTERRUPTED
};

typedef struct toile_error {
    int code;           /* enum toile_code */
    char message[1024]; /* one line, UTF-8 */
} toile_error;

/* "0.1.0"; static. */
const char *toile_version(void);

/* Messages about what was guessed or approximated, on standard error; off at first. For the process. */
void toile_set_messages(bool on);

/* Loads a scene: a YAML file, a model, a pattern, the name of a built-in one, or NULL: the built-in review.
 * `options` are "table.key=value" and end with NULL; NULL: none. Built-in garments and patterns with a body
 * are draped, which takes seconds; files stand as they were made (option scene.drape). Errors: NULL. */
toile_scene *toile_load(const char *scene, const char *const *options, toile_error *error);

/* Drapes a garment that stands as its file has it; nothing happens to one that was draped. On an error the
 * scene stays as it was. */
bool toile_settle(toile_scene *scene, toile_error *error);

/* Advances by one frame, 1 / cloth.frame_rate seconds. On an error the scene can only be destroyed. */
bool toile_step(toile_scene *scene, toile_error *error);

/* Pixels of the image: options image.width and image.height. */
void toile_size(const toile_scene *scene, int *width, int *height);

/* Draws the present frame as a still image into `rgba`: width * height * 4 floats, rows from the top, linear
 * radiance times coverage, and coverage. `count` is the number of floats that there is room for.
 * Errors: TOILE_USAGE when it is another one. */
bool toile_draw(toile_scene *scene, float *rgba, size_t count, toile_error *error);

/* Draws it into a file: .exr (linear) or .png (as displayed). */
bool toile_save(toile_scene *scene, const char *path, toile_error *error);

/* Frees the scene and sets *scene to NULL; a null *scene is fine. */
void toile_destroy(toile_scene **scene);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
