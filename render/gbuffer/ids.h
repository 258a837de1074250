/* The ID buffer on the CPU: the number of the nearest triangle at every pixel, of those behind it while these
 * are open, and a list of the triangles that are seen. On hardware, and where alpha maps cut holes, GL
 * rasterises one integer target and depth, which is read back once. Where GL runs on the CPU itself, raster.h
 * takes its place, with the same result: GL's vertex stage on one thread took ten times as long.
 *
 * Lifetime: owns its arrays and GL objects; needs the context of its tl_gpu. Threads: that of the context. */
#ifndef TOILE_RENDER_GBUFFER_IDS_H
#define TOILE_RENDER_GBUFFER_IDS_H

#include "render/gbuffer/gbuffer.h"
#include "render/gbuffer/raster.h"
#include "render/gbuffer/samples.h"

struct tl_id_buffer {
    struct tl_gbuffer drawn;  /* by GL: its one layer */
    struct tl_gbuffer behind; /* ... and that of what lies behind */
    tl_texture passed;        /* depth of the layers that have been passed, from the second on */
    struct tl_raster raster;  /* on the CPU */
    int width, height;
    uint32_t *ids; /* [height][width], rows upwards: 0 nothing; else 1 + triangle, and TL_SAMPLE_BACK */
    size_t capacity;
    /* The layers behind open triangles, of up to layer_count - 1 layers, as `ids`; and how many of these
     * hold something in each row. Beyond them rows hold 0. */
    uint32_t *layers[TL_TRANSPARENCY_LAYERS];
    uint8_t *depths; /* [height] */
    int layer_count; /* 1: only the nearest */
    size_t covered;  /* pixels, of all layers */
    /* Each triangle that is seen, once a side, in order: its global number, and TL_SAMPLE_BACK. Of those that
     * light comes through both sides are listed. */
    size_t seen_count, triangle_count;
    uint32_t *seen;   /* [2 triangle_count] */
    uint32_t *places; /* [2 triangle + back]: index into `seen`, of those that are there */
    uint8_t *marks;
};

/* Draws and reads the buffer: all layers, and the list. `request->only_triangle` must be set. Errors: false
 * when a program fails. */
bool tl_ids_draw(struct tl_id_buffer *buffer, tl_gpu *gpu, const struct tl_gbuffer_request *request,
                 const struct tl_triangle_ranges *ranges, tl_error *error);
/* Draws the nearest layer; what is seen is not listed. */
bool tl_ids_draw_nearest(struct tl_id_buffer *buffer, tl_gpu *gpu, const struct tl_gbuffer_request *request,
                         const struct tl_triangle_ranges *ranges, tl_error *error);
/* Compiles the programs again. */
bool tl_ids_reload(struct tl_id_buffer *buffer, tl_error *error);
void tl_ids_release(struct tl_id_buffer *buffer);
size_t tl_ids_bytes(const struct tl_id_buffer *buffer);

/* An ID that is not 0 as an index: 2 triangle + back. */
static inline size_t tl_ids_mark(uint32_t id)
{
    return 2 * ((size_t)(id & ~TL_SAMPLE_BACK) - 1) + (id & TL_SAMPLE_BACK ? 1 : 0);
}

/* One layer, 0 the nearest, as a buffer whose `ids` it is: borrowed, never released. */
static inline struct tl_id_buffer tl_ids_layer(const struct tl_id_buffer *buffer, int layer)
{
    struct tl_id_buffer view = *buffer;
    view.ids = layer > 0 ? buffer->layers[layer - 1] : buffer->ids;
    return view;
}

/* The place in `seen` of what an ID that is not 0 stands for. */
static inline uint32_t tl_ids_place(const struct tl_id_buffer *buffer, uint32_t id)
{
    return buffer->places[tl_ids_mark(id)];
}

#endif
