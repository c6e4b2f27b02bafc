/* A made-up country: cities side by side, by the program camber_country, which lies beside camber_bench where libosmium
 * is. */
#define _DEFAULT_SOURCE /* mkstemps */

#include "bench.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const cities[] = {"porto_portugal.osm.pbf",   "nyc.osm.pbf",
                                     "columbus.osm.pbf",         "liechtenstein-latest.osm.pbf",
                                     "Helsinki-1327152.osm.pbf", "spo_osm.pbf"};
enum { CITIES = sizeof cities / sizeof *cities };

bool bench_country_make(const bench *b, double millions, const char *ending, char *path, size_t size) {
    char program[1024], count[32], paths[CITIES][1024];
    const char *arguments[4 + CITIES] = {program, path, count}, *slash = strrchr(b->program, '/');
    const char *folder = getenv("TMPDIR");
    snprintf(program, sizeof program, "%.*scamber_country", slash ? (int)(slash + 1 - b->program) : 0, b->program);
    snprintf(count, sizeof count, "%g", millions);
    if (!b->data || access(program, X_OK) != 0)
        return false;
    snprintf(path, size, "%s/camber-country-XXXXXX%s", folder && *folder ? folder : "/tmp", ending);
    const int file = mkstemps(path, (int)strlen(ending));
    if (file < 0)
        return false;
    close(file);
    for (size_t i = 0; i < CITIES; i++) {
        snprintf(paths[i], sizeof paths[i], "%s/data/%s", b->data, cities[i]);
        arguments[3 + i] = paths[i];
    }
    const bench_child child = bench_child_run(arguments, NULL, NULL);
    free(child.output);
    if (child.status != 0)
        unlink(path);
    return child.status == 0;
}
