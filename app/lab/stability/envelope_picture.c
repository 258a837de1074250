#include "app/lab/stability/envelope_sweep.h"
#include "app/report/canvas.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdio.h>

#define CELL     13 /* pixels */
#define GAP      14
#define PANEL_W  (TL_ENVELOPE_STIFFNESSES * CELL)
#define PANEL_H  (TL_ENVELOPE_STEPS * CELL)
#define SOLVER_W (TL_ENVELOPE_RATIOS * (PANEL_W + GAP) + GAP)
#define LEFT     220
#define TOP      110
#define BOTTOM   90

static const uint32_t paper = 0xfbfaf8, ink = 0x1d2126, soft = 0x5c6670, nothing = 0xefece6;
/* Colours differ in lightness, too, for colour-blind readers. */
static const uint32_t colours[TL_OUTCOME_COUNT] = {0x2c8a57, 0x8fc7e8, 0xe6c84f,
                                                   0xc9c4ba, 0xd3650b, 0xbd1030};

/* 1e3 rather than 1e+03. */
static void spell_power(char text[40], double value, const char *unit)
{
    int power = (int)lround(log10(value));
    if (power == 0)
        snprintf(text, 40, "1%s", unit);
    else
        snprintf(text, 40, "1e%d%s", power, unit);
}

static void draw_panel(tl_image *canvas, const struct tl_envelope_sweep *sweep, struct tl_envelope_place at,
                       int x, int y)
{
    for (at.step = 0; at.step < TL_ENVELOPE_STEPS; at.step++)
        for (at.stiffness = 0; at.stiffness < TL_ENVELOPE_STIFFNESSES; at.stiffness++) {
            const struct tl_envelope_cell *cell = tl_envelope_at(sweep, at);
            tl_canvas_box(canvas, x + at.stiffness * CELL, y + at.step * CELL, CELL - 1, CELL - 1,
                          cell->run ? colours[cell->outcome] : nothing);
        }
}

static void draw_heads(tl_image *canvas)
{
    char text[40];
    tl_canvas_text(canvas, GAP, GAP, "the envelope of cloth: stiffness (across) x time step (down)", ink);
    for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++) {
        int x = LEFT + solver * SOLVER_W;
        tl_canvas_text(canvas, x, TOP - 56, tl_cloth_solver_names[solver], ink);
        for (int ratio = 0; ratio < TL_ENVELOPE_RATIOS; ratio++) {
            int left = x + ratio * (PANEL_W + GAP);
            spell_power(text, tl_envelope_ratios[ratio], "");
            tl_canvas_text(canvas, left, TOP - 28, "masses 1 :", soft);
            tl_canvas_text(canvas, left + tl_canvas_text_width("masses 1 : "), TOP - 28, text, soft);
        }
    }
}

static void draw_foot(tl_image *canvas)
{
    char text[40];
    int x = LEFT, y = canvas->height - BOTTOM + GAP;
    spell_power(text, tl_envelope_stiffnesses[0], "");
    tl_canvas_text(canvas, x, y, text, soft);
    spell_power(text, tl_envelope_stiffnesses[TL_ENVELOPE_STIFFNESSES - 1], " N/m");
    tl_canvas_text(canvas, x + PANEL_W - tl_canvas_text_width("1e9"), y, text, soft);
    y += 2 * TL_CANVAS_LETTER + 4;
    for (int i = 0; i < TL_OUTCOME_COUNT; i++) {
        tl_canvas_box(canvas, x, y, CELL, CELL, colours[i]);
        tl_canvas_text(canvas, x + CELL + 6, y, tl_outcome_names[i], ink);
        x += CELL + 6 + tl_canvas_text_width(tl_outcome_names[i]) + 2 * GAP;
    }
    tl_canvas_box(canvas, x, y, CELL, CELL, nothing);
    tl_canvas_text(canvas, x + CELL + 6, y, "not run", ink);
}

tl_image tl_envelope_picture(const struct tl_envelope_sweep *sweep)
{
    char text[40];
    int sizes = (int)tl_envelope_size_count;
    tl_image canvas = tl_canvas_create(LEFT + TL_CLOTH_SOLVER_COUNT * SOLVER_W,
                                       TOP + sizes * (PANEL_H + GAP) + BOTTOM, paper);
    draw_heads(&canvas);
    for (int size = 0; size < sizes; size++) {
        int y = TOP + size * (PANEL_H + GAP);
        tl_canvas_text(&canvas, GAP, y, tl_envelope_sizes[size].name, ink);
        spell_power(text, tl_envelope_steps[0], " s");
        tl_canvas_text(&canvas, LEFT - GAP - tl_canvas_text_width(text), y, text, soft);
        spell_power(text, tl_envelope_steps[TL_ENVELOPE_STEPS - 1], " s");
        tl_canvas_text(&canvas, LEFT - GAP - tl_canvas_text_width(text), y + PANEL_H - TL_CANVAS_LETTER, text,
                       soft);
        for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++)
            for (int ratio = 0; ratio < TL_ENVELOPE_RATIOS; ratio++)
                draw_panel(&canvas, sweep,
                           (struct tl_envelope_place){.solver = solver, .ratio = ratio, .size = (size_t)size},
                           LEFT + solver * SOLVER_W + ratio * (PANEL_W + GAP), y);
    }
    draw_foot(&canvas);
    return canvas;
}
