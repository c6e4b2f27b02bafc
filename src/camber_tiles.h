/* Map tiles, and archives of them: PMTiles 3, MBTiles 1.3, folders FOLDER/{z}/{x}/{y}.EXTENSION.
 *
 *     features -> engine -> picture of some tiles -> tiles, or an archive
 *
 * The ending of a path gives its format: .pmtiles, .mbtiles, or a slash for a folder. An existing folder needs no
 * slash.
 *
 * The rules of camber.h (errors, ownership, descriptions, threads) apply here too. */
#ifndef CAMBER_TILES_H
#define CAMBER_TILES_H

#include "camber_map.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Showing an archive ---- */

typedef struct camber_tiles_zoom {
    int zoom;
    uint64_t tiles;
    uint64_t size_bytes; /* stored bytes; equal tiles count once, at the lowest zoom that has them */
} camber_tiles_zoom;

typedef struct camber_tiles_info {
    const char *format;      /* "pmtiles", "mbtiles", "folder" */
    const char *type;        /* "png", "jpg", "webp", "avif", "pbf", "mlt", "glb"; "bin" if it is not known */
    const char *compression; /* "gzip", "none" */
    int min_zoom, max_zoom;  /* as the archive says */
    uint64_t tiles;          /* number of tiles that can be requested */
    uint64_t entries;        /* entries in the directories of PMTiles; for other formats, the same number as tiles */
    uint64_t contents;       /* number of distinct tiles, as they are stored */
    bool has_bounds, has_center;
    double bounds[4];        /* west, south, east, north, in degrees */
    double center[3];        /* longitude, latitude, zoom */
    const char *metadata;    /* the rest of the metadata, a JSON object without keys that are not UTF-8 */
    const char *fingerprint; /* NULL: it is not known */
    uint32_t shard, shards;  /* 0: it is not one shard of several */
    const camber_tiles_zoom *zooms;
    size_t zoom_count;
    const char *schema; /* of vector tiles, if the style "city" knows it, such as "OpenMapTiles"; otherwise NULL */
} camber_tiles_info;

/* Reads a description of an archive. Free *info with camber_tiles_info_destroy.
 * Returns CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_INPUT (not an archive, or damaged), CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT,
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_show(camber_context *context, const char *path, camber_tiles_info **info);
CAMBER_API void camber_tiles_info_destroy(camber_tiles_info *info);

/* ---- Reading single tiles of an archive ---- */

typedef struct camber_tiles_place {
    int zoom;
    uint32_t column, row; /* from the north */
} camber_tiles_place;

/* An open archive, from which tiles are read on request. It serves one thread at a time. */
typedef struct camber_tiles_reader camber_tiles_reader;

/* Returns the errors of camber_tiles_show. It reads no tiles, so its time does not grow with the archive. */
CAMBER_API camber_status camber_tiles_reader_create(camber_context *context, const char *path,
                                                    camber_tiles_reader **reader);
CAMBER_API void camber_tiles_reader_destroy(camber_tiles_reader *reader);
/* Returns the archive's description of itself, which the reader owns. Counts and zooms are 0, because they are not
 * determined. */
CAMBER_API const camber_tiles_info *camber_tiles_reader_get_info(const camber_tiles_reader *reader);
/* Reads a tile as it is stored, possibly compressed (camber_tiles_info). The reader owns *bytes, which are valid until
 * its next call; *size_bytes is 0 if the archive has no such tile.
 * Returns CAMBER_ERROR_ARGUMENT (a zoom, column or row out of range), CAMBER_ERROR_INPUT (damaged), CAMBER_ERROR_IO,
 * CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_reader_read(camber_tiles_reader *reader, const camber_tiles_place *place,
                                                  const uint8_t **bytes, size_t *size_bytes);

/* ---- Whether an archive is right ---- */

typedef struct camber_tiles_finding {
    bool error;          /* true: readers may fail or show something wrong. false: it wastes space or is unusual */
    const char *message; /* one line, without the path */
} camber_tiles_finding;

typedef struct camber_tiles_findings {
    const camber_tiles_finding *findings;
    size_t count;
    size_t left_out;            /* findings that are not listed, because each kind is listed only up to a limit */
    uint64_t tiles, size_bytes; /* of the archive, as far as it could be read */
} camber_tiles_findings;

/* Checks everything that an archive claims: its header, counts, zooms, bounds, order and sections, its tables, indices
 * and metadata, the tileset of a folder of meshes, and for each tile its position and whether its content is of the
 * declared type. A damaged archive gives findings; the call itself does not fail. Free *findings with
 * camber_tiles_findings_destroy.
 * Returns CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_verify(camber_context *context, const char *path,
                                             camber_tiles_findings **findings);
CAMBER_API void camber_tiles_findings_destroy(camber_tiles_findings *findings);

/* ---- Merging and converting ---- */

typedef struct camber_tiles_merge_desc {
    const char *const *parts; /* part_count of them */
    size_t part_count;
    const char *output; /* in the format that its name gives */
    bool force;         /* an existing archive is replaced */
    /* Called as soon as no other process can write this output. From then on this call owns the files beside the output
     * (camber_tiles_beside), and they may be removed if the process has to end. NULL: not called. */
    void (*begun)(void *user);
    void *user;
} camber_tiles_merge_desc;

/* Writes one archive with the tiles of all parts; a single part is converted. If parts say that they are shard K of N,
 * all N must be given, with the same fingerprint; the archive then has the bytes that a single run would have written.
 * A tile that two parts have is written once if its bytes are equal. The output appears complete, or remains as it was.
 * Returns CAMBER_ERROR_INPUT (parts that are missing, given twice, damaged, or differ in fingerprint, type or
 * compression; tiles that differ), CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY.
 * The message names each part. */
CAMBER_API camber_status camber_tiles_merge(camber_context *context, const camber_tiles_merge_desc *desc);
/* Writes the name of the n-th temporary file, counted from 0, that is beside an archive while it is written. false:
 * past the last, or the name is too long. */
CAMBER_API bool camber_tiles_beside(const char *path, size_t n, char *name, size_t size);

/* ---- Drawing tiles ---- */

typedef struct camber_tiles_engine_desc {
    camber_renderer *renderer; /* not NULL unless tiles are meshes; may be from another context than the features */
    camber_device *device;     /* the renderer's */
    /* CSS px: 256 (whose zoom 1 is MapLibre's zoom 0) or 512 (the same zooms as MapLibre). 0: 256 */
    uint32_t tile_size;
    double ratio;       /* device px per CSS px; a tile is rounded to whole px, 64 to 2048. 0: 1 */
    double simplify_px; /* as in camber_scene_desc. 0: nothing is left out */
    camber_coverage coverage;
    uint32_t threads; /* that locate lines and encode tiles, besides the device's own threads. 0: one per core */
    /* For an engine that serves single tiles in any order: the most tiles on a side of a picture, 1, 2, 4 or 8. The
     * memory for high zooms then stays bounded. Such an engine draws no archives. 0: 8, for archives. */
    uint32_t on_demand_side;
    /* Tiles are meshes, as docs/mesh-tiles.md describes them: a tile has what the style draws from its own zoom up to
     * the next. There are no pictures, and renderer may be NULL. */
    bool meshes;
} camber_tiles_engine_desc;

/* An engine draws tiles of features. One picture shows a metatile: up to 8 x 8 tiles. Metatiles are arranged in a grid
 * from the north-west. The tiles of a metatile are cut out of one picture. Lines continue across the edges of
 * metatiles, whatever their width, offset, blur, dashes or pattern. The output of an engine depends only on its desc
 * and on the features. If kernels draw, and tiles are a multiple of 32 px wide, on_demand_side changes no byte of a
 * tile, except in areas that an image fills: there by one level of 255.
 *
 * If fonts were read with the features (camber_features_read_fonts), pictures have labels. These have fixed places in
 * each zoom: a label that touches several tiles is the same in all of them, whichever are drawn, in any order, at any
 * ratio. A tile is drawn if a label touches it, even if no line does.
 *
 * An engine, the renderer and the features serve one thread at a time. The caller owns a picture: other threads may cut
 * and encode it while the next one is drawn, each with a camber_encoder from a context of its own.
 *
 * The engine locates the lines of a zoom when it is first asked for that zoom. It keeps 4 bytes per line and metatile.
 * With on_demand_side, it keeps them per tile of zoom 16 if the drawn tiles are smaller than that. */
typedef struct camber_tiles_engine camber_tiles_engine;

/* Returns a hash of everything that determines a picture of the features, except the desc: lines, the properties that
 * the style reads, the style with its sprites, and the library's version. It visits every point. A tile that is cached
 * under this hash is never a tile of another input. */
CAMBER_API uint64_t camber_features_get_hash(const camber_features *features);
/* The features, the renderer and the device must outlive the engine.
 * Returns CAMBER_ERROR_ARGUMENT (a size or ratio out of range), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_engine_create(const camber_features *features,
                                                    const camber_tiles_engine_desc *desc, camber_tiles_engine **engine);
CAMBER_API void camber_tiles_engine_destroy(camber_tiles_engine *engine);

/* A metatile, drawn or still to be drawn. */
typedef struct camber_tiles_picture {
    int zoom;
    uint32_t column, row; /* of its north-western tile */
    uint32_t side;        /* tiles on a side: a power of two, 1 to 8 */
    uint32_t tile_px;     /* device px on a side of a tile */
    /* bit side * y + x: a line or a label may touch tile x, y of the metatile; the others show only the background */
    uint64_t tiles;
    bool has_background;   /* the background is the following colour, not an image */
    uint8_t background[4]; /* premultiplied RGBA */
    const uint8_t *rgba;   /* side * tile_px rows of side * tile_px premultiplied RGBA8 pixels. NULL: not drawn */
} camber_tiles_picture;

/* Returns the largest number of bytes that the pixels of one picture take. */
CAMBER_API size_t camber_tiles_engine_get_picture_bytes(const camber_tiles_engine *engine);
/* Finds the metatile that contains a tile, and which of its tiles lines or labels touch, without drawing.
 * Returns CAMBER_ERROR_ARGUMENT (no such tile; zooms are 0 to 24), CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_engine_look(camber_tiles_engine *engine, int zoom, uint32_t column, uint32_t row,
                                                  camber_tiles_picture *picture);
/* Draws the metatile that contains a tile into rgba, which must have room for a picture, as camber_renderer_render_into
 * does. A metatile that nothing touches is drawn too.
 * Returns the errors of camber_tiles_engine_look, camber_mesh_tessellate_network and camber_renderer_render_into. */
CAMBER_API camber_status camber_tiles_engine_draw(camber_tiles_engine *engine, int zoom, uint32_t column, uint32_t row,
                                                  uint8_t *rgba, camber_tiles_picture *picture);
/* Sets *pixels to tile x, y of a picture, counted from its north-western tile, ready to encode. */
CAMBER_API void camber_tiles_picture_get_tile(const camber_tiles_picture *picture, uint32_t x, uint32_t y,
                                              camber_pixels *pixels);

/* ---- Drawing an archive ---- */

/* A schedule lists the tiles that a run draws. A dry run determines it and writes it to a file. With a schedule, a
 * shard need not locate lines itself, and it reads only what it draws from input files that have an index. */
typedef struct camber_tiles_schedule camber_tiles_schedule;

/* Reads a schedule. inputs are the files that will be read, in order. The call compares their sizes, and up to 64 MB of
 * each, with the schedule.
 * Returns CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_INPUT (not a schedule, or one for other files), CAMBER_ERROR_IO,
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_schedule_read(camber_context *context, const char *path,
                                                    const char *const *inputs, size_t input_count,
                                                    camber_tiles_schedule **schedule);
CAMBER_API void camber_tiles_schedule_destroy(camber_tiles_schedule *schedule);
/* Tells a set of features which shard of the run it is for: files are then read only for the tiles of that shard. Call
 * it before camber_features_read, with the desc that the engine will have; camber_tiles_schedule_load then follows it
 * too. shards 0: all tiles.
 * Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_schedule_read_for(camber_tiles_schedule *schedule, camber_features *features,
                                                        const camber_tiles_engine_desc *desc, uint32_t shard,
                                                        uint32_t shards);

/* Fills an empty set, for which camber_tiles_schedule_read_for was called, from the file that the dry run wrote beside
 * the schedule. *loaded says whether that file exists; if not, read the inputs.
 * Returns CAMBER_ERROR_INPUT (damaged, or from another run), CAMBER_ERROR_IO, CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_schedule_load(const camber_tiles_schedule *schedule, camber_features *features,
                                                    bool *loaded);

typedef struct camber_tiles_draw_desc {
    const char *output; /* in the format that its name gives */
    int min_zoom, max_zoom;
    /* only tiles that overlap bbox: west, south, east, north in degrees; west > east: across the antimeridian */
    bool has_bbox;
    double bbox[4];
    const camber_features *region; /* draw only tiles that touch its polygons. NULL: all */
    /* A list of tile_count tiles. Only these are drawn, whatever the zooms above. With renew, a tile on the list is
     * drawn only if it is within the zooms above (if min_zoom is negative: within the archive's zooms) and, without a
     * bbox or a region, within the archive's bounds. NULL: all tiles. */
    const camber_tiles_place *tiles;
    size_t tile_count;
    camber_encoding encoding;
    int quality;     /* WebP: 1 to 100, which is lossless. 0: 80 */
    bool keep_empty; /* tiles with only the background are kept */
    bool force;      /* an existing archive is replaced */
    bool resume;     /* continues where an earlier run stopped; does nothing if output is complete */
    bool renew;      /* output exists, and only the tiles of this run are replaced in it */
    bool dry_run;    /* the archive is not touched; stats say what the run would draw */
    /* draw shard `shard` of `shards`, from 1; 0: all. The caller gives each shard its own name */
    uint32_t shard, shards;
    const char *name, *description; /* NULL: the name of the output, and no description */
    const char *attribution;        /* NULL: the features' attribution; "": none */
    /* Says which tiles are drawn; the features then need only contain what camber_tiles_schedule_read_for asks for.
     * NULL for a dry run. Otherwise NULL: the engine determines the tiles. */
    const camber_tiles_schedule *schedule;
    /* A dry run writes its schedule to this path, and the features beside it, completely or not at all; it draws no
     * sample pictures, so stats have no bytes. NULL: no schedule is written. */
    const char *schedule_path;
    const char *const *inputs; /* with schedule_path: the input_count files that the features were read from */
    size_t input_count;
    /* The engine's own features, if nothing else will be drawn from them: points are freed as soon as no remaining zoom
     * draws them, and the engine cannot draw afterwards. The deepest zoom is then drawn first, so that PMTiles are
     * copied at the end. NULL: the points are kept. */
    camber_features *spent;
    /* A file that records which labels are in which tile. It is written once the archive is complete. With renew and
     * tiles, it must exist and is read first: tiles whose labels have changed since then are drawn, too, although they
     * are not listed. Not with shards or a schedule. NULL: nothing is recorded. */
    const char *label_record;
    /* Called as soon as no other process can write this output (camber_tiles_beside). NULL: not called. */
    void (*begun)(void *user);
    void *user;
} camber_tiles_draw_desc;

typedef struct camber_tiles_stats {
    uint64_t tiles;      /* tiles that this run adds to the archive; for a dry run, tiles that lines may touch */
    uint64_t background; /* tiles that were drawn, but left out because they show only the background */
    /* pictures that were drawn; once its tiles are written, a picture survives the end of the process */
    uint64_t units;
    uint64_t resumed;    /* units that an earlier run had already drawn */
    uint64_t emptied;    /* renew: tiles that the archive had and that are empty now */
    uint64_t left_out;   /* renew: tiles of the list that are outside the zooms and bounds */
    uint64_t relabelled; /* renew: tiles that were added to the list because their labels have changed */
    uint64_t points;     /* points that were drawn, counted once per zoom and metatile */
    uint64_t bytes;      /* bytes of the tiles; for a dry run, an estimate from sample pictures */
    bool done;           /* resume, renew: there was nothing left to do */
    double census_ms, make_ms, draw_ms, wait_ms, write_ms; /* of the calling thread; make_ms: for networks and passes */
    /* summed over all encoding threads: wall-clock time, and processor time */
    double encode_ms, encode_cpu_ms;
} camber_tiles_stats;

/* Draws a pyramid of tiles into an archive. The archive's bytes depend on the features, the style, the engine's desc
 * except threads, and this desc. They do not depend on memory, on resuming, or, once shards are merged, on their
 * number. stats may be NULL.
 * Returns CAMBER_ERROR_ARGUMENT, CAMBER_ERROR_NOT_FOUND (renew: there is no archive, or no record of its labels),
 * CAMBER_ERROR_INPUT (resume, renew, schedule: another input, style, options or version; renew: an input outside the
 * archive's bounds), CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT, CAMBER_ERROR_DEVICE, CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_draw(camber_tiles_engine *engine, const camber_tiles_draw_desc *desc,
                                           camber_tiles_stats *stats);

#ifdef __cplusplus
}
#endif

#endif
