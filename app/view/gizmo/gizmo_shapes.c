#include "app/view/gizmo/gizmo_shapes.h"

#include <math.h>

#define LINE 2.5f

/* sRGB; alpha last. Apart by lightness too. */
static const float axis_colours[3][4] = {
    {0.92f, 0.33f, 0.30f, 1}, {0.48f, 0.80f, 0.30f, 1}, {0.35f, 0.58f, 0.98f, 1}};
static const float plain[4] = {0.92f, 0.92f, 0.92f, 1}, far_side[4] = {0.92f, 0.92f, 0.92f, 0.4f},
                   caught[4] = {1.0f, 0.78f, 0.25f, 1};

static void add(struct tl_gizmo_shapes *out, const vec2s *points, size_t count, const float colour[4],
                float width, const char *text)
{
    struct tl_panel_shape *shape = &out->of[out->count];
    const float(*first)[2] = (const float(*)[2])(out->points + out->point_count);
    if (out->count == TL_GIZMO_SHAPES_MAX ||
        out->point_count + count > sizeof out->points / sizeof out->points[0])
        return;
    *shape = (struct tl_panel_shape){.points = first, .count = count, .width = width, .text = text};
    for (int i = 0; i < 4; i++)
        shape->colour[i] = colour[i];
    for (size_t i = 0; i < count; i++, out->point_count++) {
        out->points[out->point_count][0] = points[i].x;
        out->points[out->point_count][1] = points[i].y;
    }
    out->count++;
}

/* A shaft, a head, and the axis's letter beyond it. */
static void add_arrow(struct tl_gizmo_shapes *out, vec2s from, vec2s to, const float colour[4], float scale,
                      const char *letter)
{
    const float length = 14 * scale, half = 6 * scale, beyond = 12 * scale;
    vec2s along = glms_vec2_normalize(glms_vec2_sub(to, from)), across = {{-along.y, along.x}};
    vec2s foot = glms_vec2_sub(to, glms_vec2_scale(along, length));
    const vec2s shaft[2] = {from, foot};
    const vec2s head[3] = {to, glms_vec2_add(foot, glms_vec2_scale(across, half)),
                           glms_vec2_sub(foot, glms_vec2_scale(across, half))};
    const vec2s name = glms_vec2_add(to, glms_vec2_scale(along, beyond));
    add(out, shaft, 2, colour, LINE * scale, NULL);
    add(out, head, 3, colour, 0, NULL);
    add(out, &name, 1, colour, 0, letter);
}

static void add_square(struct tl_gizmo_shapes *out, vec2s middle, float half, const float colour[4])
{
    const vec2s corners[4] = {{{middle.x - half, middle.y - half}},
                              {{middle.x + half, middle.y - half}},
                              {{middle.x + half, middle.y + half}},
                              {{middle.x - half, middle.y + half}}};
    add(out, corners, 4, colour, 0, NULL);
}

/* In runs that are behind the pivot, or before it. */
static void add_ring(struct tl_gizmo_shapes *out, const struct tl_gizmo_drawing *drawing, bool is_caught,
                     float scale)
{
    for (int first = 0, last; first + 1 < TL_GIZMO_RING_POINTS; first = last) {
        last = first + 1;
        while (last + 1 < TL_GIZMO_RING_POINTS && drawing->is_far[last] == drawing->is_far[first])
            last++;
        add(out, &drawing->ring[first], (size_t)(last - first) + 1,
            is_caught                ? caught
            : drawing->is_far[first] ? far_side
                                     : plain,
            LINE * scale, NULL);
    }
}

void tl_gizmo_list_shapes(const struct tl_gizmo *gizmo, enum tl_gizmo_handle marked, bool only,
                          struct tl_gizmo_shapes *out)
{
    static const char *const letters[3] = {"X", "Y", "Z"};
    struct tl_gizmo_drawing drawing;
    out->count = out->point_count = 0;
    if (!tl_gizmo_draw(gizmo, &drawing))
        return;
    if (!only || marked == TL_GIZMO_TURN)
        add_ring(out, &drawing, marked == TL_GIZMO_TURN, gizmo->scale);
    for (int k = 0; k < 3; k++) {
        bool is_marked = (int)marked == TL_GIZMO_X + k;
        if (drawing.has_arrow[k] && (!only || is_marked))
            add_arrow(out, drawing.from[k], drawing.to[k], is_marked ? caught : axis_colours[k], gizmo->scale,
                      letters[k]);
    }
    if (!only || marked == TL_GIZMO_SIZE) {
        const vec2s arm[2] = {glms_vec2_lerp(drawing.centre, drawing.box, 0.2f), drawing.box};
        const float *colour = marked == TL_GIZMO_SIZE ? caught : plain;
        add(out, arm, 2, marked == TL_GIZMO_SIZE ? caught : far_side, LINE * gizmo->scale, NULL);
        add_square(out, drawing.box, drawing.half_side, colour);
    }
    add_square(out, drawing.centre, 0.8f * drawing.half_side, marked == TL_GIZMO_VIEW ? caught : plain);
}
