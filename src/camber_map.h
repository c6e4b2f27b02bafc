/* camber-map: files, projection and style on top of libcamber.
 *
 *     style + files -> features -> map -> view -> scene (polylines, strokes, passes) -> camber.h
 *
 * The rules of camber.h (errors, ownership, descriptions, threads) hold here too.
 */
#ifndef CAMBER_MAP_H
#define CAMBER_MAP_H

#include "camber_files.h"
#include "camber_network.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Style: a MapLibre style document ------------------------------------------------------------ */

typedef enum camber_theme {
    CAMBER_THEME_LIGHT = 0,
    CAMBER_THEME_DARK,
} camber_theme;

typedef struct camber_style camber_style;

/* Parses and compiles a style document (its background and line layers). name stands in messages. Layers of
 * other types and properties that are not drawn are warned of, each once.
 * Returns CAMBER_ERROR_INPUT (not JSON: line and column are said; a wrong type or value: its JSON pointer is
 * said), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_style_parse(camber_context *context, const char *json, size_t size_bytes,
                                            const char *name, camber_style **style);
/* The built-in road style. */
CAMBER_API camber_status camber_style_create_builtin(camber_context *context, camber_theme theme, camber_style **style);
CAMBER_API void camber_style_destroy(camber_style *style);
/* Effects that lines and backgrounds are drawn with, besides a width and a colour. */
typedef enum camber_style_effect {
    CAMBER_STYLE_EFFECT_GAP = 1,
    CAMBER_STYLE_EFFECT_BLUR = 2,
    CAMBER_STYLE_EFFECT_DASH = 4,
    CAMBER_STYLE_EFFECT_TRIM = 8,
    CAMBER_STYLE_EFFECT_GRADIENT = 16,
    CAMBER_STYLE_EFFECT_PATTERN = 32,
    CAMBER_STYLE_EFFECT_BORDER = 64,
} camber_style_effect;

/* Gives the effects that the layers of a zoom name, as bits; 0: none. zoom NAN: the layers of any zoom. A program can
 * prepare what it will draw with before it reads its data. */
CAMBER_API uint32_t camber_style_get_effects(const camber_style *style, double zoom);

/* Names of the styles that ship with camber: "roads", the built-in one; "openmaptiles", roads, rails, rivers and
 * borders in tiles of the OpenMapTiles schema, of openmaptiles.mbtiles in the working folder; "transit", lines of
 * public transport side by side, of transit.geojson there. NULL past the last. */
CAMBER_API const char *camber_style_list(size_t n);
/* The style document of that name. NULL: there is none. The text is the library's. */
CAMBER_API const char *camber_style_get_text(const char *name, camber_theme theme, size_t *size_bytes);

/* Compiles one expression or older function, or a filter where "filter" stands for "expression", and evaluates it over
 * inputs. json is {"expression": ..., "propertySpec":
 * {...}, "inputs": [[{"zoom": ...}, {"properties": {...}, "id": ..., "geometry": ...}], ...], "globalState": {...}}, as
 * the specification's own tests have it; all but the expression may be missing. The sink gets {"compiled": {"result":
 * "success", "type": ..., "isFeatureConstant": ..., "isZoomConstant": ...}, "outputs": [...]} with {"error": ...} for
 * an input over which it cannot be evaluated, or {"compiled": {"result": "error", "errors": [{"key": ..., "error":
 * ...}]}}. Returns CAMBER_ERROR_INPUT (not such JSON), CAMBER_ERROR_IO (the sink refuses), CAMBER_ERROR_MEMORY; an
 * expression that does not compile is no error. */
CAMBER_API camber_status camber_style_evaluate(camber_context *context, const char *json, size_t size_bytes,
                                               const char *name, camber_sink sink);

/* ---- Checking a style ---- */

typedef struct camber_style_finding {
    bool error; /* against the specification; else something that is not drawn, or not as a reader may expect */
    const char *pointer; /* where, as a JSON pointer; "": the whole document; "..." for the middle of long ones */
    const char *message; /* what, and the cure */
} camber_style_finding;

/* The layers of one type. */
typedef struct camber_style_type {
    const char *type;
    size_t layers;
    bool drawn;
} camber_style_type;

typedef struct camber_style_report_source {
    const char *name, *type;
    size_t layers;       /* line layers that name it */
    const char *trouble; /* why it cannot be read, with the cure. NULL: nothing is seen from here; it is not opened */
} camber_style_report_source;

typedef struct camber_style_report {
    const camber_style_finding *findings; /* in the order of the document, mostly */
    size_t finding_count, error_count;
    const camber_style_type *types; /* in the order they are met */
    size_t type_count;
    const camber_style_report_source *sources;
    size_t source_count;
} camber_style_report;

/* Reads a style document to its end whatever is wrong with it. Of an expression the first error is told, and of what is
 * not drawn each kind once. Returns CAMBER_OK also for what is no style, which is a finding, and CAMBER_ERROR_MEMORY.
 */
CAMBER_API camber_status camber_style_check(camber_context *context, const char *json, size_t size_bytes,
                                            const char *name, camber_style_report **report);
CAMBER_API void camber_style_report_destroy(camber_style_report *report);

/* ---- Features: lines and the attributes that a style names --------------------------------------- */

typedef struct camber_source_desc {
    /* Anything OGR opens, "/vsigzip/..." included; a .gz is opened through it. Vector tiles in MBTiles and PMTiles, by
     * their endings, are read without GDAL, those of the highest zoom, unless there is a filter. */
    const char *path;
    const char *layer; /* NULL: OSM's "lines"; of a vector tile set the layers that the style names, where it has
                        * one of them, or else the road layer; of others every layer with lines */
    const char *where; /* OGR attribute filter; PMTiles have none. NULL: none */
    /* Leaves all lines apart. By default lines that the style cannot tell apart become one where two of them, and no
     * third, meet end to end; against their direction too, but for a style that names line-dasharray, line-offset,
     * line-gradient or line-pattern. */
    bool keep_apart;
} camber_source_desc;

typedef struct camber_features_stats {
    size_t features;         /* read, lines kept */
    size_t polylines;        /* kept, after parts were split, tile pieces joined and lines merged */
    size_t points;           /* kept */
    size_t skipped_features; /* points, and polygons where no layer of the style wants outlines */
    size_t damaged_features; /* that came with a failure, or whose geometry does not parse */
    size_t invalid_points;   /* dropped: NaN or infinite */
    size_t clamped_points;   /* moved to latitude 85.051129 */
    size_t antimeridian_splits;
    size_t joined_pieces;    /* vector tiles: pieces of one feature joined at a tile border */
    size_t merged_polylines; /* so many polylines fewer, for lines were merged end to end */
} camber_features_stats;

/* Sums over the files. */
typedef struct camber_features_times {
    double file_ms;  /* GDAL from open to close, projection and attributes */
    double merge_ms; /* lines end to end */
    double weigh_ms; /* how much each point matters */
} camber_features_times;

typedef struct camber_features camber_features;

/* An empty set that keeps the attributes that the style names. The style must outlive it. */
CAMBER_API camber_status camber_features_create(camber_context *context, const camber_style *style,
                                                camber_features **features);
/* Reads one more file into the set. Warnings are logged once a cause.
 * Returns CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_INPUT (unreadable, cut off, no line layer, no such layer),
 * CAMBER_ERROR_ARGUMENT (where does not parse, or names a field that no layer has), CAMBER_ERROR_IO (also where GDAL
 * cannot be loaded), CAMBER_ERROR_MEMORY. Cost: the first call of a process does what camber_gdal_load does, and
 * registers GDAL's drivers. */
CAMBER_API camber_status camber_features_read(camber_features *features, const camber_source_desc *desc);
CAMBER_API void camber_features_destroy(camber_features *features);
CAMBER_API camber_features_stats camber_features_get_stats(const camber_features *features);
CAMBER_API camber_features_times camber_features_get_times(const camber_features *features);
/* Whom to name beside a picture of the data, as UTF-8: "(c) OpenStreetMap contributors" of OpenStreetMap's own formats,
 * whose licence asks for it; of tiles what their metadata or the style's source says, with its HTML left out. Of other
 * files nothing is known. Several stand with commas between. NULL: none is known. Valid until more is read. */
CAMBER_API const char *camber_features_get_attribution(const camber_features *features);

/* Whether camber_features_read of such a file needs GDAL. */
CAMBER_API bool camber_source_needs_gdal(const camber_source_desc *desc);
/* Loads GDAL, which the first file that is read does else. It is half as long again once drivers have threads, so a
 * program that opens a device or a surface first may want it before. Returns CAMBER_ERROR_IO where GDAL or camber's
 * module for it is missing. Cost: once a process; nothing in the static library, where GDAL is linked. */
CAMBER_API camber_status camber_gdal_load(camber_context *context);
/* "GPKG", ... the short name of OGR's n-th vector driver that reads files without an allowance (camber_access), NULL
 * past the last or where GDAL cannot be loaded. The string is OGR's. */
CAMBER_API const char *camber_format_list(size_t n);
/* "GDAL 3.6.2, ...", NULL where GDAL cannot be loaded. */
CAMBER_API const char *camber_gdal_get_version(void);

/* ---- View ----------------------------------------------------------------------------------------- */

typedef enum camber_view_kind {
    CAMBER_VIEW_FIT = 0, /* what the style draws, with a margin of 2 % */
    CAMBER_VIEW_BBOX,    /* bbox inside the picture */
    CAMBER_VIEW_CENTER,  /* center and zoom */
} camber_view_kind;

typedef struct camber_view_desc {
    camber_view_kind kind;
    double west, south, east, north; /* degrees; west > east: across the antimeridian */
    double longitude, latitude;      /* of the centre, degrees */
    double zoom;                     /* MapLibre's: the world is 512 CSS px wide at 0 */
    double bearing_deg;              /* clockwise: the direction that is up in the picture */
    double pitch_deg;                /* 0 to 85: as camber_frame has it. FIT and BBOX are of a pitch of 0 */
    uint32_t width, height;          /* CSS px. 0: 1024 */
    double ratio;                    /* device px a CSS px. 0: 1 */
} camber_view_desc;

/* The view that the style's document asks for, centre, zoom, bearing and pitch, 85 at most: what it leaves out is
 * longitude and latitude 0, the whole world, north, from above. Sizes and ratio are 0. */
CAMBER_API camber_view_desc camber_style_get_view(const camber_style *style);

/* ---- Sources: what a style itself names ----------------------------------------------------------- */

/* Reads the sources that the style's line layers name, in place of files. Those of type vector (tiles or url: files by
 * a template, TileJSON, MBTiles, PMTiles) give the tiles that the view sees, at the zoom that its zoom asks for (tiles
 * are 512 CSS px wide) within the source's; those of type geojson are read whole. Paths are relative to the folder of
 * base_path, the style's file; NULL: to the working folder. Lines that the style cannot tell apart become one
 * where they go on almost straight, but for a style that names what follows a line's direction. For another view read
 * into another set.
 * A view that fits is that of the sources' bounds, or the whole world where none is known.
 * Returns CAMBER_ERROR_ARGUMENT (the view), CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_INPUT (a source on the network, a file
 * that does not read), CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT (more than 65536 tiles), CAMBER_ERROR_MEMORY. A tile that is
 * missing is empty; damage is counted and warned of. */
CAMBER_API camber_status camber_features_read_sources(camber_features *features, const camber_view_desc *view,
                                                      const char *base_path);

/* Reads the images that the style's patterns are of: its sprites, those for high resolutions where ratio, device px a
 * CSS px (0: 1), is above 1 and they are there. Paths are as those of sources. A style without patterns reads nothing;
 * what is drawn with images that are in none of its sprites, or in one on the network, is left out, and warned of.
 * Returns CAMBER_ERROR_NOT_FOUND (a sprite's file), CAMBER_ERROR_INPUT (one that is not what it says, an unknown
 * scheme), CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT (a sheet above 2^24 px), CAMBER_ERROR_ARGUMENT (the ratio),
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_features_read_sprites(camber_features *features, double ratio, const char *base_path);

/* ---- Scene: a view of features in a style, ready to tessellate and draw --------------------------- */

typedef struct camber_scene_desc {
    camber_view_desc view;
    /* A point is dropped where the line stays this close to it, device px; nodes that lines share go or stay in all of
     * them. 0: none */
    double simplify_px;
    /* true: camber_scene_create leaves out camber_scene_project, which camber_scene_tessellate does not need. */
    bool on_device;
} camber_scene_desc;

typedef struct camber_scene_info {
    double longitude, latitude, zoom; /* of the view's centre */
    double bearing_deg, pitch_deg;
    uint32_t width, height;   /* device px */
    bool opaque;              /* the background covers the picture */
    size_t undrawn;           /* features, wherever they lie, of which the style draws nothing at this zoom */
    size_t layers;            /* of the style that draw something here */
    size_t features;          /* of the polylines of which something lies in the view, once for layers that
                               * share lines; a merged polyline counts for all features that are in it */
    size_t polylines, points; /* to tessellate */
    size_t points_in;         /* of these features' polylines, before simplification and clipping */
} camber_scene_info;

typedef struct camber_scene camber_scene;

/* Evaluates the style and makes a network of what it draws. The features must outlive the scene. That the style draws
 * none of them is warned of, with the keys that it goes by.
 * Returns CAMBER_ERROR_ARGUMENT (a view out of range), CAMBER_ERROR_MEMORY. Nothing to draw is no error. */
CAMBER_API camber_status camber_scene_create(const camber_features *features, const camber_scene_desc *desc,
                                             camber_scene **scene);
CAMBER_API void camber_scene_destroy(camber_scene *scene);

/* Another view of the same features. Evaluates the style for its zoom; the network stays, on the device too, where
 * filters still draw the same features, and the picture does not come to another copy of the world. The scene is as
 * before where this fails. Cost: an evaluation a class of
 * features; where another network is needed, one pass over the points. */
CAMBER_API camber_status camber_scene_move(camber_scene *scene, const camber_view_desc *view);
/* camber_mesh_tessellate_network of what the view sees. */
CAMBER_API camber_status camber_scene_tessellate(const camber_scene *scene, camber_mesh *mesh, camber_method method);
/* Returns the network that camber_scene_tessellate tessellates, and in camera and desc how; until the scene moves or is
 * destroyed. */
CAMBER_API camber_network *camber_scene_get_network(const camber_scene *scene, camber_camera *camera,
                                                    camber_tessellation_desc *desc);

/* Makes what the view sees on the host, by the CPU twin: what the getters below give. Each stretch of a line that the
 * view cuts becomes a polyline of its own, so lines have no dashes, gradients or trims when these are drawn. After
 * camber_scene_move, and of a scene on the device, call it first; where all is there it does nothing.
 * Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
CAMBER_API camber_status camber_scene_project(camber_scene *scene);
/* layers, features, polylines and points are 0 until the scene is projected. */
CAMBER_API camber_scene_info camber_scene_get_info(const camber_scene *scene);
/* A projected scene owns all that these return. */
CAMBER_API const camber_polylines *camber_scene_get_polylines(const camber_scene *scene);
CAMBER_API const camber_lines *camber_scene_get_lines(const camber_scene *scene);
/* The row of each polyline: an index into the strokes. */
CAMBER_API const uint32_t *camber_scene_get_rows(const camber_scene *scene);
/* Any scene has strokes. */
CAMBER_API const camber_stroke *camber_scene_get_strokes(const camber_scene *scene, size_t *count);
/* The frame with all passes drawing mesh, which holds the scene as camber_scene_tessellate left it, or else its
 * polylines tessellated. Valid until the next call on this scene. */
CAMBER_API camber_frame camber_scene_get_frame(camber_scene *scene, camber_mesh *mesh);

/* ---- GLB ------------------------------------------------------------------------------------------- */

typedef struct camber_mesh_data camber_mesh_data; /* camber_proof.h */

typedef struct camber_glb_desc {
    const camber_stroke *strokes; /* go to extras, with the paints */
    const camber_paint *paints;   /* NULL: none; else stroke_count */
    size_t stroke_count;
    const char *copyright; /* asset.copyright. NULL: none */
} camber_glb_desc;

/* Writes a binary glTF 2.0 that any reader loads: triangles, or strips whose restarts are degenerate
 * triangles; x right, y up, z 0, one unit a pixel. POSITION is the stroke's true outline at the strokes'
 * widths; _CENTER, _SEGMENT, _EXTRUDE, _TURN, _FLAGS and _ROW are what camber's shaders draw from (docs in glb.c).
 * Returns CAMBER_ERROR_ARGUMENT (a paint that is not finite, a copyright that is not UTF-8), CAMBER_ERROR_IO when the
 * sink refuses, CAMBER_ERROR_LIMIT (4 GB or more), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_glb_write(camber_context *context, const camber_mesh_data *mesh,
                                          const camber_glb_desc *desc, camber_sink sink);

#ifdef __cplusplus
}
#endif

#endif
