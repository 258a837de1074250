/* Runs a program and decides on some of its system calls: each is counted, and the n-th of a kind is refused.
 *
 * The kernel asks before it executes such a call (seccomp_unotify(2)), so that nothing in the program or in
 * its libraries is replaced, and no write escapes because the C library makes it by itself. Counting begins
 * when the program names its process, which toile's main does first: what the loader of shared libraries does
 * before is not the program's. Threads: one caller. */
#ifndef TOILE_TESTS_APP_INJECT_SUPERVISE_H
#define TOILE_TESTS_APP_INJECT_SUPERVISE_H

enum call_kind {
    CALL_NONE,
    CALL_WRITE,  /* to a file below the folder or to standard output: ENOSPC */
    CALL_SYNC,   /* fsync, fdatasync: EIO */
    CALL_RENAME, /* EACCES */
    CALL_OPEN,   /* for writing, of a path below the folder: EACCES */
    CALL_FOLDER, /* mkdir: ENOSPC */
    CALL_THREAD, /* clone: EAGAIN */
    CALL_PAGES,  /* mmap without a file, mremap, brk: ENOMEM; the calls that follow are refused as well */
    CALL_KINDS
};

struct supervised {
    const char *folder;     /* where it runs: an absolute path without symbolic links */
    const char *out, *err;  /* files that take standard output and standard error */
    char *const *arguments; /* the first is the program's path; NULL ends them */
    enum call_kind refused; /* CALL_NONE: all calls are let through */
    long n;                 /* which of them, from 1 */
    /* Called before a file is renamed; paths are relative to the folder. `is_synced`: its last sync was not
     * refused, and nothing was written to it since. */
    void (*on_rename)(void *user, const char *from, const char *to, int is_synced);
    void *user;
};

#define STATUS_SIGNAL 256  /* + the number of the signal */
#define STATUS_HANGS  (-1) /* did not end by itself; killed */
#define STATUS_CANNOT (-2) /* this system has no seccomp_unotify */

/* Returns the exit status or one of the above, and how often the program made calls of each kind. */
int supervise(const struct supervised *supervised, long counts[CALL_KINDS]);

#endif
