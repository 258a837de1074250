#include "app/display/board.h"

#include "assets/sewing/layout.h"
#include "config/base/memory.h"

#include <stdlib.h>

/* Distances from what stands beside it, and above the ground. */
#define GAP_M   0.2f
#define ABOVE_M 0.05f

void tl_board_make(const tl_garment *garment, struct tl_box beside, struct tl_moving *out)
{
    const tl_mesh *mesh = &garment->model.mesh;
    vec2s *flat = TL_NEW_ARRAY(vec2s, mesh->vertex_count), size;
    *out = (struct tl_moving){0};
    if (tl_layout_make(garment, flat, &size)) {
        uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
        for (uint32_t i = 0; i < mesh->vertex_count; i++)
            weld[i] = i;
        tl_moving_create(out, &garment->model, weld);
        free(weld);
        vec3s middle = glms_vec3_scale(glms_vec3_add(beside.lower, beside.upper), 0.5f);
        float lower = fmaxf(middle.y - size.y / 2, ABOVE_M), left = beside.upper.x + GAP_M;
        for (size_t i = 0; i < mesh->vertex_count; i++)
            out->positions[i] = (vec3s){{left + flat[i].x, lower + flat[i].y, middle.z}};
        tl_moving_update(out);
    }
    free(flat);
}

tl_surface tl_board_surface(const struct tl_moving *board, const tl_surface *garment)
{
    tl_surface surface = *garment;
    surface.name = TL_SURFACE_PATTERN;
    surface.positions = board->positions;
    surface.normals = board->normals;
    surface.tangents = board->tangents;
    surface.has_own_normals = false;
    surface.crossed = NULL;
    return surface;
}
