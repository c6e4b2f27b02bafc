/* Verifying an archive: declarations that the checks of all formats share. */
#ifndef CAMBER_ARCHIVE_VERIFY_H
#define CAMBER_ARCHIVE_VERIFY_H

#include "archive/checksum.h"
#include "archive/tally.h"

#include "camber_tiles.h"

/* Kinds of findings. Many tiles may have the same problem, so only a limited number of each kind is reported. */
typedef enum camber_verify_kind {
    CAMBER_VERIFY_ARCHIVE = 0, /* about the archive as a whole: always reported */
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
    uint32_t width, height; /* of pictures; 0: not known yet */
    camber_bytes bytes, unpacked;
    camber_verify_box boxes[CAMBER_LARGEST_TILE_ZOOM + 1]; /* the tiles that the bounds touch, by zoom */
    camber_checksum checksum;
    uint64_t flipped, outside; /* how many tiles are outside the bounds, and how many of these would be inside if rows
                                  counted from the other side */
} camber_verify;

CAMBER_PRINTF(4, 5)
void camber_verify_tell(camber_verify *v, camber_verify_kind kind, bool error, const char *format, ...);
/* Writes a tile's name for messages: "12/654/1583". */
void camber_verify_name(uint64_t number, char text[40]);

/* Finds the tiles of each zoom that the bounds touch. */
void camber_verify_find_boxes(camber_verify *v);
/* Checks that a tile or run of tiles is within the zooms and bounds. */
void camber_verify_bounds(camber_verify *v, const camber_archive_tile *tile);
/* Checks a tile's bytes as stored. */
camber_status camber_verify_bytes(camber_verify *v, const char *name, const camber_bytes *bytes);

camber_status camber_verify_pmtiles(camber_verify *v);
camber_status camber_verify_mbtiles(camber_verify *v);
camber_status camber_verify_folder(camber_verify *v);

#endif
