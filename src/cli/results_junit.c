/* Writes the results of validate as JUnit XML. A suite is a device with a back end; a test case is a check. Text from
 * drivers is made valid XML by replacing characters that XML does not allow. */
#include "cli/results_text.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

typedef struct writer {
    camber_sink sink;
    bool failed;
} writer;

static void put(writer *w, const char *text, size_t size) {
    w->failed = w->failed || !w->sink.write(w->sink.user, text, size);
}

static void put_format(writer *w, const char *format, ...) CAMBER_PRINTF(2, 3);

static void put_format(writer *w, const char *format, ...) {
    char text[512];
    va_list list;
    va_start(list, format);
    const int size = vsnprintf(text, sizeof text, format, list);
    va_end(list);
    put(w, text, size < 0 ? 0 : (size_t)size < sizeof text ? (size_t)size : sizeof text - 1);
}

static void put_text(writer *w, const char *text) {
    while (*text) {
        const size_t size = camber_character_size(text);
        const char *entity = *text == '&' ? "&amp;" : *text == '<' ? "&lt;" : *text == '>' ? "&gt;" : "&quot;";
        if (size == 0)
            put(w, "?", 1);
        else if (strchr("&<>\"", *text))
            put(w, entity, strlen(entity));
        else
            put(w, text, size);
        text += size ? size : 1;
    }
}

static void put_attribute(writer *w, const char *name, const char *value) {
    put_format(w, " %s=\"", name);
    put_text(w, value);
    put(w, "\"", 1);
}

static void put_details(writer *w, const camber_finding *finding) {
    put_text(w, finding->what);
    if (finding->picture) {
        put_format(w, "\npicture: ");
        put_text(w, finding->picture);
    }
}

static void put_case(writer *w, const camber_check *check) {
    put_format(w, "    <testcase classname=\"camber.validate\" time=\"%.3f\"", check->ms / 1e3);
    put_attribute(w, "name", check->name);
    if (check->result == CAMBER_RESULT_PASSED) {
        put_format(w, "/>\n");
        return;
    }
    put_format(w, ">\n      ");
    if (check->result == CAMBER_RESULT_SKIPPED) {
        put_format(w, "<skipped");
        put_attribute(w, "message", check->reason);
        put_format(w, "/>");
    } else {
        put_format(w, "<failure type=\"%s\"", check->finding.stage ? check->finding.stage : "difference");
        put_attribute(w, "message", check->finding.what);
        put_format(w, ">");
        put_details(w, &check->finding);
        put_format(w, "</failure>");
    }
    put_format(w, "\n    </testcase>\n");
}

static bool same_text(const char *a, const char *b) {
    return a == b || (a && b && strcmp(a, b) == 0);
}

static bool same_suite(const camber_check *a, const camber_check *b) {
    return same_text(a->device, b->device) && same_text(a->backend, b->backend);
}

/* The counts of a suite or of the whole document. */
typedef struct counts {
    size_t tests, failures, skipped;
    double ms;
} counts;

/* Counts the checks in the same suite as `one`; all checks if it is NULL. */
static counts count_checks(const camber_results *results, const camber_check *one) {
    counts sum = {0};
    for (size_t i = 0; i < results->count; i++) {
        const camber_check *check = &results->list[i];
        if (one && !same_suite(check, one))
            continue;
        sum.tests++;
        sum.failures += check->result == CAMBER_RESULT_FAILED;
        sum.skipped += check->result == CAMBER_RESULT_SKIPPED;
        sum.ms += check->ms;
    }
    return sum;
}

static void put_counts(writer *w, counts sum) {
    put_format(w, " tests=\"%zu\" failures=\"%zu\" errors=\"0\" skipped=\"%zu\" time=\"%.3f\">\n", sum.tests,
               sum.failures, sum.skipped, sum.ms / 1e3);
}

/* Writes the suite whose first check this is; nothing if an earlier check belongs to the same suite. */
static void put_suite(writer *w, const camber_results *results, size_t opener) {
    const camber_check *one = &results->list[opener];
    for (size_t i = 0; i < opener; i++)
        if (same_suite(&results->list[i], one))
            return;
    char name[256];
    snprintf(name, sizeof name, "%s%s%s", one->device ? one->device : "this machine", one->backend ? ", " : "",
             one->backend ? one->backend : "");
    put_format(w, "  <testsuite");
    put_attribute(w, "name", name);
    put_counts(w, count_checks(results, one));
    for (size_t i = opener; i < results->count; i++)
        if (same_suite(&results->list[i], one))
            put_case(w, &results->list[i]);
    put_format(w, "  </testsuite>\n");
}

int camber_junit_write(const camber_results *results, camber_output *output) {
    writer w = {.sink = camber_output_sink(output)};
    put_format(&w, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"camber validate\"");
    put_counts(&w, count_checks(results, NULL));
    for (size_t i = 0; i < results->count; i++)
        put_suite(&w, results, i);
    put_format(&w, "</testsuites>\n");
    return w.failed ? camber_output_status(output, CAMBER_ERROR_IO) : camber_output_publish(output);
}
