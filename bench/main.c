/* camber_bench: measures every section, prints the tables, and keeps, compares or publishes the document. */
#include "bench.h"

#include <stdlib.h>
#include <string.h>

typedef struct request {
    const char *json, *keep, *plot, *against, *section;
    long mosaic; /* points of the one mosaic that this process is a child for */
    bench_size size;
    unsigned fly_width, fly_height;
    bool avx2_only;
    double country_millions;
} request;

static int usage(void) {
    fprintf(stderr, "usage: camber_bench [--quick | --tiny] [--json OUT.json] [--keep OUT.json] [--plot OUT.svg]\n"
                    "                    [--against OLD.json] [--section NAME[:ITEM],...] [--fly WIDTHxHEIGHT] "
                    "[--country MILLIONS] [--cpu-features avx2]\n"
                    "       camber_bench --readme RESULTS.json... FILE...\n");
    return 2;
}

/* "3840x2160", sides of 16 to 16384 px. */
static bool parse_size(const char *text, request *r) {
    char *end = NULL;
    const unsigned long width = strtoul(text, &end, 10), height = *end == 'x' ? strtoul(end + 1, &end, 10) : 0;
    r->fly_width = (unsigned)width;
    r->fly_height = (unsigned)height;
    return *end == 0 && width >= 16 && width <= 16384 && height >= 16 && height <= 16384;
}

static bool parse(int argc, char **argv, request *r) {
    for (int i = 1; i < argc; i++) {
        const char *next = i + 1 < argc ? argv[i + 1] : NULL;
        const struct {
            const char *option;
            const char **value;
        } texts[] = {{"--json", &r->json},
                     {"--keep", &r->keep},
                     {"--plot", &r->plot},
                     {"--against", &r->against},
                     {"--section", &r->section}};
        bool known = false;
        for (size_t k = 0; k < sizeof texts / sizeof *texts; k++)
            if (next && strcmp(argv[i], texts[k].option) == 0) {
                *texts[k].value = next;
                known = true;
            }
        if (next && strcmp(argv[i], "--fly") == 0)
            known = parse_size(next, r);
        if (next && strcmp(argv[i], "--cpu-features") == 0)
            known = r->avx2_only = strcmp(next, "avx2") == 0;
        if (next && strcmp(argv[i], "--country") == 0)
            known = (r->country_millions = strtod(next, NULL)) > 0;
        if (next && strcmp(argv[i], "--mosaic") == 0)
            known = (r->mosaic = strtol(next, NULL, 10)) > 0;
        i += known;
        if (!known && strcmp(argv[i], "--quick") == 0)
            r->size = BENCH_QUICK;
        else if (!known && strcmp(argv[i], "--tiny") == 0)
            r->size = BENCH_TINY;
        else if (!known)
            return false;
    }
    return true;
}

/* Results come first, and end with .json; documents follow. */
static int publish(char **paths, int count) {
    int results = 0;
    while (results < count && strstr(paths[results], ".json"))
        results++;
    bool done = results > 0 && results < count;
    if (!done)
        return usage();
    for (int i = results; i < count && done; i++)
        done = bench_readme_write(paths, (size_t)results, paths[i]);
    return done ? 0 : 1;
}

static int keep(const json_t *document, const request *r) {
    if (r->json && json_dump_file(document, r->json, JSON_INDENT(1) | JSON_REAL_PRECISION(6)) != 0) {
        perror(r->json);
        return 73;
    }
    if (r->keep) {
        json_t *kept = bench_document_keep(document);
        const bool done = bench_document_write(kept, r->keep);
        json_decref(kept);
        if (!done) {
            perror(r->keep);
            return 73;
        }
    }
    if (r->plot)
        bench_plot_mosaic(document, r->plot);
    return 0;
}

static int measure_all(bench *b, const request *r) {
    json_t *old = NULL, *document = NULL;
    int status = 1;
    if (r->against) {
        json_t *loaded = bench_document_load(r->against);
        if (!loaded)
            return 66;
        old = bench_document_keep(loaded);
        json_decref(loaded);
    }
    if (bench_scenes_make(b, NULL))
        document = bench_document_make(b, r->section);
    if (document)
        status = keep(document, r);
    if (document && status == 0 && old) {
        const int losses = bench_compare(b, document, old, stdout);
        status = losses < 0 ? 2 : losses > 0;
    }
    json_decref(document);
    json_decref(old);
    return status;
}

int main(int argc, char **argv) {
    static const size_t runs[] = {7, 3, 3};
    request r = {.fly_width = 1280, .fly_height = 720};
    if (argc >= 4 && strcmp(argv[1], "--readme") == 0)
        return publish(argv + 2, argc - 2);
    if (!parse(argc, argv, &r))
        return usage();
    if (r.avx2_only)
        setenv("CAMBER_CPU", "x86-64-v3", 0);
    const char *data = getenv("CAMBER_DATA");
    bench b = {.size = r.size,
               .warm_ups = r.size == BENCH_FULL ? 2 : 1,
               .runs = runs[r.size],
               .program = argv[0],
               .tool = CAMBER_TOOL,
               .fly_width = r.fly_width,
               .fly_height = r.fly_height,
               .avx2_only = r.avx2_only,
               .country_millions = r.country_millions,
               .data = data && *data ? data : NULL};
    int status = bench_open(&b) && (!b.avx2_only || bench_is_avx2_only(&b)) ? 0 : 69;
    if (status == 0)
        status = r.mosaic ? bench_mosaic_child(&b, (size_t)r.mosaic) : measure_all(&b, &r);
    bench_scenes_free(&b);
    bench_close(&b);
    return status;
}
