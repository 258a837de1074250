#include "app/view/window/window.h"

#include "config/base/error.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <ctype.h>
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

struct tl_window {
    GLFWwindow *handle;
    double pointer_x, pointer_y;    /* screen coordinates, at the current event */
    struct tl_window_event *events; /* [first, count) are queued */
    size_t first, count, capacity;
};

static char last_glfw_message[512]; /* static: GLFW reports errors before there is a window */

static void store_glfw_message(int code, const char *message)
{
    (void)code;
    snprintf(last_glfw_message, sizeof last_glfw_message, "%s", message);
    tl_debug("GLFW: %s", message);
}

static void queue(tl_window *window, struct tl_window_event event)
{
    if (window->count == window->capacity) {
        window->capacity = window->capacity ? 2 * window->capacity : 64;
        window->events = tl_resize(window->events, window->capacity, sizeof *window->events);
    }
    window->events[window->count++] = event;
}

/* The pointer's position at the event, in framebuffer pixels; GLFW counts in screen coordinates.
 * glfwGetCursorPos would give the present position: all events of a drag during a slow frame would then lie
 * at one point. */
static struct tl_window_event pointer_event(const tl_window *window, enum tl_window_event_type type)
{
    int width, height, pixels_x, pixels_y;
    glfwGetWindowSize(window->handle, &width, &height);
    glfwGetFramebufferSize(window->handle, &pixels_x, &pixels_y);
    return (struct tl_window_event){
        .type = type,
        .x = width > 0 ? (float)(window->pointer_x * pixels_x / width) : 0,
        .y = height > 0 ? (float)(window->pointer_y * pixels_y / height) : 0,
    };
}

/* Letters are identified by the keyboard's layout (A and Q change places on a French one), other keys by
 * position. */
static int key_of_layout(int key, int scancode)
{
    const char *name = glfwGetKeyName(key, scancode);
    bool is_letter = name && isascii((unsigned char)name[0]) && isalpha((unsigned char)name[0]) && !name[1];
    return is_letter ? toupper((unsigned char)name[0]) : key;
}

static void on_key(GLFWwindow *handle, int key, int scancode, int action, int modifiers)
{
    queue(glfwGetWindowUserPointer(handle),
          (struct tl_window_event){.type = action == GLFW_RELEASE ? TL_WINDOW_KEY_UP : TL_WINDOW_KEY,
                                   .key = key_of_layout(key, scancode),
                                   .modifiers = modifiers,
                                   .repeated = action == GLFW_REPEAT});
}

static void on_text(GLFWwindow *handle, unsigned character)
{
    queue(glfwGetWindowUserPointer(handle),
          (struct tl_window_event){.type = TL_WINDOW_TEXT, .key = (int)character});
}

static void on_button(GLFWwindow *handle, int button, int action, int modifiers)
{
    tl_window *window = glfwGetWindowUserPointer(handle);
    struct tl_window_event event =
        pointer_event(window, action == GLFW_PRESS ? TL_WINDOW_PRESS : TL_WINDOW_RELEASE);
    event.button = button;
    event.modifiers = modifiers;
    queue(window, event);
}

/* GLFW reports keys and buttons only to them. */
static int held_modifiers(GLFWwindow *handle)
{
    static const int keys[][2] = {{GLFW_KEY_LEFT_CONTROL, GLFW_MOD_CONTROL},
                                  {GLFW_KEY_RIGHT_CONTROL, GLFW_MOD_CONTROL},
                                  {GLFW_KEY_LEFT_SHIFT, GLFW_MOD_SHIFT},
                                  {GLFW_KEY_RIGHT_SHIFT, GLFW_MOD_SHIFT}};
    int modifiers = 0;
    for (size_t i = 0; i < TL_COUNT(keys); i++)
        modifiers |= glfwGetKey(handle, keys[i][0]) == GLFW_PRESS ? keys[i][1] : 0;
    return modifiers;
}

static void on_move(GLFWwindow *handle, double x, double y)
{
    tl_window *window = glfwGetWindowUserPointer(handle);
    window->pointer_x = x;
    window->pointer_y = y;
    struct tl_window_event event = pointer_event(window, TL_WINDOW_MOVE);
    event.modifiers = held_modifiers(handle);
    queue(window, event);
}

static void on_wheel(GLFWwindow *handle, double x, double y)
{
    (void)x;
    tl_window *window = glfwGetWindowUserPointer(handle);
    struct tl_window_event event = pointer_event(window, TL_WINDOW_WHEEL);
    event.steps = (float)y;
    event.modifiers = held_modifiers(handle);
    queue(window, event);
}

static void on_drop(GLFWwindow *handle, int count, const char **paths)
{
    for (int i = 0; i < count; i++)
        queue(glfwGetWindowUserPointer(handle),
              (struct tl_window_event){.type = TL_WINDOW_DROP, .path = tl_copy_string(paths[i])});
}

static void on_refresh(GLFWwindow *handle)
{
    queue(glfwGetWindowUserPointer(handle), (struct tl_window_event){.type = TL_WINDOW_REDRAW});
}

static void on_resize(GLFWwindow *handle, int width, int height)
{
    (void)width;
    (void)height;
    on_refresh(handle);
}

static void on_close(GLFWwindow *handle)
{
    queue(glfwGetWindowUserPointer(handle), (struct tl_window_event){.type = TL_WINDOW_CLOSE});
}

static void listen_to(tl_window *window)
{
    glfwSetWindowUserPointer(window->handle, window);
    glfwSetKeyCallback(window->handle, on_key);
    glfwSetCharCallback(window->handle, on_text);
    glfwSetMouseButtonCallback(window->handle, on_button);
    glfwSetCursorPosCallback(window->handle, on_move);
    glfwSetScrollCallback(window->handle, on_wheel);
    glfwSetDropCallback(window->handle, on_drop);
    glfwSetWindowRefreshCallback(window->handle, on_refresh);
    glfwSetFramebufferSizeCallback(window->handle, on_resize);
    glfwSetWindowCloseCallback(window->handle, on_close);
}

static void set_context_hints(void)
{
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0); /* the renderer draws into targets of its own */
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
}

/* The display is gone: Xlib would print its own lines and exit. Nothing of GL or X may be called any more. */
static int end_without_display(void *display)
{
    (void)display;
    static const char line[] =
        "toile: view: the display was lost: `toile view` recovers this review where there is one\n";
    ssize_t written = write(STDERR_FILENO, line, sizeof line - 1);
    (void)written;
    _exit(tl_exit_status(TL_DEVICE));
}

/* GLFW links Xlib where it draws by X, and has no function for this. */
static void expect_loss_of_display(void)
{
    typedef int handler(void *display);
    handler *(*set_handler)(handler *);
    *(void **)&set_handler = dlsym(RTLD_DEFAULT, "XSetIOErrorHandler");
    if (set_handler)
        set_handler(end_without_display);
}

tl_window *tl_window_create(const char *title, int width, int height, tl_error *error)
{
    tl_window *window = TL_NEW(tl_window);
    last_glfw_message[0] = '\0';
    glfwSetErrorCallback(store_glfw_message);
    expect_loss_of_display();
    if (!glfwInit()) {
        tl_fail(error, TL_DEVICE,
                "no window can be opened (%s): run on a desktop or under Xvfb, or use `toile render`",
                last_glfw_message);
        goto failed;
    }
    set_context_hints();
    window->handle = glfwCreateWindow(width, height, title, NULL, NULL);
    if (!window->handle) {
        tl_fail(error, TL_DEVICE,
                "no window with OpenGL 4.5 (%s): update the graphics driver, or set "
                "LIBGL_ALWAYS_SOFTWARE=1",
                last_glfw_message);
        goto failed;
    }
    glfwMakeContextCurrent(window->handle);
    glfwSwapInterval(1);
    listen_to(window);
    return window;
failed:
    tl_window_destroy(&window);
    return NULL;
}

void tl_window_destroy(tl_window **window)
{
    if (!*window)
        return;
    struct tl_window_event event;
    while (tl_window_next(*window, &event))
        tl_window_event_release(&event);
    glfwTerminate();
    free((*window)->events);
    free(*window);
    *window = NULL;
}

void tl_window_set_title(tl_window *window, const char *title)
{
    glfwSetWindowTitle(window->handle, title);
}

void tl_window_size(const tl_window *window, int *width, int *height)
{
    glfwGetFramebufferSize(window->handle, width, height);
}

void tl_window_unscaled_size(const tl_window *window, int *width, int *height)
{
    float x, y;
    glfwGetWindowContentScale(window->handle, &x, &y);
    glfwGetWindowSize(window->handle, width, height);
    *width = (int)lrintf((float)*width / x);
    *height = (int)lrintf((float)*height / y);
}

float tl_window_scale(const tl_window *window)
{
    float x, y;
    glfwGetWindowContentScale(window->handle, &x, &y);
    return y;
}

struct GLFWwindow *tl_window_handle(const tl_window *window)
{
    return window->handle;
}

void tl_window_wait(tl_window *window, double timeout_s)
{
    if (window->first < window->count || timeout_s <= 0)
        glfwPollEvents();
    else
        glfwWaitEventsTimeout(timeout_s);
}

void tl_window_wake(void)
{
    glfwPostEmptyEvent();
}

bool tl_window_is_escape(const struct tl_window_event *event)
{
    return event->type == TL_WINDOW_KEY && event->key == GLFW_KEY_ESCAPE;
}

bool tl_window_next(tl_window *window, struct tl_window_event *out)
{
    if (window->first == window->count) {
        window->first = window->count = 0;
        return false;
    }
    *out = window->events[window->first++];
    return true;
}

void tl_window_event_release(struct tl_window_event *event)
{
    free(event->path);
    *event = (struct tl_window_event){0};
}

void tl_window_show(tl_window *window)
{
    glfwSwapBuffers(window->handle);
}
