#include "app/fit/girths.h"

#include "assets/body/fit.h"
#include "assets/topology/sets.h"
#include "config/base/memory.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

const char *const tl_girth_names[TL_GIRTHS] = {"bust", "waist", "hip"};

/* ---- The body ---- */

#define STEP_M 0.01f

/* The height at which the girth jumps between `from` and `to`, because arms join the trunk; `to` where it
 * does not. */
static float find_arms(const tl_mesh *body, float from, float to)
{
    const float jump = 1.08f;
    struct tl_girth girth, before = {0};
    int steps = (int)ceilf((to - from) / STEP_M);
    for (int step = 0; step < steps; step++) {
        float y = from + (float)step * STEP_M;
        if (!tl_mesh_girth(body, y, &girth))
            break;
        if (before.length_m > 0 && girth.length_m > jump * before.length_m)
            return y;
        before = girth;
    }
    return to;
}

static struct tl_girth_measures find_widest(const tl_mesh *body, float lowest, float highest)
{
    struct tl_girth_measures widest = {0};
    struct tl_girth girth;
    int steps = (int)ceilf((highest - lowest) / STEP_M);
    for (int step = 0; step < steps; step++) {
        float y = lowest + (float)step * STEP_M;
        if (tl_mesh_girth(body, y, &girth) && (double)girth.length_m > widest.body_m)
            widest = (struct tl_girth_measures){.height_m = (double)y, .body_m = (double)girth.length_m};
    }
    return widest;
}

void tl_girths_of_body(const tl_mesh *body, struct tl_girth_measures girths[TL_GIRTHS])
{
    const float shoulders = 0.8f, bust = 0.755f, below_crotch = 0.45f; /* of the body's height */
    const float clear_m = 0.05f;                                       /* a tape lies clear below the arms */
    float height = tl_box_of(body->positions, body->vertex_count).upper.y;
    struct tl_waist waist;
    for (int i = 0; i < TL_GIRTHS; i++)
        girths[i] = (struct tl_girth_measures){0};
    if (!tl_mesh_waist(body, &waist))
        return;
    float arms = find_arms(body, waist.y_m, shoulders * height);
    girths[TL_GIRTH_WAIST].height_m = (double)waist.y_m;
    girths[TL_GIRTH_WAIST].body_m = (double)waist.girth.length_m;
    girths[TL_GIRTH_BUST] = find_widest(body, waist.y_m, fminf(bust * height, arms - clear_m));
    girths[TL_GIRTH_HIP] = find_widest(body, below_crotch * height, waist.y_m);
}

/* ---- The cloth ---- */

/* A level and the connected lines in which it cuts the cloth, by the lowest triangle of each. */
struct cut_lines {
    const struct tl_topology *topology;
    const vec3s *positions;
    float y;
    uint32_t *roots;
};

struct cut_line {
    double rest, worn;
    float lower, upper; /* x */
    bool open;          /* it ends at an edge of the cloth */
};

static bool crosses(const struct cut_lines *lines, uint32_t a, uint32_t b)
{
    return (lines->positions[a].y < lines->y) != (lines->positions[b].y < lines->y);
}

static void connect_lines(struct cut_lines *lines)
{
    const struct tl_topology *topology = lines->topology;
    lines->roots = tl_sets_create(topology->triangle_count);
    for (size_t t = 0; t < topology->triangle_count; t++) {
        const uint32_t *v = topology->triangles[t];
        for (int i = 0; i < 3; i++)
            if (topology->neighbour[t][i] != TL_NONE && crosses(lines, v[(i + 1) % 3], v[(i + 2) % 3]))
                tl_sets_join(lines->roots, (uint32_t)t, topology->neighbour[t][i]);
    }
}

/* Adds the part of a line that lies in a triangle. */
static void add_part(const struct cut_lines *lines, size_t t, const vec2s rest[3], struct cut_line *line)
{
    const uint32_t *v = lines->topology->triangles[t];
    vec3s worn[2] = {0};
    vec2s flat[2] = {0};
    int ends = 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        if (!crosses(lines, v[i], v[j]))
            continue;
        line->open = line->open || lines->topology->neighbour[t][(i + 2) % 3] == TL_NONE;
        vec3s a = lines->positions[v[i]], b = lines->positions[v[j]];
        float share = (lines->y - a.y) / (b.y - a.y);
        worn[ends] = glms_vec3_lerp(a, b, share);
        flat[ends++] = glms_vec2_lerp(rest[i], rest[j], share);
    }
    line->worn += (double)glms_vec3_distance(worn[0], worn[1]);
    line->rest += (double)glms_vec2_distance(flat[0], flat[1]);
    line->lower = fminf(line->lower, fminf(worn[0].x, worn[1].x));
    line->upper = fmaxf(line->upper, fmaxf(worn[0].x, worn[1].x));
}

/* The longest line that is closed and has cloth on both sides of the middle. */
static struct cut_line find_line(struct cut_lines *lines, const vec2s (*rest)[3], float middle)
{
    size_t count = lines->topology->triangle_count;
    struct cut_line *all = TL_NEW_ARRAY(struct cut_line, count), best = {0};
    for (size_t t = 0; t < count; t++)
        all[t] = (struct cut_line){.lower = FLT_MAX, .upper = -FLT_MAX};
    for (size_t t = 0; t < count; t++) {
        const uint32_t *v = lines->topology->triangles[t];
        if (crosses(lines, v[0], v[1]) || crosses(lines, v[1], v[2]))
            add_part(lines, t, rest[t], &all[tl_sets_find(lines->roots, (uint32_t)t)]);
    }
    for (size_t t = 0; t < count; t++)
        if (!all[t].open && all[t].lower < middle && all[t].upper > middle && all[t].worn > best.worn)
            best = all[t];
    free(all);
    return best;
}

static struct cut_line line_at(const struct tl_topology *topology, const vec2s (*rest)[3],
                               const vec3s *positions, float y, float middle)
{
    struct cut_lines lines = {topology, positions, y, NULL};
    connect_lines(&lines);
    struct cut_line line = find_line(&lines, rest, middle);
    free(lines.roots);
    return line;
}

/* The line at a level, or a little below it where that one is much shorter: sleeves join the trunk of a
 * garment lower than arms join that of a body. Zero where it never is. */
static struct cut_line clear_line(const struct tl_topology *topology, const vec2s (*rest)[3],
                                  const vec3s *positions, float y, float middle)
{
    const float step_m = 0.02f;
    const int steps = 4;
    const double jump = 1.1;
    struct cut_line line = line_at(topology, rest, positions, y, middle);
    for (int step = 1; step <= steps && line.worn > 0; step++) {
        float below = (float)step * step_m;
        struct cut_line lower = line_at(topology, rest, positions, y - below, middle);
        if (!(lower.worn > 0) || line.worn < jump * lower.worn)
            return line;
        line = lower;
    }
    return (struct cut_line){0};
}

void tl_girths_of_cloth(const tl_mesh *body, const struct tl_topology *topology, const vec2s (*rest)[3],
                        const vec3s *positions, struct tl_girth_measures girths[TL_GIRTHS])
{
    for (int i = 0; i < TL_GIRTHS; i++) {
        float y = (float)girths[i].height_m;
        struct tl_girth girth;
        if (!(y > 0) || !tl_mesh_girth(body, y, &girth))
            continue;
        struct cut_line line = i == TL_GIRTH_BUST ? clear_line(topology, rest, positions, y, girth.centre.x)
                                                  : line_at(topology, rest, positions, y, girth.centre.x);
        girths[i].rest_m = line.rest;
        girths[i].worn_m = line.worn;
    }
}
