#include "assets/body/body.h"

#include "assets/body/fit.h"
#include "assets/body/section.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

enum part { TRUNK, LEG };

/* The part's section: the trunk's is the largest that the middle plane cuts, a leg's the largest on +X. */
static const struct tl_section *find_part(const struct tl_section *sections, size_t count, enum part part)
{
    const struct tl_section *found = NULL;
    for (size_t i = 0; i < count; i++) {
        const struct tl_section *section = &sections[i];
        bool middle = section->lower.x < 0 && section->upper.x > 0;
        bool fits = part == TRUNK ? middle : !middle && section->upper.x > 0;
        if (fits && (!found || section->girth_m > found->girth_m))
            found = section;
    }
    return found;
}

/* Girth of a part at a height, 0 where there is none; with `ring`, a ring of the given length around it. */
static double measure(const tl_mesh *mesh, double y, enum part part, double length, struct tl_ring *ring)
{
    const struct tl_plane plane = tl_plane_level((float)y);
    struct tl_section *sections;
    size_t count = tl_mesh_sections(mesh, &plane, &sections);
    const struct tl_section *section = find_part(sections, count, part);
    double girth = section ? (double)section->girth_m : 0;
    if (section && ring) {
        tl_section_ring(section, part == TRUNK, length, ring);
        ring->y = y;
    }
    tl_sections_release(&sections, count);
    return girth;
}

double tl_body_trunk_girth(const struct tl_body *body, double y)
{
    return measure(body->mesh, y, TRUNK, 0, NULL);
}

double tl_body_leg_girth(const struct tl_body *body, double y)
{
    return measure(body->mesh, y, LEG, 0, NULL);
}

bool tl_body_trunk_ring(const struct tl_body *body, double y, double length, struct tl_ring *out)
{
    return measure(body->mesh, y, TRUNK, length, out) > 0;
}

bool tl_body_leg_ring(const struct tl_body *body, double y, double length, struct tl_ring *out)
{
    return measure(body->mesh, y, LEG, length, out) > 0;
}

double tl_body_crotch_length(const struct tl_body *body, double y)
{
    const struct tl_plane middle = {{{0, (float)y, 0}}, {{0, 0, 1}}, {{0, 1, 0}}};
    struct tl_section *sections;
    size_t count = tl_mesh_sections(body->mesh, &middle, &sections);
    double length = 0;
    for (size_t s = 0; s < count; s++) {
        double below = 0;
        for (size_t i = 0; i < sections[s].hull_count; i++) {
            vec2s a = sections[s].hull[i], b = sections[s].hull[(i + 1) % sections[s].hull_count];
            float low = fminf(a.y, b.y), high = fmaxf(a.y, b.y);
            if (low < 0)
                below += (double)glms_vec2_distance(a, b) * (double)(high > 0 ? -low / (high - low) : 1);
        }
        length = fmax(length, below);
    }
    tl_sections_release(&sections, count);
    return length;
}

/* The height at which the trunk's section splits, between a height with a trunk and one without. */
static double split_height(const tl_mesh *mesh, double with, double without)
{
    for (int step = 0; step < 10; step++) {
        double middle = 0.5 * (with + without);
        if (measure(mesh, middle, TRUNK, 0, NULL) > 0)
            with = middle;
        else
            without = middle;
    }
    return with;
}

/* Whether a section has arms beside the trunk. */
static bool has_arms(const tl_mesh *mesh, double y)
{
    const struct tl_plane plane = tl_plane_level((float)y);
    struct tl_section *sections;
    size_t count = tl_mesh_sections(mesh, &plane, &sections);
    bool left = false, right = false, trunk = find_part(sections, count, TRUNK) != NULL;
    for (size_t i = 0; i < count; i++) {
        left |= sections[i].lower.x > 0;
        right |= sections[i].upper.x < 0;
    }
    tl_sections_release(&sections, count);
    return left && right && trunk;
}

/* Bust, underarm and arm, where arms hang beside the trunk above the waist. */
static void measure_chest(struct tl_body *body, double step)
{
    bool arms = false;
    for (int level = 0; body->waist_y + level * step < 0.9 * body->height; level++) {
        double y = body->waist_y + level * step;
        bool here = has_arms(body->mesh, y);
        if (arms && !here)
            break;
        arms = here;
        body->bust = fmax(body->bust, tl_body_trunk_girth(body, y));
        body->underarm_y = here ? y : 0;
    }
    if (!(body->underarm_y > 0) || !tl_body_measure_arm(body->mesh, body->underarm_y, &body->arm))
        body->underarm_y = 0;
}

static void measure_neck(struct tl_body *body, double step)
{
    body->neck = INFINITY;
    for (int level = 0; body->underarm_y + level * step < 0.9 * body->height; level++) {
        double y = body->underarm_y + level * step;
        const struct tl_plane plane = tl_plane_level((float)y);
        struct tl_section *sections;
        size_t count = tl_mesh_sections(body->mesh, &plane, &sections);
        const struct tl_section *neck = find_part(sections, count, TRUNK);
        if (neck && (double)neck->girth_m < body->neck) {
            body->neck = (double)neck->girth_m;
            body->neck_y = y;
            body->neck_half = 0.5 * (double)(neck->upper.x - neck->lower.x);
            body->neck_z = 0.5 * (double)(neck->upper.y + neck->lower.y);
        }
        tl_sections_release(&sections, count);
    }
}

bool tl_body_measure(const char *name, const tl_mesh *mesh, struct tl_body_distance distance,
                     struct tl_body *out, tl_error *error)
{
    const double step = 0.01;
    struct tl_box box = tl_box_of(mesh->positions, mesh->vertex_count);
    *out = (struct tl_body){.mesh = mesh, .distance = distance, .height = (double)box.upper.y};
    struct tl_waist waist;
    if (!tl_mesh_waist(mesh, &waist))
        return tl_fail(error, TL_INPUT,
                       "%s: no waist was found to fit a built-in garment to: name a garment file", name);
    out->waist_y = (double)waist.y_m;
    out->waist = (double)waist.girth.length_m;
    double y = out->waist_y, girth = out->waist;
    for (; girth > 0 && y > 0.3 * out->height; y -= step, girth = measure(mesh, y, TRUNK, 0, NULL)) {
        if (girth > out->hip) {
            out->hip = girth;
            out->hip_y = y;
        }
    }
    double thigh = measure(mesh, y, LEG, 0, NULL);
    if (girth > 0 || !(thigh > 0))
        return tl_fail(error, TL_INPUT,
                       "%s: has no legs that part below the waist, so no trousers are cut for it", name);
    out->crotch_y = split_height(mesh, y + step, y);
    measure_chest(out, step);
    if (out->underarm_y > 0)
        measure_neck(out, step);
    out->knee = measure(mesh, 0.55 * out->crotch_y, LEG, 0, NULL);
    double part = 0.3; /* of the crotch's height */
    for (int i = 0; i < 10; i++, part += 0.025)
        out->calf = fmax(out->calf, measure(mesh, part * out->crotch_y, LEG, 0, NULL));
    return true;
}
