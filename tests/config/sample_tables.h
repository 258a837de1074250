/* Two small tables with a row of every type, for the tests of the option reader and printer. */
#ifndef TOILE_TESTS_CONFIG_SAMPLE_TABLES_H
#define TOILE_TESTS_CONFIG_SAMPLE_TABLES_H

#include "config/options.h"

struct sample_light {
    int regions;
    int lobe;
    float softness;
    double bias_m;
    bool ground;
};

struct sample_scene {
    float tint[3];
    float target[3];
    const char *title;
    const char *file;
    const char *garment;
};

struct sample {
    struct sample_light light;
    struct sample_scene scene;
};

static const char *const sample_lobes[] = {"single", "dual", "triple", NULL};
static const char *const sample_garments[] = {"dress", "skirt", "none", NULL};

static const struct tl_option sample_light_rows[] = {
    TL_OPTION_INT(struct sample_light, regions, TL_AFFECTS_NOTHING, 6, 384, "",
                  "more regions: sharper shadows"),
    TL_OPTION_ENUM(struct sample_light, lobe, TL_AFFECTS_NOTHING, sample_lobes, "lobes a pixel"),
    TL_OPTION_FLOAT(struct sample_light, softness, TL_AFFECTS_NOTHING, 0.001f, 10, "m", "wider shadows"),
    TL_OPTION_DOUBLE(struct sample_light, bias_m, TL_AFFECTS_NOTHING, -1, 1e12, "m", "a | bar, and more"),
    TL_OPTION_BOOL(struct sample_light, ground, TL_AFFECTS_NOTHING, "draws the ground"),
};
static const struct tl_option_table sample_light_table =
    TL_OPTION_TABLE("light", "how it is lit", sample_light_rows, struct sample_light, .regions = 96,
                    .lobe = 1, .softness = 0.05f, .bias_m = 0.001, .ground = true);

static const struct tl_option sample_scene_rows[] = {
    TL_OPTION_COLOUR(struct sample_scene, tint, TL_AFFECTS_NOTHING, 0, 1, "colour"),
    TL_OPTION_VECTOR(struct sample_scene, target, TL_AFFECTS_NOTHING, -100, 100, "m",
                     "what the eye looks at"),
    TL_OPTION_STRING(struct sample_scene, title, TL_AFFECTS_NOTHING, "any text"),
    TL_OPTION_PATH(struct sample_scene, file, TL_AFFECTS_NOTHING, "a file"),
    TL_OPTION_NAME_OR_PATH(struct sample_scene, garment, TL_AFFECTS_NOTHING, sample_garments, "a garment"),
};
static const struct tl_option_table sample_scene_table =
    TL_OPTION_TABLE("scene", "what is shown", sample_scene_rows, struct sample_scene,
                    .tint = {1, 0.5f, 0.25f}, .garment = "dress");

#define SAMPLE_TABLES 2

static inline void sample_bind(struct sample *sample, struct tl_binding bindings[SAMPLE_TABLES])
{
    bindings[0] = (struct tl_binding){&sample_light_table, &sample->light};
    bindings[1] = (struct tl_binding){&sample_scene_table, &sample->scene};
    tl_options_reset(bindings, SAMPLE_TABLES);
}

#endif
