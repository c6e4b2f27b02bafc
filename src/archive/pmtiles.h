/* The parts of a PMTiles file, for all code that reads or writes such files. */
#ifndef CAMBER_ARCHIVE_PMTILES_H
#define CAMBER_ARCHIVE_PMTILES_H

#include "archive/tile_set.h"

typedef struct camber_pmtiles_entry {
    uint64_t number;     /* the number of the entry's first tile */
    uint64_t run_length; /* how many consecutive tiles have these bytes; 0: the entry is for a leaf directory */
    uint64_t offset, size;
} camber_pmtiles_entry;

enum {
    CAMBER_PMTILES_HEADER_BYTES = 127,
    CAMBER_PMTILES_PLAIN = 1, /* not compressed */
    CAMBER_PMTILES_GZIP = 2,
    CAMBER_PMTILES_LEAST_ENTRY_BYTES = 4,
};

typedef struct camber_pmtiles_range {
    uint64_t offset, size;
} camber_pmtiles_range;

typedef struct camber_pmtiles_header {
    camber_pmtiles_range root, metadata, leaves, tiles;
    uint64_t addressed, entries, contents; /* counts; 0: unknown */
    int clustered, directory_compression, tile_compression, tile_type;
    int min_zoom, max_zoom, center_zoom;
    int32_t bounds[4], center[2]; /* west, south, east, north and longitude, latitude, in 10^-7 degrees */
} camber_pmtiles_header;

void camber_pmtiles_parse_header(const unsigned char bytes[CAMBER_PMTILES_HEADER_BYTES], camber_pmtiles_header *header);

/* Returns the number of a tile: lower zooms come first, then the tile's position along the Hilbert curve. zoom: 0
 * to 31. */
uint64_t camber_pmtiles_number(int zoom, uint32_t column, uint32_t row);
/* Finds the tile at a position along the curve, counted from the first tile of its zoom. */
void camber_pmtiles_locate(uint64_t along, int zoom, uint32_t *column, uint32_t *row);

typedef struct camber_pmtiles_directory {
    camber_pmtiles_entry *entries; /* in ascending order; free them with camber_free */
    size_t count;
} camber_pmtiles_directory;

/* Parses a decompressed directory. Returns CAMBER_ERROR_INPUT with the cause in why, which is not logged;
 * CAMBER_ERROR_MEMORY. */
camber_status camber_pmtiles_parse(camber_context *context, const void *bytes, size_t size_bytes,
                                   camber_pmtiles_directory *parsed, const char **why);

/* ---- An open archive, in a tile set that camber_pmtiles_open filled ---- */

typedef struct camber_pmtiles_file {
    int descriptor; /* owned by the set */
    uint64_t size_bytes;
    camber_pmtiles_header header;
} camber_pmtiles_file;

camber_pmtiles_file camber_pmtiles_get_file(const camber_tile_set *set);

/* Receives the entries of the directories, in their order. A status other than CAMBER_OK ends the walk. */
typedef struct camber_pmtiles_visitor {
    uint64_t first, end; /* leaves that have no tiles with numbers from first to before end are not read */
    camber_status (*take_entry)(void *user, const camber_pmtiles_entry *entry);
    camber_status (*take_leaf)(void *user, const camber_pmtiles_entry *entry,
                               int depth); /* NULL: leaves are not reported */
    void *user;
} camber_pmtiles_visitor;

camber_status camber_pmtiles_walk(camber_tile_set *set, const camber_pmtiles_visitor *visitor);
/* Reads the stored bytes of an entry. *why: NULL, or what is wrong with the entry's range. */
camber_status camber_pmtiles_read_entry(camber_tile_set *set, const camber_pmtiles_entry *entry, camber_bytes *bytes,
                                        const char **why);

#endif
