/* The two ways to draw an ID buffer. tl_ids_draw chooses one of them; tests compare them. `is_whole`: with
 * the layers behind open triangles and the list of what is seen. */
#ifndef TOILE_RENDER_GBUFFER_IDS_INTERNAL_H
#define TOILE_RENDER_GBUFFER_IDS_INTERNAL_H

#include "render/gbuffer/ids.h"

bool tl_ids_draw_by_gl(struct tl_id_buffer *buffer, tl_gpu *gpu, const struct tl_gbuffer_request *request,
                       const struct tl_triangle_ranges *ranges, bool is_whole, tl_error *error);
/* No part may have holes, no surface be hidden. */
void tl_ids_draw_on_cpu(struct tl_id_buffer *buffer, const struct tl_gbuffer_request *request,
                        const struct tl_triangle_ranges *ranges, bool is_whole);

#endif
