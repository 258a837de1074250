/* The cloth's step beside other work gives the frames that it gives without, to the bit, whatever is done to
 * the session while it runs. Oracle: a second session that is stepped in turn. */
#include "tests/app/quick_session.h"

#include <string.h>

#define FRAMES 6

struct both {
    tl_session *beside, *in_turn;
};

/* Not smoothed: what is drawn is then what the cloth's positions were copied to. */
static tl_session *open_session(void)
{
    struct tl_settings settings = quick_settings(NULL);
    settings.scene.smooth = false;
    tl_error error = {0};
    tl_session *session = tl_session_create(&settings, &error);
    assert_ok(session != NULL, error);
    return session;
}

static struct both open_both(void)
{
    return (struct both){open_session(), open_session()};
}

static void close_both(struct both *both)
{
    tl_session_destroy(&both->beside);
    tl_session_destroy(&both->in_turn);
}

static const tl_surface *garment_of(tl_session *session, tl_frame *frame)
{
    *frame = tl_session_frame(session);
    return &frame->surfaces[frame->surface_count - 1];
}

static void assert_same(struct both *both)
{
    tl_frame first, second;
    const tl_surface *a = garment_of(both->beside, &first), *b = garment_of(both->in_turn, &second);
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_memory_equal(a->positions, b->positions, a->vertex_count * sizeof *a->positions);
    assert_memory_equal(a->normals, b->normals, a->vertex_count * sizeof *a->normals);
    assert_int_equal(tl_session_frame_number(both->beside), tl_session_frame_number(both->in_turn));
}

static void advance(tl_session *session)
{
    tl_error error = {0};
    assert_ok(tl_session_advance(session, &error), error);
}

/* A pull on the hem, so that every frame differs from the last one. */
static void pull(tl_session *session, int frame)
{
    const vec3s target = {{0.3f, 0.6f + 0.02f * (float)frame, 0.4f}};
    tl_cloth_grab(tl_session_cloth(session), 5, target);
}

static void begin(tl_session *session, int frame)
{
    pull(session, frame);
    assert_true(tl_session_begin_step(session));
}

static void frames_are_the_same(void **state)
{
    (void)state;
    struct both both = open_both();
    for (int i = 0; i < FRAMES; i++) {
        tl_frame drawn;
        const tl_surface *garment = garment_of(both.beside, &drawn);
        const size_t bytes = garment->vertex_count * sizeof *garment->positions;
        vec3s *before = TL_NEW_ARRAY(vec3s, garment->vertex_count);
        memcpy(before, garment->positions, bytes);
        begin(both.beside, i);
        assert_false(tl_session_begin_step(both.beside));
        tl_session_end_step(both.beside);
        assert_memory_equal(before, garment->positions, bytes); /* the frame that is drawn stays */
        advance(both.beside);
        assert_memory_not_equal(before, garment_of(both.beside, &drawn)->positions, bytes);
        pull(both.in_turn, i);
        advance(both.in_turn);
        assert_same(&both);
        free(before);
    }
    close_both(&both);
}

static void an_edit_waits(void **state)
{
    (void)state;
    struct both both = open_both();
    struct tl_settings edited = *tl_session_settings(both.beside);
    tl_error error = {0};
    edited.cloth.wind[2] = 4;
    begin(both.beside, 0);
    assert_ok(tl_session_apply(both.beside, &edited, &error), error);
    advance(both.beside);
    pull(both.in_turn, 0);
    advance(both.in_turn);
    assert_ok(tl_session_apply(both.in_turn, &edited, &error), error);
    assert_same(&both);
    for (int i = 0; i < FRAMES; i++) {
        begin(both.beside, i);
        advance(both.beside);
        pull(both.in_turn, i);
        advance(both.in_turn);
    }
    assert_same(&both);
    close_both(&both);
}

static void a_reset_drops_the_step(void **state)
{
    (void)state;
    struct both both = open_both();
    tl_error error = {0};
    begin(both.beside, 3);
    assert_ok(tl_session_reset(both.beside, &error), error);
    assert_same(&both);
    begin(both.beside, 1);
    assert_ok(tl_session_take_step(both.beside, &error), error);
    assert_ok(tl_session_take_step(both.beside, &error), error); /* there is none any more */
    pull(both.in_turn, 1);
    advance(both.in_turn);
    assert_same(&both);
    close_both(&both);
}

static void closing_waits(void **state)
{
    (void)state;
    struct both both = open_both();
    begin(both.beside, 0);
    close_both(&both);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_are_the_same),
        cmocka_unit_test(an_edit_waits),
        cmocka_unit_test(a_reset_drops_the_step),
        cmocka_unit_test(closing_waits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
