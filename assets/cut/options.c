#include "assets/cut/options.h"

#define AFFECTS (TL_AFFECTS_SCENE | TL_AFFECTS_DRAPE | TL_AFFECTS_WORK)

static const struct tl_option cut_rows[] = {
    TL_OPTION_FLOAT(struct tl_cut_params, ease_m, AFFECTS, -0.06, 0.4, "m",
                    "built-in garments: wider around bust, waist and hip than drafted, by half of it around "
                    "arms and legs; negative: tighter"),
    TL_OPTION_FLOAT(struct tl_cut_params, longer_m, AFFECTS, -0.4, 0.5, "m",
                    "built-in garments: a lower hem than drafted, by this length of cloth; negative: higher; "
                    "trousers end between crotch and feet, shirts below the waist"),
    TL_OPTION_FLOAT(struct tl_cut_params, sleeve_m, AFFECTS, -0.45, 0.1, "m",
                    "shirt: longer sleeves than drafted, to the wrists; negative: shorter, with the cuff "
                    "where they end"),
};
const struct tl_option_table tl_cut_options =
    TL_OPTION_TABLE("cut", "sizes of the built-in garments, as differences from their drafts", cut_rows,
                    struct tl_cut_params, .ease_m = 0);
