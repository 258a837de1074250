/* Text fields of the panel whose text is changed by the program between two edits. */
#include "tests/app/view/panel/fields_shim.h"

#include "tests/testing.h"

/* Without tl_panel_forget_text the library's undo writes outside of the text and aborts within some rounds.
 */
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
