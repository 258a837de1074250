/* The handles of a gizmo as shapes of the panel's overlay, coloured by axis and lettered, so that they differ
 * without colours, too. Pure. */
#ifndef TOILE_APP_VIEW_GIZMO_GIZMO_SHAPES_H
#define TOILE_APP_VIEW_GIZMO_GIZMO_SHAPES_H

#include "app/view/gizmo/gizmo.h"
#include "app/view/panel/panel_shim.h"

#define TL_GIZMO_SHAPES_MAX 24
struct tl_gizmo_shapes {
    size_t count;
    struct tl_panel_shape of[TL_GIZMO_SHAPES_MAX]; /* whose points are below: not to be copied */
    size_t point_count;
    float points[256][2];
};

/* `marked` is drawn in the colour of what is caught; while it is held, `only`, nothing else is drawn. None
 * where the gizmo cannot be drawn. */
void tl_gizmo_list_shapes(const struct tl_gizmo *gizmo, enum tl_gizmo_handle marked, bool only,
                          struct tl_gizmo_shapes *out);

#endif
