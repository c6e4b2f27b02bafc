/* Archives of tiles: PMTiles 3, MBTiles 1.3, and folders of files. How they are written, read, and looked over.
 *
 * Writing, from one thread:
 *
 *     camber_archive_writer_create            locks the archive; with resume, finds the units that are done
 *     for each unit that camber_archive_writer_has_unit does not have:
 *         camber_archive_writer_add ...       its tiles, in any order; by their numbers is fastest
 *         camber_archive_writer_end_unit      from here on the unit survives the end of the process
 *     camber_archive_writer_finish            the archive appears, whole
 *     camber_archive_writer_destroy
 *
 * The bytes of an archive depend on its description and its tiles alone: not on the order in which tiles were added,
 * not on units, and not on what was resumed or merged. Until it is whole, its tiles lie in two files beside it, which
 * camber_archive_beside names. They are appended to, unit by unit; checksums tell which units are whole.
 *
 * Memory: 24 bytes a tile that was added, 32 bytes a different content, and 2 MB. */
#ifndef CAMBER_ARCHIVE_ARCHIVE_H
#define CAMBER_ARCHIVE_ARCHIVE_H

#include "archive/tile_set.h"

typedef enum camber_archive_format {
    CAMBER_ARCHIVE_PMTILES = 0,
    CAMBER_ARCHIVE_MBTILES,
    CAMBER_ARCHIVE_FOLDER, /* FOLDER/{z}/{x}/{y}.EXTENSION, rows from the north, and FOLDER/metadata.json */
} camber_archive_format;

/* The numbers up to MLT are PMTiles' own. */
typedef enum camber_tile_type {
    CAMBER_TILE_OTHER = 0,
    CAMBER_TILE_MVT,
    CAMBER_TILE_PNG,
    CAMBER_TILE_JPEG,
    CAMBER_TILE_WEBP,
    CAMBER_TILE_AVIF,
    CAMBER_TILE_MLT,
    CAMBER_TILE_GLB,
} camber_tile_type;

enum { CAMBER_ARCHIVE_LARGEST_TILE_BYTES = 64 << 20 };

/* The format of a path: by its ending; a folder is there already, or ends in a slash. false: it tells none. */
bool camber_archive_get_format(const char *path, camber_archive_format *format);
/* The name of a type, and the ending of its files: "png". "bin" is that of the type OTHER. */
const char *camber_tile_type_get_name(camber_tile_type type);
/* The format that metadata of MBTiles and folders say: the name, or a media type. */
const char *camber_tile_type_get_format(camber_tile_type type);
/* Finds a type by its name, its format or another ending. OTHER: none has it. */
camber_tile_type camber_tile_type_find(const char *name);

/* A place and a zoom that a viewer may open at. Zeroed: the middle of the bounds, at the lowest zoom. */
typedef struct camber_archive_center {
    bool given;
    double longitude, latitude;
    int zoom;
} camber_archive_center;

/* ---- Writing ---- */

typedef struct camber_archive_desc {
    const char *path;
    camber_archive_format format;
    camber_tile_type type;
    bool gzipped; /* the tiles' bytes are compressed with gzip */
    bool force;   /* an archive that is there is replaced */
    bool resume;  /* units that an earlier run has ended are kept */
    bool unites;  /* merging: a tile that comes twice with different bytes is an error; else the later stays */
    int min_zoom; /* these two count only where there are no tiles */
    int max_zoom;
    double bounds[4]; /* west, south, east, north in degrees; all 0: the whole world */
    camber_archive_center center;
    const json_t *metadata; /* an object: name, description, attribution, version and so on. NULL: none */
    /* Says what the tiles are made of, as words name=value with blanks between: "input=... style=... options=...
     * version=...". Parts of one archive have the same. NULL: not told. */
    const char *fingerprint;
    uint32_t shard, shards; /* part shard of shards, from 1; 0: the whole archive */
} camber_archive_desc;

typedef struct camber_archive_writer camber_archive_writer;
typedef struct camber_archive camber_archive;

/* Opens the files beside desc->path and locks them. The strings and metadata are copied.
 * Returns CAMBER_ERROR_IO (no such folder, another writer has it, it exists without force), CAMBER_ERROR_INPUT (resume:
 * the units there are of another fingerprint), CAMBER_ERROR_MEMORY. */
camber_status camber_archive_writer_create(camber_context *context, const camber_archive_desc *desc,
                                           camber_archive_writer **writer);
/* Whether an archive with the same fingerprint and shard stands at the path already: there is nothing to do. Only with
 * resume. */
bool camber_archive_writer_is_done(const camber_archive_writer *writer);
/* Whether an earlier run has ended this unit. */
bool camber_archive_writer_has_unit(const camber_archive_writer *writer, uint64_t unit);
/* Adds a tile of the unit that is being written. The bytes are copied.
 * Returns CAMBER_ERROR_IO, CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT (a tile of 0 bytes or more than the largest). */
camber_status camber_archive_writer_add(camber_archive_writer *writer, int zoom, camber_tile_index tile,
                                        const void *bytes, size_t size_bytes);
/* Takes a tile out, which camber_archive_writer_take has brought. */
camber_status camber_archive_writer_remove(camber_archive_writer *writer, int zoom, camber_tile_index tile);
/* Ends the unit of this number: its tiles are written, and survive the process. */
camber_status camber_archive_writer_end_unit(camber_archive_writer *writer, uint64_t unit);
/* Takes all tiles of an archive: a part to merge, or the archive that some tiles are renewed of, whichever tiles were
 * or are added besides. The archive stays open until the writer is destroyed; its bytes are copied when the writer
 * finishes. */
camber_status camber_archive_writer_take(camber_archive_writer *writer, camber_archive *archive);
/* Writes the archive beside its path, syncs it and gives it its name; what is beside it is removed. Where that fails,
 * the path has what it had, and the units stay.
 * Returns CAMBER_ERROR_IO, CAMBER_ERROR_INPUT (unites: two tiles differ), CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_archive_writer_finish(camber_archive_writer *writer);
/* How many tiles that were taken the finished archive is without, as they were removed. */
uint64_t camber_archive_writer_get_removed(const camber_archive_writer *writer);
/* Closes the files. Those beside the archive stay where a unit has ended and the archive is not finished. */
void camber_archive_writer_destroy(camber_archive_writer *writer);

/* Writes the name of the n-th file beside an archive that is being written: its tiles, its finished units, the whole.
 * false: past the last, or too long. */
bool camber_archive_beside(const char *path, size_t n, char *name, size_t size);
/* Writes the names of what differs between two fingerprints: "style, version". */
void camber_fingerprint_compare(const char *one, const char *other, char *names, size_t size);

/* ---- Reading ---- */

struct camber_archive {
    camber_context *context;
    char *path; /* without a slash at its end */
    camber_archive_format format;
    camber_tile_type type;
    bool gzipped;
    bool sniffed;         /* the archive does not say the type, which is that of its first tile */
    camber_tile_set *set; /* NULL: a folder */
    int min_zoom, max_zoom;
    bool has_bounds;
    double bounds[4];
    camber_archive_center center;
    int whole_center_zoom; /* that of the archive which this is a part of, or its own */
    json_t *metadata;      /* an object, without what stands above and below */
    char *fingerprint;     /* NULL: not told */
    char checksum[17];     /* of its tiles, as camber_checksum_write has it. "": not told */
    uint32_t shard, shards;
};

/* Opens an archive by its path. Returns what camber_tile_set_open does. */
camber_status camber_archive_open(camber_context *context, const char *path, camber_archive **archive);
/* Finds the type of the tiles by the first of them, where the archive does not say it. What is none that is known stays
 * OTHER. Returns what camber_archive_walk does. */
camber_status camber_archive_sniff(camber_archive *archive);
void camber_archive_close(camber_archive *archive);

typedef struct camber_archive_tile {
    uint64_t number, run_length; /* the tiles number, number + 1, ... have the same bytes */
    uint64_t offset;             /* PMTiles: within the tiles of the file */
    uint64_t size_bytes;
    const unsigned char *bytes; /* valid during the call. NULL: PMTiles */
    bool outside;               /* MBTiles, folders: there is no such tile; its number says nothing */
    int zoom;
    int64_t column, row; /* of the first, as they stand in the archive */
} camber_archive_tile;

/* Calls take_tile for each tile, or run of tiles, in the order in which they are stored. */
camber_status camber_archive_walk(camber_archive *archive,
                                  camber_status (*take_tile)(void *user, const camber_archive_tile *tile), void *user);
/* Reads a tile's bytes; those of PMTiles are read from the file. *why: NULL, or what is wrong with its place. */
camber_status camber_archive_read(camber_archive *archive, const camber_archive_tile *tile, camber_bytes *bytes,
                                  const char **why);

/* The zoom of a tile's number, and the number of the first tile of a zoom. */
int camber_archive_zoom(uint64_t number);
uint64_t camber_archive_first(int zoom);

#endif
