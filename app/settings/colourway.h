/* Colourways: the same cut in other fabrics and colours, each with a name. A scene file has them in a
 * section:
 *
 *     colourways:
 *       Ink:
 *         bodice: {fabric: satin, diffuse: [0.02, 0.03, 0.09]}
 *         skirt: {fabric: voile}
 *       As cut:
 *
 * that is NAME: {MATERIAL: {OPTION: VALUE}}. MATERIAL is a material of the garment, or `all`; later ones win.
 * The options are those of the tables material and weave, `fabric`, whose appearance (not whose stiffness)
 * the material takes on before the others change it, and `print`. What is not given stays as the scene has
 * it. A garment's or avatar's glTF file brings colourways of its own, KHR_materials_variants; a name that
 * both have means both, the scene's on top.
 *
 * A colourway changes materials and weaves only, never how the cloth moves. Errors: one line with file, line,
 * field and the nearest name. Lifetime: the reader fills a table of the caller's; tl_colourways_keep makes an
 * immutable copy that lives as long as the program, which settings share by pointer. Threads: any. */
#ifndef TOILE_APP_SETTINGS_COLOURWAY_H
#define TOILE_APP_SETTINGS_COLOURWAY_H

#include "assets/weave/weave.h"
#include "config/options.h"
#include "render/brdf/options.h"
#include "render/renderer.h"

#define TL_COLOURWAYS_MAX 64
#define TL_SWATCHES_MAX   16
#define TL_SWATCH_ALL     "all"

/* One material of a colourway. */
struct tl_swatch {
    const char *material; /* its name, interned, or TL_SWATCH_ALL */
    int line;             /* of the file, for messages */
    bool has_fabric;      /* params and weave are whole; else only `given` is */
    bool print;           /* a picture in the file's own colour map stays, under the given colour */
    uint64_t given;       /* of rows, by bits */
    struct tl_material_params params;
    struct tl_weave_params weave;
};

/* The names that a scene has, and the swatches of the one that is chosen: they follow from scene.colourways
 * and scene.colourway. */
struct tl_colourways {
    size_t name_count;
    const char *names[TL_COLOURWAYS_MAX]; /* interned */
    bool is_known;                        /* scene.colourway is one of `names` */
    size_t swatch_count;
    struct tl_swatch swatches[TL_SWATCHES_MAX];
};

/* Takes a document's section, as config/options.h hands it over: names and swatches go to `out`. */
struct tl_colourways_reader {
    const char *chosen; /* whose swatches are read; "": none are */
    struct tl_colourways *out;
    struct tl_swatch swatch; /* of the part that is being read */
    bool is_chosen;          /* the record that is being read is */
};
void tl_colourways_begin(struct tl_colourways_reader *reader, const char *chosen, struct tl_colourways *out);
struct tl_record_section tl_colourways_section(struct tl_colourways_reader *reader);

/* The copy of a table that settings point to. Equal tables have one, so pointers compare as the tables do. */
const struct tl_colourways *tl_colourways_keep(const struct tl_colourways *made);
extern const struct tl_colourways tl_colourways_none; /* no names, no swatches */

/* Continues `hash` (config/hash.h) over what the swatches change, wherever in the file they stand. */
uint64_t tl_colourways_hash(const struct tl_colourways *colourways, uint64_t hash);

/* The swatch's own values over those of `params` and `weave`; all of them when it has a fabric. */
void tl_swatch_apply(const struct tl_swatch *swatch, struct tl_material_params *params,
                     struct tl_weave_params *weave);
/* Whether it gives a diffuse colour; something of the weave. */
bool tl_swatch_is_dyed(const struct tl_swatch *swatch);
bool tl_swatch_is_woven(const struct tl_swatch *swatch);

#endif
