/* The views of a fabric card: two drapes, four pictures and a measured colour. */
#include "app/fabric/card_internal.h"
#include "app/fabric/shimmer.h"
#include "app/scene/headless.h"
#include "assets/specimen/cusick.h"
#include "config/base/interrupt.h"

#include <math.h>
#include <string.h>

/* Along the axis of the disc the swatch is seen through a long lens: its scale differs by 0.1 % over the
 * relief of any fabric. */
#define ABOVE_DEG  90
#define LENS_DEG   4.0
#define CLOSER_DEG 1.0

#define SHEET_EDGES 1.875f /* of the sheet, as a multiple of the disc's: 15 mm */

static void view_from_above(struct tl_settings *settings, double fov_deg, double side_mm)
{
    settings->camera =
        (struct tl_camera_params){.pitch_deg = ABOVE_DEG,
                                  .distance_m = (float)(0.5e-3 * side_mm / tan(fov_deg / 2 * M_PI / 180)),
                                  .target = {0, (float)TL_CUSICK_HEIGHT_M, 0},
                                  .fov_deg = (float)fov_deg};
}

static void view_from_side(struct tl_settings *settings, float distance_m, float height_m)
{
    settings->camera = (struct tl_camera_params){
        .yaw_deg = 20, .pitch_deg = 28, .distance_m = distance_m, .target = {0, height_m, 0}, .fov_deg = 30};
}

static bool draw(struct tl_headless *headless, double side_mm, tl_error *error)
{
    headless->settings.image.width = headless->settings.image.height = (int)(side_mm * TL_CARD_PER_MM);
    if (!tl_session_apply(headless->session, &headless->settings, error) ||
        !tl_headless_draw_still(headless, error))
        return false;
    return !tl_interrupted() || tl_fail(error, TL_INTERRUPTED, "stopped");
}

static bool draw_picture(struct tl_headless *headless, double side_mm, tl_image *out, tl_error *error)
{
    return draw(headless, side_mm, error) && tl_renderer_show_image(headless->renderer, out, error);
}

/* The colour under light that comes from everywhere alike, seen along the normal, gloss included: what a
 * spectrophotometer of the geometry d/0 measures. The light behind a sheer fabric shines through it. */
static bool measure_colour(struct tl_headless *headless, struct tl_card *card, tl_error *error)
{
    const struct tl_settings kept = headless->settings;
    tl_image image = {0};
    double sums[4] = {0};
    headless->settings.scene.environment = "white";
    view_from_above(&headless->settings, LENS_DEG, 0.6 * TL_CARD_SWATCH_MM);
    bool read = draw(headless, 16, error) && tl_renderer_read(headless->renderer, &image, error);
    for (size_t i = 0; read && i < 4 * (size_t)image.width * (size_t)image.height; i++)
        sums[i % 4] += (double)tl_image_floats(&image)[i];
    float rgb[3];
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(sums[c] / fmax(sums[3], 1e-6));
    card->measured = tl_card_colour_of(rgb);
    tl_image_release(&image);
    headless->settings = kept;
    return read;
}

static void measure_drape(const struct tl_headless *headless, struct tl_card *card)
{
    tl_frame frame = tl_session_frame(headless->session);
    const tl_garment *disc = tl_session_cut(headless->session);
    const vec3s *positions = frame.surfaces[frame.surface_count - 1].positions;
    card->shadow = tl_cusick_shadow(disc, positions);
    card->drape = tl_cusick_coefficient(&card->shadow);
    card->folds = tl_cusick_folds(disc, positions);
    card->is_at_rest = tl_session_garment_state(headless->session) == TL_GARMENT_AT_REST;
}

/* Flat, near and draped: the middle of the disc is level. */
static bool draw_disc(struct tl_headless *headless, struct tl_card *card, tl_error *error)
{
    view_from_above(&headless->settings, LENS_DEG, TL_CARD_SWATCH_MM);
    if (!draw_picture(headless, TL_CARD_SWATCH_MM, &card->swatch, error))
        return false;
    view_from_above(&headless->settings, CLOSER_DEG, TL_CARD_CLOSE_MM);
    if (!draw_picture(headless, TL_CARD_PICTURE_MM, &card->close, error))
        return false;
    view_from_side(&headless->settings, 0.58f, 0.365f);
    return draw_picture(headless, TL_CARD_PICTURE_MM, &card->disc, error);
}

static bool draw_ball(struct tl_headless *headless, struct tl_card *card, tl_error *error)
{
    const struct tl_cloth_params *defaults = tl_cloth_options.defaults;
    headless->settings.cloth.edge_m *= SHEET_EDGES;
    headless->settings.cloth.settle_s = defaults->settle_s;
    headless->settings.scene.garment = "sheet";
    headless->settings.scene.avatar = "ball";
    view_from_side(&headless->settings, 0.95f, 0.31f);
    return draw_picture(headless, TL_CARD_PICTURE_MM, &card->ball, error);
}

bool tl_card_draw_views(struct tl_card *card, bool with_pictures, tl_error *error)
{
    struct tl_headless headless;
    if (!tl_headless_open(&headless, &card->settings, error))
        return false;
    measure_drape(&headless, card);
    bool done = measure_colour(&headless, card, error) &&
                tl_shimmer_measure(&headless, &card->shimmer, error) &&
                (!with_pictures || (draw_disc(&headless, card, error) && draw_ball(&headless, card, error)));
    tl_headless_release(&headless);
    return done;
}
