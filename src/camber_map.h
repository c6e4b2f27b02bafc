/* libcamber-map: files, projection and styles, on top of libcamber.
 *
 *     style + files -> features -> map -> view -> scene (polylines, strokes, passes) -> camber.h
 *
 * The rules of camber.h (errors, ownership, descriptions, threads) apply here too. */
#ifndef CAMBER_MAP_H
#define CAMBER_MAP_H

#include "camber_files.h"
#include "camber_network.h"
#include "camber_text.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Style: a MapLibre style document ------------------------------------------------------------ */

typedef enum camber_theme {
    CAMBER_THEME_LIGHT = 0,
    CAMBER_THEME_DARK,
} camber_theme;

typedef struct camber_style camber_style;

/* Parses a style document and compiles its background, line, fill, circle and symbol layers. It warns once of each
 * layer type and each property that camber does not draw.
 * name is used in messages.
 * Returns CAMBER_ERROR_INPUT, CAMBER_ERROR_MEMORY. The message gives the line and column if the text is not JSON, or
 * the JSON pointer of a wrong type or value. */
CAMBER_API camber_status camber_style_parse(camber_context *context, const char *json, size_t size_bytes,
                                            const char *name, camber_style **style);
/* Rewrites a style document so that symbol layers read a feature's name in a language first: the properties name:de and
 * name_de, and then what they read before. language: its code, such as "de". name is used in messages. The context
 * allocates *translated; camber_style_parse takes it, and camber_style_free_text frees it.
 * Returns CAMBER_ERROR_ARGUMENT (the language), CAMBER_ERROR_INPUT (not JSON), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_style_translate(camber_context *context, const char *json, size_t size_bytes,
                                                const char *name, const char *language, char **translated);
CAMBER_API void camber_style_free_text(camber_context *context, char *text);
/* Makes the built-in style, "city". Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_style_create_builtin(camber_context *context, camber_theme theme, camber_style **style);
CAMBER_API void camber_style_destroy(camber_style *style);
/* Effects that lines and backgrounds may have besides a width and a colour. */
typedef enum camber_style_effect {
    CAMBER_STYLE_EFFECT_GAP = 1,
    CAMBER_STYLE_EFFECT_BLUR = 2,
    CAMBER_STYLE_EFFECT_DASH = 4,
    CAMBER_STYLE_EFFECT_TRIM = 8,
    CAMBER_STYLE_EFFECT_GRADIENT = 16,
    CAMBER_STYLE_EFFECT_PATTERN = 32,
    CAMBER_STYLE_EFFECT_BORDER = 64,
} camber_style_effect;

/* Returns the effects that the style's layers use at a zoom, as bits; 0: none. With this a program can prepare for
 * drawing before it reads its data.
 * zoom NAN: the layers of all zooms. */
CAMBER_API uint32_t camber_style_get_effects(const camber_style *style, double zoom);

/* Returns the name of the n-th style that ships with camber, counted from 0, or NULL past the last.
 *
 *     "city"          the built-in one: water, parks, woods, built-up land, buildings, and the roads of "roads" on them
 *     "roads"         roads of OpenStreetMap and of the US Census Bureau, and nothing else
 *     "openmaptiles"  what "city" draws of tiles of the OpenMapTiles schema
 *     "transit"       lines of public transport side by side, and stations
 *
 * "openmaptiles" reads openmaptiles.mbtiles in the working folder, and "transit" transit.geojson there. */
CAMBER_API const char *camber_style_list(size_t n);
/* Returns the document of the style with that name, which the library owns; NULL: there is none.
 * "city-osm", which is not listed, is "city" without the layers for vector tiles. It draws the same of OpenStreetMap's
 * extracts (camber_source_is_osm), and parsing it takes a third of the time and of the memory. */
CAMBER_API const char *camber_style_get_text(const char *name, camber_theme theme, size_t *size_bytes);

/* Compiles one expression, or a function of the older kind, and evaluates it for each input. An expression that does
 * not compile is not an error of the call.
 * json has the form of the specification's own tests. Only the expression is required; a filter is given as "filter"
 * instead of "expression":
 *
 *     {"expression": ..., "propertySpec": {...}, "globalState": {...},
 *      "inputs": [[{"zoom": ...}, {"properties": {...}, "id": ..., "geometry": ...}], ...]}
 *
 * name is used in messages. The sink receives one of these; the output for an input that cannot be evaluated is
 * {"error": ...}:
 *
 *     {"compiled": {"result": "success", "type": ..., "isFeatureConstant": ..., "isZoomConstant": ...},
 *      "outputs": [...]}
 *     {"compiled": {"result": "error", "errors": [{"key": ..., "error": ...}]}}
 *
 * Returns CAMBER_ERROR_INPUT (json does not have this form), CAMBER_ERROR_IO (the sink returned false),
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_style_evaluate(camber_context *context, const char *json, size_t size_bytes,
                                               const char *name, camber_sink sink);

/* ---- Checking a style ---- */

typedef struct camber_style_finding {
    bool error;          /* true: breaks the specification. false: not drawn, or not drawn as a reader may expect */
    const char *pointer; /* where, as a JSON pointer; "": the whole document. Long pointers have "..." in the middle */
    const char *message; /* says what is wrong and how to fix it */
} camber_style_finding;

/* The layers of one type. */
typedef struct camber_style_type {
    const char *type;
    size_t layers;
    bool drawn;
} camber_style_type;

typedef struct camber_style_report_source {
    const char *name, *type;
    size_t layers; /* layers that are drawn and name it */
    /* why it cannot be read, and the cure. NULL: no reason is known, but the check does not open it */
    const char *trouble;
} camber_style_report_source;

typedef struct camber_style_report {
    const camber_style_finding *findings; /* mostly in document order */
    size_t finding_count, error_count;
    const camber_style_type *types; /* in the order in which they occur */
    size_t type_count;
    const camber_style_report_source *sources;
    size_t source_count;
} camber_style_report;

/* Checks a whole style document, whatever is wrong with it. The report has the first error of each expression, and
 * lists each kind of thing that is not drawn once. A document that is not a style is a finding, not an error.
 * name is used in messages. Free the report with camber_style_report_destroy.
 * Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_style_check(camber_context *context, const char *json, size_t size_bytes,
                                            const char *name, camber_style_report **report);
CAMBER_API void camber_style_report_destroy(camber_style_report *report);

/* ---- Features: lines and the attributes that a style names --------------------------------------- */

typedef struct camber_source_desc {
    /* Anything that OGR opens, including "/vsigzip/..."; a .gz file is opened through it. camber reads some formats
     * without GDAL: vector tiles in MBTiles and PMTiles, known by their endings, at the highest zoom and only if there
     * is no filter; the lines of an OpenStreetMap PBF, whatever its name, with several threads; and, if GDAL cannot be
     * loaded, GeoJSON without a filter. */
    const char *path;
    /* The layer to read. NULL: OSM's "lines"; in a vector tile set the layers that the style names, or, if the set has
     * none of them, its road layer, or else all; in other files every layer from which the style draws something. */
    const char *layer;
    const char *where; /* an OGR attribute filter, not for PMTiles. NULL: none */
    /* true: no lines are merged. false: lines that the style cannot tell apart are merged at points where exactly two
     * of them meet end to end. Lines of opposite direction are merged too, unless the style uses line-dasharray,
     * line-offset, line-gradient or line-pattern. */
    bool keep_apart;
    uint32_t threads; /* that read an OpenStreetMap PBF, and weigh the points of any file; 0: one per core */
} camber_source_desc;

typedef struct camber_features_stats {
    size_t features;         /* read, lines kept */
    size_t polylines;        /* kept, after multi-part geometries were split, tile pieces joined and lines merged */
    size_t points;           /* kept */
    size_t skipped_features; /* points, and polygons that no layer of the style draws */
    size_t damaged_features; /* the read failed, or the geometry cannot be parsed */
    size_t invalid_points;   /* dropped: NaN or infinite */
    size_t clamped_points;   /* moved to latitude 85.051129 */
    /* jumps of more than 180 degrees, which are taken the short way, across the antimeridian */
    size_t antimeridian_splits;
    size_t joined_pieces;    /* vector tiles: pieces of one feature joined at a tile border */
    size_t merged_polylines; /* by how many polylines merging lines end to end reduced the count */
    /* The next counts are about areas that a layer of the style fills. */
    size_t closed_rings; /* did not end where they begin, and were closed */
    /* wound the wrong way: holes in the same direction as their outer ring, or all rings of a tile's area */
    size_t turned_rings;
    size_t empty_rings; /* left out: fewer than three different points, or all of them on one line */
    /* OpenStreetMap multipolygons with missing ways: their rings that do not close are left out */
    size_t open_relations;
    /* cross themselves, and are drawn by their winding. In a ring with very many near-crossings the search may stop
     * before it finds one */
    size_t crossing_rings;
    size_t spiked_rings; /* have an edge that goes back along the previous edge */
    /* begin outside their area, and are filled there. If an area has more than 200 holes, some may not be counted */
    size_t outside_holes;
    /* The next counts are about OpenStreetMap PBF files. A missing node or way is left out of the features that refer
     * to it. */
    size_t missing_nodes;     /* lines refer to them, but the file does not have them */
    size_t missing_ways;      /* multipolygons refer to them, but the file does not have them, or none of their nodes */
    size_t dropped_relations; /* multipolygons with no ring left */
    size_t input_bytes;       /* of the files that were read */
} camber_features_stats;

/* Times, summed over all files. */
typedef struct camber_features_times {
    double file_ms;  /* reading: GDAL from open to close, projection and attributes */
    double merge_ms; /* joining lines that meet end to end */
    double weigh_ms; /* computing the importance of each point */
} camber_features_times;

typedef struct camber_features camber_features;

/* Makes an empty set of features, which keeps the attributes that the style uses. The style must outlive it.
 * Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_features_create(camber_context *context, const camber_style *style,
                                                camber_features **features);
/* Reads one more file into the set. Warnings are logged once per cause.
 * Returns CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_INPUT (unreadable, truncated, no line layer, no such layer),
 * CAMBER_ERROR_ARGUMENT (the filter `where` cannot be parsed, or names a field that no layer has), CAMBER_ERROR_IO
 * (also if GDAL cannot be loaded), CAMBER_ERROR_LIMIT (more than the budget allows), CAMBER_ERROR_MEMORY.
 * The first call of a process does what camber_gdal_load does, and registers GDAL's drivers. */
CAMBER_API camber_status camber_features_read(camber_features *features, const camber_source_desc *desc);
CAMBER_API void camber_features_destroy(camber_features *features);
CAMBER_API camber_features_stats camber_features_get_stats(const camber_features *features);
CAMBER_API camber_features_times camber_features_get_times(const camber_features *features);
/* Returns the credit to show next to a picture of the data, as UTF-8, with commas between several names; NULL: none is
 * known. The text is valid until more is read.
 * For OpenStreetMap's own formats it is "(c) OpenStreetMap contributors", as their licence requires. For tiles it is
 * the attribution in their metadata or in the style's source, without its HTML. For other files none is known. */
CAMBER_API const char *camber_features_get_attribution(const camber_features *features);

/* Explains why an empty picture or empty tiles show nothing of the set. Writes into text what was read, what hides it
 * at these zooms (the style, the zoom, the view, missing nodes), and the cure. 512 bytes are enough.
 * Returns whether the style draws some of the set at these zooms, so that only the view hides it. */
CAMBER_API bool camber_features_explain_nothing(const camber_features *features, double min_zoom, double max_zoom,
                                                char *text, size_t size);

/* Writes the bounding box of all lines: west, south, east, north in degrees. false: there are no lines, and bounds is
 * unchanged. It visits every point. */
CAMBER_API bool camber_features_get_bounds(const camber_features *features, double bounds[4]);

/* Writes the bounding box of everything that the style draws between two zooms. west is greater than east if the box
 * that crosses the antimeridian is the smaller one. false: nothing is drawn. */
CAMBER_API bool camber_features_get_drawn_bounds(const camber_features *features, double min_zoom, double max_zoom,
                                                 double bounds[4]);

/* Gives another style to a set that was read from files; scenes and engines that are made from then on use it. The
 * lines do not change. The new style must read the same properties as the old one, in the same order, as the themes of
 * one style do, and the same sprites. It must outlive the set.
 * Returns CAMBER_ERROR_ARGUMENT (the style reads other properties; read the files into another set). */
CAMBER_API camber_status camber_features_restyle(camber_features *features, const camber_style *style);

/* Returns whether camber_features_read needs GDAL for the file of this source. */
CAMBER_API bool camber_source_needs_gdal(const camber_source_desc *desc);
/* Returns whether camber_features_read reads the file of this source as an OpenStreetMap PBF. */
CAMBER_API bool camber_source_is_osm(const camber_source_desc *desc);
/* Loads GDAL; without this call, reading the first file loads it.
 * Returns CAMBER_ERROR_IO (GDAL or camber's module for it is missing).
 * Cost: loading takes time once per process, and half as much again if threads of a device or a surface are already
 * running, so call it before they are opened. It costs nothing with the static library, which GDAL is linked into. */
CAMBER_API camber_status camber_gdal_load(camber_context *context);
/* Returns the short name ("GPKG") of the n-th format, counted from 0, that camber_features_read reads without special
 * permission (camber_access): first OGR's vector drivers, if GDAL can be loaded, then the formats that camber reads
 * itself and OGR does not. NULL: past the last. OGR or the library owns the string. */
CAMBER_API const char *camber_format_list(size_t n);
/* Returns GDAL's version string, such as "GDAL 3.6.2, ..."; NULL if GDAL cannot be loaded. */
CAMBER_API const char *camber_gdal_get_version(void);

/* ---- View ----------------------------------------------------------------------------------------- */

typedef enum camber_view_kind {
    CAMBER_VIEW_FIT = 0, /* everything that the style draws, with a margin of 2 % */
    CAMBER_VIEW_BBOX,    /* bbox inside the picture */
    CAMBER_VIEW_CENTER,  /* center and zoom */
} camber_view_kind;

typedef struct camber_view_desc {
    camber_view_kind kind;
    double west, south, east, north; /* degrees; west > east: across the antimeridian */
    double longitude, latitude;      /* of the centre, degrees */
    double zoom;                     /* MapLibre's: the world is 512 CSS px wide at 0 */
    double bearing_deg;              /* clockwise: the direction that is up in the picture */
    double pitch_deg;                /* 0 to 85, as in camber_frame. FIT and BBOX choose the view as for a pitch of 0 */
    uint32_t width, height;          /* CSS px. 0: 1024 */
    double ratio;                    /* device px per CSS px. 0: 1 */
    bool cover;                      /* FIT and BBOX fill the picture, and cut off what does not fit on it */
    bool whole_labels;               /* no label that the picture's edge would cut is placed, as on paper */
} camber_view_desc;

/* Returns the view that the style's document asks for: centre, zoom, bearing and pitch, at most 85. Values that the
 * document does not give describe a view of the whole world: longitude, latitude and zoom are 0, north is up, and the
 * camera looks straight down. Sizes and ratio are 0. */
CAMBER_API camber_view_desc camber_style_get_view(const camber_style *style);

/* ---- Sources: what a style itself names ----------------------------------------------------------- */

/* Reads the sources that the style's line, fill and circle layers name, and, after camber_features_read_fonts, the
 * sources of its symbol layers, instead of files that the caller names. From a source of type vector it reads the tiles
 * that the view sees, and tiles from which circles of up to 256 CSS px reach into the view: the source's tiles or url
 * is a template of file names, TileJSON, MBTiles or PMTiles. The tiles are 512 CSS px wide and have the view's zoom,
 * clamped to the source's zooms. Sources of type geojson are read whole. A missing tile counts as empty; damage is
 * counted, and a warning is logged. Lines that the style cannot tell apart are merged if one continues the other almost
 * straight, unless the style uses a property that depends on a line's direction. view selects the tiles; for another
 * view, read into another set. A view of kind CAMBER_VIEW_FIT shows the sources' bounds, or the whole world if none are
 * known. base_path is the style's file: paths are relative to its folder. NULL: they are relative to the working
 * folder. Returns CAMBER_ERROR_ARGUMENT (the view), CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_INPUT (a source on the
 * network, a file that cannot be read), CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT (more than 65536 tiles),
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_features_read_sources(camber_features *features, const camber_view_desc *view,
                                                      const char *base_path);

/* Reads the style's sprites, which have the images of its patterns and icons. For a style that names no images it reads
 * nothing. Everything whose image is in no sprite, or in a sprite on the network, is left out, and a warning is logged.
 * ratio is device px per CSS px; 0: 1. Above 1 the call takes the high-resolution sprites, if they exist. base_path is
 * as in camber_features_read_sources.
 * Returns CAMBER_ERROR_NOT_FOUND (a sprite's file), CAMBER_ERROR_INPUT (a file that is not what it claims to be, an
 * unknown scheme), CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT (a sheet above 2^24 px), CAMBER_ERROR_ARGUMENT (the ratio),
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_features_read_sprites(camber_features *features, double ratio, const char *base_path);

/* Reads the fonts that labels are drawn with; without this call symbol layers are left out. Call it before files are
 * read, because features that are only labelled are read only if there are fonts. Glyphs that the style names (as
 * files: nothing is downloaded) are used before fonts. Scenes of the set, except those made with CAMBER_SCENE_LINES,
 * then have the labels of their view, which camber_scene_tessellate prepares for drawing, and tiles that are pictures
 * have the labels of their zoom. desc may be NULL. base_path is as in camber_features_read_sources.
 * Returns CAMBER_ERROR_NOT_FOUND (a folder), CAMBER_ERROR_INPUT (glyphs without {range}, or not in the root; an unknown
 * scheme), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_features_read_fonts(camber_features *features, const camber_fonts_desc *desc,
                                                    const char *base_path);

/* ---- Scene: a view of features in a style, ready to tessellate and draw --------------------------- */

/* The views that a scene is made for. */
typedef enum camber_scene_use {
    CAMBER_SCENE_VIEWS = 0, /* a view that moves: the network is kept as long as it can be used for the next view */
    /* One view; another view needs a new network. Points are rounded to 1/4096 px of the view, as in tiles of its zoom
     * (camber_tiles.h), so that such tiles are exact parts of the picture. */
    CAMBER_SCENE_ONE_VIEW,
    CAMBER_SCENE_LINES, /* like VIEWS, but with lines only; camber_scene_triangulate makes the areas */
} camber_scene_use;

typedef struct camber_scene_desc {
    camber_view_desc view;
    /* A point is dropped if the simplified line is no farther from it than this, in device px. Nodes that several lines
     * share are dropped from all of them or from none. 0: no points are dropped. */
    double simplify_px;
    camber_scene_use use;
} camber_scene_desc;

typedef struct camber_scene_info {
    double longitude, latitude, zoom; /* of the view's centre */
    double bearing_deg, pitch_deg;
    uint32_t width, height; /* device px */
    bool opaque;            /* the background covers the picture */
    size_t undrawn;         /* features anywhere of which the style draws nothing at this zoom */
    size_t layers;          /* layers of the style that draw something in the view */
    /* features whose polylines are at least partly in the view, counted once for layers that share lines; a merged
     * polyline counts for all of its features */
    size_t features;
    size_t polylines, points; /* to tessellate */
    size_t points_in;         /* points of these features' polylines, before simplification and clipping */
    size_t labels;            /* labels that are shown */
} camber_scene_info;

typedef struct camber_scene camber_scene;

/* Says which scene the files are read for, starting with the next file. From these files the set then takes only the
 * lines that touch the scene's picture, or that reach it with any width or offset that the style may ask for.
 * FlatGeobuf, GeoPackage and Shapefile are read by their spatial index if they have one, so that the time depends on
 * what is seen. The set and the picture are the same with and without an index. With scene NULL, or a view of kind
 * CAMBER_VIEW_FIT, files are read whole, which is the default. For another view, read into another set: a scene with
 * another view lacks lines, and no warning says so.
 * Returns CAMBER_ERROR_ARGUMENT (a view out of range). */
CAMBER_API camber_status camber_features_read_for(camber_features *features, const camber_scene_desc *scene);

/* Makes a scene: evaluates the style, and makes a network from the lines that it draws. The features must outlive the
 * scene. It is not an error if there is nothing to draw. If the style draws none of the features, a warning names the
 * keys that it selects features by.
 * Returns CAMBER_ERROR_ARGUMENT (a view out of range), CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_scene_create(const camber_features *features, const camber_scene_desc *desc,
                                             camber_scene **scene);
/* Makes the last scene of its features, with CAMBER_SCENE_ONE_VIEW, whatever desc->use says. Points that the network
 * leaves out are freed before it is made, and the others as soon as it has them. Afterwards, no other scene can be made
 * from the features. Returns the errors of camber_scene_create. */
CAMBER_API camber_status camber_scene_create_last(camber_features *features, const camber_scene_desc *desc,
                                                  camber_scene **scene);
CAMBER_API void camber_scene_destroy(camber_scene *scene);

/* Moves the scene to another view of the same features, and evaluates the style for its zoom. The network is kept, also
 * on the device, if the filters still select the same features and the picture shows no other copy of the world. If the
 * call fails, the scene is unchanged.
 * Returns the errors of camber_scene_create.
 * Cost: the style is evaluated once per class of features. If another network is needed, there is also one pass over
 * the points. */
CAMBER_API camber_status camber_scene_move(camber_scene *scene, const camber_view_desc *view);
/* Tessellates the lines that the view sees. Returns the errors of camber_mesh_tessellate_network. */
CAMBER_API camber_status camber_scene_tessellate(const camber_scene *scene, camber_mesh *mesh, camber_method method);
/* Returns the network that camber_scene_tessellate tessellates. *camera and *desc receive the other arguments that
 * camber_mesh_tessellate_network needs. All are valid until the scene moves or is destroyed. */
CAMBER_API camber_network *camber_scene_get_network(const camber_scene *scene, camber_camera *camera,
                                                    camber_tessellation_desc *desc);

/* Projects the lines that the view sees on the host, with the CPU twin, for the getters below. Call it before them, and
 * again after camber_scene_move. If the lines are already there, it does nothing. Drawing a network does not need it.
 * Each visible stretch of a line becomes a polyline of its own. These lines are therefore drawn without dashes,
 * gradients, trims and patterns.
 * Returns CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_scene_project(camber_scene *scene);
/* Frees the projected lines. camber_scene_get_info keeps their counts until the scene moves. */
CAMBER_API void camber_scene_release_lines(camber_scene *scene);
/* Returns a description of the scene. layers, features, polylines and points are 0 until the scene is projected. */
CAMBER_API camber_scene_info camber_scene_get_info(const camber_scene *scene);
/* These return the lines of a projected scene, in two forms. The scene owns them. */
CAMBER_API const camber_polylines *camber_scene_get_polylines(const camber_scene *scene);
CAMBER_API const camber_lines *camber_scene_get_lines(const camber_scene *scene);
/* Returns the row of each polyline of a projected scene: an index into the strokes. The scene owns them. */
CAMBER_API const uint32_t *camber_scene_get_rows(const camber_scene *scene);
/* Returns the strokes, indexed by row, and stores their number in *count. Every scene has them, and owns them. */
CAMBER_API const camber_stroke *camber_scene_get_strokes(const camber_scene *scene, size_t *count);
/* Returns the frame whose passes draw the scene with a mesh. It is valid until the next call on this scene.
 * mesh must hold the scene from camber_scene_tessellate, or the tessellated polylines of the projected scene. */
CAMBER_API camber_frame camber_scene_get_frame(camber_scene *scene, camber_mesh *mesh);

/* Consecutive areas of a scene with the same fill, as triangles that do not overlap. */
typedef struct camber_area_fill {
    const char *layer;               /* id of its layer, owned by the style */
    uint32_t level;                  /* number of layers of areas below it */
    camber_color color;              /* straight sRGB, straight alpha, opacities multiplied in */
    size_t first_point, point_count; /* its own points */
    size_t first_index, index_count;
} camber_area_fill;

typedef struct camber_area_data {
    camber_context *context; /* it allocated the arrays. NULL: there are none */
    float *points;           /* point_count pairs of x, y in px, y down */
    size_t point_count;
    uint32_t *indices; /* index_count of them: three points per triangle, counter-clockwise as seen */
    size_t index_count;
    camber_area_fill *fills; /* fill_count of them, in drawing order */
    size_t fill_count;
} camber_area_data;

/* Makes triangles from the areas that the view sees, clipped one px outside the picture. They cover exactly what the
 * nonzero rule fills, without overlap within a fill. Points are on multiples of 1/256 px. Patterns are left out, and
 * the view's pitch is ignored. Free areas with camber_area_data_destroy, also after a failure. The points of the
 * features must not have been released.
 * Returns CAMBER_ERROR_DEVICE (there are areas, but GLU is missing; Debian: libglu1-mesa), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_scene_triangulate(const camber_scene *scene, camber_area_data *areas);
CAMBER_API void camber_area_data_destroy(camber_area_data *areas);

/* ---- GLB ------------------------------------------------------------------------------------------- */

typedef struct camber_mesh_data camber_mesh_data; /* camber_proof.h */

typedef struct camber_glb_desc {
    const camber_stroke *strokes; /* stroke_count of them, written to the file's extras, with the paints */
    const camber_paint *paints;   /* stroke_count of them. NULL: none */
    size_t stroke_count;
    const char *copyright;         /* asset.copyright. NULL: none */
    const camber_area_data *areas; /* drawn below the lines. NULL: none */
} camber_glb_desc;

/* Writes a mesh as a binary glTF 2.0 file that any reader loads. It has triangles, or strips in which degenerate
 * triangles mark the restarts; x points right, y up, z is 0, and a unit is a pixel.
 * POSITION is the true outline of the lines at the widths of the strokes. camber's shaders draw from _CENTER, _SEGMENT,
 * _EXTRUDE, _TURN, _FLAGS and _ROW, which glb.c describes.
 * Areas are triangles in a separate primitive, before the primitive of the lines, with POSITION and COLOR_0. The
 * topmost layer of areas is at z = -1, and each further layer is 1 px lower.
 * Returns CAMBER_ERROR_ARGUMENT (a paint that is not finite, a copyright that is not UTF-8), CAMBER_ERROR_IO (the sink
 * returned false), CAMBER_ERROR_LIMIT (4 GB or more), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_glb_write(camber_context *context, const camber_mesh_data *mesh,
                                          const camber_glb_desc *desc, camber_sink sink);

#ifdef __cplusplus
}
#endif

#endif
