/* The mosaic's curve, drawn by gnuplot: what a point costs in time and in memory, by the number of points. */
#include "bench.h"

#include <stdlib.h>
#include <string.h>

static void put_curve(const json_t *rows, const char *kind, FILE *script) {
    size_t i;
    const json_t *row;
    fprintf(script, "$%s << END\n", kind);
    json_array_foreach(rows, i, row) fprintf(
        script, "%.0f %.9g %.9g\n", bench_number(row, "points"), bench_number(json_object_get(row, kind), "ns_a_point"),
        bench_number(row, strcmp(kind, "simple") == 0 ? "peak_bytes" : "everything_peak_bytes") / 1e6);
    fputs("END\n", script);
}

static void put_script(const json_t *rows, FILE *script) {
    put_curve(rows, "simple", script);
    put_curve(rows, "everything", script);
    fprintf(script,
            "set terminal svg size 1120,420 dynamic noenhanced font 'Helvetica,Arial,sans-serif,14' background rgb "
            "'white'\nset encoding utf8\nset logscale xy\nset format x '10^%%T'\nset border 3 lc rgb '#606060'\n"
            "set tics nomirror\nset grid ytics lc rgb '#e0e0e0'\nset key top left\nset xlabel 'points'\n"
            "set multiplot layout 1,2\n"
            "set title 'Mosaic of %s, %d x %d px: ns a point'\n"
            "set yrange [1:*]\n"
            "plot $everything using 1:2 with linespoints lw 2 pt 7 lc rgb '#e69f00' title 'everything', "
            "$simple using 1:2 with linespoints lw 2 pt 7 lc rgb '#0072b2' title 'at %g px'\n"
            "set title 'peak memory, MB'\nset autoscale y\n"
            "plot $everything using 1:3 with linespoints lw 2 pt 7 lc rgb '#e69f00' title 'everything', "
            "$simple using 1:3 with linespoints lw 2 pt 7 lc rgb '#0072b2' title 'at %g px'\nunset multiplot\n",
            bench_text(json_array_get(rows, 0), "city"), BENCH_SIDE_PX, BENCH_SIDE_PX, BENCH_SIMPLIFY_PX,
            BENCH_SIMPLIFY_PX);
}

bool bench_plot_mosaic(const json_t *document, const char *path) {
    const json_t *sections = json_object_get(document, "sections");
    const json_t *rows = bench_result_rows(json_object_get(sections, "mosaic"));
    char *script = NULL;
    size_t size = 0;
    if (json_array_size(rows) == 0)
        return false; /* of a run of another section */
    FILE *to = open_memstream(&script, &size);
    if (to) {
        put_script(rows, to);
        fclose(to);
    }
    const char *const arguments[] = {"gnuplot", "-d", "-", NULL};
    bench_child child = bench_child_run(arguments, NULL, script);
    FILE *file = child.status == 0 && child.output && *child.output ? fopen(path, "w") : NULL;
    const bool done = file && fputs(child.output, file) >= 0 && fclose(file) == 0;
    if (!done)
        fprintf(stderr, "camber_bench: %s is not drawn: gnuplot does not run (apt install gnuplot-nox)\n", path);
    free(child.output);
    free(script);
    return done;
}
