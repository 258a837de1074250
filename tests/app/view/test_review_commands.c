/* The table of the window's commands, without a window: no key is bound twice, every row has help and an
 * action, and every key and every button leads to its row. */
#include "tests/testing.h"

#include "app/view/command/review_commands.h"
#include "config/base/memory.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <string.h>

#define LINES_MAX 128

static void no_key_is_bound_twice(void **state)
{
    (void)state;
    size_t key_count = 0;
    for (size_t i = 0; i < tl_review_command_count; i++)
        for (int k = 0; k < TL_REVIEW_KEYS_MAX; k++) {
            const struct tl_review_key *row = &tl_review_commands[i].keys[k];
            for (int key = row->key; key < row->key + row->count; key++, key_count++) {
                int argument = -100;
                /* The first match is the row itself: no row before it has the key. */
                assert_ptr_equal(tl_review_command_of_key(key, row->modifiers, &argument),
                                 &tl_review_commands[i]);
                assert_int_equal(argument, row->argument + key - row->key);
                for (int other = 0; other < k; other++) {
                    const struct tl_review_key *before = &tl_review_commands[i].keys[other];
                    assert_false(before->modifiers == row->modifiers && key >= before->key &&
                                 key < before->key + before->count);
                }
            }
        }
    assert_true(key_count > tl_review_command_count);
    int argument;
    assert_null(tl_review_command_of_key(GLFW_KEY_KP_0, 0, &argument));
    assert_null(tl_review_command_of_key(GLFW_KEY_Q, GLFW_MOD_ALT, &argument));
    assert_null(tl_review_command_of_key(GLFW_KEY_UNKNOWN, 0, &argument));
}

static void every_row_has_a_key_help_and_an_action(void **state)
{
    (void)state;
    for (size_t i = 0; i < tl_review_command_count; i++) {
        const struct tl_review_command *command = &tl_review_commands[i];
        assert_true(command->keys[0].count > 0);
        assert_true(command->help && command->help[0]);
        assert_true(command->act != NULL);
        assert_true(command->section < TL_SECTION_COUNT);
        assert_true((command->button_on == NULL) == (command->is_on == NULL));
        assert_true(command->button || !command->button_on);
    }
    for (size_t i = 0; i < tl_review_gesture_count; i++)
        assert_true(tl_review_gestures[i].help[0] && tl_review_gestures[i].section < TL_SECTION_COUNT);
}

static void every_button_leads_to_its_row(void **state)
{
    (void)state;
    size_t expected = 0;
    for (size_t i = 0; i < tl_review_command_count; i++)
        expected += tl_review_commands[i].button != NULL;
    struct tl_review_buttons buttons;
    tl_review_list_buttons(NULL, &buttons);
    assert_int_equal(buttons.count, expected); /* none is left out for want of room */
    for (size_t i = 0; i < buttons.count; i++) {
        assert_string_equal(buttons.of[i].label, buttons.commands[i]->button);
        assert_ptr_equal(strstr(buttons.of[i].help, buttons.commands[i]->help), buttons.of[i].help);
        for (size_t k = 0; k < i; k++)
            assert_true(strcmp(buttons.of[i].label, buttons.of[k].label) != 0);
    }
    struct tl_review *playing = TL_NEW(struct tl_review);
    playing->play.is_on = true;
    tl_review_list_buttons(playing, &buttons);
    assert_string_equal(buttons.of[0].label, "Pause");
    free(playing);
}

static const struct tl_review_command *find(tl_review_action *act)
{
    for (size_t i = 0; i < tl_review_command_count; i++)
        if (tl_review_commands[i].act == act)
            return &tl_review_commands[i];
    return NULL;
}

static void keys_are_named_as_they_are_printed_on_them(void **state)
{
    (void)state;
    const struct {
        tl_review_action *act;
        const char *names;
    } expected[] = {
        {tl_act_play, "Space"},         {tl_act_turn_camera, "Left  Right  Up  Down"},
        {tl_act_zoom, "PgUp  PgDn"},    {tl_act_view, "1 to 9"},
        {tl_act_fabric, "Ctrl+1 to 9"}, {tl_act_next_fabric, "G  Shift+G"},
        {tl_act_help, "H  F1"},         {tl_act_redo, "Ctrl+Shift+Z  Ctrl+Y"},
        {tl_act_panel, "Tab"},          {tl_act_turn_environment, "[  ]"},
    };
    char text[64];
    for (size_t i = 0; i < TL_COUNT(expected); i++) {
        tl_review_key_names(find(expected[i].act), text, sizeof text);
        assert_string_equal(text, expected[i].names);
    }
    for (size_t i = 0; i < tl_review_command_count;
         i++) { /* a key without a name of its own would print a control code */
        tl_review_key_names(&tl_review_commands[i], text, sizeof text);
        for (const char *c = text; *c; c++)
            assert_true(*c >= ' ' && *c <= '~');
    }
}

static void the_list_of_keys_has_every_row_once(void **state)
{
    (void)state;
    static struct tl_panel_line lines[LINES_MAX];
    size_t count = tl_review_help(lines, LINES_MAX);
    assert_int_equal(count, TL_SECTION_COUNT + tl_review_command_count + tl_review_gesture_count);
    for (size_t i = 0; i < tl_review_command_count; i++) {
        size_t found = 0;
        for (size_t k = 0; k < count; k++)
            found += strcmp(lines[k].cells[1], tl_review_commands[i].help) == 0;
        assert_true(found >= 1);
    }
    assert_int_equal(tl_review_help(lines, 3), 3); /* and no more than there is room for */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_key_is_bound_twice),
        cmocka_unit_test(every_row_has_a_key_help_and_an_action),
        cmocka_unit_test(every_button_leads_to_its_row),
        cmocka_unit_test(keys_are_named_as_they_are_printed_on_them),
        cmocka_unit_test(the_list_of_keys_has_every_row_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
