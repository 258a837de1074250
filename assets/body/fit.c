#include "assets/body/fit.h"

#include "assets/body/form.h"
#include "assets/body/section.h"
#include "config/base/memory.h"

#include <math.h>

bool tl_mesh_girth(const tl_mesh *mesh, float y_m, struct tl_girth *out)
{
    const struct tl_plane plane = tl_plane_level(y_m);
    struct tl_section *sections;
    size_t count = tl_mesh_sections(mesh, &plane, &sections);
    *out = (struct tl_girth){0};
    for (size_t i = 0; i < count; i++)
        if (sections[i].girth_m > out->length_m)
            *out =
                (struct tl_girth){sections[i].girth_m,
                                  glms_vec2_scale(glms_vec2_add(sections[i].lower, sections[i].upper), 0.5f)};
    tl_sections_release(&sections, count);
    return count > 0;
}

bool tl_mesh_waist(const tl_mesh *mesh, struct tl_waist *out)
{
    const float from = 0.56f, to = 0.66f; /* of the body's height */
    const int sections = 21;
    struct tl_box box = tl_box_of(mesh->positions, mesh->vertex_count);
    float height = box.upper.y - box.lower.y;
    *out = (struct tl_waist){.girth = {.length_m = INFINITY}};
    for (int i = 0; i < sections; i++) {
        float y = box.lower.y + height * (from + (to - from) * (float)i / (float)(sections - 1));
        struct tl_girth girth;
        if (tl_mesh_girth(mesh, y, &girth) && girth.length_m < out->girth.length_m)
            *out = (struct tl_waist){y, girth};
    }
    return isfinite(out->girth.length_m);
}

/* The shares of the height between which a trunk is measured: of a person from the crotch to below the arms.
 */
static const float trunk[2] = {0.45f, 0.72f};
static const float all_of_it[2] = {0.1f, 0.9f};

/* False when no section was found. */
static bool extreme_girths(const tl_mesh *mesh, const float shares[2], float *narrowest_m, float *widest_m)
{
    const int sections = 21;
    struct tl_box box = tl_box_of(mesh->positions, mesh->vertex_count);
    float height = box.upper.y - box.lower.y;
    *narrowest_m = INFINITY;
    *widest_m = 0;
    for (int i = 0; i < sections; i++) {
        float share = shares[0] + (shares[1] - shares[0]) * (float)i / (float)(sections - 1);
        struct tl_girth girth;
        if (!tl_mesh_girth(mesh, box.lower.y + height * share, &girth))
            continue;
        *narrowest_m = fminf(*narrowest_m, girth.length_m);
        *widest_m = fmaxf(*widest_m, girth.length_m);
    }
    return *widest_m > 0;
}

static float longest_side(const tl_mesh *mesh)
{
    struct tl_box box = tl_box_of(mesh->positions, mesh->vertex_count);
    return glms_vec3_max(glms_vec3_sub(box.upper, box.lower));
}

char *tl_describe_size(const char *name, const tl_mesh *garment, const char *body_name, const tl_mesh *body)
{
    /* Knits are worn stretched by some percent; coats are wider than bodies by a quarter. */
    const float too_small = 0.9f, too_large = 4.0f / 3, too_long = 1.25f, too_short = 0.1f;
    float narrowest_m, widest_m, body_narrowest_m, body_widest_m;
    struct tl_waist waist;
    const char *remedy = "it was made for another body, or its units are others; --units and --scale size it";
    float garment_m = longest_side(garment), body_m = longest_side(body);
    if (garment_m > too_long * body_m || garment_m < too_short * body_m)
        return tl_format("%s: %.3g times as large as %s (%.3g m and %.3g m at their longest): %s", name,
                         (double)(garment_m / body_m), body_name, (double)garment_m, (double)body_m, remedy);
    if (!tl_mesh_waist(body, &waist) || !extreme_girths(body, trunk, &body_narrowest_m, &body_widest_m) ||
        !extreme_girths(garment, all_of_it, &narrowest_m, &widest_m))
        return NULL;
    double small = (double)(widest_m / waist.girth.length_m), large = (double)(narrowest_m / body_widest_m);
    if (small < (double)too_small)
        return tl_format("%s: at its widest %.2f m around, %.2f of the waist of %s: %s", name,
                         (double)widest_m, small, body_name, remedy);
    if (large > (double)too_large)
        return tl_format("%s: at its narrowest %.2f m around, %.2f times as wide as %s is anywhere: %s", name,
                         (double)narrowest_m, large, body_name, remedy);
    return NULL;
}

char *tl_describe_waist(const char *name, const char *body_name, const tl_mesh *body)
{
    const float form_m = (float)tl_form_girth(TL_FORM_WAIST), same = 0.03f;
    struct tl_waist waist;
    if (!tl_mesh_waist(body, &waist) || fabsf(waist.girth.length_m / form_m - 1) < same)
        return NULL;
    return tl_format("%s: cut for a waist of %.2f m around, that of %s is %.2f m: it is worn as it was cut; "
                     "scene.refit=true makes it %.2f times as large",
                     name, (double)form_m, body_name, (double)waist.girth.length_m,
                     (double)(waist.girth.length_m / form_m));
}

bool tl_garment_fit(tl_garment *garment, const char *body_name, const tl_mesh *body, bool scaled,
                    tl_error *error)
{
    struct tl_waist waist;
    if (!tl_mesh_waist(body, &waist))
        return tl_fail(error, TL_INPUT,
                       "%s: no waist was found to fit a built-in garment to: name a garment file", body_name);
    float scale = scaled ? waist.girth.length_m / (float)tl_form_girth(TL_FORM_WAIST) : 1;
    tl_mesh *mesh = &garment->model.mesh;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        vec3s *p = &mesh->positions[i];
        p->x = waist.girth.centre.x + scale * p->x;
        p->y = waist.y_m + scale * (p->y - (float)TL_FORM_WAIST);
        p->z = waist.girth.centre.y + scale * p->z;
        garment->pattern[i] = glms_vec2_scale(garment->pattern[i], scale);
        mesh->uvs[i] = glms_vec2_scale(mesh->uvs[i], scale);
    }
    return true;
}
