/* The review window: GLFW, with a GL 4.5 core debug context that is current on the caller's thread.
 *
 * Input is queued as events and handed out one by one. Positions and sizes are framebuffer pixels from the
 * upper left corner, whatever the screen's scale. Ownership: tl_window_destroy also ends GLFW, so there is
 * one window at a time. Threads: the main thread only. Failure: TL_DEVICE when there is no display or no
 * GL 4.5. */
#ifndef TOILE_APP_VIEW_WINDOW_WINDOW_H
#define TOILE_APP_VIEW_WINDOW_WINDOW_H

#include "config/base/error.h"

#include <stddef.h>

typedef struct tl_window tl_window;

enum tl_window_event_type {
    TL_WINDOW_KEY,     /* pressed, or held: `repeated` */
    TL_WINDOW_KEY_UP,  /* released */
    TL_WINDOW_TEXT,    /* a character that keys have written: `key` */
    TL_WINDOW_PRESS,   /* mouse button down */
    TL_WINDOW_RELEASE, /* mouse button up */
    TL_WINDOW_MOVE,    /* pointer */
    TL_WINDOW_WHEEL,
    TL_WINDOW_DROP,   /* a file was dropped */
    TL_WINDOW_REDRAW, /* contents were lost or the size changed */
    TL_WINDOW_CLOSE,
};

struct tl_window_event {
    enum tl_window_event_type type;
    int key;    /* GLFW_KEY_*: letters by the keyboard's layout, others by position; TEXT: a Unicode number */
    int button; /* GLFW_MOUSE_BUTTON_* */
    int modifiers; /* GLFW_MOD_* */
    bool repeated; /* KEY: it is held */
    float x, y;    /* pointer */
    float steps;   /* WHEEL: positive is away from the user */
    char *path;    /* DROP: owned by the event, tl_window_event_release */
};

tl_window *tl_window_create(const char *title, int width, int height, tl_error *error);
void tl_window_destroy(tl_window **window);

void tl_window_set_title(tl_window *window, const char *title);
void tl_window_size(const tl_window *window, int *width, int *height); /* 0 x 0 while minimised */
void tl_window_unscaled_size(const tl_window *window, int *width,
                             int *height);                    /* at scale 1, as tl_window_create takes it */
float tl_window_scale(const tl_window *window);               /* 1 on a plain screen, 2 on a HiDPI one */
struct GLFWwindow *tl_window_handle(const tl_window *window); /* for the panel */

/* Waits for events for at most `timeout_s` seconds and queues them; 0 does not wait. */
void tl_window_wait(tl_window *window, double timeout_s);
void tl_window_wake(void); /* ends tl_window_wait; any thread */
/* False when no event is left. */
bool tl_window_next(tl_window *window, struct tl_window_event *out);
bool tl_window_is_escape(const struct tl_window_event *event);
void tl_window_event_release(struct tl_window_event *event);

void tl_window_show(tl_window *window); /* swaps buffers, synchronised with the screen */

#endif
