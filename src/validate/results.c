#include "validate/results.h"

#include "base/clock.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

camber_value_text camber_value_print(double value) {
    camber_value_text made;
    const bool whole = fabs(value) < 0x1p53 && floor(value) == value;
    snprintf(made.text, sizeof made.text, whole ? "%.0f" : "%.9g", value);
    return made;
}

/* ---- Groups ---- */

void camber_results_end(camber_results *results) {
    if (results->listener.group && results->group[0] && results->count > results->group_first)
        results->listener.group(results->listener.user, results);
    results->group[0] = 0;
    results->group_first = results->count;
}

bool camber_results_group(camber_results *results, const char *format, ...) {
    va_list list;
    camber_results_end(results);
    va_start(list, format);
    vsnprintf(results->group, sizeof results->group, format, list);
    va_end(list);
    const bool wanted = !results->only || strstr(results->group, results->only);
    results->wanted += wanted;
    return wanted;
}

/* ---- Checks ---- */

camber_check camber_check_start(const char *device, const char *backend, const char *format, ...) {
    camber_check check = {.device = device, .backend = backend, .start_ms = camber_now_ms()};
    va_list list;
    va_start(list, format);
    vsnprintf(check.name, sizeof check.name, format, list);
    va_end(list);
    return check;
}

void camber_results_add(camber_results *results, const camber_check *check) {
    results->failed += check->result == CAMBER_RESULT_FAILED;
    results->skipped += check->result == CAMBER_RESULT_SKIPPED;
    if (results->count == results->capacity && !results->full) {
        const size_t capacity = results->capacity ? 2 * results->capacity : 256;
        camber_check *grown = realloc(results->list, capacity * sizeof *grown);
        results->full = !grown;
        results->list = grown ? grown : results->list;
        results->capacity = grown ? capacity : results->capacity;
    }
    if (results->full) {
        free(check->finding.picture);
        return;
    }
    camber_check *kept = &results->list[results->count++];
    *kept = *check;
    kept->ms = camber_now_ms() - kept->start_ms;
    if (results->listener.check)
        results->listener.check(results->listener.user, kept, results->count);
}

void camber_results_skip(camber_results *results, camber_check check, const char *reason) {
    check.result = CAMBER_RESULT_SKIPPED;
    snprintf(check.reason, sizeof check.reason, "%s", reason);
    camber_results_add(results, &check);
}

void camber_results_close(camber_results *results) {
    for (size_t i = 0; i < results->count; i++)
        free(results->list[i].finding.picture);
    free(results->list);
    *results = (camber_results){0};
}
