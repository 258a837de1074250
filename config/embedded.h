/* Files compiled into the program by toile_embed() (config/embed.cmake). Read only, valid as long as the
 * program runs. */
#ifndef TOILE_CONFIG_EMBEDDED_H
#define TOILE_CONFIG_EMBEDDED_H

#include <stddef.h>

struct tl_embedded {
    const char *name;   /* file name without folders; NULL ends a list */
    const char *source; /* path in the source tree at build time, for messages */
    const char *data;   /* bytes, followed by a NUL that `size` does not count */
    size_t size;        /* bytes */
};

/* The entry called `name`, or NULL. */
const struct tl_embedded *tl_embedded_find(const struct tl_embedded *list, const char *name);

/* The names of each list without their extension, NULL-terminated: choices for a tl_option. */
extern const char *const tl_embedded_presets_names[];
extern const char *const tl_embedded_scenes_names[];
extern const char *const tl_embedded_fabrics_names[];

extern const struct tl_embedded tl_embedded_presets[]; /* paper.yaml ... : what --preset names */
extern const struct tl_embedded tl_embedded_scenes[];  /* built-in scenes */
extern const struct tl_embedded tl_embedded_fabrics[]; /* what --fabric names */

#endif
