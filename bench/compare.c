/* A document against an older one, figure by figure. What looks like a loss is measured again, and is a loss only
 * where no measurement comes as far as the old one. */
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { AGAIN = 2 };
/* Ratios of times wander by some percent from run to run; counts of bytes do not. */
#define TIMES_SLACK 1.10
#define COUNTS_SLACK 1.01

static bool same_text(const json_t *a, const json_t *b, const char *key) {
    return strcmp(bench_text(a, key), bench_text(b, key)) == 0;
}

static const json_t *find(const json_t *result, const json_t *figure) {
    size_t i;
    const json_t *other;
    json_array_foreach(json_object_get(result, "figures"), i,
                       other) if (same_text(other, figure, "item") && same_text(other, figure, "what") &&
                                  same_text(other, figure, "against")) return other;
    return NULL;
}

/* The value that a section of a kept document has of a figure; 0: it has none. */
static double find_kept(const json_t *section, const json_t *figure) {
    const json_t *items = json_object_get(section, "figures");
    const json_t *whats = json_object_get(items, bench_text(figure, "item"));
    return bench_number(json_object_get(whats, bench_text(figure, "what")), bench_text(figure, "against"));
}

/* How many times as good as before: above 1 is better. */
static double gain_of(const json_t *figure, double old) {
    const double ratio = bench_number(figure, "value") / old;
    return json_is_true(json_object_get(figure, "less")) ? 1 / ratio : ratio;
}

static bool is_loss(const json_t *figure, double gain) {
    return gain * (*bench_text(figure, "against") ? TIMES_SLACK : COUNTS_SLACK) < 1;
}

static void tell(const char *word, const json_t *figure, double old, double gain, FILE *to) {
    const char *against = bench_text(figure, "against");
    fprintf(to, "%-6s %s: %s", word, bench_text(figure, "item"), bench_text(figure, "what"));
    if (*against)
        fprintf(to, ", %s in the same run: %.3g, was %.3g (%+.0f %%)\n", against, bench_number(figure, "value"), old,
                100 * (gain - 1));
    else
        fprintf(to, ": %.4g, was %.4g (%+.0f %%)\n", bench_number(figure, "value"), old, 100 * (gain - 1));
}

/* ---- Measuring again ---- */

typedef struct suspect {
    const json_t *figure;
    double old, best; /* gain so far */
} suspect;

/* All suspects of one item share its new measurement. */
static void measure_item(bench *b, const bench_section *section, const char *item, suspect *suspects, size_t count) {
    json_t *result = section->measure(b, item);
    for (size_t i = 0; result && i < count; i++) {
        const json_t *again = find(result, suspects[i].figure);
        if (strcmp(bench_text(suspects[i].figure, "item"), item) == 0 && again)
            suspects[i].best = fmax(suspects[i].best, gain_of(again, suspects[i].old));
    }
    json_decref(result);
}

static bool still_lost(const suspect *suspects, size_t count, const char *item) {
    for (size_t i = 0; i < count; i++)
        if (strcmp(bench_text(suspects[i].figure, "item"), item) == 0 && is_loss(suspects[i].figure, suspects[i].best))
            return true;
    return false;
}

static void measure_again(bench *b, const bench_section *section, suspect *suspects, size_t count, FILE *to) {
    for (size_t i = 0; i < count; i++) {
        const char *item = bench_text(suspects[i].figure, "item");
        bool done = false; /* with the first suspect of its item */
        for (size_t k = 0; k < i; k++)
            done = done || strcmp(bench_text(suspects[k].figure, "item"), item) == 0;
        for (int k = 0; k < AGAIN && !done && still_lost(suspects, count, item); k++) {
            fprintf(to, "again  %s: %s\n", section->name, item);
            fflush(to);
            measure_item(b, section, item, suspects, count);
        }
    }
}

/* ---- Section by section ---- */

typedef struct comparison_counts {
    int compared, gains, losses;
} comparison_counts;

static bool compare_section(bench *b, const bench_section *section, const json_t *result, const json_t *old,
                            comparison_counts *sum, FILE *to) {
    const json_t *figures = json_object_get(result, "figures"), *figure;
    suspect *suspects = calloc(json_array_size(figures) + 1, sizeof *suspects);
    size_t i, count = 0;
    if (!suspects)
        return false;
    json_array_foreach(figures, i, figure) {
        const double before = find_kept(old, figure);
        if (before <= 0)
            continue;
        const double gain = gain_of(figure, before);
        sum->compared++;
        if (is_loss(figure, gain)) {
            suspects[count++] = (suspect){figure, before, gain};
        } else if (is_loss(figure, 1 / gain)) {
            sum->gains++;
            tell("gain", figure, before, gain, to);
        }
    }
    measure_again(b, section, suspects, count, to);
    for (i = 0; i < count; i++)
        if (is_loss(suspects[i].figure, suspects[i].best)) {
            sum->losses++;
            tell("LOSS", suspects[i].figure, suspects[i].old, suspects[i].best, to);
        }
    free(suspects);
    return true;
}

int bench_compare(bench *b, const json_t *document, const json_t *old, FILE *to) {
    const json_t *sections = json_object_get(document, "sections"), *before = json_object_get(old, "sections");
    const json_t *gl = json_object_get(document, "gl"), *old_gl = json_object_get(old, "gl");
    comparison_counts sum = {.compared = 0};
    if (!json_is_object(before) || !same_text(document, old, "size") ||
        json_boolean_value(json_object_get(gl, "software")) !=
            json_boolean_value(json_object_get(old_gl, "software"))) {
        fprintf(stderr,
                "camber_bench: the older results are no such document, of another size (--quick), or of another "
                "kind of device; compare with one that this machine made\n");
        return -1;
    }
    fprintf(to,
            "\nAgainst %s, %s, %s. Ratios to what was measured in the same run, no times; a loss is what measures more "
            "than "
            "%.0f %% worse (bytes: %.0f %%) %d times.\n",
            bench_text(old, "date"), bench_text(json_object_get(old, "device"), "name"), bench_text(old_gl, "renderer"),
            100 * (TIMES_SLACK - 1), 100 * (COUNTS_SLACK - 1), 1 + AGAIN);
    if (!same_text(json_object_get(document, "device"), json_object_get(old, "device"), "name"))
        fprintf(to, "The devices differ: ratios of one say little about the other.\n");
    for (size_t i = 0; bench_sections[i]; i++) {
        const char *name = bench_sections[i]->name;
        if (!compare_section(b, bench_sections[i], json_object_get(sections, name), json_object_get(before, name), &sum,
                             to))
            return -1;
    }
    fprintf(to, "%d figures compared: %d gains, %d losses\n", sum.compared, sum.gains, sum.losses);
    if (sum.compared == 0)
        fprintf(stderr, "camber_bench: the two have no figure in common\n");
    return sum.compared > 0 ? sum.losses : -1;
}
