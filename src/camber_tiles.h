/* camber-tiles: tiles of a map, and archives of them: PMTiles 3, MBTiles 1.3, folders FOLDER/{z}/{x}/{y}.EXTENSION.
 *
 *     features -> engine -> picture of some tiles -> tiles, or an archive
 *
 * The format of a path is told by its ending: .pmtiles, .mbtiles, or a slash (or a folder that is there).
 *
 * The rules of camber.h (errors, ownership, descriptions, threads) hold here too.
 */
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
    uint64_t size_bytes; /* bytes that are stored; those of equal tiles count once, at the lowest zoom that has them */
} camber_tiles_zoom;

typedef struct camber_tiles_info {
    const char *format;      /* "pmtiles", "mbtiles", "folder" */
    const char *type;        /* "png", "jpg", "webp", "avif", "pbf", "mlt", "glb"; "bin" where it is not told */
    const char *compression; /* "gzip", "none" */
    int min_zoom, max_zoom;  /* as the archive says */
    uint64_t tiles;          /* that can be asked for */
    uint64_t entries;        /* of PMTiles' directories; else as many as tiles */
    uint64_t contents;       /* different ones, as they are stored */
    bool has_bounds, has_center;
    double bounds[4];        /* west, south, east, north, in degrees */
    double center[3];        /* longitude, latitude, zoom */
    const char *metadata;    /* the rest of what it says, a JSON object; a name that is not UTF-8 is left out */
    const char *fingerprint; /* NULL: not told */
    uint32_t shard, shards;  /* 0: it is no part */
    const camber_tiles_zoom *zooms;
    size_t zoom_count;
    const char *schema; /* of vector tiles, where the style city knows it, as "OpenMapTiles"; else NULL */
} camber_tiles_info;

/* Reads what an archive has. Free *info with camber_tiles_info_destroy.
 * Returns CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_INPUT (no archive, damaged), CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT,
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_show(camber_context *context, const char *path, camber_tiles_info **info);
CAMBER_API void camber_tiles_info_destroy(camber_tiles_info *info);

/* ---- Reading single tiles of an archive ---- */

typedef struct camber_tiles_place {
    int zoom;
    uint32_t column, row; /* from the north */
} camber_tiles_place;

/* An open archive, from which tiles are read as they are asked for. It serves one thread at a time. */
typedef struct camber_tiles_reader camber_tiles_reader;

/* Returns what camber_tiles_show returns. It reads no tile, so its time does not grow with the archive. */
CAMBER_API camber_status camber_tiles_reader_create(camber_context *context, const char *path,
                                                    camber_tiles_reader **reader);
CAMBER_API void camber_tiles_reader_destroy(camber_tiles_reader *reader);
/* Returns what the archive says of itself, which is the reader's. Counts and zooms are 0: they are not looked for. */
CAMBER_API const camber_tiles_info *camber_tiles_reader_get_info(const camber_tiles_reader *reader);
/* Reads a tile as it is stored, maybe compressed (camber_tiles_info). *bytes are the reader's until its next call;
 * *size_bytes is 0 where the archive has no such tile. Returns CAMBER_ERROR_ARGUMENT (no such place),
 * CAMBER_ERROR_INPUT (damaged), CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_reader_read(camber_tiles_reader *reader, const camber_tiles_place *place,
                                                  const uint8_t **bytes, size_t *size_bytes);

/* ---- Whether an archive is right ---- */

typedef struct camber_tiles_finding {
    bool error;          /* readers may fail or show something wrong; else it wastes room or is unusual */
    const char *message; /* one line, without the path */
} camber_tiles_finding;

typedef struct camber_tiles_findings {
    const camber_tiles_finding *findings;
    size_t count;
    size_t left_out; /* findings of a kind are told up to a number */
} camber_tiles_findings;

/* Checks every promise that an archive makes: its header, counts, zooms, bounds, order and sections, its tables,
 * indices and metadata, the tileset of a folder of meshes, and each tile: where it lies, and that it is what its type
 * says. A damaged archive has findings, and is no failure. Free *findings with camber_tiles_findings_destroy. Returns
 * CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_verify(camber_context *context, const char *path,
                                             camber_tiles_findings **findings);
CAMBER_API void camber_tiles_findings_destroy(camber_tiles_findings *findings);

/* ---- Merging and converting ---- */

typedef struct camber_tiles_merge_desc {
    const char *const *parts; /* part_count paths */
    size_t part_count;
    const char *output; /* in the format that its name tells */
    bool force;         /* an archive that is there is replaced */
    /* Is called once no other process writes this output: the files beside it (camber_tiles_beside) are this call's
     * from then on, and may be removed where the process has to end. NULL: not told. */
    void (*begun)(void *user);
    void *user;
} camber_tiles_merge_desc;

/* Writes one archive of the tiles of all parts; with one part, converts it. Parts that say to be part K of N must be
 * all N, of one fingerprint; the archive then has the bytes that a single run would have written. A tile that two parts
 * have is written once where its bytes are equal. The output appears whole, or stays as it was. Returns
 * CAMBER_ERROR_INPUT (parts missing, twice, of another fingerprint, type or compression; tiles that differ; damaged),
 * CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. The message names each part. */
CAMBER_API camber_status camber_tiles_merge(camber_context *context, const camber_tiles_merge_desc *desc);
/* Writes the name of the n-th file that stands beside an archive while it is written. false: past the last, or the name
 * is too long. */
CAMBER_API bool camber_tiles_beside(const char *path, size_t n, char *name, size_t size);

/* ---- Drawing tiles ---- */

typedef struct camber_tiles_engine_desc {
    camber_renderer *renderer; /* not NULL, unless tiles are meshes; it may be of another context than the features */
    camber_device *device;     /* the renderer's */
    uint32_t tile_size; /* CSS px: 256, whose zoom 1 is a MapLibre zoom 0, or 512, which has the same zooms. 0: 256 */
    double ratio;       /* device px a CSS px; a tile is rounded to whole px, 64 to 2048. 0: 1 */
    double simplify_px; /* as camber_scene_desc has it. 0: nothing is left out */
    camber_coverage coverage;
    uint32_t threads; /* that look where lines are and encode tiles, beside those of the device. 0: one a core */
    /* Single tiles are asked for, now here and now there: a picture has so many of them on a side, 1, 2, 4 or 8 at
     * most. What is kept of high zooms does not grow with them then. Such an engine draws no archive. 0: 8, for
     * archives */
    uint32_t on_demand_side;
    /* Tiles are meshes, as docs/mesh-tiles.md describes them: what the style draws at the zooms from a tile's own to
     * the next. There are no pictures, and renderer may be NULL. */
    bool meshes;
} camber_tiles_engine_desc;

/* Draws tiles of features. One picture shows up to 8 x 8 tiles, a metatile; metatiles lie side by side from the
 * north-west. Tiles of one metatile are cuts of one picture. Across metatiles lines go on within one level of 255,
 * whatever their width, offset, blur, dashes or pattern. What an engine draws depends on its desc and the features
 * alone.
 *
 * An engine, the renderer and the features serve one thread at a time. A picture is the caller's: other threads may cut
 * and encode it while the next is drawn, each with a camber_encoder of a context of its own.
 *
 * The engine looks once a zoom where lines are, when it is first asked for that zoom. It keeps 4 bytes a line of each
 * metatile; on demand, of tiles of zoom 16 where those that are drawn are smaller. */
typedef struct camber_tiles_engine camber_tiles_engine;

/* Returns a hash of all that a picture of the features is made of, but for the desc: lines, the properties that the
 * style reads, the style with its sprites, and the library's version. It looks at each point. Tiles that are kept under
 * it are never another input's. */
CAMBER_API uint64_t camber_features_get_hash(const camber_features *features);
/* The features, the renderer and the device must outlive the engine.
 * Returns CAMBER_ERROR_ARGUMENT (a size or ratio out of range), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_engine_create(const camber_features *features,
                                                    const camber_tiles_engine_desc *desc, camber_tiles_engine **engine);
CAMBER_API void camber_tiles_engine_destroy(camber_tiles_engine *engine);

/* A metatile of tiles, drawn or to be drawn. */
typedef struct camber_tiles_picture {
    int zoom;
    uint32_t column, row; /* of its first tile, the north-western one */
    uint32_t side;        /* tiles on a side: a power of two, 1 to 8 */
    uint32_t tile_px;     /* device px on a side of a tile */
    uint64_t tiles;       /* bit side * y + x: a line may touch tile x, y of the metatile; others show the background */
    bool has_background;  /* the background is this colour, not an image: */
    uint8_t background[4]; /* premultiplied RGBA */
    const uint8_t *rgba;   /* side * tile_px rows of as many premultiplied RGBA8. NULL: not drawn */
} camber_tiles_picture;

/* The bytes that the pixels of one picture take at most. */
CAMBER_API size_t camber_tiles_engine_get_picture_bytes(const camber_tiles_engine *engine);
/* Finds the metatile that has a tile, and which of its tiles lines touch, without drawing.
 * Returns CAMBER_ERROR_ARGUMENT (no such tile; zooms are 0 to 24), CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_engine_look(camber_tiles_engine *engine, int zoom, uint32_t column, uint32_t row,
                                                  camber_tiles_picture *picture);
/* Draws the metatile that has a tile into rgba, which has room for a picture, as camber_renderer_render_into does. A
 * metatile that no line touches is drawn too. Returns what camber_tiles_engine_look, camber_mesh_tessellate_network and
 * camber_renderer_render_into return. */
CAMBER_API camber_status camber_tiles_engine_draw(camber_tiles_engine *engine, int zoom, uint32_t column, uint32_t row,
                                                  uint8_t *rgba, camber_tiles_picture *picture);
/* Gives tile x, y of a picture, counted from its north-western one, as pixels to encode. */
CAMBER_API void camber_tiles_picture_get_tile(const camber_tiles_picture *picture, uint32_t x, uint32_t y,
                                              camber_pixels *pixels);

/* ---- Drawing an archive ---- */

/* The tiles that a run draws, as a dry run of it finds out and writes to a file. With it a part need not look where
 * lines are, and reads of files that have an index what it draws. */
typedef struct camber_tiles_schedule camber_tiles_schedule;

/* Reads a schedule. inputs: the files that will be read, in order. They are looked at: their sizes, and up to 64 MB of
 * each. Returns CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_INPUT (no schedule, or one of other files), CAMBER_ERROR_IO,
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_schedule_read(camber_context *context, const char *path,
                                                    const char *const *inputs, size_t input_count,
                                                    camber_tiles_schedule **schedule);
CAMBER_API void camber_tiles_schedule_destroy(camber_tiles_schedule *schedule);
/* Tells a set which part of the run it is for: files are then read for its tiles alone. Call it before
 * camber_features_read, with the desc of the engine to be; camber_tiles_schedule_load then goes by it, too. shards 0:
 * for all. Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_schedule_read_for(camber_tiles_schedule *schedule, camber_features *features,
                                                        const camber_tiles_engine_desc *desc, uint32_t shard,
                                                        uint32_t shards);

/* Fills an empty set for which camber_tiles_schedule_read_for was called, from the file that the dry run has written
 * beside the schedule. *loaded: it is there; else read the inputs. Returns CAMBER_ERROR_INPUT (damaged, or of another
 * run), CAMBER_ERROR_IO, CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_schedule_load(const camber_tiles_schedule *schedule, camber_features *features,
                                                    bool *loaded);

typedef struct camber_tiles_draw_desc {
    const char *output; /* in the format that its name tells */
    int min_zoom, max_zoom;
    bool has_bbox; /* only tiles that overlap bbox: west, south, east, north in degrees; west > east: across 180 */
    double bbox[4];
    const camber_features *region; /* only tiles that touch its polygons. NULL: all */
    /* tile_count: only these, whatever the zooms above; with renew those of these zooms, or, where min_zoom is below
     * 0, those that lie in the zooms of the archive, and without a bbox or a region in its bounds. NULL: all. */
    const camber_tiles_place *tiles;
    size_t tile_count;
    camber_encoding encoding;
    int quality;            /* WebP: 1 to 100, which is lossless. 0: 80 */
    bool keep_empty;        /* tiles with the background alone are kept */
    bool force;             /* an archive that is there is replaced */
    bool resume;            /* goes on where an earlier run stopped; does nothing where output is whole */
    bool renew;             /* output is there, and only the tiles of this run are replaced in it */
    bool dry_run;           /* nothing is drawn into the archive, which is not touched; stats tell what would be */
    uint32_t shard, shards; /* this part of so many, from 1; 0: all. The caller gives each part a name of its own */
    const char *name, *description; /* NULL: the output's name, and none */
    const char *attribution;        /* NULL: what the features say; "": none */
    /* Tells what is drawn; the features need be no more than camber_tiles_schedule_read_for asks for. A dry run: NULL.
     * Else NULL: the engine looks for it. */
    const camber_tiles_schedule *schedule;
    /* A dry run's schedule goes there, and the features beside it, whole or not at all; no picture is tried, so
     * stats have no bytes. NULL: nowhere. */
    const char *schedule_path;
    const char *const *inputs; /* with schedule_path: input_count files that the features were read of */
    size_t input_count;
    /* The engine's own features, where nothing else is drawn of them: points go as soon as no zoom is left that draws
     * them, and the engine draws nothing more. That takes the deepest zoom first, so that PMTiles are copied at the
     * end. NULL: they stay. */
    camber_features *spent;
    /* Is called once no other process writes this output (camber_tiles_beside). NULL: not told. */
    void (*begun)(void *user);
    void *user;
} camber_tiles_draw_desc;

typedef struct camber_tiles_stats {
    uint64_t tiles;      /* that the archive gets of this run; of a dry run: that lines may touch */
    uint64_t background; /* drawn, and left out since they show the background alone */
    uint64_t units;      /* pictures that were drawn; each survives the process once its tiles are written */
    uint64_t resumed;    /* units that an earlier run had drawn */
    uint64_t emptied;    /* renew: tiles that the archive had, and that have nothing now */
    uint64_t left_out;   /* renew: tiles of the list outside of the zooms and bounds */
    uint64_t points;     /* that were drawn, once a zoom and metatile */
    uint64_t bytes;      /* of the tiles; of a dry run: expected, by pictures that were drawn to try */
    bool done;           /* resume, renew: there was nothing left to do */
    double census_ms, make_ms, draw_ms, wait_ms, write_ms; /* of the calling thread; make: networks and passes */
    double encode_ms, encode_cpu_ms;                       /* of all threads that encode, and of their processors */
} camber_tiles_stats;

/* Draws a pyramid of tiles into an archive. The archive's bytes depend on the features, the style, the engine's desc
 * without its threads, and this desc; not on memory, on what was resumed, or on the number of shards, once these are
 * merged. stats may be NULL. Returns CAMBER_ERROR_ARGUMENT, CAMBER_ERROR_NOT_FOUND (renew: no archive is there),
 * CAMBER_ERROR_INPUT (resume, renew, schedule: another input, style, options or version; renew: an input outside of the
 * archive's bounds), CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT, CAMBER_ERROR_DEVICE, CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_tiles_draw(camber_tiles_engine *engine, const camber_tiles_draw_desc *desc,
                                           camber_tiles_stats *stats);

#ifdef __cplusplus
}
#endif

#endif
