/* drop_files WINDOW X Y FILE...: drops files on a window as a file manager does (the XDND protocol, version
 * 5, as its source). X, Y: where, in the window. Exit 0: the window took them; 1: it did not, and the reason
 * is printed.
 */
#include <X11/Xatom.h>
#include <X11/Xlib.h>

#include <limits.h>
#include <poll.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define XDND_VERSION      5
#define ANSWER_TIMEOUT_MS 20000 /* a window that draws by software may be busy */

struct drag {
    Display *display;
    Window source, target;
    Atom selection, enter, position, status, drop, finished, copy, uri_list, aware;
    char *uris;
};

static int refuse(const char *why)
{
    fprintf(stderr, "drop_files: %s\n", why);
    return 1;
}

static void find_atoms(struct drag *drag)
{
    const struct {
        const char *name;
        Atom *atom;
    } atoms[] = {
        {"XdndSelection", &drag->selection}, {"XdndEnter", &drag->enter},
        {"XdndPosition", &drag->position},   {"XdndStatus", &drag->status},
        {"XdndDrop", &drag->drop},           {"XdndFinished", &drag->finished},
        {"XdndActionCopy", &drag->copy},     {"text/uri-list", &drag->uri_list},
        {"XdndAware", &drag->aware},
    };
    for (size_t i = 0; i < sizeof atoms / sizeof atoms[0]; i++)
        *atoms[i].atom = XInternAtom(drag->display, atoms[i].name, False);
}

/* Bytes that a URI does not have are written %XX (RFC 3986). */
static void append_uri(char *uris, const char *path)
{
    char whole[PATH_MAX];
    char *end = uris + strlen(uris);
    end += sprintf(end, "file://");
    for (const char *byte = realpath(path, whole) ? whole : path; *byte; byte++) {
        const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~/";
        end +=
            strchr(plain, *byte) ? sprintf(end, "%c", *byte) : sprintf(end, "%%%02X", (unsigned char)*byte);
    }
    sprintf(end, "\r\n");
}

static bool understands(const struct drag *drag)
{
    Atom type;
    int format;
    unsigned long count, left;
    unsigned char *version = NULL;
    bool answers = XGetWindowProperty(drag->display, drag->target, drag->aware, 0, 1, False, XA_ATOM, &type,
                                      &format, &count, &left, &version) == Success &&
                   count == 1;
    XFree(version);
    return answers;
}

static void send_message(const struct drag *drag, Atom what, const long data[4])
{
    XEvent event = {.xclient = {.type = ClientMessage,
                                .display = drag->display,
                                .window = drag->target,
                                .message_type = what,
                                .format = 32}};
    event.xclient.data.l[0] = (long)drag->source;
    memcpy(event.xclient.data.l + 1, data, 4 * sizeof *data);
    XSendEvent(drag->display, drag->target, False, NoEventMask, &event);
    XFlush(drag->display);
}

static void hand_over(const struct drag *drag, const XSelectionRequestEvent *request)
{
    XEvent answer = {.xselection = {.type = SelectionNotify,
                                    .requestor = request->requestor,
                                    .selection = request->selection,
                                    .target = request->target,
                                    .property = request->property,
                                    .time = request->time}};
    XChangeProperty(drag->display, request->requestor, request->property, request->target, 8, PropModeReplace,
                    (const unsigned char *)drag->uris, (int)strlen(drag->uris));
    XSendEvent(drag->display, request->requestor, False, NoEventMask, &answer);
    XFlush(drag->display);
}

/* Waits for this message and leaves it in `answer`; hands over the files meanwhile. */
static bool hear(const struct drag *drag, Atom what, XClientMessageEvent *answer)
{
    struct pollfd wire = {.fd = ConnectionNumber(drag->display), .events = POLLIN};
    while (XPending(drag->display) > 0 || poll(&wire, 1, ANSWER_TIMEOUT_MS) > 0) {
        XEvent event;
        XNextEvent(drag->display, &event);
        if (event.type == SelectionRequest)
            hand_over(drag, &event.xselectionrequest);
        *answer = event.xclient;
        if (event.type == ClientMessage && answer->message_type == what)
            return true;
    }
    return false;
}

static int drop(const struct drag *drag, int x, int y)
{
    int root_x, root_y;
    Window root = DefaultRootWindow(drag->display), child;
    XClientMessageEvent answer;
    XTranslateCoordinates(drag->display, drag->target, root, x, y, &root_x, &root_y, &child);
    XSetSelectionOwner(drag->display, drag->selection, drag->source, CurrentTime);
    send_message(drag, drag->enter, (const long[4]){(long)XDND_VERSION << 24, (long)drag->uri_list});
    send_message(drag, drag->position,
                 (const long[4]){0, (long)root_x << 16 | root_y, CurrentTime, (long)drag->copy});
    if (!hear(drag, drag->status, &answer))
        return refuse("the window does not answer");
    if (!(answer.data.l[1] & 1))
        return refuse("the window does not want files");
    send_message(drag, drag->drop, (const long[4]){0, CurrentTime});
    return hear(drag, drag->finished, &answer) ? 0 : refuse("the window never took the files");
}

int main(int argc, char **argv)
{
    if (argc < 5)
        return refuse("usage: drop_files WINDOW X Y FILE...");
    struct drag drag = {.display = XOpenDisplay(NULL), .target = strtoul(argv[1], NULL, 0)};
    if (!drag.display)
        return refuse("there is no display");
    find_atoms(&drag);
    if (!understands(&drag))
        return refuse("the window does not announce that it accepts drops");
    drag.source = XCreateSimpleWindow(drag.display, DefaultRootWindow(drag.display), 0, 0, 1, 1, 0, 0, 0);
    drag.uris = calloc((size_t)(argc - 4), 3 * PATH_MAX + 16);
    for (int i = 4; i < argc; i++)
        append_uri(drag.uris, argv[i]);
    int status = drop(&drag, atoi(argv[2]), atoi(argv[3]));
    free(drag.uris);
    XCloseDisplay(drag.display);
    return status;
}
