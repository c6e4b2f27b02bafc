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

/* Parses a style document and compiles its background, line, fill and circle layers. Layers of other types, and
 * properties that are not drawn, are warned of, each once.
 * name stands in messages.
 * Returns CAMBER_ERROR_INPUT, CAMBER_ERROR_MEMORY. The message says the line and column where the text is no JSON, and
 * the JSON pointer of a wrong type or value. */
CAMBER_API camber_status camber_style_parse(camber_context *context, const char *json, size_t size_bytes,
                                            const char *name, camber_style **style);
/* Makes the built-in style, "city". Returns CAMBER_ERROR_MEMORY. */
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

/* Returns the effects that the style's layers name at a zoom, as bits; 0: none. So a program can prepare what it will
 * draw with before it reads its data.
 * zoom NAN: the layers of all zooms. */
CAMBER_API uint32_t camber_style_get_effects(const camber_style *style, double zoom);

/* Returns the name of the n-th style that ships with camber, counted from 0, and NULL past the last.
 *
 *     "city"          the built-in one: water, parks, woods, built-up land, buildings, and the roads of "roads" on them
 *     "roads"         roads of OpenStreetMap and of the US Census Bureau, and nothing else
 *     "openmaptiles"  roads, rails, rivers and borders in tiles of the OpenMapTiles schema
 *     "transit"       lines of public transport side by side
 *
 * "openmaptiles" reads openmaptiles.mbtiles in the working folder, and "transit" transit.geojson there. */
CAMBER_API const char *camber_style_list(size_t n);
/* Returns the document of the style of that name, which is the library's; NULL: there is none. */
CAMBER_API const char *camber_style_get_text(const char *name, camber_theme theme, size_t *size_bytes);

/* Compiles one expression or older function and evaluates it over inputs. An expression that does not compile is no
 * error.
 * json has the form of the specification's own tests. All but the expression may be missing, and "filter" stands in
 * place of "expression" where it is a filter:
 *
 *     {"expression": ..., "propertySpec": {...}, "globalState": {...},
 *      "inputs": [[{"zoom": ...}, {"properties": {...}, "id": ..., "geometry": ...}], ...]}
 *
 * name stands in messages. The sink gets one of these; an output is {"error": ...} where an input does not evaluate:
 *
 *     {"compiled": {"result": "success", "type": ..., "isFeatureConstant": ..., "isZoomConstant": ...},
 *      "outputs": [...]}
 *     {"compiled": {"result": "error", "errors": [{"key": ..., "error": ...}]}}
 *
 * Returns CAMBER_ERROR_INPUT (json is not such JSON), CAMBER_ERROR_IO (the sink refuses), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_style_evaluate(camber_context *context, const char *json, size_t size_bytes,
                                               const char *name, camber_sink sink);

/* ---- Checking a style ---- */

typedef struct camber_style_finding {
    bool error;          /* true: against the specification. false: not drawn, or not drawn as a reader may expect */
    const char *pointer; /* where, as a JSON pointer; "": the whole document; "..." for the middle of long ones */
    const char *message; /* says what is wrong, and the cure */
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
    const char *trouble; /* why it cannot be read, with the cure. NULL: none is known, but it is not opened here */
} camber_style_report_source;

typedef struct camber_style_report {
    const camber_style_finding *findings; /* in the order of the document, mostly */
    size_t finding_count, error_count;
    const camber_style_type *types; /* in the order they are met */
    size_t type_count;
    const camber_style_report_source *sources;
    size_t source_count;
} camber_style_report;

/* Checks a style document, to its end whatever is wrong with it. The report has the first error of an expression, and
 * each kind of thing that is not drawn once. A document that is no style is a finding, not an error.
 * name stands in messages. camber_style_report_destroy frees the report.
 * Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_style_check(camber_context *context, const char *json, size_t size_bytes,
                                            const char *name, camber_style_report **report);
CAMBER_API void camber_style_report_destroy(camber_style_report *report);

/* ---- Features: lines and the attributes that a style names --------------------------------------- */

typedef struct camber_source_desc {
    /* Anything that OGR opens, "/vsigzip/..." included; a .gz is opened through it. Vector tiles in MBTiles and
     * PMTiles, by their endings, are read without GDAL, unless there is a filter: those of the highest zoom. So are
     * the lines of a PBF of OpenStreetMap, whatever its name, by several threads. */
    const char *path;
    /* The layer that is read. NULL: OSM's "lines". In a vector tile set it is then the layers that the style names, or
     * the road layer where the set has none of them, or all. In other files it is every layer of which the style draws
     * something. */
    const char *layer;
    const char *where; /* OGR attribute filter; PMTiles have none. NULL: none */
    /* true: all lines stay apart. false: lines that the style cannot tell apart become one where two of them, and no
     * third, meet end to end. They do so against their direction too, unless the style names line-dasharray,
     * line-offset, line-gradient or line-pattern. */
    bool keep_apart;
    uint32_t threads; /* that read a PBF of OpenStreetMap; 0: one a core */
} camber_source_desc;

typedef struct camber_features_stats {
    size_t features;            /* read, lines kept */
    size_t polylines;           /* kept, after parts were split, tile pieces joined and lines merged */
    size_t points;              /* kept */
    size_t skipped_features;    /* points, and polygons where no layer of the style draws them */
    size_t damaged_features;    /* that came with a failure, or whose geometry does not parse */
    size_t invalid_points;      /* dropped: NaN or infinite */
    size_t clamped_points;      /* moved to latitude 85.051129 */
    size_t antimeridian_splits; /* jumps of more than 180 degrees, which go the short way: over it */
    size_t joined_pieces;       /* vector tiles: pieces of one feature joined at a tile border */
    size_t merged_polylines;    /* so many polylines fewer, for lines were merged end to end */
    /* The next are of areas, where a layer of the style fills them. */
    size_t closed_rings;   /* did not end where they begin, and were closed */
    size_t turned_rings;   /* wound the wrong way: holes as their outer ring does, or all rings of a tile's area */
    size_t empty_rings;    /* left out: fewer than three different points, or all of them on one line */
    size_t open_relations; /* multipolygons of OpenStreetMap of which ways are missing: rings that do not close are left
                              out */
    size_t crossing_rings; /* cross themselves, and are drawn as they wind. One of very many that nearly do is not
                              counted */
    size_t spiked_rings;   /* have an edge that goes back the way the one before it came */
    size_t outside_holes;  /* begin outside of their area, and are filled there. Of an area with more than 200 holes
                              some are not counted */
    /* The next are of OpenStreetMap's PBF. What is missing is left out of what names it. */
    size_t missing_nodes;     /* that lines name, and the file does not have */
    size_t missing_ways;      /* that multipolygons name, and that it does not have, or none of their nodes */
    size_t dropped_relations; /* multipolygons of which no ring is left */
    size_t input_bytes;       /* of the files that were read */
} camber_features_stats;

/* Sums over the files. */
typedef struct camber_features_times {
    double file_ms;  /* reading: GDAL from open to close, projection and attributes */
    double merge_ms; /* joining lines that meet end to end */
    double weigh_ms; /* finding how much each point matters */
} camber_features_times;

typedef struct camber_features camber_features;

/* Makes an empty set, which keeps the attributes that the style names. The style must outlive it.
 * Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_features_create(camber_context *context, const camber_style *style,
                                                camber_features **features);
/* Reads one more file into the set. Warnings are logged once a cause.
 * Returns CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_INPUT (unreadable, cut off, no line layer, no such layer),
 * CAMBER_ERROR_ARGUMENT (where does not parse, or names a field that no layer has), CAMBER_ERROR_IO (also where GDAL
 * cannot be loaded), CAMBER_ERROR_LIMIT (more than the budget's bounds), CAMBER_ERROR_MEMORY.
 * The first call of a process does what camber_gdal_load does, and registers GDAL's drivers. */
CAMBER_API camber_status camber_features_read(camber_features *features, const camber_source_desc *desc);
CAMBER_API void camber_features_destroy(camber_features *features);
/* Frees the points of the lines, most of what a set takes. Scenes that were made stay, and are drawn as before. Call it
 * once there are all that are wanted: none can be made or moved from then on, and nothing more is read. */
CAMBER_API void camber_features_release_points(camber_features *features);
CAMBER_API camber_features_stats camber_features_get_stats(const camber_features *features);
CAMBER_API camber_features_times camber_features_get_times(const camber_features *features);
/* Returns whom to name beside a picture of the data, as UTF-8; NULL: nobody is known. Several names have commas between
 * them. The text is valid until more is read.
 * For OpenStreetMap's own formats it is "(c) OpenStreetMap contributors", as their licence asks. For tiles it is what
 * their metadata or the style's source says, without its HTML. For other files nobody is known. */
CAMBER_API const char *camber_features_get_attribution(const camber_features *features);

/* Writes why nothing of the set is drawn, for a picture or for tiles without anything in it: what was read, what hides
 * it at these zooms (the style, the zoom, the view, nodes that are missing), and the cure. 512 bytes are enough.
 * Returns whether the style draws some of it at these zooms, so that the view alone hides it. */
CAMBER_API bool camber_features_explain_nothing(const camber_features *features, double min_zoom, double max_zoom,
                                                char *text, size_t size);

/* Writes the box that all lines lie in: west, south, east, north in degrees. false: there are no lines, and bounds
 * stays as it was. It looks at each point. */
CAMBER_API bool camber_features_get_bounds(const camber_features *features, double bounds[4]);

/* The same for what the style draws between two zooms; west is greater than east where that box is smaller across the
 * antimeridian. false: nothing is drawn. */
CAMBER_API bool camber_features_get_drawn_bounds(const camber_features *features, double min_zoom, double max_zoom,
                                                 double bounds[4]);

/* Gives a set that was read from files another style, from the next scene or engine on, and leaves the lines as they
 * are. The style must read the same properties as the set's, in the same order, as the themes of one style do; it has
 * no sprites. It must outlive the set.
 * Returns CAMBER_ERROR_ARGUMENT where it differs in what it reads; then the files are to be read into another set. */
CAMBER_API camber_status camber_features_restyle(camber_features *features, const camber_style *style);

/* Returns whether camber_features_read of such a file needs GDAL. */
CAMBER_API bool camber_source_needs_gdal(const camber_source_desc *desc);
/* Loads GDAL; without this call the first file that is read does so.
 * Returns CAMBER_ERROR_IO where GDAL or camber's module for it is missing.
 * It costs time once a process, and half as much again where threads of a device or a surface run already: call it
 * before these are opened. It costs nothing in the static library, where GDAL is linked. */
CAMBER_API camber_status camber_gdal_load(camber_context *context);
/* Returns the short name ("GPKG") of the n-th format, counted from 0, that camber_features_read reads without an
 * allowance (camber_access): first OGR's vector drivers, if GDAL can be loaded, then those formats that camber reads by
 * itself and OGR does not. NULL: past the last. The string is OGR's, or the library's. */
CAMBER_API const char *camber_format_list(size_t n);
/* Returns GDAL's version as it says it, "GDAL 3.6.2, ..."; NULL where GDAL cannot be loaded. */
CAMBER_API const char *camber_gdal_get_version(void);

/* ---- View ----------------------------------------------------------------------------------------- */

typedef enum camber_view_kind {
    CAMBER_VIEW_FIT = 0, /* all that the style draws, with a margin of 2 % */
    CAMBER_VIEW_BBOX,    /* bbox inside the picture */
    CAMBER_VIEW_CENTER,  /* center and zoom */
} camber_view_kind;

typedef struct camber_view_desc {
    camber_view_kind kind;
    double west, south, east, north; /* degrees; west > east: across the antimeridian */
    double longitude, latitude;      /* of the centre, degrees */
    double zoom;                     /* MapLibre's: the world is 512 CSS px wide at 0 */
    double bearing_deg;              /* clockwise: the direction that is up in the picture */
    double pitch_deg;                /* 0 to 85, as camber_frame has it. FIT and BBOX go by a pitch of 0 */
    uint32_t width, height;          /* CSS px. 0: 1024 */
    double ratio;                    /* device px a CSS px. 0: 1 */
} camber_view_desc;

/* Returns the view that the style's document asks for: centre, zoom, bearing and pitch, 85 at most. Where the document
 * says nothing, the view is of longitude and latitude 0, the whole world, north up, from above. Sizes and ratio are 0.
 */
CAMBER_API camber_view_desc camber_style_get_view(const camber_style *style);

/* ---- Sources: what a style itself names ----------------------------------------------------------- */

/* Reads the sources that the style's line, fill and circle layers name, in place of files. Sources of type vector give
 * the tiles that the view sees, and those from which circles of up to 256 CSS px reach into it: their tiles or url name
 * files by a template, TileJSON, MBTiles or PMTiles. Tiles are 512 CSS px wide, and are of the zoom that the view's
 * zoom asks for, within the source's. Sources of type geojson are read whole. A tile that is missing is empty; damage
 * is counted and warned of. Lines that the style cannot tell apart become one where they go on almost straight, unless
 * the style names what follows a line's direction. view says which tiles; for another view read into another set. A
 * view that fits is that of the sources' bounds, or the whole world where none is known. base_path is the style's file:
 * paths are relative to its folder. NULL: they are relative to the working folder. Returns CAMBER_ERROR_ARGUMENT (the
 * view), CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_INPUT (a source on the network, a file that does not read),
 * CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT (more than 65536 tiles), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_features_read_sources(camber_features *features, const camber_view_desc *view,
                                                      const char *base_path);

/* Reads the style's sprites, which have the images of its patterns. A style without patterns reads nothing. Lines and
 * backgrounds are left out, and warned of, where their image is in no sprite or in one on the network.
 * ratio is device px a CSS px; 0: 1. Above 1 it takes the sprites for high resolutions, where they are there. base_path
 * is as camber_features_read_sources has it.
 * Returns CAMBER_ERROR_NOT_FOUND (a sprite's file), CAMBER_ERROR_INPUT (one that is not what it says, an unknown
 * scheme), CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT (a sheet above 2^24 px), CAMBER_ERROR_ARGUMENT (the ratio),
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_features_read_sprites(camber_features *features, double ratio, const char *base_path);

/* ---- Scene: a view of features in a style, ready to tessellate and draw --------------------------- */

/* The views that a scene is made for. */
typedef enum camber_scene_use {
    CAMBER_SCENE_VIEWS = 0, /* a view that moves: the network stays as long as it serves the others */
    /* One view; another one takes a new network. Points are rounded to 1/4096 px of it, as tiles of its zoom have them
     * (camber_tiles.h), so that these are cuts of the picture. */
    CAMBER_SCENE_ONE_VIEW,
    CAMBER_SCENE_LINES, /* as VIEWS, of lines only: camber_scene_triangulate has the areas */
} camber_scene_use;

typedef struct camber_scene_desc {
    camber_view_desc view;
    /* A point is dropped where the line stays this close to it, device px. Nodes that lines share go or stay in all of
     * them. 0: none is dropped. */
    double simplify_px;
    camber_scene_use use;
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

/* Says which scene the files are read for, from the next on. Of these files the set then has the lines that touch the
 * scene's picture or reach it, by whatever the style may ask for, and no others. FlatGeobuf, GeoPackage and Shapefile
 * are read by their index where they have one, so that the time is that of what is seen. The set and the picture are
 * the same with and without an index. A view that fits, and scene NULL: files are read whole, as at first. For another
 * view read into another set; a scene with another view lacks lines, and says nothing.
 * Returns CAMBER_ERROR_ARGUMENT (a view out of range). */
CAMBER_API camber_status camber_features_read_for(camber_features *features, const camber_scene_desc *scene);

/* Makes a scene: evaluates the style, and makes a network of the lines that it draws. The features must outlive the
 * scene. Nothing to draw is no error. Where the style draws none of the features, a warning says the keys that it goes
 * by.
 * Returns CAMBER_ERROR_ARGUMENT (a view out of range), CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_scene_create(const camber_features *features, const camber_scene_desc *desc,
                                             camber_scene **scene);
/* Makes the last scene of its features, of ONE_VIEW whatever use says: their points go as soon as they are in the
 * network, as by camber_features_release_points, and those that it leaves out before that. Returns the same. */
CAMBER_API camber_status camber_scene_create_last(camber_features *features, const camber_scene_desc *desc,
                                                  camber_scene **scene);
CAMBER_API void camber_scene_destroy(camber_scene *scene);

/* Moves the scene to another view of the same features, and evaluates the style for its zoom. The network stays, on the
 * device too, where filters still draw the same features and the picture comes to no other copy of the world. The scene
 * is as before where the call fails.
 * Returns what camber_scene_create returns.
 * It evaluates the style once a class of features. Where another network is needed, it takes one pass over the points.
 */
CAMBER_API camber_status camber_scene_move(camber_scene *scene, const camber_view_desc *view);
/* Tessellates the lines that the view sees. Returns what camber_mesh_tessellate_network returns. */
CAMBER_API camber_status camber_scene_tessellate(const camber_scene *scene, camber_mesh *mesh, camber_method method);
/* Returns the network that camber_scene_tessellate tessellates. camera and desc take the rest that
 * camber_mesh_tessellate_network needs for it. All are valid until the scene moves or is destroyed. */
CAMBER_API camber_network *camber_scene_get_network(const camber_scene *scene, camber_camera *camera,
                                                    camber_tessellation_desc *desc);

/* Projects the lines that the view sees on the host, by the CPU twin, for the getters below: call it before them, and
 * again after camber_scene_move. Where all is there it does nothing. Drawing a network does not need it.
 * Each stretch of a line that the view cuts becomes a polyline of its own. So these lines have no dashes, gradients,
 * trims or patterns when they are drawn.
 * Returns CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_scene_project(camber_scene *scene);
/* Frees the projected lines. What camber_scene_get_info says of them stays until the scene moves. */
CAMBER_API void camber_scene_release_lines(camber_scene *scene);
/* Returns what the scene is. layers, features, polylines and points are 0 until the scene is projected. */
CAMBER_API camber_scene_info camber_scene_get_info(const camber_scene *scene);
/* These return the lines of a projected scene, in two forms. The scene owns them. */
CAMBER_API const camber_polylines *camber_scene_get_polylines(const camber_scene *scene);
CAMBER_API const camber_lines *camber_scene_get_lines(const camber_scene *scene);
/* Returns the row of each polyline of a projected scene: an index into the strokes. The scene owns them. */
CAMBER_API const uint32_t *camber_scene_get_rows(const camber_scene *scene);
/* Returns the strokes, by row, which any scene has, and in count how many there are. The scene owns them. */
CAMBER_API const camber_stroke *camber_scene_get_strokes(const camber_scene *scene, size_t *count);
/* Returns the frame whose passes draw the scene with a mesh. It is valid until the next call on this scene.
 * mesh holds the scene as camber_scene_tessellate left it, or the tessellated polylines of the projected scene. */
CAMBER_API camber_frame camber_scene_get_frame(camber_scene *scene, camber_mesh *mesh);

/* Areas of a scene that have one fill and follow each other: triangles that do not overlap. */
typedef struct camber_area_fill {
    const char *layer;               /* the id of its layer. The style owns it */
    uint32_t level;                  /* how many layers of areas lie below */
    camber_color color;              /* straight sRGB, straight alpha, opacities multiplied in */
    size_t first_point, point_count; /* its own points */
    size_t first_index, index_count;
} camber_area_fill;

typedef struct camber_area_data {
    camber_context *context; /* frees the rest; NULL: empty */
    float *points;           /* point_count pairs of px, y down */
    size_t point_count;
    uint32_t *indices; /* index_count: three points a triangle, counter-clockwise as seen */
    size_t index_count;
    camber_area_fill *fills; /* fill_count, in drawing order */
    size_t fill_count;
} camber_area_data;

/* Makes triangles of the areas that the view sees, cut a px outside of the picture. They cover what the nonzero rule
 * fills, each place once a fill. Points lie on 256ths of a px. Patterns are left out. A view with a pitch is taken
 * without it. Free them with camber_area_data_destroy, also after a failure. The features must have their points.
 * Returns CAMBER_ERROR_DEVICE (areas are there, and GLU is not, Debian's libglu1-mesa), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_scene_triangulate(const camber_scene *scene, camber_area_data *areas);
CAMBER_API void camber_area_data_destroy(camber_area_data *areas);

/* ---- GLB ------------------------------------------------------------------------------------------- */

typedef struct camber_mesh_data camber_mesh_data; /* camber_proof.h */

typedef struct camber_glb_desc {
    const camber_stroke *strokes; /* stroke_count. They go to the file's extras, with the paints */
    const camber_paint *paints;   /* NULL: none; else stroke_count */
    size_t stroke_count;
    const char *copyright;         /* asset.copyright. NULL: none */
    const camber_area_data *areas; /* they lie below the lines. NULL: none */
} camber_glb_desc;

/* Writes a mesh as a binary glTF 2.0 that any reader loads. It has triangles, or strips whose restarts are degenerate
 * triangles; x goes right, y up, z is 0, and a unit is a pixel.
 * POSITION is the true outline of the lines, at the widths of the strokes. camber's shaders draw from _CENTER,
 * _SEGMENT, _EXTRUDE, _TURN, _FLAGS and _ROW, which glb.c describes.
 * Areas are triangles of a primitive of their own, before that of the lines, with POSITION and COLOR_0; layers of areas
 * lie at z = -1, the topmost, and a px below each other.
 * Returns CAMBER_ERROR_ARGUMENT (a paint that is not finite, a copyright that is not UTF-8), CAMBER_ERROR_IO where the
 * sink refuses, CAMBER_ERROR_LIMIT (4 GB or more), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_glb_write(camber_context *context, const camber_mesh_data *mesh,
                                          const camber_glb_desc *desc, camber_sink sink);

#ifdef __cplusplus
}
#endif

#endif
