/* camber: polylines to anti-aliased pictures. OpenCL kernels tessellate; GLES shaders draw, or kernels
 * as well.
 *
 *     polylines -> tessellation -> mesh -> renderer -> rows of RGBA8
 *
 * This header is the manual of libcamber. libcamber-map (camber_map.h) stands on it.
 *
 * Errors. What can fail returns a camber_status. Results go to the last parameter, which is left
 * untouched on failure. The message of a failure (what, where, and the cure, in one line) goes to the
 * log callback of the context. Misuse (a NULL object, a count that contradicts a pointer) asserts.
 *
 * Ownership. X_create makes an object, X_destroy frees it and accepts NULL. Inputs are read during the
 * call only, unless a comment says that the object keeps a pointer. An object must outlive those made
 * from it: context > device, surface > renderer > mesh.
 *
 * Descriptions. Every desc and params struct is valid when zeroed; each field says what zero means.
 *
 * Threads. A context and all that was made from it may be used by one thread at a time; different
 * contexts are independent, and threads may make and use them, and all that is made from them, at once.
 * There is no global state but that of drivers and GDAL, whose first set-up camber guards by a lock. A
 * host that calls them itself does not do so while camber's first call runs. Drivers read and set environment
 * variables when devices are first looked for: until then no other thread may read or change the environment.
 * A surface's GL context is made current on the calling thread by each call that needs it, and stays so
 * until camber_surface_release.
 *
 * Units. Pixels are device pixels, x to the right, y down; pixel centres lie at .5.
 */
#ifndef CAMBER_H
#define CAMBER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define CAMBER_VERSION_MAJOR 0
#define CAMBER_VERSION_MINOR 1
#define CAMBER_VERSION_PATCH 0

#if !defined(CAMBER_API) && defined(__GNUC__)
#define CAMBER_API __attribute__((visibility("default")))
#elif !defined(CAMBER_API)
#define CAMBER_API
#endif

/* ---- Status ------------------------------------------------------------------------------------ */

typedef enum camber_status {
    CAMBER_OK = 0,
    CAMBER_ERROR_MEMORY,    /* an allocation failed, on the host or on the device */
    CAMBER_ERROR_ARGUMENT,  /* a value that the user chose is out of range or does not parse */
    CAMBER_ERROR_INPUT,     /* input data is not what it claims to be, or is cut off */
    CAMBER_ERROR_NOT_FOUND, /* no such file */
    CAMBER_ERROR_DEVICE,    /* no usable OpenCL device or GL back end, or a program does not build */
    CAMBER_ERROR_IO,        /* reading or writing failed, a full disk among the causes */
    CAMBER_ERROR_LIMIT,     /* more than 32-bit vertex indices, a buffer or a target can hold */
} camber_status;

/* A short English name of the status; never NULL. */
CAMBER_API const char *camber_status_get_name(camber_status status);

/* "0.1.0" of the library in use. */
CAMBER_API const char *camber_version(void);

/* ---- Budget: what files may make a run take ------------------------------------------------------- */

/* A small file can ask for more than a machine has. What a budget refuses fails with CAMBER_ERROR_MEMORY or
 * CAMBER_ERROR_LIMIT, and the log says which bound it was. */
typedef struct camber_budget_desc {
    /* Held at once by all contexts of the budget: blocks of the allocator, and OpenCL buffers in the host's memory.
     * Libraries' own memory is not counted. 0: three quarters of what this process can still have, by what the machine
     * has free and what its control group and its limits allow, when it holds 64 MB for the first time or is asked. */
    uint64_t memory_bytes;
    /* The following bound one set of features: */
    uint64_t tiles;  /* vector tiles looked for. 0: 262144 */
    uint64_t steps;  /* of databases' machines, besides 4096 a tile. 0: 2^26, some seconds */
    uint32_t unfold; /* bytes that come out of tiles for each byte of their files, besides 4 MB. 0: 32 */
} camber_budget_desc;

typedef struct camber_budget camber_budget;

/* desc may be NULL. A budget must outlive its contexts, which different threads may use at once.
 * Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_budget_create(const camber_budget_desc *desc, camber_budget **budget);
CAMBER_API void camber_budget_destroy(camber_budget *budget);
/* Return the bytes that are held now, and the bytes that may be held. */
CAMBER_API uint64_t camber_budget_get_held_bytes(const camber_budget *budget);
CAMBER_API uint64_t camber_budget_get_most_bytes(camber_budget *budget);

/* ---- Access: what files may reach ------------------------------------------------------------------ */

/* Nothing is opened but what the caller names, what a style names, and the parts that a format has beside its file
 * (.shx, .dbf, .prj, -wal); none of these by a link to a device or a pipe; and nothing is fetched. */
typedef struct camber_access {
    bool remote; /* files named as input may lead to the network, and may be there themselves */
    bool vrt;    /* files named as input may name other files (VRT) */
    /* A folder beyond which no file lies that a style names: sources, TileJSON, tiles, sprites. NULL: anywhere. */
    const char *root;
    /* Files that are about to be replaced, which nothing may read. NULL: none. */
    const char *outputs[4];
} camber_access;

/* ---- Context: allocator, log, cache -------------------------------------------------------------- */

typedef enum camber_log_level {
    CAMBER_LOG_ERROR = 0, /* the message of a failure that a status reports */
    CAMBER_LOG_WARNING,   /* something was left out or repaired; said once a cause */
    CAMBER_LOG_INFO,      /* what was chosen and how long it took */
} camber_log_level;

/* message: one line without a newline, valid during the call. */
typedef void camber_log_fn(void *user, camber_log_level level, const char *message);

/* How far a long call is: fraction in 0 to 1, or below 0 where the end is not known. Called from the
 * thread that made the call. */
typedef void camber_progress_fn(void *user, const char *stage, double fraction);

typedef struct camber_context_desc {
    /* realloc's contract, with size 0 meaning free. NULL: the C library's. */
    void *(*reallocate)(void *user, void *block, size_t size_bytes);
    void *allocator_user;
    camber_log_fn *log; /* NULL: silence */
    void *log_user;
    camber_progress_fn *progress; /* NULL: none */
    void *progress_user;
    /* Folder for compiled kernels and linked shaders. NULL: $XDG_CACHE_HOME/camber, else ~/.cache/camber; "": no cache.
     * A folder that cannot be written is not an error. Kernels are looked for in a folder that all users share first
     * (camber_device_warm), which $CAMBER_KERNELS may name. */
    const char *cache_dir;
    camber_budget *budget; /* NULL: one of its own, all zero */
    camber_access access;  /* its strings are copied */
} camber_context_desc;

typedef struct camber_context camber_context;

/* Returns CAMBER_ERROR_MEMORY. desc may be NULL. */
CAMBER_API camber_status camber_context_create(const camber_context_desc *desc, camber_context **context);
CAMBER_API void camber_context_destroy(camber_context *context);

/* ---- Polylines ----------------------------------------------------------------------------------- */

typedef struct camber_polylines_desc {
    const float *points; /* point_count pairs of x, y in pixels */
    size_t point_count;
    const uint32_t *offsets; /* polyline_count + 1 indices into points, ascending, from 0 to point_count */
    size_t polyline_count;
    const uint32_t *rows; /* polyline_count indices into the strokes, below 2^24. NULL: all 0 */
    /* false: a polyline whose first and last points are equal is a ring, and its seam is a join.
     * true: such a polyline has caps at its ends like any other. */
    bool keep_open;
} camber_polylines_desc;

/* The findings of cleaning. Nothing is dropped without being counted here. */
typedef struct camber_polylines_stats {
    size_t polylines;       /* as given */
    size_t points;          /* as given */
    size_t kept_points;     /* that are tessellated */
    size_t kept_segments;   /* that are tessellated */
    size_t rings;           /* polylines that close */
    size_t dots;            /* polylines of one distinct point: drawn as a dot by round and square caps */
    size_t empty_polylines; /* polylines without a point */
    size_t repeated_points; /* dropped: no farther than 1e-9 px from the point before */
    size_t invalid_points;  /* dropped: NaN, infinite, or beyond 1e9 px; the polyline is split there */
} camber_polylines_stats;

typedef struct camber_polylines camber_polylines;

/* Cleans and copies polylines into the form that the kernels read. A polyline that is split at invalid
 * points keeps its index and its row.
 * Returns CAMBER_ERROR_INPUT (offsets not ascending from 0 to point_count, a row of 2^24 or more),
 * CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT (more than 2.5 * 10^9 points). Cost: one pass. */
CAMBER_API camber_status camber_polylines_create(camber_context *context, const camber_polylines_desc *desc,
                                                 camber_polylines **polylines);
CAMBER_API void camber_polylines_destroy(camber_polylines *polylines);
CAMBER_API camber_polylines_stats camber_polylines_get_stats(const camber_polylines *polylines);

/* ---- Strokes: how wide, which joins and caps ------------------------------------------------------ */

typedef enum camber_join {
    CAMBER_JOIN_ROUND = 0,
    CAMBER_JOIN_MITER, /* a bevel where the miter limit is exceeded */
    CAMBER_JOIN_BEVEL,
} camber_join;

typedef enum camber_cap {
    CAMBER_CAP_BUTT = 0,
    CAMBER_CAP_ROUND,
    CAMBER_CAP_SQUARE,
} camber_cap;

/* A row of the style table as the tessellation needs it. */
typedef struct camber_stroke {
    /* The widest that the mesh will be drawn with: casing, not fill. 0 to 16384 px. */
    float width_px;
    camber_join join;
    camber_cap cap;
    /* Miter length over width, as in SVG: 1 / cos(turn / 2). 0: 2. */
    float miter_limit;
    /* How far beside its polyline it is drawn: to the right of the polyline's direction as seen, to the left where
     * below 0. Its corners follow the join: arcs (to 1/8 px), miters within the limit, or bevels; what has no room on
     * the inner side of a bend goes. Not of dots. -16384 to 16384 px. */
    float offset_px;
    /* Round joins whose miter length over width is less are miter joins, or bevels past the miter limit. 0: none */
    float round_limit;
} camber_stroke;

/* ---- OpenCL devices ------------------------------------------------------------------------------- */

typedef enum camber_device_type {
    CAMBER_DEVICE_TYPE_OTHER = 0,
    CAMBER_DEVICE_TYPE_CPU,
    CAMBER_DEVICE_TYPE_GPU,
} camber_device_type;

typedef struct camber_device_info {
    char name[128];
    char platform[128];
    char version[128]; /* "OpenCL 3.0 ..." */
    char driver[64];
    camber_device_type type;
    uint32_t compute_units;
    uint64_t memory_bytes;
    uint64_t largest_buffer_bytes; /* of an open device: what its desc allows, if that is less */
    bool gl_sharing;               /* cl_khr_gl_sharing */
} camber_device_info;

/* Gives the n-th device, from 0, and NULL past the last. The first call of a context looks for devices. What it finds
 * lives as long as the context.
 * Returns CAMBER_ERROR_MEMORY, also where the process has too little address space for drivers (ulimit -v). */
CAMBER_API camber_status camber_device_list(camber_context *context, size_t n, const camber_device_info **info);

/* Whether match, as in camber_device_desc, names the device. */
CAMBER_API bool camber_device_info_matches(const camber_device_info *info, const char *match);

/* A GL context that a device can share buffers with, as camber_surface_get_handles tells it. Zero: there is none. */
typedef struct camber_gl_handles {
    intptr_t context, display;
    intptr_t display_kind;         /* the name that OpenCL has for such displays: CL_EGL_DISPLAY_KHR, ... */
    uint64_t largest_buffer_bytes; /* that the context's shaders can read. 0: no bound */
} camber_gl_handles;

typedef struct camber_device_desc {
    /* "cpu", "gpu", or part of a device's or platform's name, case ignored. NULL: a GPU, else a CPU. */
    const char *match;
    /* Which of the devices that match is opened, in the order of camber_device_list: 1 is the first. 0: the first
     * GPU, else the first CPU. */
    uint32_t number;
    /* Work-group size of all kernels: 64, 128 or 256 points. 0 (recommended): chosen for the device. It affects speed
     * only; the output is the same bytes. */
    uint32_t work_group_size;
    /* No buffer is made larger. A mesh that needs more is made in parts of whole polylines; what is read or drawn is
     * the same. At least 4096. 0, or more than the device allows: the device's own limit, below 2^31 bytes. */
    uint64_t largest_buffer_bytes;
    /* The memory that all meshes of the device may hold at once: points, joins, records, indices (twice where they are
     * copied), strokes and networks. Not counted are polylines on the host, what is read back, and pictures.
     * A mesh is made in parts of an eighth of it or less. A part that does not fit is tessellated again when it is
     * read or drawn, to the same bytes and pixels. A polyline may take half of it: about 50 bytes a point that is seen.
     * A renderer that draws in OpenCL reserves a quarter of it, or 4 MB besides where that is less; it draws what
     * needs more in slices, to the same bytes.
     * At least 65536. 0: three quarters of the device's memory; no bound where that is the host's. */
    uint64_t memory_bytes;
    /* The surface whose renderers will draw the device's meshes in GL. Zero: none; buffers are copied. */
    camber_gl_handles gl;
} camber_device_desc;

typedef struct camber_device camber_device;

/* Opens a device. The kernels of a method are built, or loaded from the cache, when it is first used.
 * desc may be NULL.
 * Returns CAMBER_ERROR_DEVICE (no platform, no device that matches or not so many), CAMBER_ERROR_ARGUMENT (a work-group
 * size that is none of these, a largest buffer below 4096 bytes, memory below 65536), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_device_create(camber_context *context, const camber_device_desc *desc,
                                              camber_device **device);
CAMBER_API void camber_device_destroy(camber_device *device);

typedef struct camber_warmed {
    size_t programs;   /* of the share */
    size_t built;      /* the others lay in the cache */
    size_t kept;       /* that lie in the folder now */
    char folder[1024]; /* where they lie; "": nowhere, as no folder can be written */
} camber_warmed;

/* Builds all kernels that the device can be asked for and saves those that the cache lacks, so that later runs load
 * them. They go to the folder camber-kernels beside the library, which all users of the machine read, or to the user's
 * cache where that folder cannot be written. Kernels of other devices, drivers or versions of camber are left alone.
 * share, shares: several processes can build at once, each its share of all; 0 of 1 is everything.
 * Returns CAMBER_ERROR_ARGUMENT (no such share), CAMBER_ERROR_DEVICE (kernels that do not build),
 * CAMBER_ERROR_MEMORY. Some drivers do not let their kernels be saved; kept stays 0 then. */
CAMBER_API camber_status camber_device_warm(camber_device *device, unsigned share, unsigned shares,
                                            camber_warmed *warmed);
CAMBER_API camber_device_info camber_device_get_info(const camber_device *device);

typedef struct camber_device_memory {
    uint64_t allowed_bytes; /* to the device's meshes and what draws, as camber_device_desc has it. 0: no bound */
    uint64_t held_bytes, most_bytes; /* of what is counted: now, and at any time since the device was opened */
} camber_device_memory;

CAMBER_API camber_device_memory camber_device_get_memory(const camber_device *device);

/* ---- Surfaces: a GL context without a window ------------------------------------------------------- */

typedef enum camber_backend {
    CAMBER_BACKEND_AUTO = 0, /* EGL, else OSMesa */
    CAMBER_BACKEND_EGL,      /* surfaceless, else the first device platform */
    CAMBER_BACKEND_OSMESA,
} camber_backend;

typedef struct camber_surface camber_surface;

typedef struct camber_surface_desc {
    camber_backend backend;
    /* A GLES context of the caller's (EGLContext) and its initialised display (EGLDisplay): the surface's own context
     * shares textures and fences with it (camber_renderer_render_texture), and no state. NULL: none. Needs EGL. */
    void *egl_context, *egl_display;
} camber_surface_desc;

typedef struct camber_surface_info {
    const char *backend;  /* "EGL surfaceless", "EGL device", "EGL shared", "OSMesa" */
    const char *renderer; /* GL_RENDERER */
    const char *version;  /* GL_VERSION */
    uint32_t largest_target_px;
    bool software; /* the renderer is a software rasteriser */
    bool buffer_storage;
} camber_surface_info;

/* false: GL on such a surface would be a software rasteriser, or is not there, and OpenCL draws the same picture
 * sooner. true: it may be hardware, and camber_surface_info.software of an open surface tells. Looks for what GPUs'
 * drivers are reached through (on Linux files in /dev, render nodes among them), and loads no GL library: some
 * microseconds. */
CAMBER_API bool camber_surface_may_be_hardware(const camber_surface_desc *desc);

/* Returns CAMBER_ERROR_DEVICE when the library or the driver is not there, or a context cannot share the caller's. */
CAMBER_API camber_status camber_surface_create(camber_context *context, const camber_surface_desc *desc,
                                               camber_surface **surface);
CAMBER_API void camber_surface_destroy(camber_surface *surface);
/* Returns the surface's GL context for camber_device_desc.gl. NULL gives zero. */
CAMBER_API camber_gl_handles camber_surface_get_handles(const camber_surface *surface);
/* Lets go of the GL context on the calling thread, so that another thread can use the surface. */
CAMBER_API void camber_surface_release(camber_surface *surface);
/* Whether the GL context is lost, as it is when the GPU is reset or its driver restarts. What needs it then returns
 * CAMBER_ERROR_DEVICE. Destroy the meshes, renderers and the surface, and make them again: that works in the same
 * process. A device that was opened with the surface goes the same way; polylines and scenes stay. */
CAMBER_API bool camber_surface_is_lost(const camber_surface *surface);
/* The strings live as long as the surface. */
CAMBER_API camber_surface_info camber_surface_get_info(const camber_surface *surface);

/* ---- Renderer -------------------------------------------------------------------------------------- */

typedef enum camber_sharing {
    CAMBER_SHARING_AUTO = 0,  /* the first of the following that works */
    CAMBER_SHARING_GL,        /* cl_khr_gl_sharing: OpenCL writes the GL buffer on the GPU */
    CAMBER_SHARING_ZERO_COPY, /* a persistent map of the GL buffer is the OpenCL buffer */
    CAMBER_SHARING_COPY,      /* through host memory; works anywhere */
} camber_sharing;

/* The way in which frames are drawn. */
typedef enum camber_rasterizer {
    /* OpenCL where there is no surface or its GL is a software rasteriser, which takes several times as long for the
     * same picture; GL where it is hardware. A program that wants pictures in memory opens a surface only where
     * camber_surface_may_be_hardware. */
    CAMBER_RASTERIZER_AUTO = 0,
    CAMBER_RASTERIZER_GL,     /* GLES shaders */
    CAMBER_RASTERIZER_OPENCL, /* OpenCL kernels, which need no surface */
} camber_rasterizer;

typedef struct camber_renderer_desc {
    /* Asking for one path and not AUTO fails with CAMBER_ERROR_DEVICE where it does not work. */
    camber_sharing sharing;
    camber_rasterizer rasterizer;
} camber_renderer_desc;

typedef struct camber_renderer camber_renderer;

/* desc may be NULL, and so may the surface where OpenCL draws: its pictures need no GL, and only
 * camber_renderer_render_texture uses a surface then, whose paths of sharing pixels take. Returns CAMBER_ERROR_DEVICE
 * (the sharing path asked for does not work), CAMBER_ERROR_MEMORY. Shaders are built when they are first used. */
CAMBER_API camber_status camber_renderer_create(camber_device *device, camber_surface *surface,
                                                const camber_renderer_desc *desc, camber_renderer **renderer);
CAMBER_API void camber_renderer_destroy(camber_renderer *renderer);
/* CAMBER_SHARING_AUTO without a surface: nothing is shared. */
CAMBER_API camber_sharing camber_renderer_get_sharing(const camber_renderer *renderer);
CAMBER_API camber_rasterizer camber_renderer_get_rasterizer(const camber_renderer *renderer);
/* "auto", "gl" or "cl". */
CAMBER_API const char *camber_rasterizer_get_name(camber_rasterizer draw);
/* "cl_khr_gl_sharing", "zero copy" or "copy". */
CAMBER_API const char *camber_sharing_get_name(camber_sharing sharing);

/* ---- Times of stages -------------------------------------------------------------------------------- */

/* How long a kernel took. Which stages there are, and their names, may change from version to version. */
typedef struct camber_stage_time {
    const char *name; /* the library's: "classify", ... */
    double ms;
} camber_stage_time;

#define CAMBER_STAGE_TIMES_MAX 24

typedef struct camber_stage_times {
    size_t count;
    camber_stage_time stages[CAMBER_STAGE_TIMES_MAX]; /* count, in the order in which they run */
} camber_stage_times;

/* The time of the stage of that name. 0: it did not run, or there is none. */
CAMBER_API double camber_stage_times_get_ms(const camber_stage_times *times, const char *name);

/* ---- Meshes ---------------------------------------------------------------------------------------- */

typedef enum camber_method {
    CAMBER_METHOD_STRIP = 0, /* two vertices a point, cut along the bisectors: one strip a polyline */
    CAMBER_METHOD_KITE,      /* bodies and two triangles a round join */
    CAMBER_METHOD_FAN,       /* bodies and a fan of triangles a round join */
} camber_method;

CAMBER_API const char *camber_method_get_name(camber_method method);

typedef struct camber_tessellation_desc {
    const camber_stroke *strokes; /* stroke_count rows; every row of the polylines must be below it */
    size_t stroke_count;
    camber_method method;
    float fan_tolerance_px; /* farthest that a fan's chord lies from its arc, up to 64 chords a half turn. 0: 0.25 */
    /* Records say how far along their polyline they lie, as dashes, trims, ramps and patterns need it. A record takes
     * 32 bytes then. */
    bool has_arc_length;
} camber_tessellation_desc;

/* How far the geometry reaches past the stroke's edge, so that every pixel an edge touches is shaded: exact
 * coverage reaches sqrt(1/2) px from the edge. */
#define CAMBER_PAD_PX 0.75f

typedef struct camber_mesh_info {
    camber_method method;
    bool strips;              /* triangle strips; else triangles */
    bool has_arc_length;      /* as the tessellation was asked for */
    size_t record_count;      /* camber_record */
    size_t vertex_count;      /* of strips two a record, those between strips too */
    size_t index_count;       /* of strips one a vertex, though none is kept */
    size_t bytes;             /* all that is kept to draw from: records, and indices of kite and fan */
    size_t triangle_count;    /* not degenerate */
    size_t joins;             /* points with a join, by kind: */
    size_t tight_joins;       /* the inner side has no room: (h + pad) tan(turn / 2) > half the shorter neighbour */
    size_t split_joins;       /* turns past 127 degrees */
    size_t undrawn_dots;      /* dots with butt caps, which have no area */
    camber_stage_times times; /* of the last tessellation's stages, on the device's queue */
} camber_mesh_info;

typedef struct camber_mesh camber_mesh;

/* An empty mesh. renderer may be NULL: the mesh can be read then, not drawn. */
CAMBER_API camber_status camber_mesh_create(camber_device *device, camber_renderer *renderer, camber_mesh **mesh);
CAMBER_API void camber_mesh_destroy(camber_mesh *mesh);

/* Tessellates on the device, replacing what the mesh held. Output is in input order and byte-identical from
 * run to run. The mesh keeps the uploaded polylines, so that another call with the same object and other
 * strokes uploads nothing.
 * Returns CAMBER_ERROR_ARGUMENT (a width or a limit that is not a number or out of range, a row without a
 * stroke), CAMBER_ERROR_LIMIT (more than 2^30 records of strips or 2^25 of kite and fan, or a polyline that needs
 * more than the largest buffer, or than half of what the device's meshes may hold), CAMBER_ERROR_MEMORY,
 * CAMBER_ERROR_DEVICE (a kernel that does not build: the log has the build log). Cost: the first use of a method
 * compiles its kernels or loads them from the cache; then linear in the points. */
CAMBER_API camber_status camber_mesh_tessellate(camber_mesh *mesh, const camber_polylines *polylines,
                                                const camber_tessellation_desc *desc);
/* The first call after a tessellation counts joins and triangles: one pass over the points. */
CAMBER_API camber_mesh_info camber_mesh_get_info(camber_mesh *mesh);

typedef struct camber_mesh_memory {
    size_t parts;          /* runs of polylines with buffers of their own: 1, where there is room */
    size_t resident_parts; /* that need not be tessellated again to be read or drawn */
    size_t remade_parts;   /* that were, since the last tessellation */
    uint64_t held_bytes;   /* of what the device's bound counts */
} camber_mesh_memory;

CAMBER_API camber_mesh_memory camber_mesh_get_memory(const camber_mesh *mesh);

/* ---- Drawing --------------------------------------------------------------------------------------- */

/* Straight (not premultiplied), each 0 to 1. */
typedef struct camber_color {
    float r, g, b, a;
} camber_color;

/* Lengths that are drawn and left out in turn, from where a polyline begins; an odd count is gone through twice, as in
 * SVG. Their ends are cut straight, but round where the stroke's caps are. */
typedef struct camber_dash {
    const float *lengths; /* count, in units of the paint; 0 and more; their sum is above 0 */
    size_t count;         /* up to CAMBER_DASH_LENGTHS_MAX */
} camber_dash;

#define CAMBER_DASH_LENGTHS_MAX 128

typedef struct camber_ramp_stop {
    float place; /* a share of the line's length, not below that of the stop before */
    camber_color color;
} camber_ramp_stop;

/* Colours along a line, of a mesh with arc lengths: between stops mixed as premultiplied ones, before the first and
 * behind the last as there. Two stops at one place are a step, whose edge has the exact area of the pixel. */
typedef struct camber_ramp {
    const camber_ramp_stop *stops;
    size_t count; /* 1 to CAMBER_RAMP_STOPS_MAX */
} camber_ramp;

#define CAMBER_RAMP_STOPS_MAX 4096

/* A picture to draw with: premultiplied RGBA8, rows from the top down. */
typedef struct camber_image {
    const uint8_t *rgba;
    uint32_t width, height; /* px; 1 to CAMBER_IMAGE_SIDE_MAX each */
    size_t stride_bytes;    /* from row to row. 0: 4 * width */
} camber_image;

#define CAMBER_IMAGE_SIDE_MAX 16384

/* How a row is drawn in one pass. */
typedef struct camber_paint {
    float width_px; /* 0: nothing is drawn. gap_px + 2 width_px with a gap, else this, is at most the stroke's width */
    camber_color color;
    float gap_px;                         /* 0: none; else the room between two bands of this width each */
    float blur_px;                        /* 0: none; else edges fade over so much more than a pixel, inwards */
    float translate_x_px, translate_y_px; /* where it is drawn, from where its polyline lies */
    const camber_dash *dash;              /* NULL: none; else of a mesh with arc lengths */
    float dash_unit_px;                   /* that the dash's lengths are given in. 0: 1 */
    /* Shares of its line's length, of a mesh with arc lengths: from the one to the other it is not drawn. What is
     * trimmed at an end takes the cap too. trim_end not above trim_start: it is whole. */
    float trim_start, trim_end;
    const camber_ramp *ramp; /* NULL: none; else of a mesh with arc lengths: color is multiplied by it */
    /* NULL: none; else of a mesh with arc lengths: in place of the colour, whose
     * alpha it takes. It is as high as the stroke is wide, a gap with it, its top to the right of the line's direction,
     * and follows upon itself from where the line begins. */
    const camber_image *image;
    float image_px; /* along the line, that one takes. 0: as many as keep the image's shape */
} camber_paint;

/* The whole picture in one colour, or in one image side by side. */
typedef struct camber_fill {
    camber_color color;
    const camber_image *image; /* NULL: none; else in place of the colour, whose alpha it takes */
    float width_px, height_px; /* of one image in the picture. 0: as it is */
    float x_px, y_px;          /* where the top left corner of one lies in the picture */
    double bearing_deg;        /* as a camera's, of the map that the images lie on */
} camber_fill;

typedef enum camber_overlap {
    /* A translucent pass covers each pixel once, however often its lines cross it: coverage is gathered
     * first and composited once. A run of polylines with equal alpha is flattened together.
     * Where that makes more than 32 layers of a pass, polylines of one alpha come together, the faintest lowest; where
     * there are more than 16 alphas, in GL one layer has them all, in which the last line alone is seen. */
    CAMBER_OVERLAP_FLATTEN = 0,
    CAMBER_OVERLAP_ACCUMULATE, /* overlaps of translucent lines darken */
    /* FLATTEN, and opaque runs of one colour are gathered and composited once as well. Where edges meet in a pixel, of
     * one line or of several, the picture has the area of all lines together, which drawing one over the other
     * misses: a third to three quarters of the error, for 1.1 to 1.8 times the drawing on llvmpipe. */
    CAMBER_OVERLAP_UNITE,
} camber_overlap;

typedef enum camber_coverage {
    CAMBER_COVERAGE_EXACT = 0, /* the exact area of a pixel under a straight edge */
    CAMBER_COVERAGE_LINEAR,    /* a ramp one pixel wide across the edge: cheaper, about twice the error */
} camber_coverage;

typedef enum camber_pass_kind {
    CAMBER_PASS_LINES = 0, /* draws polylines of a mesh, in order */
    CAMBER_PASS_FILL,      /* fills the picture; takes fill and opacity, and nothing else of the pass */
} camber_pass_kind;

typedef struct camber_pass {
    camber_pass_kind kind;
    camber_mesh *mesh; /* of the renderer that draws; not NULL for lines */
    size_t first_polyline;
    size_t polyline_count;      /* 0: to the last */
    const camber_paint *paints; /* paint_count; a row at or past it is not drawn */
    size_t paint_count;
    camber_fill fill;
    camber_overlap overlap;
    float opacity; /* of all that is drawn, put onto the picture as one layer. 0: 1, and no layer */
} camber_pass;

typedef struct camber_frame {
    uint32_t width, height;  /* px; 1 to 65535 each */
    camber_color background; /* zero: transparent */
    const camber_pass *passes;
    size_t pass_count;
    camber_coverage coverage;
    /* The picture is drawn in pieces where a side is longer than this. 0: the largest target, or less where
     * that would take more than 64 MB; a layer that is united takes 128 MB more. */
    uint32_t largest_piece_px;
    /* 0 to 85: the angle at which the plane of the polylines is seen, from straight above at 0. Meshes of a network
     * bring the pitch of their camera (camber_camera.pitch_deg), which a frame then need not name: 0 takes theirs. It
     * is for frames of fills, and of meshes of polylines. The camera looks at the picture's centre, where a px of the
     * plane is one of the picture, and sees 36.87 degrees from the bottom to the top. Widths, dashes and translations
     * lie in the plane; blurs do not. What is farther than 6.7 times the distance of the centre is not drawn: at 85 %
     * of the way from there to the horizon. */
    double pitch_deg;
} camber_frame;

typedef struct camber_frame_stats {
    size_t draw_calls;
    size_t pieces;
    double draw_ms; /* clear, draw, finish; of a frame that overlaps others, what its calls take */
    double read_ms;
    camber_stage_times times; /* of CAMBER_RASTERIZER_OPENCL's stages, on the device's queue */
} camber_frame_stats;

/* Takes row_count rows of width * 4 bytes, premultiplied RGBA8, from the top down; a return of false stops the
 * drawing. */
typedef bool camber_rows_fn(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count);

/* Draws a frame and hands its rows over.
 * rows may be NULL: the frame is drawn and finished, not read back. stats may be NULL.
 * Returns CAMBER_ERROR_ARGUMENT (a size or a pitch out of range, meshes of cameras with different pitches, a dash, a
 * ramp or an image that is none, dashes, ramps, trims or images of a mesh without arc lengths),
 * CAMBER_ERROR_LIMIT (more rows of strokes and paints, or images of one pass, than textures hold, or in OpenCL images
 * of one frame than a buffer), CAMBER_ERROR_DEVICE (a shader or a kernel does not build, or GL or OpenCL reported an
 * error), CAMBER_ERROR_MEMORY, CAMBER_ERROR_IO (rows returned false). */
CAMBER_API camber_status camber_renderer_render(camber_renderer *renderer, const camber_frame *frame,
                                                camber_rows_fn *rows, void *user, camber_frame_stats *stats);

#define CAMBER_FRAMES_IN_FLIGHT 2

/* camber_renderer_render in two steps, so that what comes next overlaps the drawing: begin draws and does not wait, end
 * waits for the frame that began first and hands its rows over. With two meshes in turn,
 *
 *     tessellate mesh n + 1, begin frame n + 1, end frame n
 *
 * keeps the device and GL at work on two frames. CAMBER_FRAMES_IN_FLIGHT frames at most may have begun and not ended,
 * and none when camber_renderer_render is called; the passes' meshes, dashes, ramps and images must live until the end.
 * Tessellating a mesh before waits for the drawing, and so gains nothing; nor does drawing in OpenCL gain, which has
 * both steps on one device: begin draws the frame and keeps it. Where a picture takes several
 * pieces, those after the first are drawn at the end, in OpenCL all of them, from the meshes as they are then.
 *
 * They return what camber_renderer_render returns. Where begin fails no frame has begun; where end fails the frame is
 * given up. Destroying the renderer gives up what is in flight. */
CAMBER_API camber_status camber_renderer_begin(camber_renderer *renderer, const camber_frame *frame);
CAMBER_API camber_status camber_renderer_end(camber_renderer *renderer, camber_rows_fn *rows, void *user,
                                             camber_frame_stats *stats);

/* ---- Drawing into textures: for engines that draw more than lines ----------------------------------- */

/* A texture of the surface's GL context, or of one that shares its objects (camber_surface_desc). Pixels are
 * premultiplied: engines put them over what they have by glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA). */
typedef struct camber_texture {
    uint32_t name;  /* a GL_TEXTURE_2D of GL_RGBA8, as wide and high as the frame */
    bool keep;      /* the frame lies over what the texture holds. false: in place of it */
    bool bottom_up; /* the picture's last row lies at t = 0, as in GL's framebuffers. false: its first row does */
    void *ready;    /* a GLsync behind what other contexts did to the texture, which GL waits for. NULL: none */
} camber_texture;

/* Draws a frame into a texture, in GL or OpenCL as the renderer does, and reads nothing back: so pictures of engines
 * lie below lines and above them, and renderers of both kinds draw into one texture in turn. All of it is one piece:
 * its sides are the surface's largest_target_px at most, and layers take up to 25 bytes a px more.
 *
 * drawn: takes a GLsync behind the last command, which has been flushed; another context waits for it by glWaitSync
 * before it uses the texture, and the caller deletes it. It may be NULL then: all is done. With drawn NULL the call
 * itself waits. No frame may be in flight. The surface's context stays current: make your own one current again.
 *
 * Returns what camber_renderer_render does, and CAMBER_ERROR_ARGUMENT (no such texture, another size or format, a
 * renderer without a surface), CAMBER_ERROR_LIMIT (a side too long). The texture's pixels are not defined on failure.
 */
CAMBER_API camber_status camber_renderer_render_texture(camber_renderer *renderer, const camber_frame *frame,
                                                        const camber_texture *texture, void **drawn);

#ifdef __cplusplus
}
#endif

#endif
