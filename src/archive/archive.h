/* Archives of tiles (PMTiles 3, MBTiles 1.3, and folders of files): how they are written, read, and verified.
 *
 * Writing, from one thread:
 *
 *     camber_archive_writer_create            locks the archive; with resume, finds the finished units
 *     for each unit for which camber_archive_writer_has_unit is false:
 *         camber_archive_writer_add ...       adds its tiles, in any order; ascending numbers are fastest
 *         camber_archive_writer_end_unit      from now on the unit survives the end of the process
 *     camber_archive_writer_finish            the complete archive appears
 *     camber_archive_writer_destroy
 *
 * The bytes of an archive depend only on its description and its tiles. They do not depend on the order in which tiles
 * were added, on the units, or on whether the work was resumed or merged from parts. Until the archive is complete, its
 * tiles are in two files next to it, whose names camber_archive_temporary_path returns. Units are appended to these
 * files, with checksums that show which units are complete.
 *
 * Memory: 24 bytes per added tile, 32 bytes per distinct content, and 2 MB. */
#ifndef CAMBER_ARCHIVE_ARCHIVE_H
#define CAMBER_ARCHIVE_ARCHIVE_H

#include "archive/tile_set.h"

typedef enum camber_archive_format {
    CAMBER_ARCHIVE_PMTILES = 0,
    CAMBER_ARCHIVE_MBTILES,
    CAMBER_ARCHIVE_FOLDER, /* FOLDER/{z}/{x}/{y}.EXTENSION, rows from the north, and FOLDER/metadata.json */
} camber_archive_format;

/* PMTiles defines the numbers up to MLT. */
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

/* Finds the format by the extension of a path. A path is a folder if it is an existing folder, or if it ends with a
 * slash. Returns false if the path does not show the format. */
bool camber_archive_get_format(const char *path, camber_archive_format *format);
/* Returns the name of a type, such as "png", which is also the extension of its files. The name of OTHER is "bin". */
const char *camber_tile_type_get_name(camber_tile_type type);
/* Returns the format for the metadata of MBTiles and folders: the name, or a media type. */
const char *camber_tile_type_get_format(camber_tile_type type);
/* Finds a type by its name, its format or another common extension. Returns OTHER if no type has it. */
camber_tile_type camber_tile_type_find(const char *name);

/* The place and zoom at which a viewer may open the archive. A zeroed center stands for the middle of the bounds at the
 * lowest zoom. */
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
    bool gzipped; /* the bytes of tiles are compressed with gzip */
    bool force;   /* replaces an existing archive */
    bool resume;  /* keeps the units that an earlier run finished */
    bool unites;  /* merging: two tiles with the same number and different bytes are an error; otherwise the later tile
                     wins */
    int min_zoom; /* min_zoom and max_zoom are only used if there are no tiles */
    int max_zoom;
    double bounds[4]; /* west, south, east, north in degrees; all 0: the whole world */
    camber_archive_center center;
    const json_t *metadata; /* an object: name, description, attribution, version and so on. NULL: none */
    /* Identifies the origin of the tiles, as words name=value separated by blanks: "input=... style=... options=...
     * version=...". All parts of an archive have the same fingerprint. NULL: unknown. */
    const char *fingerprint;
    uint32_t shard, shards; /* this is part number `shard` of `shards` parts, counted from 1; 0: the whole archive */
} camber_archive_desc;

typedef struct camber_archive_writer camber_archive_writer;
typedef struct camber_archive camber_archive;

/* Opens the files next to desc->path and locks them. The strings and metadata are copied.
 * Returns CAMBER_ERROR_IO (the folder does not exist, another writer has it open, the archive exists and force is not
 * set), CAMBER_ERROR_INPUT (resume: the existing units have another fingerprint), CAMBER_ERROR_MEMORY. */
camber_status camber_archive_writer_create(camber_context *context, const camber_archive_desc *desc,
                                           camber_archive_writer **writer);
/* Whether an archive with the same fingerprint and shard already exists at the path, so that nothing is left to do. It
 * is always false without resume. */
bool camber_archive_writer_is_done(const camber_archive_writer *writer);
/* Whether an earlier run finished this unit. */
bool camber_archive_writer_has_unit(const camber_archive_writer *writer, uint64_t unit);
/* Adds a tile of the current unit. The bytes are copied.
 * Returns CAMBER_ERROR_IO, CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT (the tile is empty or larger than the limit). */
camber_status camber_archive_writer_add(camber_archive_writer *writer, int zoom, camber_tile_index tile,
                                        const void *bytes, size_t size_bytes);
/* Removes a tile that camber_archive_writer_take has added. */
camber_status camber_archive_writer_remove(camber_archive_writer *writer, int zoom, camber_tile_index tile);
/* Ends the unit with this number: its tiles are written, and survive the end of the process. */
camber_status camber_archive_writer_end_unit(camber_archive_writer *writer, uint64_t unit);
/* Adds all tiles of an archive, which is either a part to merge, or an archive in which some tiles will be replaced.
 * Tiles added by camber_archive_writer_add, before or after, take precedence. The archive stays open until the writer
 * is destroyed; its bytes are copied when the writer finishes. */
camber_status camber_archive_writer_take(camber_archive_writer *writer, camber_archive *archive);
/* Writes the archive to a temporary path, syncs it, renames it and removes the temporary files. On failure, the path is
 * unchanged, and the units stay. Returns CAMBER_ERROR_IO, CAMBER_ERROR_INPUT (unites: two tiles differ),
 * CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_archive_writer_finish(camber_archive_writer *writer);
/* Returns how many of the taken tiles the finished archive lacks because they were removed. */
uint64_t camber_archive_writer_get_removed(const camber_archive_writer *writer);
/* Closes the files. The temporary files stay if a unit was finished but the archive was not. */
void camber_archive_writer_destroy(camber_archive_writer *writer);

/* Writes the name of the n-th temporary file of an archive: the file of tiles, the file of finished units, and the
 * complete archive before it is renamed. Returns false after the last one, or if the name is too long. */
bool camber_archive_temporary_path(const char *path, size_t n, char *name, size_t size);
/* Writes the names of the words that differ between two fingerprints: "style, version". */
void camber_fingerprint_compare(const char *one, const char *other, char *names, size_t size);

/* ---- Reading ---- */

struct camber_archive {
    camber_context *context;
    char *path; /* without a final slash */
    camber_archive_format format;
    camber_tile_type type;
    bool gzipped;
    bool sniffed;         /* the archive does not state its type, so the type of its first tile is used */
    camber_tile_set *set; /* NULL: a folder */
    int min_zoom, max_zoom;
    bool has_bounds;
    double bounds[4];
    camber_archive_center center;
    int whole_center_zoom; /* the center's zoom in the whole archive, if this is a part; otherwise the same as center's
                            */
    json_t *metadata;      /* an object, without the values that other fields of this struct have */
    char *fingerprint;     /* NULL: unknown */
    char checksum[17];     /* the checksum of its tiles, as camber_checksum_write writes it. "": unknown */
    uint32_t shard, shards;
};

/* Opens the archive at a path. Returns the errors of camber_tile_set_open. */
camber_status camber_archive_open(camber_context *context, const char *path, camber_archive **archive);
/* If the archive does not state the type of its tiles, determines it from the first tile. If that tile has no known
 * type, the type stays OTHER. Returns the errors of camber_archive_walk. */
camber_status camber_archive_sniff(camber_archive *archive);
void camber_archive_close(camber_archive *archive);

typedef struct camber_archive_tile {
    uint64_t number, run_length; /* the run_length tiles number, number + 1, ... have the same bytes */
    uint64_t offset;             /* PMTiles: within the file's section of tiles */
    uint64_t size_bytes;
    const unsigned char *bytes; /* valid during the call. NULL: PMTiles */
    bool outside;               /* MBTiles, folders: no such tile can exist, so the number has no meaning */
    int zoom;
    int64_t column, row; /* of the first tile, as stored in the archive */
} camber_archive_tile;

/* Calls take_tile for each tile or run of equal tiles, in the order in which they are stored. */
camber_status camber_archive_walk(camber_archive *archive,
                                  camber_status (*take_tile)(void *user, const camber_archive_tile *tile), void *user);
/* Returns a tile's bytes; for PMTiles it reads them from the file. *why: NULL, or what is wrong with the tile's
 * range. */
camber_status camber_archive_read(camber_archive *archive, const camber_archive_tile *tile, camber_bytes *bytes,
                                  const char **why);

/* Return the zoom of a tile's number, and the number of the first tile of a zoom. */
int camber_archive_zoom(uint64_t number);
uint64_t camber_archive_first(int zoom);

#endif
