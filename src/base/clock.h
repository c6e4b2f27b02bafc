/* The clock. The functions are inline because the tool, the server and the checks measure time, too, and libcamber
 * hides its internal symbols. */
#ifndef CAMBER_BASE_CLOCK_H
#define CAMBER_BASE_CLOCK_H

#include <time.h>

/* Returns a clock's time in milliseconds, or 0 if the clock no longer exists. */
static inline double camber_clock_ms(clockid_t clock) {
    struct timespec now;
    return clock_gettime(clock, &now) == 0 ? (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6 : 0.0;
}

/* Returns the time of a monotonic clock in milliseconds. */
static inline double camber_now_ms(void) {
    return camber_clock_ms(CLOCK_MONOTONIC);
}

/* Returns the time of day that it will be in ms milliseconds, as pthread_cond_timedwait needs it. */
static inline struct timespec camber_time_in(long ms) {
    struct timespec end;
    clock_gettime(CLOCK_REALTIME, &end);
    end.tv_nsec += ms % 1000 * 1000000L;
    end.tv_sec += ms / 1000 + end.tv_nsec / 1000000000L;
    end.tv_nsec %= 1000000000L;
    return end;
}

#endif
