/* The commands of the review window: one row each with its keys, its button in the panel, its help and its
 * action. The keyboard, the panel's buttons and the list of keys all read this table.
 *
 * The table is constant. Threads: any for the table, the window's for whatever takes a review. */
#ifndef TOILE_APP_VIEW_COMMAND_REVIEW_COMMANDS_H
#define TOILE_APP_VIEW_COMMAND_REVIEW_COMMANDS_H

#include "app/view/command/review_act.h"
#include "app/view/review/review.h"

enum tl_review_section { /* headings of the list of keys, in its order */
                         TL_SECTION_CLOTH,
                         TL_SECTION_CAMERA,
                         TL_SECTION_LIGHT,
                         TL_SECTION_FABRIC,
                         TL_SECTION_COMPARE,
                         TL_SECTION_INSPECT,
                         TL_SECTION_WINDOW,
                         TL_SECTION_COUNT
};
extern const char *const tl_review_section_names[TL_SECTION_COUNT];

/* `count` keys in a row, from `key` on; 1 stands for one key, 0 for none. */
struct tl_review_key {
    int key;       /* GLFW_KEY_* */
    int modifiers; /* GLFW_MOD_* */
    int count;
    int argument; /* of the action, for the first key; each further key adds 1 */
};

#define TL_REVIEW_KEYS_MAX 4
struct tl_review_command {
    const char *help;      /* what it does; never empty */
    tl_review_action *act; /* never NULL */
    enum tl_review_section section;
    bool repeats;                                  /* while the key is held */
    struct tl_review_key keys[TL_REVIEW_KEYS_MAX]; /* the button passes the argument of keys[0] */
    const char *button;                            /* its label; NULL: no button */
    const char *button_on;                         /* its label while is_on; NULL: always `button` */
    bool (*is_on)(const struct tl_review *review);
};
extern const struct tl_review_command tl_review_commands[];
extern const size_t tl_review_command_count;

/* Gestures of the pointer (review_input.c), for the list of keys alone. */
struct tl_review_gesture {
    enum tl_review_section section;
    const char *gesture, *help;
};
extern const struct tl_review_gesture tl_review_gestures[];
extern const size_t tl_review_gesture_count;

/* The command of a key and the action's argument; NULL when the key has none. */
const struct tl_review_command *tl_review_command_of_key(int key, int modifiers, int *argument);

/* A command's keys as text: "Ctrl+Shift+Z  Ctrl+Y", "1 to 9". */
void tl_review_key_names(const struct tl_review_command *command, char *text, size_t size);

/* Rows "keys, help" below the headings of their sections, which have no second cell. Returns their number. */
size_t tl_review_help(struct tl_panel_line *lines, size_t capacity);

#define TL_REVIEW_BUTTONS_MAX 16
struct tl_review_buttons { /* commands[i] belongs to of[i]; of[i] points into help[i] */
    size_t count;
    struct tl_panel_button of[TL_REVIEW_BUTTONS_MAX];
    char help[TL_REVIEW_BUTTONS_MAX][160];
    const struct tl_review_command *commands[TL_REVIEW_BUTTONS_MAX];
};
/* The buttons, labelled for the state of `review`; NULL labels nothing as on. */
void tl_review_list_buttons(const struct tl_review *review, struct tl_review_buttons *out);

#endif
