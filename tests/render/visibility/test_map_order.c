#include "render/visibility/map_order.h"

#include "tests/testing.h"

#include <string.h>

#define MAPS 96

static void age(struct tl_map_wait *waits, int count, const bool *due, int *drawn)
{
    for (int i = 0; i < count; i++) {
        waits[i].age = due[i] ? 1 : waits[i].age + 1;
        drawn[i] += due[i];
    }
}

static int count_of(const bool *due, int count)
{
    int sum = 0;
    for (int i = 0; i < count; i++)
        sum += due[i];
    return sum;
}

/* Energies over five decades: the bright ones come often, the dark ones not never. */
static void everybody_gets_a_turn(void **state)
{
    (void)state;
    struct tl_map_wait waits[MAPS];
    int drawn[MAPS] = {0}, frames = 600, maximum = 12, cap = tl_map_age_cap(MAPS, maximum);
    long sum = 0;
    for (int i = 0; i < MAPS; i++)
        waits[i] =
            (struct tl_map_wait){.energy = powf(10, -5.0f * (float)i / MAPS), .softness = 0.1f, .age = 1};
    assert_int_equal(cap, 16);
    for (int frame = 0; frame < frames; frame++) {
        bool due[MAPS];
        tl_map_order(waits, MAPS, maximum, due);
        assert_true(count_of(due, MAPS) >= maximum);
        sum += count_of(due, MAPS);
        age(waits, MAPS, due, drawn);
        for (int i = 0; i < MAPS; i++)
            assert_in_range(waits[i].age, 1, cap);
    }
    assert_true(drawn[0] > 3 * drawn[MAPS - 1]);
    assert_in_range(drawn[MAPS - 1], frames / cap - 1, frames / cap + 1);
    /* The cap's turns are half of all at most, so that this is what they add. */
    assert_true((double)sum / frames <= 1.5 * maximum);
}

static void equal_maps_take_turns(void **state)
{
    (void)state;
    struct tl_map_wait waits[MAPS];
    int drawn[MAPS] = {0};
    for (int i = 0; i < MAPS; i++)
        waits[i] = (struct tl_map_wait){.energy = 2, .softness = 0.3f, .age = 1};
    for (int frame = 0; frame < 80; frame++) {
        bool due[MAPS];
        tl_map_order(waits, MAPS, 12, due);
        assert_int_equal(count_of(due, MAPS), 12);
        age(waits, MAPS, due, drawn);
    }
    for (int i = 0; i < MAPS; i++)
        assert_int_equal(drawn[i], 10);
}

/* Of two maps with the same energy the one with the sharper shadow is drawn first; a limit of all draws all.
 */
static void sharp_shadows_go_first(void **state)
{
    (void)state;
    const struct tl_map_wait waits[3] = {{1, 0.5f, 1}, {1, 0.05f, 1}, {0, 0.05f, 1}};
    bool due[3];
    tl_map_order(waits, 3, 1, due);
    assert_true(!due[0] && due[1] && !due[2]);
    tl_map_order(waits, 3, 2, due);
    assert_true(due[0] && due[1] && !due[2]);
    const int whole[] = {0, 3, 7};
    for (int i = 0; i < 3; i++) {
        memset(due, 0, sizeof due);
        tl_map_order(waits, 3, whole[i], due);
        assert_int_equal(count_of(due, 3), 3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(everybody_gets_a_turn),
        cmocka_unit_test(equal_maps_take_turns),
        cmocka_unit_test(sharp_shadows_go_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
