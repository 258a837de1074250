/* Keys and clicks that lie between two frames of the panel: none is lost, and they keep their order. */
#include "tests/app/view/panel/inputs_shim.h"

#include "tests/testing.h"

#include <string.h>

/* Without the queue the field reads "3navxy" or "#301020..." after a slow frame. */
static void nothing_typed_is_lost_in_a_slow_frame(void **state)
{
    (void)state;
    for (int events_a_frame = 1; events_a_frame < 64; events_a_frame++) {
        char entered[16];
        inputs_type(events_a_frame, entered);
        if (strcmp(entered, "navy") != 0)
            fail_msg("%d events a frame: the field holds \"%s\"", events_a_frame, entered);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(nothing_typed_is_lost_in_a_slow_frame)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
