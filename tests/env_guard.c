/* Preloaded into the tool: ends it where the environment grows once there are threads. Growing moves it, and a getenv
 * of another thread then reads what is freed: a crash of one start in some hundreds, which no test would meet. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static void check(const char *name) {
    struct stat threads; /* one link each, and two of the folder */
    if (getenv(name) || stat("/proc/self/task", &threads) != 0 || threads.st_nlink <= 3)
        return;
    fprintf(stderr, "env_guard: %s is new to the environment, and %d threads may be reading it\n", name,
            (int)threads.st_nlink - 2);
    abort();
}

int setenv(const char *name, const char *value, int overwrite) {
    int (*next)(const char *, const char *, int);
    void *symbol = dlsym(RTLD_NEXT, "setenv");
    memcpy(&next, &symbol, sizeof next);
    check(name);
    return next(name, value, overwrite);
}

int putenv(char *text) {
    int (*next)(char *);
    char name[256] = "";
    void *symbol = dlsym(RTLD_NEXT, "putenv");
    memcpy(&next, &symbol, sizeof next);
    const size_t length = strcspn(text, "=");
    memcpy(name, text, length < sizeof name ? length : sizeof name - 1);
    check(name);
    return next(text);
}
