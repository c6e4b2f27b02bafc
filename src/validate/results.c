#include "validate/results.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

void camber_results_open(camber_results *verdicts, camber_report *report, bool tap, bool each) {
    *verdicts = (camber_results){.report = report, .tap = tap, .each = each};
    if (tap)
        puts("TAP version 14");
}

camber_check camber_check_start(const char *device, const char *backend, const char *format, ...) {
    camber_check check = {.device = device, .backend = backend, .start_ms = camber_clock_ms()};
    va_list list;
    va_start(list, format);
    vsnprintf(check.name, sizeof check.name, format, list);
    va_end(list);
    return check;
}

camber_value_text camber_value_print(double value) {
    camber_value_text made;
    const bool whole = fabs(value) < 0x1p53 && floor(value) == value;
    snprintf(made.text, sizeof made.text, whole ? "%.0f" : "%.9g", value);
    return made;
}

size_t camber_character_size(const char *character) {
    const unsigned char *text = (const unsigned char *)character;
    if (text[0] < 0x80)
        return text[0] >= 0x20 && text[0] != 0x7f;
    const size_t size = text[0] >= 0xf0 ? 4 : text[0] >= 0xe0 ? 3 : 2;
    if (text[0] < 0xc2 || text[0] > 0xf4)
        return 0;
    uint32_t code = text[0] & (0x7fu >> size);
    for (size_t i = 1; i < size; i++) {
        if ((text[i] & 0xc0) != 0x80)
            return 0;
        code = code << 6 | (text[i] & 0x3fu);
    }
    static const uint32_t least[] = {0x80, 0x800, 0x10000};
    const bool surrogate = code >= 0xd800 && code <= 0xdfff;
    return code < least[size - 2] || code > 0x10ffff || surrogate || code == 0xfffe || code == 0xffff ? 0 : size;
}

/* ---- TAP ---- */

/* A name of a file may hold anything; a line stays a line. special: what takes a \ before it. */
static void print_text(const char *text, const char *special) {
    while (*text) {
        const size_t size = camber_character_size(text);
        if (strchr(special, *text))
            putchar('\\');
        if (size)
            fwrite(text, 1, size, stdout);
        else
            putchar('?');
        text += size ? size : 1;
    }
}

static void print_description(const char *text) {
    print_text(text, "#\\");
}

static void print_yaml_text(const char *key, const char *text) {
    printf("  %s: \"", key);
    print_text(text, "\"\\");
    puts("\"");
}

static void print_yaml_number(const char *key, double value) {
    if (isnan(value))
        printf("  %s: .nan\n", key);
    else if (isinf(value))
        printf("  %s: %s.inf\n", key, value < 0 ? "-" : "");
    else
        printf("  %s: %s\n", key, camber_value_print(value).text);
}

static void print_finding(const camber_finding *finding) {
    puts("  ---");
    print_yaml_text("message", finding->what);
    if (finding->stage)
        print_yaml_text("stage", finding->stage);
    if (finding->has_point) {
        printf("  polyline: %zu\n  point: %zu\n", finding->polyline, finding->point);
        printf("  at: [%.9g, %.9g]\n", finding->x, finding->y);
    }
    if (finding->field) {
        print_yaml_text("field", finding->field);
        print_yaml_number("got", finding->got);
        print_yaml_number("expected", finding->expected);
    }
    if (finding->picture)
        print_yaml_text("picture", finding->picture);
    puts("  ...");
}

static void print_tap(const camber_check *check, size_t number) {
    printf("%s %zu - ", check->verdict == CAMBER_RESULT_FAILED ? "not ok" : "ok", number);
    print_description(check->name);
    if (check->verdict == CAMBER_RESULT_SKIPPED) {
        fputs(" # SKIP ", stdout);
        print_description(check->reason);
    }
    putchar('\n');
    if (check->verdict == CAMBER_RESULT_FAILED)
        print_finding(&check->finding);
    const camber_pixel_bounds *is = &check->error.of, *most = &check->most;
    if (check->has_error)
        printf("# %zu pixels: mean %.3f (at most %.2f), past 16: %.3f %% (%.2f), past 64: %.4f %% (%.3f), max %d\n",
               check->error.pixels, is->mean, most->mean, 100 * is->past_16, 100 * most->past_16, 100 * is->past_64,
               100 * most->past_64, check->error.max);
    fflush(stdout); /* for who waits for the first failure */
}

/* ---- Groups ---- */

/* One that failed shows what its first failure found, and names the others. */
static void print_group(const camber_results *verdicts, size_t failed, size_t skipped) {
    const camber_check *first = NULL;
    const size_t count = verdicts->count - verdicts->group_first;
    printf("%s %zu - ", failed ? "not ok" : "ok", verdicts->group_count);
    print_description(verdicts->group);
    printf(": %zu check%s", count, camber_plural(count));
    if (failed)
        printf(", %zu failed", failed);
    if (skipped)
        printf(", %zu skipped", skipped);
    putchar('\n');
    for (size_t i = verdicts->group_first; i < verdicts->count; i++) {
        const camber_check *check = &verdicts->list[i];
        if (check->verdict != CAMBER_RESULT_FAILED)
            continue;
        if (!first)
            print_finding(&check->finding);
        first = first ? first : check;
        fputs("# failed: ", stdout);
        print_text(check->name, "");
        putchar('\n');
    }
    fflush(stdout);
}

static void end_group(camber_results *verdicts) {
    size_t failed = 0, skipped = 0;
    for (size_t i = verdicts->group_first; i < verdicts->count; i++) {
        failed += verdicts->list[i].verdict == CAMBER_RESULT_FAILED;
        skipped += verdicts->list[i].verdict == CAMBER_RESULT_SKIPPED;
    }
    if (verdicts->tap && !verdicts->each && verdicts->group[0] && verdicts->count > verdicts->group_first) {
        verdicts->group_count++;
        print_group(verdicts, failed, skipped);
    }
    verdicts->group[0] = 0;
    verdicts->group_first = verdicts->count;
}

void camber_results_group(camber_results *verdicts, const char *format, ...) {
    va_list list;
    end_group(verdicts);
    va_start(list, format);
    vsnprintf(verdicts->group, sizeof verdicts->group, format, list);
    va_end(list);
}

/* ---- Adding ---- */

void camber_results_add(camber_results *verdicts, const camber_check *check) {
    verdicts->failed += check->verdict == CAMBER_RESULT_FAILED;
    verdicts->skipped += check->verdict == CAMBER_RESULT_SKIPPED;
    if (verdicts->count == verdicts->capacity && !verdicts->full) {
        const size_t capacity = verdicts->capacity ? 2 * verdicts->capacity : 256;
        camber_check *grown = realloc(verdicts->list, capacity * sizeof *grown);
        verdicts->full = !grown;
        verdicts->list = grown ? grown : verdicts->list;
        verdicts->capacity = grown ? capacity : verdicts->capacity;
    }
    if (verdicts->full) {
        free(check->finding.picture);
        return;
    }
    camber_check *kept = &verdicts->list[verdicts->count++];
    *kept = *check;
    kept->ms = camber_clock_ms() - kept->start_ms;
    if (verdicts->tap && verdicts->each)
        print_tap(kept, verdicts->count);
}

void camber_results_skip(camber_results *verdicts, camber_check check, const char *reason) {
    check.verdict = CAMBER_RESULT_SKIPPED;
    snprintf(check.reason, sizeof check.reason, "%s", reason);
    camber_results_add(verdicts, &check);
}

/* ---- The end ---- */

static json_t *number_json(double value) {
    if (!isfinite(value))
        return json_string(isnan(value) ? "nan" : value < 0 ? "-inf" : "inf");
    return fabs(value) < 0x1p53 && floor(value) == value ? json_integer((json_int_t)value) : json_real(value);
}

static json_t *text_json(const char *text) {
    return text ? camber_json_text(text) : json_null();
}

static json_t *check_json(const camber_check *check) {
    return json_pack("{s:o, s:o, s:o}", "check", text_json(check->name), "device", text_json(check->device), "backend",
                     text_json(check->backend));
}

static json_t *failure_json(const camber_check *check) {
    const camber_finding *finding = &check->finding;
    json_t *object = check_json(check);
    json_object_set_new(object, "stage", text_json(finding->stage));
    json_object_set_new(object, "polyline", finding->has_point ? camber_json_count(finding->polyline) : json_null());
    json_object_set_new(object, "point", finding->has_point ? camber_json_count(finding->point) : json_null());
    json_object_set_new(object, "field", text_json(finding->field));
    json_object_set_new(object, "got", finding->field ? number_json(finding->got) : json_null());
    json_object_set_new(object, "expected", finding->field ? number_json(finding->expected) : json_null());
    json_object_set_new(object, "difference", text_json(finding->what));
    json_object_set_new(object, "picture", text_json(finding->picture));
    return object;
}

static json_t *bounds_json(const camber_pixel_bounds *bounds) {
    return json_pack("{s:f, s:f, s:f}", "mean", bounds->mean, "past_16", bounds->past_16, "past_64", bounds->past_64);
}

static json_t *pixels_json(const camber_check *check) {
    json_t *object = check_json(check), *measured = bounds_json(&check->error.of);
    json_object_update(object, measured);
    json_decref(measured);
    json_object_set_new(object, "windows", camber_json_count(check->error.windows));
    json_object_set_new(object, "pixels", camber_json_count(check->error.pixels));
    json_object_set_new(object, "max", json_integer(check->error.max));
    json_object_set_new(object, "bounds", bounds_json(&check->most));
    return object;
}

static int print_json(const camber_results *verdicts) {
    json_t *failures = json_array(), *skips = json_array(), *pixels = json_array();
    for (size_t i = 0; i < verdicts->count; i++) {
        const camber_check *check = &verdicts->list[i];
        if (check->verdict == CAMBER_RESULT_FAILED)
            json_array_append_new(failures, failure_json(check));
        if (check->verdict == CAMBER_RESULT_SKIPPED) {
            json_t *skip = check_json(check);
            json_object_set_new(skip, "reason", text_json(check->reason));
            json_array_append_new(skips, skip);
        }
        if (check->has_error)
            json_array_append_new(pixels, pixels_json(check));
    }
    return camber_report_json(verdicts->report,
                              json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}", "checks", camber_json_count(verdicts->count),
                                        "failed", camber_json_count(verdicts->failed), "skipped",
                                        camber_json_count(verdicts->skipped), "failures", failures, "skips", skips,
                                        "pixels", pixels));
}

void camber_results_bail(camber_results *verdicts) {
    end_group(verdicts);
    if (!verdicts->tap)
        return;
    puts("Bail out! see standard error");
    fflush(stdout);
}

int camber_results_print(camber_results *verdicts) {
    if (verdicts->full)
        return camber_report_status(verdicts->report, CAMBER_ERROR_MEMORY);
    int status = CAMBER_EXIT_DONE;
    end_group(verdicts);
    if (verdicts->tap) {
        printf("1..%zu\n", verdicts->each ? verdicts->count : verdicts->group_count);
        status = camber_report_flush(verdicts->report);
    } else {
        status = print_json(verdicts);
    }
    return status == CAMBER_EXIT_DONE && verdicts->failed ? CAMBER_EXIT_CHECK : status;
}

void camber_results_close(camber_results *verdicts) {
    for (size_t i = 0; i < verdicts->count; i++)
        free(verdicts->list[i].finding.picture);
    free(verdicts->list);
    *verdicts = (camber_results){0};
}
