/* How a pattern hangs at the options' defaults: cloth that is stiff in its plane must fold where it is free,
 * which it cannot where its triangles are too large. */
#include "app/scene/session.h"
#include "app/settings/settings.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#include <stdlib.h>

/* The front of a shirt of plain cotton hangs: the lower end of its front seam is near the body's front. At
 * edges of 20 mm it stood 10 cm before it, held by a ridge along the seam. */
static void the_front_of_a_shirt_hangs(void **state)
{
    (void)state;
    const float belly_z = 0.135f; /* mean_all.obj between 1.05 and 1.15 m */
    /* Free cloth before it, at most: twice the fall of the bust before the belly, and as much for the ridge
     * of its triangles of 14 mm, which are as stiff in their plane as the fabric is. */
    const float hem_z = 0.1f;
    char *garment = tl_format("scene.garment=%s", test_data("patterns/shirt_mean_specification.json"));
    char *avatar = tl_format("scene.avatar=%s", test_data("avatars/mean_all.obj"));
    const char *const assignments[] = {garment, avatar, "scene.environment=white"};
    tl_error error = {0};
    struct tl_settings *settings = TL_NEW(struct tl_settings);
    assert_ok(tl_settings_load(settings, &(struct tl_settings_source){NULL, assignments, 3}, &error), error);
    tl_session *session = tl_session_create(settings, &error);
    assert_ok(session != NULL, error);
    assert_int_equal(tl_session_garment_state(session), TL_GARMENT_AT_REST);
    tl_frame frame = tl_session_frame(session);
    const tl_surface *shown = &frame.surfaces[frame.surface_count - 1];
    vec3s lowest = {{0, 10, 0}};
    for (size_t i = 0; i < shown->vertex_count;
         i++) { /* of the front, in the middle: the seam's end at the hem */
        vec3s at = shown->positions[i];
        if (at.z > 0 && fabsf(at.x) < 0.02f && at.y < lowest.y)
            lowest = at;
    }
    print_message("the front seam ends at y %.3f, z %.3f m\n", (double)lowest.y, (double)lowest.z);
    assert_true(lowest.z < belly_z + hem_z);
    tl_session_destroy(&session);
    free(settings);
    free(garment);
    free(avatar);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_front_of_a_shirt_hangs)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
