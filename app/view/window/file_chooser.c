#include "app/view/window/file_chooser.h"

#include "config/base/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* The longest path on Linux. */
enum { PATH_BYTES = 4096 };

struct tl_file_chooser {
    pid_t process;
    int output; /* of the dialog, not blocking: the path and a line end */
    char path[PATH_BYTES + 1];
    size_t length;
};

static int start(const char *title, int output, pid_t *out)
{
    char *option = tl_format("--title=%s", title);
    char *const arguments[] = {"zenity", "--file-selection", option, NULL};
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0); /* GTK's chatter */
    int reason = posix_spawnp(out, arguments[0], &files, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&files);
    free(option);
    return reason;
}

tl_file_chooser *tl_file_chooser_open(const char *title, tl_error *error)
{
    int ends[2];
    pid_t process = 0;
    int reason = pipe2(ends, O_CLOEXEC) == 0 ? 0 : errno;
    if (reason != 0) {
        tl_fail(error, TL_DEVICE, "the file dialog cannot be opened: %s: drop a file on the window instead",
                strerror(reason));
        return NULL;
    }
    reason = start(title, ends[1], &process);
    close(ends[1]);
    if (reason != 0) {
        close(ends[0]);
        tl_fail(error, TL_DEVICE,
                "the command zenity, which shows the file dialog, cannot be run: install the package zenity, "
                "or drop a file on the window");
        return NULL;
    }
    fcntl(ends[0], F_SETFL, O_NONBLOCK);
    tl_file_chooser *chooser = TL_NEW(tl_file_chooser);
    chooser->process = process;
    chooser->output = ends[0];
    return chooser;
}

/* Waits for the process, which has closed its output or was signalled to end. */
static bool ended_well(pid_t process)
{
    int status = 0;
    while (waitpid(process, &status, 0) < 0)
        if (errno != EINTR)
            return false;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

static void release(tl_file_chooser **handle)
{
    close((*handle)->output);
    free(*handle);
    *handle = NULL;
}

bool tl_file_chooser_poll(tl_file_chooser **handle, char **path)
{
    tl_file_chooser *chooser = *handle;
    ssize_t got = 0;
    *path = NULL;
    while (chooser->length < PATH_BYTES &&
           (got = read(chooser->output, chooser->path + chooser->length, PATH_BYTES - chooser->length)) > 0)
        chooser->length += (size_t)got;
    if (got < 0 && (errno == EAGAIN || errno == EINTR))
        return false;
    bool is_chosen = ended_well(chooser->process);
    chooser->path[strcspn(chooser->path, "\n")] = '\0';
    if (is_chosen && chooser->path[0] != '\0')
        *path = tl_copy_string(chooser->path);
    release(handle);
    return true;
}

void tl_file_chooser_close(tl_file_chooser **handle)
{
    if (!*handle)
        return;
    kill((*handle)->process, SIGTERM);
    ended_well((*handle)->process);
    release(handle);
}
