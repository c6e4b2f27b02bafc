/* camber: polylines to anti-aliased pictures. OpenCL kernels tessellate; GLES shaders draw, or OpenCL kernels do.
 *
 *     polylines -> tessellation -> mesh -> renderer -> rows of RGBA8
 *
 * This header is the manual of libcamber. libcamber-map (camber_map.h) stands on it.
 *
 * Errors. A function that can fail returns a camber_status. Results go to the last parameter, which is left
 * untouched on failure. The message of a failure goes to the log callback of the context: one line that says what
 * failed, where, and the cure. Misuse (a NULL object, a count that contradicts a pointer) asserts.
 *
 * Ownership. X_create makes an object, X_destroy frees it and accepts NULL. Inputs, and all that they point at, are
 * read during the call only, unless a comment says that the object keeps a pointer. An object must outlive those made
 * from it: context > device, surface > renderer > mesh.
 *
 * Descriptions. Every desc and params struct is valid when zeroed; each field says what zero means.
 *
 * Threads. A context and all that was made from it may be used by one thread at a time; different
 * contexts are independent, and threads may make and use them, and all that is made from them, at once.
 * There is no global state but that of drivers and GDAL, whose first set-up camber guards by a lock. A program that
 * calls them itself must not do so while camber's first call runs. Drivers read and set environment variables when
 * devices are first looked for: until then no other thread may read or change the environment.
 * A surface's GL context is made current on the calling thread by each call that needs it, and stays so
 * until camber_surface_release.
 *
 * Processes. Drivers do not survive fork(): in a child of a process that has looked for devices, whatever needs a
 * device, also a new one, fails with CAMBER_ERROR_DEVICE. Fork before camber's first call, or call exec in the child.
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

/* The version of the library in use, as "0.1.0". */
CAMBER_API const char *camber_version(void);

/* ---- Budget: what files may make a run take ------------------------------------------------------- */

/* A small file can ask for more than a machine has. A call that a budget refuses fails with CAMBER_ERROR_MEMORY or
 * CAMBER_ERROR_LIMIT, and the log says which bound it was. */
typedef struct camber_budget_desc {
    /* All contexts of the budget may hold so much at once: blocks of the allocator, and OpenCL buffers in the host's
     * memory. Memory that other libraries take is not counted.
     * 0: three quarters of what this process can still have. That goes by what the machine has free, and by what the
     * control group and the limits of the process allow. It is settled when the budget first holds 64 MB, or is asked.
     */
    uint64_t memory_bytes;
    /* The following bound one set of features: */
    uint64_t tiles;  /* how many vector tiles it looks for. 0: 262144 */
    uint64_t steps;  /* how many steps databases may take to answer, besides 4096 a tile. 0: 2^26, some seconds */
    uint32_t unfold; /* how many bytes tiles unpack to for each byte of their files, besides 4 MB. 0: 32 */
} camber_budget_desc;

typedef struct camber_budget camber_budget;

/* Makes a budget. A budget must outlive its contexts, which different threads may use at once.
 * desc may be NULL.
 * Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_budget_create(const camber_budget_desc *desc, camber_budget **budget);
CAMBER_API void camber_budget_destroy(camber_budget *budget);
/* Returns the bytes that are held now. */
CAMBER_API uint64_t camber_budget_get_held_bytes(const camber_budget *budget);
/* Returns the bytes that may be held. The first call settles them, where the budget's desc left them open. */
CAMBER_API uint64_t camber_budget_get_most_bytes(camber_budget *budget);

/* ---- Access: what files may reach ------------------------------------------------------------------ */

/* camber opens the files that the caller names and those that a style names. It opens the parts that a format has
 * beside its file too (.shx, .dbf, .prj, -wal). None is opened through a link to a device or a pipe, and nothing is
 * fetched. */
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

/* Takes a message of the library. message is one line without a newline, and is valid during the call. */
typedef void camber_log_fn(void *user, camber_log_level level, const char *message);

/* Is told how far a long call is, on the thread that made that call.
 * fraction is 0 to 1, or below 0 where the end is not known. */
typedef void camber_progress_fn(void *user, const char *stage, double fraction);

typedef struct camber_context_desc {
    /* Allocates as realloc does, and frees the block where the size is 0. NULL: the C library's. */
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

/* Makes a context. desc may be NULL.
 * Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_context_create(const camber_context_desc *desc, camber_context **context);
CAMBER_API void camber_context_destroy(camber_context *context);

/* ---- Polylines ----------------------------------------------------------------------------------- */

typedef struct camber_polylines_desc {
    /* point_count pairs of x, y in pixels. Floats keep the edges of a segment whose ends lie within 30,000 px of the
     * picture to a level of 255; at 100,000 px it is 4, at a million 30: cut such segments before. */
    const float *points;
    size_t point_count;
    const uint32_t *offsets; /* polyline_count + 1 indices into points, ascending, from 0 to point_count */
    size_t polyline_count;
    const uint32_t *rows; /* polyline_count indices into the strokes, below 2^24. NULL: all 0 */
    /* false: a polyline whose first and last points are equal is a ring, and its seam is a join.
     * true: such a polyline has caps at its ends like any other. */
    bool keep_open;
} camber_polylines_desc;

/* The findings of cleaning. All that it drops is counted here. */
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

/* Cleans polylines and copies them into the form that the kernels read. A polyline that is split at invalid points
 * keeps its index and its row.
 * Returns CAMBER_ERROR_INPUT (offsets that do not ascend from 0 to point_count, a row of 2^24 or more),
 * CAMBER_ERROR_LIMIT (more than 2.5 * 10^9 points), CAMBER_ERROR_MEMORY.
 * It takes one pass over the points. */
CAMBER_API camber_status camber_polylines_create(camber_context *context, const camber_polylines_desc *desc,
                                                 camber_polylines **polylines);
CAMBER_API void camber_polylines_destroy(camber_polylines *polylines);
CAMBER_API camber_polylines_stats camber_polylines_get_stats(const camber_polylines *polylines);

/* ---- Areas: rings that are filled ------------------------------------------------------------------ */

/* Areas as rings. A ring need not close: its last point is joined to its first. */
typedef struct camber_areas_desc {
    const float *points; /* point_count pairs of x, y in pixels */
    size_t point_count;
    const uint32_t *offsets; /* ring_count + 1 indices into points, ascending, from 0 to point_count */
    size_t ring_count;
    /* area_count + 1 indices into the rings, ascending, from 0 to ring_count. The first ring of an area is its outer
     * one, and the others are holes. NULL: each ring is an area, and area_count is not read. */
    const uint32_t *rings;
    size_t area_count;
    const uint32_t *rows; /* of each area, as camber_polylines_desc has them. NULL: all 0 */
} camber_areas_desc;

/* Makes closed polylines of areas, one a ring, for passes whose paints have a fill. Outer rings are turned clockwise as
 * seen, by their signed area, and holes the other way. Invalid points are left out, and the ring goes on without them.
 * A ring of fewer than three distinct points has no area; as a polyline it is drawn as any other.
 * Returns what camber_polylines_create does, CAMBER_ERROR_INPUT for rings that do not ascend from 0 to ring_count, too.
 */
CAMBER_API camber_status camber_areas_create(camber_context *context, const camber_areas_desc *desc,
                                             camber_polylines **areas);

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
    /* The widest that any pass will draw the mesh with. 0 to 16384 px. */
    float width_px;
    camber_join join;
    camber_cap cap;
    /* Miter length over width, as in SVG: 1 / cos(turn / 2). 0: 2. */
    float miter_limit;
    /* How far beside its polyline the line is drawn: to the right of the polyline's direction as seen, to the left
     * where this is below 0. -16384 to 16384 px. Its corners follow the join: arcs (to 1/8 px), miters within the
     * limit, or bevels. Parts without room on the inner side of a bend are left out. Dots stay where they are. */
    float offset_px;
    /* A round join whose miter length over width is less becomes a miter join, or a bevel past the miter limit.
     * 0: none does. */
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

/* Gives the n-th device, counted from 0, and NULL past the last. The first call of a context looks for devices. The
 * infos live as long as the context.
 * Returns CAMBER_ERROR_MEMORY, also where the process has too little address space for drivers (ulimit -v). */
CAMBER_API camber_status camber_device_list(camber_context *context, size_t n, const camber_device_info **info);

/* Returns whether match names the device. match is as in camber_device_desc. */
CAMBER_API bool camber_device_info_matches(const camber_device_info *info, const char *match);

typedef enum camber_gl_display { CAMBER_GL_DISPLAY_EGL, CAMBER_GL_DISPLAY_GLX } camber_gl_display;

/* A GL context that a device can share buffers with, as camber_surface_get_handles gives it. Zero: there is none. */
typedef struct camber_gl_handles {
    intptr_t context, display;
    camber_gl_display display_kind;
    uint64_t largest_buffer_bytes; /* that the context's shaders can read. 0: no bound */
} camber_gl_handles;

typedef struct camber_device_desc {
    /* "cpu", "gpu", or a part of the name of a device or a platform. Case is ignored. NULL: a GPU, else a CPU. */
    const char *match;
    /* Which of the devices that match is opened, in the order of camber_device_list: 1 is the first. 0: the first
     * GPU, else the first CPU. */
    uint32_t number;
    /* Work-group size of all kernels: 64, 128 or 256 points. It affects speed only; the output is the same bytes.
     * 0 (recommended): chosen for the device. */
    uint32_t work_group_size;
    /* Lanes of the vectors that OpenCL draws with: 1, 8 or 16. It affects speed only; the output is the same bytes.
     * 0 (recommended): as wide as a CPU's own vectors of floats, and 1 on other devices. */
    uint32_t lanes;
    /* No buffer is made larger than this, which is at least 4096. A mesh that needs more is made in parts of whole
     * polylines; it is read and drawn the same. 0, or more than the device allows: the device's own limit, below 2^31
     * bytes. */
    uint64_t largest_buffer_bytes;
    /* The memory that all meshes of the device may hold at once, at least 65536. It counts points, joins, records,
     * indices (twice where they are copied), strokes and networks. It does not count polylines on the host, data that
     * is read back, and pictures.
     * A mesh is made in parts of an eighth of it or less. A part that does not fit is tessellated again when it is
     * read or drawn, to the same bytes and pixels. A polyline may take half of it, at about 50 bytes a point that is
     * seen. A renderer that draws in OpenCL reserves a quarter of it, or 4 MB besides where that is less. A picture
     * that needs more is drawn in slices, to the same bytes.
     * 0: three quarters of the device's memory; no bound where that is the host's. */
    uint64_t memory_bytes;
    /* The surface whose renderers will draw the device's meshes in GL. Zero: none; buffers are copied. */
    camber_gl_handles gl;
} camber_device_desc;

typedef struct camber_device camber_device;

/* Opens a device. desc may be NULL.
 * Returns CAMBER_ERROR_DEVICE (no platform, no device that matches or not so many), CAMBER_ERROR_ARGUMENT (a work-group
 * size or lanes that are none of these, a largest buffer below 4096 bytes, memory below 65536), CAMBER_ERROR_MEMORY.
 * No kernel is built here: those of a method are built, or loaded from the cache, when it is first used. */
CAMBER_API camber_status camber_device_create(camber_context *context, const camber_device_desc *desc,
                                              camber_device **device);
CAMBER_API void camber_device_destroy(camber_device *device);

/* The work that camber_device_warm did. */
typedef struct camber_warmed {
    size_t programs;   /* how many the share has */
    size_t built;      /* how many were built; the others lay in the cache */
    size_t kept;       /* how many lie in the folder now. 0 where a driver does not let its kernels be saved */
    char folder[1024]; /* where they lie; "": nowhere, as no folder can be written */
} camber_warmed;

/* Builds all kernels that the device can be asked for, and saves those that the cache lacks, so that later runs load
 * them. They go to the folder camber-kernels beside the library, which all users of the machine read. Where that folder
 * cannot be written they go to the user's cache. Kernels of other devices, drivers or versions of camber are left
 * alone.
 * share is below shares: so several processes can build at once, each its share of all. Share 0 of 1 is everything.
 * Returns CAMBER_ERROR_ARGUMENT (no such share), CAMBER_ERROR_DEVICE (kernels that do not build),
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_device_warm(camber_device *device, unsigned share, unsigned shares,
                                            camber_warmed *warmed);
CAMBER_API camber_device_info camber_device_get_info(const camber_device *device);

typedef struct camber_device_memory {
    uint64_t allowed_bytes; /* for the device's meshes and renderers, as camber_device_desc has it. 0: no bound */
    uint64_t held_bytes, most_bytes; /* that are counted: now, and the most since the device was opened */
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
    /* A GLES context of the caller's (EGLContext) and its initialised display (EGLDisplay). The surface's own context
     * shares textures and fences with it (camber_renderer_render_texture), and no state. This needs EGL. NULL: none. */
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

/* Returns whether GL on such a surface may be hardware; camber_surface_info.software of an open surface tells.
 * false: GL would be a software rasteriser, or is not there, and OpenCL draws the same picture sooner.
 * desc may be NULL.
 * The call takes some microseconds. It looks for what GPUs' drivers are reached through (on Linux files in /dev,
 * render nodes among them), and loads no GL library. */
CAMBER_API bool camber_surface_may_be_hardware(const camber_surface_desc *desc);

/* Makes a surface. desc may be NULL.
 * Returns CAMBER_ERROR_DEVICE where the library or the driver is not there, or where a context cannot share the
 * caller's; CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_surface_create(camber_context *context, const camber_surface_desc *desc,
                                               camber_surface **surface);
CAMBER_API void camber_surface_destroy(camber_surface *surface);
/* Returns the surface's GL context for camber_device_desc.gl. A surface of NULL gives zero. */
CAMBER_API camber_gl_handles camber_surface_get_handles(const camber_surface *surface);
/* Releases the GL context on the calling thread, so that another thread can use the surface. */
CAMBER_API void camber_surface_release(camber_surface *surface);
/* Returns whether the GL context is lost, as it is when the GPU is reset or its driver restarts. Calls that need the
 * context then return CAMBER_ERROR_DEVICE. Destroy the meshes, the renderers and the surface, and a device that was
 * opened with the surface, and make them again: that works in the same process. Polylines and scenes stay. */
CAMBER_API bool camber_surface_is_lost(const camber_surface *surface);
/* Returns what the surface is. The strings live as long as the surface. */
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
    camber_sharing sharing; /* other than AUTO: camber_renderer_create fails where this path does not work */
    camber_rasterizer rasterizer;
} camber_renderer_desc;

typedef struct camber_renderer camber_renderer;

/* Makes a renderer, which draws frames of meshes that are made for it.
 * surface may be NULL where OpenCL draws, since its pictures need no GL. Only camber_renderer_render_texture uses the
 * surface of such a renderer, and pixels take its path of sharing. desc may be NULL.
 * Returns CAMBER_ERROR_DEVICE (the sharing path that was asked for does not work), CAMBER_ERROR_MEMORY.
 * No shader is built here: each is built when it is first used. */
CAMBER_API camber_status camber_renderer_create(camber_device *device, camber_surface *surface,
                                                const camber_renderer_desc *desc, camber_renderer **renderer);
CAMBER_API void camber_renderer_destroy(camber_renderer *renderer);
/* Returns the path of sharing in use. CAMBER_SHARING_AUTO, without a surface: nothing is shared. */
CAMBER_API camber_sharing camber_renderer_get_sharing(const camber_renderer *renderer);
/* Returns what draws: GL or OpenCL, never AUTO. */
CAMBER_API camber_rasterizer camber_renderer_get_rasterizer(const camber_renderer *renderer);
/* The name of a rasterizer: "auto", "gl" or "cl". */
CAMBER_API const char *camber_rasterizer_get_name(camber_rasterizer rasterizer);
/* The name of a path of sharing: "cl_khr_gl_sharing", "zero copy" or "copy". */
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

/* Returns the time of the stage of that name. 0: the stage did not run, or there is none of this name. */
CAMBER_API double camber_stage_times_get_ms(const camber_stage_times *times, const char *name);

/* ---- Meshes ---------------------------------------------------------------------------------------- */

typedef enum camber_method {
    CAMBER_METHOD_STRIP = 0, /* two vertices a point, cut along the bisectors: one strip a polyline */
    CAMBER_METHOD_KITE,      /* bodies and two triangles a round join */
    CAMBER_METHOD_FAN,       /* bodies and a fan of triangles a round join */
} camber_method;

/* The name of a method: "strip", "kite" or "fan". */
CAMBER_API const char *camber_method_get_name(camber_method method);

typedef struct camber_tessellation_desc {
    const camber_stroke *strokes; /* stroke_count rows; every row of the polylines must be below it */
    size_t stroke_count;
    camber_method method;
    float fan_tolerance_px; /* how far a fan's chord may lie from its arc, up to 64 chords a half turn. 0: 0.25 */
    /* Records know how far along their polyline they lie, as dashes, trims, ramps and images need it. A record takes
     * 32 bytes then. */
    bool has_arc_length;
} camber_tessellation_desc;

/* How far the geometry reaches past the stroke's edge, so that every pixel an edge touches is shaded: exact
 * coverage reaches sqrt(1/2) px from the edge. */
#define CAMBER_PAD_PX 0.75f

typedef struct camber_mesh_info {
    camber_method method;
    bool strips;         /* triangle strips; else triangles */
    bool has_arc_length; /* as the tessellation was asked for */
    /* The next three are 0 until camber_mesh_count_joins if a renderer that draws with OpenCL draws the mesh: it needs
     * points alone. */
    size_t record_count;      /* camber_record */
    size_t vertex_count;      /* of strips two a record, those between strips too */
    size_t index_count;       /* of strips one a vertex, though none is kept */
    size_t bytes;             /* all that is kept to draw from: points, or records, and indices of kite and fan */
    size_t triangle_count;    /* not degenerate; this and the following are 0 until camber_mesh_count_joins */
    size_t joins;             /* points with a join, by kind: */
    size_t tight_joins;       /* the inner side has no room: (h + pad) tan(turn / 2) > half the shorter neighbour */
    size_t split_joins;       /* turns past 127 degrees */
    size_t undrawn_dots;      /* dots with butt caps, which have no area */
    camber_stage_times times; /* of the last tessellation's stages, on the device's queue */
} camber_mesh_info;

typedef struct camber_mesh camber_mesh;

/* Makes an empty mesh.
 * renderer is the one that will draw the mesh. NULL: the mesh can be read, not drawn.
 * Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_mesh_create(camber_device *device, camber_renderer *renderer, camber_mesh **mesh);
CAMBER_API void camber_mesh_destroy(camber_mesh *mesh);

/* Tessellates on the device, and replaces what the mesh held. The output is in input order, and is the same bytes from
 * run to run. The mesh keeps the polylines: another call with the same object and other strokes uploads nothing.
 * Where the device works in the host's memory it reads them in place, so that after camber_polylines_destroy they take
 * memory until the mesh takes others or is destroyed.
 * Returns CAMBER_ERROR_ARGUMENT (a width or a limit that is not a number or out of range, a row without a
 * stroke), CAMBER_ERROR_LIMIT (more than 2^30 records of strips or 2^25 of kite and fan, or a polyline that needs
 * more than the largest buffer, or than half of what the device's meshes may hold), CAMBER_ERROR_MEMORY,
 * CAMBER_ERROR_DEVICE (a kernel that does not build: the log has the build log).
 * The first use of a method compiles its kernels, or loads them from the cache. After that the cost is linear in the
 * points. */
CAMBER_API camber_status camber_mesh_tessellate(camber_mesh *mesh, const camber_polylines *polylines,
                                                const camber_tessellation_desc *desc);
/* Returns what the last tessellation made. Some counts are 0 until camber_mesh_count_joins: camber_mesh_info. */
CAMBER_API camber_mesh_info camber_mesh_get_info(const camber_mesh *mesh);
/* Counts the joins and triangles of the last tessellation, and its records, vertices and indices, unless that is done
 * already. camber_mesh_read counts them, too.
 * Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_DEVICE, and what tessellating a part again can return.
 * Cost: one pass over the points. */
CAMBER_API camber_status camber_mesh_count_joins(camber_mesh *mesh);

typedef struct camber_mesh_memory {
    size_t parts;          /* polylines that follow each other, with buffers of their own: 1, where there is room */
    size_t resident_parts; /* parts that need not be tessellated again to be read or drawn */
    size_t remade_parts;   /* parts that were tessellated again since the last tessellation */
    uint64_t held_bytes;   /* that the device's bound counts */
} camber_mesh_memory;

CAMBER_API camber_mesh_memory camber_mesh_get_memory(const camber_mesh *mesh);

/* ---- Drawing --------------------------------------------------------------------------------------- */

/* A straight (not premultiplied) colour; each channel is 0 to 1. */
typedef struct camber_color {
    float r, g, b, a;
} camber_color;

/* Lengths that are drawn and left out in turn, from where a polyline begins. An odd count is gone through twice, as in
 * SVG; in a MapLibre style, the last dash of such a list runs on into the first. The ends of dashes are round where the
 * stroke's caps are, and straight elsewhere. */
typedef struct camber_dash {
    const float *lengths; /* count, in units of the paint's dash_unit_px; 0 or more each, and their sum is above 0 */
    size_t count;         /* 1 to CAMBER_DASH_LENGTHS_MAX */
} camber_dash;

#define CAMBER_DASH_LENGTHS_MAX 128

typedef struct camber_ramp_stop {
    float place; /* a share of the line's length, not below that of the stop before */
    camber_color color;
} camber_ramp_stop;

/* Colours along a line. Between two stops they are mixed as premultiplied ones; before the first stop and behind the
 * last one the colour is that of the stop. Two stops at one place are a step, whose edge has the exact area of the
 * pixel. */
typedef struct camber_ramp {
    const camber_ramp_stop *stops; /* count, their places ascending and finite, their colours finite */
    size_t count;                  /* 1 to CAMBER_RAMP_STOPS_MAX */
} camber_ramp;

#define CAMBER_RAMP_STOPS_MAX 4096

/* A picture to draw with: premultiplied RGBA8, rows from the top down. */
typedef struct camber_image {
    const uint8_t *rgba;
    uint32_t width, height; /* px; 1 to CAMBER_IMAGE_SIDE_MAX each */
    size_t stride_bytes;    /* from row to row. 0: 4 * width */
} camber_image;

#define CAMBER_IMAGE_SIDE_MAX 16384

/* A point is inside of rings by how often they wind around it: clockwise as seen counts 1, the other way -1. */
typedef enum camber_fill_rule {
    CAMBER_FILL_NONZERO = 0, /* a number of times that is not 0 in sum */
    CAMBER_FILL_EVENODD,     /* an odd number of times */
} camber_fill_rule;

/* A fill of areas, or of the whole picture: one colour, or copies of one image side by side. */
typedef struct camber_fill {
    camber_color color;
    const camber_image *image; /* in place of the colour, with the colour's alpha. NULL: none */
    float width_px, height_px; /* the size of one copy in the picture. 0: the image's own */
    float x_px, y_px;          /* where the top left corner of one copy lies in the picture */
    double bearing_deg;        /* of the map that the copies lie on, as a camera has it */
    camber_fill_rule rule;     /* of areas */
} camber_fill;

/* How a row is drawn in one pass. Dashes, trims, ramps and images need a mesh with arc lengths. Several paints may
 * point at one dash, ramp or image. Give equal ones one pointer: rows in turn then share it on the device. */
typedef struct camber_paint {
    /* 0: nothing is drawn. What the paint takes is at most as wide as the stroke: this, or gap_px + 2 width_px with a
     * gap. */
    float width_px;
    camber_color color;
    float gap_px; /* 0: none. Else the line is two rails, each as wide as width_px, and this is the room between them */
    float blur_px;                        /* 0: none. Else edges fade inwards, over so much more than a pixel */
    float translate_x_px, translate_y_px; /* from where the polyline lies to where it is drawn */
    bool smooth_blur;                     /* the blur fades by a smooth step, 3 t^2 - 2 t^3, in place of evenly */
    const camber_dash *dash;              /* NULL: none */
    float dash_unit_px;                   /* the unit of the dash's lengths. 0: 1 */
    /* Shares of the line's length, between which it is not drawn. A trim at an end takes the cap away too. Where
     * trim_end is not above trim_start, the line is whole. */
    float trim_start, trim_end;
    const camber_ramp *ramp; /* color is multiplied by it. NULL: none */
    /* The line shows this image in place of the colour, with the colour's alpha. One copy follows the other from where
     * the line begins. It is as high as the stroke is wide, with the gap, and its top lies to the right of the line's
     * direction. NULL: none. */
    const camber_image *image;
    float image_px; /* how much of the line one copy of the image takes. 0: as much as keeps the image's shape */
    /* The row's polylines are rings, and what lies inside of them is filled; beside this only the translation counts.
     * Areas of a pass that have one fill and follow each other are one path: where they meet or overlap there is no
     * seam, and a translucent fill covers each pixel once. Where the areas and lines of a pass alternate more than 64
     * times, or its lines need more than 32 layers, the areas lie below the lines. Close rings, as camber_areas_create
     * does: one that is open fills what lies to the right of it. NULL: lines are drawn. */
    const camber_fill *fill;
} camber_paint;

typedef enum camber_overlap {
    /* A translucent pass covers each pixel once, however often its lines cross it: coverage is gathered first and
     * composited once. Polylines that follow each other and have one alpha are flattened together, in a layer.
     * Where a pass would take more than 32 layers, all its polylines of one alpha come together, the faintest lowest.
     * Where such a pass has more than 16 alphas, one layer has them all, in which the last line alone is seen. */
    CAMBER_OVERLAP_FLATTEN = 0,
    CAMBER_OVERLAP_ACCUMULATE, /* overlaps of translucent lines darken */
    /* As FLATTEN. Opaque polylines that follow each other and have one colour are gathered and composited once as well.
     * Where edges of one or several lines meet in a pixel, the picture then has the area of all of them together.
     * Drawing one over the other misses that. This is more exact, and takes longer (docs/performance.md). */
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

/* One step of a frame: lines of a mesh, or a fill. */
typedef struct camber_pass {
    camber_pass_kind kind;
    camber_mesh *mesh; /* of the renderer that draws; not NULL for lines */
    size_t first_polyline;
    size_t polyline_count;      /* 0: to the last */
    const camber_paint *paints; /* paint_count, by row; a row at or past it is not drawn */
    size_t paint_count;
    camber_fill fill;
    camber_overlap overlap;
    float opacity; /* the pass is put onto the picture as one layer of this opacity. 0: 1, and no layer */
} camber_pass;

/* A picture: its passes, drawn one over the other. */
typedef struct camber_frame {
    uint32_t width, height;  /* px; 1 to 65535 each */
    camber_color background; /* zero: transparent */
    const camber_pass *passes;
    size_t pass_count;
    camber_coverage coverage;
    /* The picture is drawn in several areas where a side is longer than this. 0: the largest
     * target, or less where that would take more than 64 MB; a layer that is united takes 128 MB more. */
    uint32_t largest_area_px;
    /* The angle at which the plane of the polylines is seen: 0 is straight from above, 85 is the most. Meshes of a
     * network bring the pitch of their camera (camber_camera.pitch_deg), and a frame of them may leave this 0. Frames
     * of fills, and of meshes of polylines, set it.
     * The camera looks at the picture's centre, where a px of the plane is one of the picture. It sees 36.87 degrees
     * from the bottom to the top. Widths, dashes and translations lie in the plane; blurs do not. Nothing is drawn that
     * is farther than 6.7 times the distance of the centre: that lies at 85 % of the way to the horizon. */
    double pitch_deg;
} camber_frame;

typedef struct camber_frame_stats {
    size_t draw_calls;
    size_t areas;   /* that the picture was drawn in */
    double draw_ms; /* clear, draw and finish; for a frame that overlaps others, the time that its calls take */
    double read_ms;
    camber_stage_times times; /* of CAMBER_RASTERIZER_OPENCL's stages, on the device's queue */
} camber_frame_stats;

/* Takes row_count rows of the picture, from the top down: width * 4 bytes each, premultiplied RGBA8. Returns false to
 * stop the drawing. */
typedef bool camber_rows_fn(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count);

/* Draws a frame and hands its rows over.
 * rows may be NULL: the frame is drawn and finished, not read back. stats may be NULL.
 * Returns CAMBER_ERROR_ARGUMENT (a size or a pitch out of range, meshes of cameras with different pitches, a dash, a
 * ramp or an image that its own description does not allow, or any of these or a trim with a mesh without arc lengths),
 * CAMBER_ERROR_LIMIT (more rows of strokes and paints, or images of one pass, than textures hold, or in OpenCL images
 * of one frame than a buffer), CAMBER_ERROR_DEVICE (a shader or a kernel does not build, or GL or OpenCL reported an
 * error), CAMBER_ERROR_MEMORY, CAMBER_ERROR_IO (rows returned false). */
CAMBER_API camber_status camber_renderer_render(camber_renderer *renderer, const camber_frame *frame,
                                                camber_rows_fn *rows, void *user, camber_frame_stats *stats);

/* Kernels write pixels into the caller's memory where they begin at a multiple of so many bytes. */
#define CAMBER_PIXELS_ALIGNMENT 128

/* Draws a frame into memory of the caller: rows from the top down, stride_bytes from one to the next. That is width * 4
 * at least; 0 means just so much. rgba may not be NULL.
 * Where OpenCL draws on the host's processor, rgba is a multiple of CAMBER_PIXELS_ALIGNMENT, width and height are
 * multiples of 32, rows have no gaps and an area is as wide as the picture (to 8192 px, unless less memory is allowed),
 * kernels write there themselves. Elsewhere rows are copied.
 * stats, and what it returns, are as camber_renderer_render has them. The pixels are undefined on failure. */
CAMBER_API camber_status camber_renderer_render_into(camber_renderer *renderer, const camber_frame *frame,
                                                     uint8_t *rgba, size_t stride_bytes, camber_frame_stats *stats);

/* ---- Drawing into textures: for engines that draw more than lines ----------------------------------- */

/* A texture of the surface's GL context, or of one that shares its objects (camber_surface_desc). Pixels are
 * premultiplied: an engine puts them over its own by glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA). */
typedef struct camber_texture {
    uint32_t name;  /* a GL_TEXTURE_2D of GL_RGBA8, as wide and high as the frame */
    bool keep;      /* the frame lies over what the texture holds. false: in place of it */
    bool bottom_up; /* the picture's last row lies at t = 0, as in GL's framebuffers. false: its first row does */
    void *ready;    /* a GLsync behind what other contexts did to the texture, which GL waits for. NULL: none */
} camber_texture;

/* Draws a frame into a texture and reads nothing back. So an engine's pictures can lie below the lines and above them.
 * Renderers of both kinds, GL and OpenCL, can draw into one texture in turn. The surface's context stays current: make
 * your own one current again.
 * frame: the whole picture is one area, so its sides are the surface's largest_target_px at most.
 * drawn takes a GLsync behind the last command, which has been flushed. Another context waits for it by glWaitSync
 * before it uses the texture, and the caller deletes it. Where it is NULL after the call, all is done. Where drawn
 * itself is NULL, the call waits.
 * Returns what camber_renderer_render does, and CAMBER_ERROR_ARGUMENT (no such texture, another size or format, a
 * renderer without a surface), CAMBER_ERROR_LIMIT (a side too long). The texture's pixels are undefined on failure.
 * Layers take up to 25 bytes a px more. */
CAMBER_API camber_status camber_renderer_render_texture(camber_renderer *renderer, const camber_frame *frame,
                                                        const camber_texture *texture, void **drawn);

#ifdef __cplusplus
}
#endif

#endif
