/* Light at every pixel from ratios at vertices, in one pass over the ID buffer: interpolation within the
 * triangle, material, exact light of the environment times the interpolated ratio, suns and lamps.
 *
 *     c = kd E(n, 1) ratio_d + sum of lobes weight E(direction, s) ratio_g + kt E(-n, 1) ratio_d' + suns,
 * lamps
 *
 * where fuzz is left out (render/brdf/fuzz.h: its exact light times a ratio of its own), and ratio_d' is that
 * of the other side, from which light comes through. The layers behind open cloth are blended as
 * render/light/transparency.h has it, each with the share that the nearer ones let through.
 *
 * The error against composing each sample is measured by tests/render/shade. Linear, premultiplied by cover.
 * Results do not depend on the number of threads. */
#ifndef TOILE_RENDER_SHADE_PIXELS_H
#define TOILE_RENDER_SHADE_PIXELS_H

#include "render/scene/view.h"
#include "render/shade/ratios.h"
#include "render/shade/sun_pixels.h"
#include "render/shade/triangles.h"
#include "render/surfaces/ground.h"

struct tl_pixels_request {
    const struct tl_id_buffer *ids;
    const struct tl_pixel_triangles *triangles; /* of `ids` */
    const struct tl_triangle_ranges *ranges;
    const struct tl_shade_materials *materials;
    const struct tl_vertex_ratios *ratios;
    const struct tl_lobes *lobes;
    const struct tl_pixel_lights *lights;
    const struct tl_sun_pixels *sun_pixels; /* `visible` NULL: all of that light is seen */
    const struct tl_ground *ground;         /* the last of the surfaces, or NULL when none is drawn */
    const struct tl_view *view;
    float environment_yaw; /* rad */
    float cover_m;         /* what is closer above a surface covers it: its ratios hold for covered points */
};

/* Writes RGBA [height / side][width / side] of the ID buffer, rows upwards: means of `side` x `side` samples;
 * 0 where nothing is covered. `side` divides both. */
void tl_pixels_shade(const struct tl_pixels_request *request, int side, float *image);

#endif
