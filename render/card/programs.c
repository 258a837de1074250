#include "render/card/card_internal.h"

#include "render/gpu/shaders.h"

void tl_card_release_programs(tl_graphics_card *card)
{
#define DESTROY(name, file, defines) tl_program_destroy(&card->name);
    TL_CARD_PROGRAMS(DESTROY)
#undef DESTROY
    for (int i = 0; i < 2; i++)
        tl_program_destroy(&card->draw_ids[i]);
    card->have_programs = false;
}

bool tl_card_reload(tl_graphics_card *card, tl_error *error)
{
    if (!card->have_programs)
        return true;
    bool fine = true;
#define RELOAD(name, file, defines) fine = fine && tl_program_reload(&card->name, error);
    TL_CARD_PROGRAMS(RELOAD)
#undef RELOAD
    return fine && tl_program_reload(&card->draw_ids[0], error) &&
           tl_program_reload(&card->draw_ids[1], error) && tl_card_points_reload(&card->points, error);
}

const char *tl_card_gl_refusal(const tl_gpu *gpu)
{
    const struct tl_compute_limits limits = tl_gpu_compute_limits(gpu);
    tl_error unused;
    return tl_compute_limits_check(&limits, &unused) ? NULL
                                                     : "OpenGL has too few storage buffers for a program";
}

bool tl_card_make_programs(tl_graphics_card *card, tl_error *error)
{
    if (card->have_programs)
        return true;
#define CREATE(name, file, defines)                                                                          \
    if (!tl_program_create_compute(card->gpu, tl_embedded_shaders, file, defines, &card->name, error))       \
        return false;
    TL_CARD_PROGRAMS(CREATE)
#undef CREATE
    for (int i = 0; i < 2; i++)
        if (!tl_program_create_variant(card->gpu, tl_embedded_shaders, "card_ids.vert", "card_ids.frag",
                                       i == 0 ? NULL : "#define HOLES\n", &card->draw_ids[i], error))
            return false;
    card->have_programs = true;
    return card->have_programs;
}

bool tl_card_send_frame(tl_graphics_card *card, tl_error *error)
{
    if (!tl_buffer_reserve(&card->frame_buffer, card->gpu, sizeof card->frame, error))
        return false;
    tl_buffer_write(&card->frame_buffer, 0, &card->frame, sizeof card->frame);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, card->frame_buffer.id);
    glBindBufferBase(GL_UNIFORM_BUFFER, 1, card->blends.id);
    const struct tl_card_points *points = &card->points;
    const tl_buffer *const shared[CARD_NODES] = {
        [CARD_POSITIONS] = &points->positions,
        [CARD_NORMALS] = &points->normals,
        [CARD_INDICES] = &points->corners,
        [CARD_PROBES] = &points->probes,
        [CARD_TRIANGLE_PROBES] = &points->triangle_probes,
        [CARD_LISTED] = &points->work,
        [CARD_LIST] = &points->list,
        [CARD_ORIGINS] = &points->origins,
        [CARD_VISIBLE] = &points->values,
    };
    for (unsigned i = 0; i < CARD_BUFFERS; i++) {
        const tl_buffer *buffer = i < CARD_NODES ? shared[i] : &card->buffers[i];
        if (buffer->id != 0)
            tl_buffer_bind(buffer, i);
    }
    tl_buffer_bind(&points->holes, CARD_HOLES);
    tl_tree_buffers_bind(&points->tree, CARD_NODES);
    return true;
}

void tl_card_fit_texture(tl_graphics_card *card, tl_texture *texture, unsigned format, int width, int height)
{
    if (texture->id != 0 && texture->width == width && texture->height == height)
        return;
    tl_texture_destroy(texture);
    *texture = tl_texture_create(card->gpu, GL_TEXTURE_2D, format, width, height, 1, 1);
    glTextureParameteri(texture->id, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(texture->id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void tl_card_dispatch(const tl_program *program, size_t threads, size_t group)
{
    glUseProgram(program->id);
    tl_gpu_dispatch(tl_gpu_groups(threads, group), 1, 1);
    tl_gpu_barrier();
}

void tl_card_dispatch_listed(const tl_graphics_card *card, const tl_program *program, size_t word)
{
    glUseProgram(program->id);
    tl_gpu_dispatch_indirect(&card->buffers[CARD_WORK], sizeof(uint32_t) * word);
    tl_gpu_barrier();
}
