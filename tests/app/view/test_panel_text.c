/* Fields of the panel whose text changes while nobody types in them. */
#include "tests/app/view/fields_shim.h"

#include "tests/testing.h"

/* The library's own steps of undo would write outside of the text: it aborts within some rounds. */
static void a_field_survives_other_texts(void **state)
{
    (void)state;
    fields_drive(300);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_field_survives_other_texts)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
