#include "tests/app/inject/supervise.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <signal.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#define TIMEOUT_MS 60000 /* without any call that is decided on */
#define PATH_ROOM  4096

/* Where a call's argument that decides is. */
static const struct trapped {
    int number;
    enum call_kind kind;
    int error, path; /* the argument that names a file; of a rename the next name follows 1 or 2 later */
} trapped[] = {
    {SYS_write, CALL_WRITE, ENOSPC, -1},    {SYS_pwrite64, CALL_WRITE, ENOSPC, -1},
    {SYS_writev, CALL_WRITE, ENOSPC, -1},   {SYS_pwritev, CALL_WRITE, ENOSPC, -1},
    {SYS_fsync, CALL_SYNC, EIO, -1},        {SYS_fdatasync, CALL_SYNC, EIO, -1},
    {SYS_renameat, CALL_RENAME, EACCES, 1}, {SYS_renameat2, CALL_RENAME, EACCES, 1},
    {SYS_openat, CALL_OPEN, EACCES, 1},     {SYS_mkdirat, CALL_FOLDER, ENOSPC, 1},
    {SYS_clone, CALL_THREAD, EAGAIN, -1},   {SYS_clone3, CALL_THREAD, EAGAIN, -1},
    {SYS_mmap, CALL_PAGES, ENOMEM, -1},     {SYS_mremap, CALL_PAGES, ENOMEM, -1},
    {SYS_brk, CALL_PAGES, ENOMEM, -1},      {SYS_prctl, CALL_NONE, 0, -1},
#ifdef SYS_open
    {SYS_open, CALL_OPEN, EACCES, 0},       {SYS_rename, CALL_RENAME, EACCES, 0},
    {SYS_mkdir, CALL_FOLDER, ENOSPC, 0},
#endif
};
#define TRAPPED (sizeof trapped / sizeof trapped[0])

/* Returns the descriptor by which the kernel asks, or -1. */
static int install_filter(void)
{
    struct sock_filter filter[TRAPPED + 3] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr))};
    for (size_t i = 0; i < TRAPPED; i++)
        filter[1 + i] = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (unsigned)trapped[i].number,
                                                     (unsigned char)(TRAPPED - i), 0);
    filter[1 + TRAPPED] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    filter[2 + TRAPPED] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_USER_NOTIF);
    struct sock_fprog program = {TRAPPED + 3, filter};
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0)
        return -1;
    return (int)syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_NEW_LISTENER, &program);
}

union descriptor_message {
    char bytes[CMSG_SPACE(sizeof(int))];
    struct cmsghdr aligned;
};

static void send_descriptor(int socket, int descriptor)
{
    char byte = 0;
    union descriptor_message control = {{0}};
    struct iovec data = {&byte, 1};
    struct msghdr message = {
        .msg_iov = &data, .msg_iovlen = 1, .msg_control = &control, .msg_controllen = sizeof control};
    struct cmsghdr *header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(sizeof(int));
    memcpy(CMSG_DATA(header), &descriptor, sizeof(int));
    if (sendmsg(socket, &message, 0) != 1)
        _exit(127);
}

static int receive_descriptor(int socket)
{
    char byte;
    int descriptor = -1;
    union descriptor_message control;
    struct iovec data = {&byte, 1};
    struct msghdr message = {
        .msg_iov = &data, .msg_iovlen = 1, .msg_control = &control, .msg_controllen = sizeof control};
    if (recvmsg(socket, &message, 0) == 1 && CMSG_FIRSTHDR(&message))
        memcpy(&descriptor, CMSG_DATA(CMSG_FIRSTHDR(&message)), sizeof(int));
    return descriptor;
}

static void redirect(int to, const char *path, int flags)
{
    int descriptor = open(path, flags | O_CLOEXEC, 0666);
    if (descriptor < 0 || dup2(descriptor, to) < 0)
        _exit(127);
}

static void become(const struct supervised *supervised, int socket)
{
    redirect(STDIN_FILENO, "/dev/null", O_RDONLY);
    redirect(STDOUT_FILENO, supervised->out, O_WRONLY | O_CREAT | O_TRUNC);
    redirect(STDERR_FILENO, supervised->err, O_WRONLY | O_CREAT | O_TRUNC);
    if (chdir(supervised->folder) != 0)
        _exit(127);
    int listener = install_filter();
    if (listener < 0)
        _exit(127); /* nothing is sent, so that the other side knows */
    send_descriptor(socket, listener);
    close(listener);
    execv(supervised->arguments[0], supervised->arguments);
    _exit(127);
}

struct supervision {
    const struct supervised *supervised;
    long *counts;
    int listener, has_begun;
    char synced[PATH_ROOM]; /* the file that was synced last */
};

/* Whether the path is below the folder; it is made relative to it. */
static int is_below(const char *folder, char *path)
{
    size_t length = strlen(folder);
    if (path[0] != '/')
        return path[0] != '\0';
    if (strncmp(path, folder, length) != 0 || path[length] != '/')
        return 0;
    memmove(path, path + length + 1, strlen(path + length));
    return 1;
}

/* A path in the program's memory. The program waits meanwhile. */
static int read_path(const struct supervision *supervision, const struct seccomp_notif *call, int argument,
                     char path[PATH_ROOM])
{
    char memory[64];
    snprintf(memory, sizeof memory, "/proc/%u/mem", call->pid);
    int descriptor = open(memory, O_RDONLY | O_CLOEXEC);
    ssize_t size =
        descriptor < 0 ? 0 : pread(descriptor, path, PATH_ROOM - 1, (off_t)call->data.args[argument]);
    if (descriptor >= 0)
        close(descriptor);
    path[size > 0 ? size : 0] = '\0';
    return is_below(supervision->supervised->folder, path);
}

/* The path of the call's open file; "" if it is none below the folder. */
static void find_path(const struct supervision *supervision, const struct seccomp_notif *call,
                      char path[PATH_ROOM])
{
    char link[64];
    snprintf(link, sizeof link, "/proc/%u/fd/%d", call->pid, (int)call->data.args[0]);
    ssize_t size = readlink(link, path, PATH_ROOM - 1);
    path[size > 0 ? size : 0] = '\0';
    if (path[0] != '/' || !is_below(supervision->supervised->folder, path))
        path[0] = '\0';
}

static int is_own_write(struct supervision *supervision, const struct seccomp_notif *call)
{
    char path[PATH_ROOM];
    find_path(supervision, call, path);
    if (strcmp(path, supervision->synced) == 0)
        supervision->synced[0] = '\0';
    return path[0] || call->data.args[0] == STDOUT_FILENO;
}

static void report_rename(const struct supervision *supervision, const struct trapped *known,
                          const struct seccomp_notif *call)
{
    char from[PATH_ROOM], to[PATH_ROOM];
    if (read_path(supervision, call, known->path, from) &&
        read_path(supervision, call, known->path == 0 ? 1 : 3, to))
        supervision->supervised->on_rename(supervision->supervised->user, from, to,
                                           strcmp(from, supervision->synced) == 0);
}

static int is_counted(struct supervision *supervision, const struct trapped *known,
                      const struct seccomp_notif *call)
{
    char path[PATH_ROOM];
    const unsigned long long *arguments = (const unsigned long long *)call->data.args;
    switch (known->kind) {
    case CALL_WRITE:
        return is_own_write(supervision, call);
    case CALL_OPEN:
        return (arguments[known->path + 1] & (O_WRONLY | O_RDWR | O_CREAT)) != 0 &&
               read_path(supervision, call, known->path, path);
    case CALL_RENAME:
        report_rename(supervision, known, call);
        return 1;
    case CALL_PAGES:
        return call->data.nr == SYS_mmap ? (arguments[3] & MAP_ANONYMOUS) != 0 : arguments[0] != 0;
    case CALL_NONE:
        return 0;
    default:
        return 1;
    }
}

static int is_refused(struct supervision *supervision, const struct trapped *known,
                      const struct seccomp_notif *call)
{
    if (call->data.nr == SYS_prctl && call->data.args[0] == PR_SET_NAME)
        supervision->has_begun = 1;
    if (!supervision->has_begun || !is_counted(supervision, known, call))
        return 0;
    const struct supervised *supervised = supervision->supervised;
    long count = ++supervision->counts[known->kind];
    return known->kind == supervised->refused &&
           (known->kind == CALL_PAGES ? count >= supervised->n : count == supervised->n);
}

static void answer(struct supervision *supervision)
{
    struct seccomp_notif call = {0};
    if (ioctl(supervision->listener, SECCOMP_IOCTL_NOTIF_RECV, &call) != 0)
        return; /* the thread has ended meanwhile */
    const struct trapped *known = trapped;
    while (known->number != call.data.nr)
        known++;
    struct seccomp_notif_resp response = {.id = call.id};
    if (is_refused(supervision, known, &call))
        response.error =
            call.data.nr == SYS_brk ? 0 : -known->error; /* brk returns an end below the wanted one */
    else
        response.flags = SECCOMP_USER_NOTIF_FLAG_CONTINUE;
    if (known->kind == CALL_SYNC && response.error == 0)
        find_path(supervision, &call, supervision->synced);
    ioctl(supervision->listener, SECCOMP_IOCTL_NOTIF_SEND, &response);
}

static int status_of(pid_t child)
{
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : STATUS_SIGNAL + WTERMSIG(status);
}

int supervise(const struct supervised *supervised, long counts[CALL_KINDS])
{
    int sockets[2];
    memset(counts, 0, CALL_KINDS * sizeof counts[0]);
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) != 0)
        return STATUS_CANNOT;
    pid_t child = fork();
    if (child == 0)
        become(supervised, sockets[1]);
    close(sockets[1]);
    struct supervision supervision = {
        .supervised = supervised, .counts = counts, .listener = receive_descriptor(sockets[0])};
    close(sockets[0]);
    if (supervision.listener < 0) {
        waitpid(child, NULL, 0);
        return STATUS_CANNOT;
    }
    int process = (int)syscall(SYS_pidfd_open, child, 0), ready = 0;
    struct pollfd polled[2] = {{process, POLLIN, 0}, {supervision.listener, POLLIN, 0}};
    while ((ready = poll(polled, 2, TIMEOUT_MS)) > 0 && !(polled[0].revents & POLLIN))
        if (polled[1].revents & POLLIN)
            answer(&supervision);
    if (ready <= 0)
        kill(child, SIGKILL);
    int status = status_of(child);
    close(process);
    close(supervision.listener);
    return ready <= 0 ? STATUS_HANGS : status;
}
