/* Other processes: what they take of wall time, and what they print. */
#define _XOPEN_SOURCE 700 /* posix_spawn */

#include "bench.h"

#include "base/base.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { ARGUMENTS_MAX = 31 };

static bool open_pipe(int ends[2]) {
    return pipe(ends) == 0 && fcntl(ends[0], F_SETFD, FD_CLOEXEC) == 0 && fcntl(ends[1], F_SETFD, FD_CLOEXEC) == 0;
}

/* posix_spawn, since a fork takes longer the more memory this process has. Returns 0 or an errno. */
static int spawn(const char *const *arguments, int input, int output, pid_t *process) {
    char *copies[ARGUMENTS_MAX + 1] = {NULL};
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
    for (size_t i = 0; arguments[i] && i < ARGUMENTS_MAX; i++)
        copies[i] = strdup(arguments[i]);
    const int cause = posix_spawnp(process, arguments[0], &files, NULL, copies, environ);
    for (size_t i = 0; i < ARGUMENTS_MAX; i++)
        free(copies[i]);
    posix_spawn_file_actions_destroy(&files);
    return cause;
}

static char *read_all(int descriptor) {
    char *text = NULL, block[4096];
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);
    for (ssize_t count; to && (count = read(descriptor, block, sizeof block)) != 0;) {
        if (count > 0)
            fwrite(block, 1, (size_t)count, to);
        else if (errno != EINTR)
            break;
    }
    if (to)
        fclose(to);
    return text;
}

/* A program that ends early must not end this one. */
static void send(int descriptor, const char *text) {
    void (*const before)(int) = signal(SIGPIPE, SIG_IGN);
    for (size_t left = strlen(text); left > 0;) {
        const ssize_t written = write(descriptor, text, left);
        if (written < 0 && errno != EINTR)
            break;
        if (written > 0) {
            text += written;
            left -= (size_t)written;
        }
    }
    signal(SIGPIPE, before);
}

static void run(bench_child *child, const char *const *arguments, const char *input) {
    int in[2] = {-1, -1}, out[2] = {-1, -1}, status = 0;
    pid_t process = -1;
    const double begin = camber_now_ms();
    const bool started = open_pipe(in) && open_pipe(out) && spawn(arguments, in[0], out[1], &process) == 0;
    close(in[0]);
    close(out[1]);
    if (started && input)
        send(in[1], input);
    close(in[1]);
    child->output = started ? read_all(out[0]) : NULL;
    close(out[0]);
    if (started && waitpid(process, &status, 0) == process && WIFEXITED(status)) {
        child->wall_ms = camber_now_ms() - begin;
        child->status = WEXITSTATUS(status);
    }
}

/* Sets a variable and gives what to give back; NULL as a value: not set. */
static char *swap_variable(const char *name, const char *value) {
    const char *before = getenv(name);
    char *kept = before ? strdup(before) : NULL;
    if (value)
        setenv(name, value, 1);
    else
        unsetenv(name);
    return kept;
}

bench_child bench_child_run(const char *const *arguments, const char *cache_dir, const char *input) {
    bench_child child = {.status = -1};
    if (!cache_dir) {
        run(&child, arguments, input);
        return child;
    }
    /* Without the kernels that the build has compiled for all users, too. */
    char *cache = swap_variable("XDG_CACHE_HOME", cache_dir), *kernels = swap_variable("CAMBER_KERNELS", "");
    run(&child, arguments, input);
    free(swap_variable("XDG_CACHE_HOME", cache));
    free(swap_variable("CAMBER_KERNELS", kernels));
    free(cache);
    free(kernels);
    return child;
}
