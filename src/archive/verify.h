/* Verifying an archive: what the checks of each format share. */
#ifndef CAMBER_ARCHIVE_VERIFY_H
#define CAMBER_ARCHIVE_VERIFY_H

#include "archive/checksum.h"
#include "archive/tally.h"

#include "camber_tiles.h"

/* Findings of a kind that many tiles may have are told up to a number each. */
typedef enum camber_verify_kind {
    CAMBER_VERIFY_ARCHIVE = 0, /* of the archive as a whole: always told */
    CAMBER_VERIFY_PLACE,
    CAMBER_VERIFY_ORDER,
    CAMBER_VERIFY_BOUNDS,
    CAMBER_VERIFY_BYTES,
    CAMBER_VERIFY_NAME,
    CAMBER_VERIFY_TILESET,
    CAMBER_VERIFY_KINDS,
} camber_verify_kind;

typedef struct camber_verify_box {
    double low_column, high_column, low_row, high_row;
} camber_verify_box;

typedef struct camber_verify {
    camber_context *context;
    camber_archive *archive;
    camber_tally tally;
    camber_tiles_finding *findings;
    size_t count, capacity, left_out, told[CAMBER_VERIFY_KINDS];
    bool out_of_memory;
    uint32_t width, height; /* of the pictures; 0: none yet */
    camber_bytes bytes, unpacked;
    camber_verify_box boxes[CAMBER_LARGEST_TILE_ZOOM + 1]; /* tiles that the bounds meet */
    camber_checksum checksum;
    uint64_t flipped, outside; /* tiles out of bounds, and how many of them would be within if rows were turned */
} camber_verify;

CAMBER_PRINTF(4, 5)
void camber_verify_tell(camber_verify *v, camber_verify_kind kind, bool error, const char *format, ...);
/* Names a tile for a message: "12/654/1583". */
void camber_verify_name(uint64_t number, char text[40]);

/* Finds the tiles of each zoom that the bounds touch. */
void camber_verify_find_boxes(camber_verify *v);
/* Checks that a tile, or run of tiles, lies within the zooms and bounds. */
void camber_verify_bounds(camber_verify *v, const camber_archive_tile *tile);
/* Checks a tile's bytes as they are stored. */
camber_status camber_verify_bytes(camber_verify *v, const char *name, const camber_bytes *bytes);

camber_status camber_verify_pmtiles(camber_verify *v);
camber_status camber_verify_mbtiles(camber_verify *v);
camber_status camber_verify_folder(camber_verify *v);

#endif
