#include "app/view/command/review_commands.h"

#include "config/base/memory.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <stdio.h>
#include <string.h>

#define SHIFT GLFW_MOD_SHIFT
#define CTRL  GLFW_MOD_CONTROL

const char *const tl_review_section_names[TL_SECTION_COUNT] = {
    [TL_SECTION_CLOTH] = "Cloth",   [TL_SECTION_CAMERA] = "Camera",   [TL_SECTION_LIGHT] = "Light",
    [TL_SECTION_FABRIC] = "Fabric", [TL_SECTION_COMPARE] = "Compare", [TL_SECTION_INSPECT] = "Inspect",
    [TL_SECTION_WINDOW] = "Window",
};

static bool is_playing(const struct tl_review *review)
{
    return review->play.is_on;
}

static bool is_placing(const struct tl_review *review)
{
    return review->placing.shown;
}

/* clang-format off */
/* Keys of a row: one, with modifiers, with an argument of the action, with both; the digits 1 to 9. */
#define KEY(name)                          {GLFW_KEY_##name, 0, 1, 0}
#define WITH(modifiers, name)              {GLFW_KEY_##name, modifiers, 1, 0}
#define TO(name, argument)                 {GLFW_KEY_##name, 0, 1, argument}
#define WITH_TO(modifiers, name, argument) {GLFW_KEY_##name, modifiers, 1, argument}
#define DIGITS(modifiers)                  {GLFW_KEY_1, modifiers, 9, 0}

const struct tl_review_command tl_review_commands[] = {
    {"play or pause", tl_act_play, TL_SECTION_CLOTH, .keys = {KEY(SPACE)},
     .button = "Play", .button_on = "Pause", .is_on = is_playing},
    {"one frame further, back in a motion", tl_act_step, TL_SECTION_CLOTH,
     .keys = {TO(PERIOD, 1), WITH_TO(SHIFT, PERIOD, -1)}, .repeats = true},
    {"first, last frame of a motion", tl_act_end, TL_SECTION_CLOTH, .keys = {TO(HOME, -1), TO(END, 1)}},
    {"drape the garment: at rest on its avatar", tl_act_drape, TL_SECTION_CLOTH, .keys = {KEY(D)}},
    {"read the file in the next, previous unit", tl_act_next_units, TL_SECTION_CLOTH,
     .keys = {TO(U, 1), WITH_TO(SHIFT, U, -1)}},
    {"read the file with Z up, with Y up", tl_act_next_up, TL_SECTION_CLOTH, .keys = {KEY(A)}},
    {"keep units and axis as they were guessed", tl_act_keep_reading, TL_SECTION_CLOTH, .keys = {KEY(ENTER)}},
    {"show handles that move, turn and size it", tl_act_place, TL_SECTION_CLOTH, .keys = {KEY(M)},
     .button = "Place", .button_on = "Done", .is_on = is_placing},
    {"back to the start", tl_act_reset, TL_SECTION_CLOTH, .keys = {KEY(R)}, .button = "Reset"},
    {"pin what is pulled; else remove all pins", tl_act_pin, TL_SECTION_CLOTH, .keys = {KEY(P)}},

    {"turn about the figure", tl_act_turn_camera, TL_SECTION_CAMERA,
     .keys = {TO(LEFT, TL_ACT_LEFT), TO(RIGHT, TL_ACT_RIGHT), TO(UP, TL_ACT_UP), TO(DOWN, TL_ACT_DOWN)}, .repeats = true},
    {"nearer, farther", tl_act_zoom, TL_SECTION_CAMERA, .keys = {TO(PAGE_UP, 1), TO(PAGE_DOWN, -1)}, .repeats = true},
    {"frame the whole figure", tl_act_frame_all, TL_SECTION_CAMERA, .keys = {KEY(F)}, .button = "Frame"},
    {"turntable", tl_act_turntable, TL_SECTION_CAMERA, .keys = {KEY(T)}, .button = "Turn"},
    {"go to a saved view", tl_act_view, TL_SECTION_CAMERA, .keys = {DIGITS(0)}},
    {"save this view: camera and light", tl_act_save_view, TL_SECTION_CAMERA, .keys = {DIGITS(SHIFT)}},
    {"add a key to the camera path: 2 s on", tl_act_path_key, TL_SECTION_CAMERA, .keys = {KEY(K)}},
    {"record a camera path; again: save it", tl_act_path_record, TL_SECTION_CAMERA, .keys = {WITH(SHIFT, K)}},
    {"play the camera path", tl_act_path_play, TL_SECTION_CAMERA, .keys = {KEY(L)}},

    {"next environment", tl_act_next_environment, TL_SECTION_LIGHT, .keys = {KEY(E)}, .button = "Next light"},
    {"turn the environment by 15\u00b0", tl_act_turn_environment, TL_SECTION_LIGHT,
     .keys = {TO(LEFT_BRACKET, 1), TO(RIGHT_BRACKET, -1)}, .repeats = true},
    {"turn the environment continuously", tl_act_environment_turntable, TL_SECTION_LIGHT, .keys = {WITH(SHIFT, T)}},

    {"next, previous fabric", tl_act_next_fabric, TL_SECTION_FABRIC, .keys = {TO(G, 1), WITH_TO(SHIFT, G, -1)}},
    {"a fabric, in the order of the panel's list", tl_act_fabric, TL_SECTION_FABRIC, .keys = {DIGITS(CTRL)}},
    {"next, previous colourway", tl_act_next_colourway, TL_SECTION_FABRIC, .keys = {TO(C, 1), WITH_TO(SHIFT, C, -1)},
     .button = "Colours"},

    {"split the view; A stays as it looks now", tl_act_compare, TL_SECTION_COMPARE, .keys = {KEY(W)},
     .button = "Compare"},
    {"exchange A and B", tl_act_swap, TL_SECTION_COMPARE, .keys = {KEY(X)}},
    {"move the line between them", tl_act_move_wipe, TL_SECTION_COMPARE, .keys = {TO(COMMA, -1), TO(SLASH, 1)},
     .repeats = true},

    {"show normals, UVs, visibility, strain ...", tl_act_next_view, TL_SECTION_INSPECT,
     .keys = {TO(V, 1), WITH_TO(SHIFT, V, -1)}, .button = "Inspect"},
    {"show light again", tl_act_light_view, TL_SECTION_INSPECT, .keys = {KEY(B)}},
    {"show the flat pattern beside the garment", tl_act_pattern, TL_SECTION_INSPECT, .keys = {KEY(N)}},
    {"print the values under the pointer", tl_act_read_out, TL_SECTION_INSPECT, .keys = {KEY(I)}},

    {"open a file, as if it were dropped", tl_act_open, TL_SECTION_WINDOW, .keys = {WITH(CTRL, O)},
     .button = "Open"},
    {"open a garment again: the last ten", tl_act_recent, TL_SECTION_WINDOW, .keys = {WITH(CTRL, R)}},
    {"undo the last edit", tl_act_undo, TL_SECTION_WINDOW, .keys = {WITH(CTRL, Z)}, .repeats = true, .button = "Undo"},
    {"redo", tl_act_redo, TL_SECTION_WINDOW, .keys = {WITH(CTRL | SHIFT, Z), WITH(CTRL, Y)}, .repeats = true},
    {"less, more time for a frame", tl_act_budget, TL_SECTION_WINDOW, .keys = {TO(MINUS, -1), TO(EQUAL, 1)}},
    {"screenshot as PNG", tl_act_screenshot, TL_SECTION_WINDOW, .keys = {TO(S, 0), TO(F12, 0)}, .button = "Picture"},
    {"screenshot as linear EXR", tl_act_screenshot, TL_SECTION_WINDOW, .keys = {WITH_TO(SHIFT, S, 1)}},
    {"use the panel by keys; Esc ends", tl_act_options, TL_SECTION_WINDOW, .keys = {KEY(O)}},
    {"hide or show the panel", tl_act_panel, TL_SECTION_WINDOW, .keys = {KEY(TAB)}},
    {"list keys and gestures", tl_act_help, TL_SECTION_WINDOW, .keys = {KEY(H), KEY(F1)}, .button = "Keys"},
    {"stop or close what is open, or quit", tl_act_back, TL_SECTION_WINDOW, .keys = {KEY(ESCAPE)}},
    {"quit", tl_act_quit, TL_SECTION_WINDOW, .keys = {KEY(Q)}},
};
const size_t tl_review_command_count = TL_COUNT(tl_review_commands);

const struct tl_review_gesture tl_review_gestures[] = {
    {TL_SECTION_CLOTH, "Ctrl+drag", "pull the cloth"},
    {TL_SECTION_CLOTH, "drag a handle", "Shift: fine; Ctrl: in steps; Esc: back"},
    {TL_SECTION_CLOTH, "Ctrl+Shift+drag", "move a garment; right drag: turn it"},
    {TL_SECTION_CLOTH, "Ctrl+Shift+wheel", "size it"},
    {TL_SECTION_CAMERA, "drag", "turn about the figure"},
    {TL_SECTION_CAMERA, "right drag", "move the figure"},
    {TL_SECTION_CAMERA, "wheel", "nearer, farther"},
    {TL_SECTION_CAMERA, "double click", "look closely at that point"},
    {TL_SECTION_LIGHT, "Shift+drag", "turn the environment"},
    {TL_SECTION_COMPARE, "drag the line", "move it"},
    {TL_SECTION_WINDOW, "drop a file", "garment, body: .glb .gltf .obj .ply .stl .off"},
    {TL_SECTION_WINDOW, "", "pattern: .json; motion: .pc2 .mdd"},
    {TL_SECTION_WINDOW, "", "light: .exr .hdr; fabric: .u3m .u3ma, folder"},
    {TL_SECTION_WINDOW, "", "scene, fabric, preset: .yaml"},
};
const size_t tl_review_gesture_count = TL_COUNT(tl_review_gestures);
/* clang-format on */

const struct tl_review_command *tl_review_command_of_key(int key, int modifiers, int *argument)
{
    for (size_t i = 0; i < tl_review_command_count; i++)
        for (int k = 0; k < TL_REVIEW_KEYS_MAX; k++) {
            const struct tl_review_key *row = &tl_review_commands[i].keys[k];
            if (modifiers != row->modifiers || key < row->key || key >= row->key + row->count)
                continue;
            *argument = row->argument + key - row->key;
            return &tl_review_commands[i];
        }
    return NULL;
}

/* GLFW numbers keys that print a character by that character, as ASCII. */
static void name_key(int key, char *text, size_t size)
{
    static const struct {
        int key;
        const char *name;
    } named[] = {
        {GLFW_KEY_SPACE, "Space"},    {GLFW_KEY_LEFT, "Left"},   {GLFW_KEY_RIGHT, "Right"},
        {GLFW_KEY_UP, "Up"},          {GLFW_KEY_DOWN, "Down"},   {GLFW_KEY_PAGE_UP, "PgUp"},
        {GLFW_KEY_PAGE_DOWN, "PgDn"}, {GLFW_KEY_TAB, "Tab"},     {GLFW_KEY_ESCAPE, "Esc"},
        {GLFW_KEY_F1, "F1"},          {GLFW_KEY_F12, "F12"},     {GLFW_KEY_HOME, "Home"},
        {GLFW_KEY_END, "End"},        {GLFW_KEY_ENTER, "Enter"},
    };
    for (size_t i = 0; i < TL_COUNT(named); i++)
        if (named[i].key == key) {
            snprintf(text, size, "%s", named[i].name);
            return;
        }
    snprintf(text, size, "%c", key);
}

void tl_review_key_names(const struct tl_review_command *command, char *text, size_t size)
{
    text[0] = '\0';
    for (int k = 0; k < TL_REVIEW_KEYS_MAX && command->keys[k].count > 0; k++) {
        const struct tl_review_key *row = &command->keys[k];
        char first[16], last[16];
        name_key(row->key, first, sizeof first);
        name_key(row->key + row->count - 1, last, sizeof last);
        size_t length = strlen(text);
        snprintf(text + length, size - length, "%s%s%s%s%s%s", k > 0 ? "  " : "",
                 row->modifiers & CTRL ? "Ctrl+" : "", row->modifiers & SHIFT ? "Shift+" : "", first,
                 row->count > 1 ? " to " : "", row->count > 1 ? last : "");
    }
}

static size_t add_line(struct tl_panel_line *lines, size_t count, size_t capacity, const char *left,
                       const char *right)
{
    if (count == capacity)
        return count;
    lines[count] = (struct tl_panel_line){0};
    snprintf(lines[count].cells[0], sizeof lines[count].cells[0], "%s", left);
    snprintf(lines[count].cells[1], sizeof lines[count].cells[1], "%s", right);
    return count + 1;
}

size_t tl_review_help(struct tl_panel_line *lines, size_t capacity)
{
    size_t count = 0;
    for (int section = 0; section < TL_SECTION_COUNT; section++) {
        count = add_line(lines, count, capacity, tl_review_section_names[section], "");
        for (size_t i = 0; i < tl_review_command_count; i++) {
            char keys[sizeof lines->cells[0]];
            tl_review_key_names(&tl_review_commands[i], keys, sizeof keys);
            if ((int)tl_review_commands[i].section == section)
                count = add_line(lines, count, capacity, keys, tl_review_commands[i].help);
        }
        for (size_t i = 0; i < tl_review_gesture_count; i++)
            if ((int)tl_review_gestures[i].section == section)
                count = add_line(lines, count, capacity, tl_review_gestures[i].gesture,
                                 tl_review_gestures[i].help);
    }
    return count;
}

void tl_review_list_buttons(const struct tl_review *review, struct tl_review_buttons *out)
{
    out->count = 0;
    for (size_t i = 0; i < tl_review_command_count && out->count < TL_REVIEW_BUTTONS_MAX; i++) {
        const struct tl_review_command *command = &tl_review_commands[i];
        if (!command->button)
            continue;
        bool is_on = review && command->is_on && command->is_on(review);
        char keys[64];
        tl_review_key_names(command, keys, sizeof keys);
        snprintf(out->help[out->count], sizeof out->help[0], "%s: %s", command->help, keys);
        out->of[out->count] =
            (struct tl_panel_button){is_on ? command->button_on : command->button, out->help[out->count]};
        out->commands[out->count++] = command;
    }
}
