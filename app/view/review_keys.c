/* Keys of the review window and their help: one table. */
#include "app/view/review.h"
#include "config/memory.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <stdio.h>

#define SHIFT GLFW_MOD_SHIFT
#define CTRL  GLFW_MOD_CONTROL

struct key_row {
    int key, modifiers; /* key 0: a row of help alone */
    int command;
    const char *label; /* NULL: another key for the row above */
    const char *help;  /* NULL: `label` is a heading */
    bool repeats;      /* while it is held */
};

/* Keys of one digit each. */
#define DIGITS(modifiers, command)                                                                           \
    {GLFW_KEY_2, modifiers, (command) + 1, NULL, NULL, false},                                               \
        {GLFW_KEY_3, modifiers, (command) + 2, NULL, NULL, false},                                           \
        {GLFW_KEY_4, modifiers, (command) + 3, NULL, NULL, false},                                           \
        {GLFW_KEY_5, modifiers, (command) + 4, NULL, NULL, false},                                           \
        {GLFW_KEY_6, modifiers, (command) + 5, NULL, NULL, false},                                           \
        {GLFW_KEY_7, modifiers, (command) + 6, NULL, NULL, false},                                           \
        {GLFW_KEY_8, modifiers, (command) + 7, NULL, NULL, false},                                           \
    {                                                                                                        \
        GLFW_KEY_9, modifiers, (command) + 8, NULL, NULL, false                                              \
    }

/* clang-format off */
static const struct key_row key_rows[] = {
    {0, 0, 0, "Cloth", NULL, false},
    {GLFW_KEY_SPACE, 0, TL_REVIEW_PLAY, "Space", "play, pause", false},
    {GLFW_KEY_PERIOD, 0, TL_REVIEW_STEP, ".", "one frame on", true},
    {GLFW_KEY_R, 0, TL_REVIEW_RESET, "R", "back to the settled start", false},
    {0, 0, 0, "Ctrl + drag", "pull on the cloth", false},
    {GLFW_KEY_P, 0, TL_REVIEW_PIN, "P", "while pulling: pin it there; else: take pins out", false},

    {0, 0, 0, "Camera", NULL, false},
    {0, 0, 0, "drag", "turn about the figure", false},
    {GLFW_KEY_LEFT, 0, TL_REVIEW_TURN_CAMERA_LEFT, "arrows", "the same", true},
    {GLFW_KEY_RIGHT, 0, TL_REVIEW_TURN_CAMERA_RIGHT, NULL, NULL, true},
    {GLFW_KEY_UP, 0, TL_REVIEW_TURN_CAMERA_UP, NULL, NULL, true},
    {GLFW_KEY_DOWN, 0, TL_REVIEW_TURN_CAMERA_DOWN, NULL, NULL, true},
    {0, 0, 0, "right drag", "move the figure", false},
    {GLFW_KEY_PAGE_UP, 0, TL_REVIEW_NEARER, "wheel, PgUp, PgDn", "nearer, farther", true},
    {GLFW_KEY_PAGE_DOWN, 0, TL_REVIEW_FARTHER, NULL, NULL, true},
    {0, 0, 0, "double click", "look closely at that point", false},
    {GLFW_KEY_F, 0, TL_REVIEW_FRAME_ALL, "F", "frame the whole figure", false},
    {GLFW_KEY_T, 0, TL_REVIEW_TURNTABLE, "T", "turntable", false},
    {GLFW_KEY_1, 0, TL_REVIEW_VIEW, "1 to 9", "go to a saved view", false},
    DIGITS(0, TL_REVIEW_VIEW),
    {GLFW_KEY_1, SHIFT, TL_REVIEW_SAVE_VIEW, "Shift+1 to 9", "save this view: camera and light", false},
    DIGITS(SHIFT, TL_REVIEW_SAVE_VIEW),
    {GLFW_KEY_K, 0, TL_REVIEW_PATH_KEY, "K", "add a key, 2 s on, to the camera's path", false},
    {GLFW_KEY_K, SHIFT, TL_REVIEW_PATH_RECORD, "Shift+K", "record the camera's path; again: save it", false},
    {GLFW_KEY_L, 0, TL_REVIEW_PATH_PLAY, "L", "play the path", false},

    {0, 0, 0, "Light", NULL, false},
    {GLFW_KEY_E, 0, TL_REVIEW_NEXT_ENVIRONMENT, "E", "next environment", false},
    {0, 0, 0, "Shift + drag", "turn the environment", false},
    {GLFW_KEY_LEFT_BRACKET, 0, TL_REVIEW_TURN_LEFT, "[  ]", "the same, by 15\u00b0", true},
    {GLFW_KEY_RIGHT_BRACKET, 0, TL_REVIEW_TURN_RIGHT, NULL, NULL, true},
    {GLFW_KEY_T, SHIFT, TL_REVIEW_TURN_ENVIRONMENT, "Shift+T", "the environment turns by itself", false},

    {0, 0, 0, "Fabric", NULL, false},
    {GLFW_KEY_G, 0, TL_REVIEW_NEXT_FABRIC, "G, Shift+G", "next fabric, the one before", false},
    {GLFW_KEY_G, SHIFT, TL_REVIEW_PREVIOUS_FABRIC, NULL, NULL, false},
    {GLFW_KEY_1, CTRL, TL_REVIEW_FABRIC, "Ctrl+1 to 9", "a fabric, in the order of the panel's list", false},
    DIGITS(CTRL, TL_REVIEW_FABRIC),

    {GLFW_KEY_C, 0, TL_REVIEW_NEXT_COLOURWAY, "C, Shift+C", "next colourway, the one before", false},
    {GLFW_KEY_C, SHIFT, TL_REVIEW_PREVIOUS_COLOURWAY, NULL, NULL, false},

    {0, 0, 0, "Compare", NULL, false},
    {GLFW_KEY_W, 0, TL_REVIEW_COMPARE, "W", "split the view: A stays as it looks now", false},
    {GLFW_KEY_X, 0, TL_REVIEW_EXCHANGE, "X", "exchange A and B", false},
    {GLFW_KEY_COMMA, 0, TL_REVIEW_WIPE_LEFT, ",  /", "move the line; or drag it", true},
    {GLFW_KEY_SLASH, 0, TL_REVIEW_WIPE_RIGHT, NULL, NULL, true},

    {0, 0, 0, "Inspect", NULL, false},
    {GLFW_KEY_V, 0, TL_REVIEW_NEXT_VIEW, "V, Shift+V", "normals, UVs, visibility, strain ...", false},
    {GLFW_KEY_V, SHIFT, TL_REVIEW_PREVIOUS_VIEW, NULL, NULL, false},
    {GLFW_KEY_B, 0, TL_REVIEW_PLAIN_VIEW, "B", "light again", false},
    {GLFW_KEY_I, 0, TL_REVIEW_READ_OUT, "I", "read out what lies under the pointer", false},

    {0, 0, 0, "Window", NULL, false},
    {GLFW_KEY_Z, CTRL, TL_REVIEW_UNDO, "Ctrl+Z", "undo", true},
    {GLFW_KEY_Z, CTRL | SHIFT, TL_REVIEW_REDO, "Ctrl+Shift+Z", "redo; also Ctrl+Y", true},
    {GLFW_KEY_Y, CTRL, TL_REVIEW_REDO, NULL, NULL, true},
    {GLFW_KEY_MINUS, 0, TL_REVIEW_BUDGET_LESS, "-  =", "less, more time for a frame", false},
    {GLFW_KEY_EQUAL, 0, TL_REVIEW_BUDGET_MORE, NULL, NULL, false},
    {GLFW_KEY_S, 0, TL_REVIEW_SCREENSHOT, "S, F12", "screenshot as PNG", false},
    {GLFW_KEY_F12, 0, TL_REVIEW_SCREENSHOT, NULL, NULL, false},
    {GLFW_KEY_S, SHIFT, TL_REVIEW_SCREENSHOT_LINEAR, "Shift+S", "screenshot as EXR, linear", false},
    {GLFW_KEY_O, 0, TL_REVIEW_OPTIONS, "O", "use the panel by keys; Esc ends", false},
    {GLFW_KEY_TAB, 0, TL_REVIEW_PANEL, "Tab", "hide or show the panel", false},
    {0, 0, 0, "drop a file", ".glb .gltf .obj: model; .pc2 .mdd: motion", false},
    {0, 0, 0, "", ".exr .hdr: light; .yaml: scene, fabric, preset", false},
    {GLFW_KEY_H, 0, TL_REVIEW_HELP, "H, F1", "this list", false},
    {GLFW_KEY_F1, 0, TL_REVIEW_HELP, NULL, NULL, false},
    {GLFW_KEY_ESCAPE, 0, TL_REVIEW_BACK, "Esc", "stop or close what is open, or leave", false},
    {GLFW_KEY_Q, 0, TL_REVIEW_QUIT, "Q", "leave", false},
};
/* clang-format on */

size_t tl_review_help(struct tl_panel_line *lines, size_t capacity)
{
    size_t count = 0;
    for (size_t i = 0; i < TL_COUNT(key_rows) && count < capacity; i++) {
        const struct key_row *row = &key_rows[i];
        if (!row->label)
            continue;
        struct tl_panel_line *line = &lines[count++];
        snprintf(line->cells[0], sizeof line->cells[0], "%s", row->label);
        snprintf(line->cells[1], sizeof line->cells[1], "%s", row->help ? row->help : "");
    }
    return count;
}

/* A question is answered by its number; anything else waits. */
static bool answer(struct tl_review *review, const struct tl_window_event *event)
{
    size_t count;
    const struct tl_panel_button *answers = tl_review_answers(review, &count);
    if (!answers || event->key == GLFW_KEY_ESCAPE)
        return false;
    for (size_t i = 0; i < count; i++)
        if (event->key == GLFW_KEY_1 + (int)i) {
            tl_review_act(review, answers[i].command);
            break;
        }
    return true;
}

void tl_review_on_key(struct tl_review *review, const struct tl_window_event *event)
{
    if (tl_panel_wants_keys(review->panel) && event->key != GLFW_KEY_ESCAPE) {
        if (event->key > 0 && event->key <= GLFW_KEY_LAST)
            tl_panel_press(review->panel, event->key);
        return;
    }
    if (answer(review, event))
        return;
    int modifiers = event->modifiers & (SHIFT | CTRL | GLFW_MOD_ALT | GLFW_MOD_SUPER);
    if (review->drag == TL_DRAG_CLOTH) /* Ctrl is held to pull */
        modifiers &= ~CTRL;
    for (size_t i = 0; i < TL_COUNT(key_rows); i++) {
        const struct key_row *row = &key_rows[i];
        if (row->key == 0 || row->key != event->key || row->modifiers != modifiers)
            continue;
        if (!event->repeated || row->repeats)
            tl_review_act(review, row->command);
        return;
    }
}
