#include "assets/cut/fit.h"

#include "assets/builtin/form.h"
#include "assets/cut/section.h"

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

bool tl_garment_fit(tl_garment *garment, const char *body_name, const tl_mesh *body, tl_error *error)
{
    struct tl_waist waist;
    if (!tl_mesh_waist(body, &waist))
        return tl_fail(error, TL_INPUT,
                       "%s: no waist was found to fit a built-in garment to: name a garment file", body_name);
    float scale = waist.girth.length_m / (float)tl_form_girth(TL_FORM_WAIST);
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
