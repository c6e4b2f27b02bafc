/* The plan that a finished writer passes to the function that writes a format. */
#ifndef CAMBER_ARCHIVE_WRITER_H
#define CAMBER_ARCHIVE_WRITER_H

#include "archive/archive.h"
#include "archive/contents.h"

/* A run: the tiles number, number + 1, ... have the same content. */
typedef struct camber_archive_run {
    uint64_t number, length;
    uint32_t content; /* CAMBER_NO_CONTENT: removed */
    uint32_t order;   /* the position of this run in the order in which runs arrived */
} camber_archive_run;

typedef struct camber_archive_plan {
    camber_context *context;
    const camber_archive_desc *desc;
    const char *whole; /* the path to write to */
    camber_contents *contents;
    const camber_archive_run *runs; /* ascending and disjoint; neighbours have different contents */
    size_t run_count;
    uint64_t tile_count;
    int min_zoom, max_zoom;
    double bounds[4];
    camber_archive_center center;
    json_t *metadata; /* an object that includes what camber adds */
} camber_archive_plan;

camber_status camber_archive_write_pmtiles(const camber_archive_plan *plan);
camber_status camber_archive_write_mbtiles(const camber_archive_plan *plan);
camber_status camber_archive_write_folder(const camber_archive_plan *plan);

/* Compresses bytes with gzip and appends the result to a buffer. name is for messages. */
camber_status camber_archive_gzip(const char *name, const void *bytes, size_t size_bytes, camber_bytes *to);

/* Adds bounds, centre, zooms and format to metadata as texts, in the form of MBTiles. */
void camber_archive_put_texts(const camber_archive_plan *plan, json_t *metadata);

/* A list of runs. */
typedef struct camber_archive_runs {
    camber_archive_run *items;
    size_t count, capacity;
    size_t removed; /* result: how many taken tiles were removed */
} camber_archive_runs;

typedef struct camber_archive_conflict {
    bool found;
    uint64_t number;
    uint32_t orders[2];
} camber_archive_conflict;

/* Makes one ascending list of added and taken runs. If a tile was added several times, the last one stays. Added tiles
 * replace taken ones. Two taken tiles with the same number but different bytes are a conflict. */
camber_status camber_archive_resolve(camber_context *context, camber_archive_runs *added, camber_archive_runs *taken,
                                     camber_archive_runs *made, camber_archive_conflict *conflict);

#endif
