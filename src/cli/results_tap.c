/* TAP: https://testanything.org, version 14. */
#include "cli/results_text.h"

#include <math.h>
#include <string.h>

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

/* A file name may contain any bytes, but must not break the line. special: characters that are escaped with a
 * backslash. */
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

static void print_check(void *user, const camber_check *check, size_t number) {
    const camber_tap *tap = user;
    camber_report_erase_bar(tap->report);
    printf("%s %zu - ", check->result == CAMBER_RESULT_FAILED ? "not ok" : "ok", number);
    print_description(check->name);
    if (check->result == CAMBER_RESULT_SKIPPED) {
        fputs(" # SKIP ", stdout);
        print_description(check->reason);
    }
    putchar('\n');
    if (check->result == CAMBER_RESULT_FAILED)
        print_finding(&check->finding);
    const camber_pixel_bounds *is = &check->error.of, *most = &check->most;
    if (check->has_error)
        printf("# %zu pixels: mean %.3f (at most %.2f), past 16: %.3f %% (%.2f), past 64: %.4f %% (%.3f), max %d\n",
               check->error.pixels, is->mean, most->mean, 100 * is->past_16, 100 * most->past_16, 100 * is->past_64,
               100 * most->past_64, check->error.max);
    fflush(stdout); /* so that a reader sees the first failure at once */
}

/* ---- Groups ---- */

/* Counts the checks of the current group that have this result. */
static size_t count_of(const camber_results *results, camber_result result) {
    size_t count = 0;
    for (size_t i = results->group_first; i < results->count; i++)
        count += results->list[i].result == result;
    return count;
}

/* For a failed group, prints the findings of its first failure and the names of the others. */
static void print_group(void *user, const camber_results *results) {
    camber_tap *tap = user;
    const camber_check *first = NULL;
    const size_t count = results->count - results->group_first;
    const size_t failed = count_of(results, CAMBER_RESULT_FAILED), skipped = count_of(results, CAMBER_RESULT_SKIPPED);
    camber_report_erase_bar(tap->report);
    printf("%s %zu - ", failed ? "not ok" : "ok", ++tap->groups);
    print_description(results->group);
    printf(": %zu check%s", count, camber_plural(count));
    if (failed)
        printf(", %zu failed", failed);
    if (skipped)
        printf(", %zu skipped", skipped);
    putchar('\n');
    for (size_t i = results->group_first; i < results->count; i++) {
        const camber_check *check = &results->list[i];
        if (check->result != CAMBER_RESULT_FAILED)
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

/* ---- The whole text ---- */

void camber_tap_open(camber_tap *tap, bool each, camber_report *report) {
    *tap = (camber_tap){.each = each, .report = report};
    puts("TAP version 14");
}

camber_results_listener camber_tap_listener(camber_tap *tap) {
    return tap->each ? (camber_results_listener){.check = print_check, .user = tap}
                     : (camber_results_listener){.group = print_group, .user = tap};
}

void camber_tap_bail(void) {
    puts("Bail out! see standard error");
    fflush(stdout);
}

int camber_tap_end(const camber_tap *tap, const camber_results *results, camber_report *report) {
    printf("1..%zu\n", tap->each ? results->count : tap->groups);
    return camber_report_flush(report);
}
