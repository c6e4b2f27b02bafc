/* camber draws polylines as anti-aliased pictures. OpenCL kernels tessellate them; GLES shaders or OpenCL kernels draw
 * them.
 *
 *     polylines -> tessellation -> mesh -> renderer -> rows of RGBA8
 *
 * This header is the manual of libcamber. libcamber-map (camber_map.h) is built on it.
 *
 * Errors. A function that can fail returns a camber_status. It stores its result through the last parameter, which
 * stays untouched on failure. It sends a message to the context's log callback: one line that says what failed, where,
 * and how to fix it. Misuse (a NULL object, a count that contradicts a pointer) trips an assertion.
 *
 * Ownership. X_create makes an object; X_destroy frees it and accepts NULL. Inputs, and everything they point to, are
 * read only during the call, unless a comment says that the object keeps a pointer. An object must outlive the objects
 * made from it: context > device, surface > renderer > mesh.
 *
 * Descriptions. Every desc struct is valid when zeroed; each field says what zero means.
 *
 * Threads. Only one thread at a time may use a context and the objects made from it. Different contexts are
 * independent: several threads may each create and use their own at the same time.
 * The only global state belongs to the drivers and to GDAL; camber holds a lock while it sets them up for the first
 * time. A program that calls them itself must not do so during camber's first call. Drivers read and set environment
 * variables when camber first looks for devices: until that is done, no other thread may read or change the
 * environment.
 * Each call that needs a surface's GL context makes it current on the calling thread. It stays current there until
 * camber_surface_release.
 *
 * Processes. Drivers do not survive fork(). If a process has looked for devices, then in its children everything that
 * needs a device, even a new one, fails with CAMBER_ERROR_DEVICE. Fork before camber's first call, or call exec in the
 * child.
 *
 * Units. Pixels are device pixels, x to the right, y down; pixel centres are at .5. */
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
    CAMBER_ERROR_ARGUMENT,  /* a value that the user chose is out of range or cannot be parsed */
    CAMBER_ERROR_INPUT,     /* input data is not in the format it claims, or is truncated */
    CAMBER_ERROR_NOT_FOUND, /* no such file */
    CAMBER_ERROR_DEVICE,    /* there is no usable OpenCL device or GL back end, or a program does not build */
    CAMBER_ERROR_IO,        /* reading or writing failed, for example because the disk is full */
    CAMBER_ERROR_LIMIT,     /* more than 32-bit vertex indices, a buffer or a render target can hold */
} camber_status;

/* A short English name of the status; never NULL. */
CAMBER_API const char *camber_status_get_name(camber_status status);

/* The version of the library in use, as "0.1.0". */
CAMBER_API const char *camber_version(void);

/* ---- Budget: how much a run may take because of its files ----------------------------------------- */

/* A small file can ask for more memory than the machine has, so a budget sets limits. A call that would exceed one
 * fails with CAMBER_ERROR_MEMORY or CAMBER_ERROR_LIMIT, and the log says which limit it was. */
typedef struct camber_budget_desc {
    /* The memory limit for all contexts of the budget together. It counts blocks from the allocator, and OpenCL buffers
     * in the host's memory. Memory that other libraries allocate is not counted.
     *
     * 0: three quarters of the memory that this process can still get, judged by the machine's free memory, the control
     * group and the process's own limits. This is fixed when the budget first holds 64 MB, or when the limit is first
     * asked for. */
    uint64_t memory_bytes;
    /* The following limits apply to each set of features: */
    uint64_t tiles;  /* vector tiles that are looked for. 0: 262144 */
    uint64_t steps;  /* steps that databases may take to answer, plus 4096 per tile. 0: 2^26, a few seconds */
    uint32_t unfold; /* inflate ratio: bytes that tiles may unpack to for each byte of their files, plus 4 MB. 0: 32 */
} camber_budget_desc;

typedef struct camber_budget camber_budget;

/* Makes a budget. A budget must outlive its contexts, which different threads may use at the same time.
 * desc may be NULL.
 * Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_budget_create(const camber_budget_desc *desc, camber_budget **budget);
CAMBER_API void camber_budget_destroy(camber_budget *budget);
/* Returns how many bytes the budget's contexts hold now. */
CAMBER_API uint64_t camber_budget_get_held_bytes(const camber_budget *budget);
/* Returns the memory limit in bytes. If the desc left it 0, the first call fixes it. */
CAMBER_API uint64_t camber_budget_get_most_bytes(camber_budget *budget);

/* ---- Access: what files may reach ------------------------------------------------------------------ */

/* camber opens the files that the caller names, the files that a style names, and the companion files of a format
 * (.shx, .dbf, .prj, -wal). It never opens a link to a device or a pipe, and it downloads nothing. */
typedef struct camber_access {
    bool remote; /* input files may be on the network, or refer to it */
    bool vrt;    /* input files may refer to other files (VRT) */
    /* The folder that must contain every file that a style names: sources, TileJSON, tiles, sprites. NULL: they may be
     * anywhere. */
    const char *root;
    /* Files that are about to be replaced, so that nothing may read them. NULL: none. */
    const char *outputs[4];
} camber_access;

/* ---- Context: allocator, log, cache -------------------------------------------------------------- */

typedef enum camber_log_level {
    CAMBER_LOG_ERROR = 0, /* the message of a failure, which a status reports too */
    CAMBER_LOG_WARNING,   /* something was left out or repaired; logged once per cause */
    CAMBER_LOG_INFO,      /* what was chosen and how long it took */
} camber_log_level;

/* Receives a message from the library. message is one line without a newline; it is valid only during the call. */
typedef void camber_log_fn(void *user, camber_log_level level, const char *message);

/* How far a long call is. */
typedef struct camber_progress_info {
    const char *stage;    /* what is being done, such as "drawing tiles" */
    double fraction;      /* 0 to 1; negative: the end is not known */
    const char *unit;     /* what is counted, in the plural, such as "tiles". NULL: nothing is counted */
    uint64_t done, total; /* in units; total 0: not known */
} camber_progress_info;

/* Receives the progress of a long call, on the thread that made the call. Both are valid only during the call. */
typedef void camber_progress_fn(void *user, const camber_progress_info *progress);

typedef struct camber_context_desc {
    /* Works like realloc, and frees the block if the size is 0. NULL: the C library's functions. */
    void *(*reallocate)(void *user, void *block, size_t size_bytes);
    void *allocator_user;
    camber_log_fn *log; /* NULL: messages are discarded */
    void *log_user;
    camber_progress_fn *progress; /* NULL: none */
    void *progress_user;
    /* Folder for compiled kernels and linked shaders. NULL: $XDG_CACHE_HOME/camber, else ~/.cache/camber; "": no cache.
     * It is not an error if the folder cannot be written. camber looks for kernels first in a folder that all users
     * share (camber_device_warm); $CAMBER_KERNELS can name another. */
    const char *cache_dir;
    camber_budget *budget; /* NULL: the context gets its own, with a zeroed desc */
    camber_access access;  /* its strings are copied */
} camber_context_desc;

typedef struct camber_context camber_context;

/* Makes a context. desc may be NULL.
 * Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_context_create(const camber_context_desc *desc, camber_context **context);
CAMBER_API void camber_context_destroy(camber_context *context);

/* ---- Polylines ----------------------------------------------------------------------------------- */

typedef struct camber_polylines_desc {
    /* point_count pairs of x, y in pixels. If both ends of a segment are within 30,000 px of the picture, float
     * rounding changes its edges by at most 1 level of 255. At 100,000 px it is 4 levels, at a million 30: clip such
     * segments first. */
    const float *points;
    size_t point_count;
    const uint32_t *offsets; /* polyline_count + 1 indices into points, ascending, from 0 to point_count */
    size_t polyline_count;
    const uint32_t *rows; /* polyline_count indices into the strokes, below 2^24. NULL: all 0 */
    /* false: a polyline whose first and last points are equal is a ring, with a join where they meet.
     * true: such a polyline has caps at its ends like any other. */
    bool keep_open;
} camber_polylines_desc;

/* Counts from cleaning polylines. Everything that is dropped is counted here. */
typedef struct camber_polylines_stats {
    size_t polylines;       /* as given */
    size_t points;          /* as given */
    size_t kept_points;     /* points that are tessellated */
    size_t kept_segments;   /* segments that are tessellated */
    size_t rings;           /* closed polylines */
    size_t dots;            /* polylines with one distinct point, which round and square caps draw as a dot */
    size_t empty_polylines; /* polylines without a point */
    size_t repeated_points; /* dropped: at most 1e-9 px from the previous point */
    size_t invalid_points;  /* dropped: NaN, infinite, or beyond 1e9 px; the polyline is split there */
} camber_polylines_stats;

typedef struct camber_polylines camber_polylines;

/* Cleans polylines and copies them into the layout that the kernels read. A polyline that is split at invalid points
 * keeps its index and its row.
 * Returns CAMBER_ERROR_INPUT (offsets that do not ascend from 0 to point_count, a row of 2^24 or more),
 * CAMBER_ERROR_LIMIT (more than 2.5 * 10^9 points), CAMBER_ERROR_MEMORY.
 * Cost: one pass over the points. */
CAMBER_API camber_status camber_polylines_create(camber_context *context, const camber_polylines_desc *desc,
                                                 camber_polylines **polylines);
CAMBER_API void camber_polylines_destroy(camber_polylines *polylines);
CAMBER_API camber_polylines_stats camber_polylines_get_stats(const camber_polylines *polylines);

/* ---- Areas: rings that are filled ------------------------------------------------------------------ */

/* Areas as rings. A ring need not repeat its first point at the end; it is closed in any case. */
typedef struct camber_areas_desc {
    const float *points; /* point_count pairs of x, y in pixels */
    size_t point_count;
    const uint32_t *offsets; /* ring_count + 1 indices into points, ascending, from 0 to point_count */
    size_t ring_count;
    /* area_count + 1 indices into the rings, ascending, from 0 to ring_count. The first ring of an area is its outer
     * ring, and the others are holes. NULL: each ring is an area, and area_count is ignored. */
    const uint32_t *rings;
    size_t area_count;
    const uint32_t *rows; /* one per area, as in camber_polylines_desc. NULL: all 0 */
} camber_areas_desc;

/* Makes a closed polyline from each ring, for passes whose paints have a fill. The call orients outer rings clockwise
 * as seen, judged by their signed area, and holes counter-clockwise. It drops invalid points and connects their
 * neighbours. A ring with fewer than three distinct points has no area, but can still be drawn as a line.
 * Returns the errors of camber_polylines_create, and CAMBER_ERROR_INPUT if the ring indices do not ascend from 0 to
 * ring_count. */
CAMBER_API camber_status camber_areas_create(camber_context *context, const camber_areas_desc *desc,
                                             camber_polylines **areas);

/* ---- Strokes: how wide, which joins and caps ------------------------------------------------------ */

typedef enum camber_join {
    CAMBER_JOIN_ROUND = 0,
    CAMBER_JOIN_MITER, /* a bevel if the miter limit is exceeded */
    CAMBER_JOIN_BEVEL,
} camber_join;

typedef enum camber_cap {
    CAMBER_CAP_BUTT = 0,
    CAMBER_CAP_ROUND,
    CAMBER_CAP_SQUARE,
} camber_cap;

/* The geometry of a stroke: one row of the style table, as the tessellation needs it. */
typedef struct camber_stroke {
    /* The largest width that any pass will draw the mesh with. 0 to 16384 px. */
    float width_px;
    camber_join join;
    camber_cap cap;
    /* The largest ratio of miter length to width, as in SVG: 1 / cos(turn / 2). 0: 2. */
    float miter_limit;
    /* How far to the side of its polyline the line is drawn: positive is to the right of the polyline's direction as
     * seen, negative to the left. -16384 to 16384 px. Its corners follow the join: arcs (to within 1/8 px), miters
     * within the limit, or bevels. Parts that have no room on the inner side of a bend are left out. Dots are not
     * moved. */
    float offset_px;
    /* A round join becomes a miter join if its ratio of miter length to width is less than this, or a bevel if it
     * exceeds the miter limit.
     * 0: all round joins stay round. */
    float round_limit;
} camber_stroke;

/* ---- Devices -------------------------------------------------------------------------------------- */

typedef enum camber_device_type {
    CAMBER_DEVICE_TYPE_OTHER = 0,
    CAMBER_DEVICE_TYPE_CPU,
    CAMBER_DEVICE_TYPE_GPU,
} camber_device_type;

typedef struct camber_device_info {
    char name[128];
    char platform[128];
    char version[128]; /* "OpenCL 3.0 ...", or the compiler of fixed kernels */
    char driver[64];
    camber_device_type type;
    uint32_t compute_units;
    uint64_t memory_bytes;
    uint64_t largest_buffer_bytes; /* for an open device: what its desc allows, if that is less */
    bool gl_sharing;               /* cl_khr_gl_sharing */
    /* The processor itself, whose kernels were compiled with the library. The work-group size and the lanes of a desc
     * must be 0. */
    bool fixed_kernels;
} camber_device_info;

/* Sets *info to the n-th device, counted from 0, of the devices that match names, or to NULL past the last one. match
 * is as in camber_device_desc; NULL: all devices. The first call for a context looks for devices. The infos live as
 * long as the context. Returns CAMBER_ERROR_MEMORY, also if the process has too little address space for the drivers
 * (ulimit -v). */
CAMBER_API camber_status camber_device_list(camber_context *context, const char *match, size_t n,
                                            const camber_device_info **info);

typedef enum camber_gl_display { CAMBER_GL_DISPLAY_EGL, CAMBER_GL_DISPLAY_GLX } camber_gl_display;

/* A GL context that a device can share buffers with, as camber_surface_get_handles gives it. Zero: there is none. */
typedef struct camber_gl_handles {
    intptr_t context, display;
    camber_gl_display display_kind;
    uint64_t largest_buffer_bytes; /* the largest buffer that the context's shaders can read. 0: no limit */
} camber_gl_handles;

typedef struct camber_device_desc {
    /* "cpu", "gpu", or part of the name, platform or version of a device ("opencl", "pocl"); case is ignored. NULL: a
     * GPU, else a CPU. */
    const char *match;
    /* Which of the matching devices to open, in the order of camber_device_list: 1 is the first. 0: the first
     * GPU, else the first CPU. */
    uint32_t number;
    /* Work-group size of all kernels: 64, 128 or 256 points. It affects only speed; the output is the same, byte for
     * byte.
     * 0 (recommended): chosen for the device. */
    uint32_t work_group_size;
    /* Number of lanes in the vectors that OpenCL draws with: 1, 8 or 16. It affects only speed; the output is the same,
     * byte for byte.
     * 0 (recommended): as wide as a CPU's own vectors of floats, and 1 on other devices. */
    uint32_t lanes;
    /* The largest size of a buffer, at least 4096. A mesh that needs more is made in parts of whole polylines, which
     * does not change how it is read or drawn. 0, or more than the device allows: the device's own limit, below 2^31
     * bytes. */
    uint64_t largest_buffer_bytes;
    /* The memory limit for all meshes of the device together, at least 65536. It counts points, joins, records, indices
     * (twice if they are copied), strokes and networks. It does not count polylines on the host, data that is read
     * back, or pictures.
     * A mesh is made in parts of an eighth of the limit or less. A part that does not fit is tessellated again when it
     * is read or drawn, to the same bytes and pixels. A polyline may take half of the limit, at about 50 bytes per
     * visible point. A renderer that draws in OpenCL reserves a quarter of the limit; if a quarter is less than 4 MB,
     * the renderer takes 4 MB in addition to the limit instead. A picture that needs more is drawn in slices, to the
     * same bytes.
     * 0: three quarters of the device's memory, or no limit if the device uses the host's memory. */
    uint64_t memory_bytes;
    /* Threads of a CPU with fixed kernels, including the caller's. OpenCL's drivers decide this themselves. 0: one for
     * each core that the process may use, but no more than the CPU quota of its control group pays for. */
    uint32_t threads;
    /* The surface whose renderers will draw the device's meshes in GL. Zero: none, so buffers are copied. */
    camber_gl_handles gl;
} camber_device_desc;

typedef struct camber_device camber_device;

/* Opens a device. desc may be NULL.
 * Returns CAMBER_ERROR_DEVICE (no platform, no matching device, or fewer matching devices than number),
 * CAMBER_ERROR_ARGUMENT (an invalid work-group size or number of lanes, a largest buffer below 4096 bytes, a memory
 * limit below 65536), CAMBER_ERROR_MEMORY.
 * No kernel is built here: the kernels of a method are built, or loaded from the cache, when it is first used. Kernels
 * of a device with fixed_kernels are part of the library. Its calls run kernels on the caller's thread, too, which
 * needs 256 KB of stack. */
CAMBER_API camber_status camber_device_create(camber_context *context, const camber_device_desc *desc,
                                              camber_device **device);
CAMBER_API void camber_device_destroy(camber_device *device);

/* The work that a call of camber_device_warm did. */
typedef struct camber_warm_result {
    size_t programs;   /* programs in the share */
    size_t built;      /* programs that were built; the others were in the cache */
    size_t kept;       /* programs that are in the folder now. 0 if the driver does not let its kernels be saved. All if
                        * the device has fixed_kernels */
    char folder[1024]; /* where they are; "": nowhere, because no folder can be written, or they are in the library */
} camber_warm_result;

/* Builds all kernels that the device can be asked for, and saves those that the cache lacks, so that later runs can
 * load them. They are saved in the folder camber-kernels next to the library, which all users of the machine can read,
 * or, if that folder cannot be written, to the user's cache. Kernels for other devices, drivers or versions of camber
 * are not touched.
 * share is less than shares. Several processes can build at the same time, each of them its own share. Share 0 of 1 has
 * all programs. Returns CAMBER_ERROR_ARGUMENT (no such share), CAMBER_ERROR_DEVICE (kernels that do not build),
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_device_warm(camber_device *device, unsigned share, unsigned shares,
                                            camber_warm_result *result);
CAMBER_API camber_device_info camber_device_get_info(const camber_device *device);

typedef struct camber_device_memory {
    uint64_t allowed_bytes; /* the memory limit of the device's meshes and renderers (camber_device_desc). 0: none */
    uint64_t held_bytes, most_bytes; /* counted against the limit: now, and the peak since the device was opened */
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
    /* The caller's GLES context (EGLContext) and its initialised display (EGLDisplay). The surface makes a context of
     * its own, which shares textures and fences with the caller's (camber_renderer_render_texture), but no state. This
     * needs EGL. NULL: none. */
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

/* Returns whether GL on such a surface may be hardware; camber_surface_info.software of an open surface is definite.
 * false: GL would be a software rasteriser or is missing, and OpenCL draws the same picture faster.
 * desc may be NULL.
 * The call takes a few microseconds. It looks for the files through which GPU drivers are reached (on Linux in /dev,
 * such as render nodes), and loads no GL library. */
CAMBER_API bool camber_surface_may_be_hardware(const camber_surface_desc *desc);

/* Makes a surface. desc may be NULL.
 * Returns CAMBER_ERROR_DEVICE (the library or the driver is missing, or a context cannot share objects with the
 * caller's), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_surface_create(camber_context *context, const camber_surface_desc *desc,
                                               camber_surface **surface);
CAMBER_API void camber_surface_destroy(camber_surface *surface);
/* Returns the surface's GL context for camber_device_desc.gl. If surface is NULL, the handles are zero. */
CAMBER_API camber_gl_handles camber_surface_get_handles(const camber_surface *surface);
/* Releases the GL context on the calling thread, so that another thread can use the surface. */
CAMBER_API void camber_surface_release(camber_surface *surface);
/* Returns whether the GL context is lost, which happens when the GPU is reset or its driver restarts. Calls that need
 * the context then return CAMBER_ERROR_DEVICE. To recover, destroy the meshes, the renderers, the surface, and a device
 * that was opened with the surface, and create them again in the same process. Polylines and scenes remain valid. */
CAMBER_API bool camber_surface_is_lost(const camber_surface *surface);
/* Returns a description of the surface. The strings live as long as the surface. */
CAMBER_API camber_surface_info camber_surface_get_info(const camber_surface *surface);

/* ---- Renderer -------------------------------------------------------------------------------------- */

typedef enum camber_sharing {
    CAMBER_SHARING_AUTO = 0,  /* the first of the following that works */
    CAMBER_SHARING_GL,        /* cl_khr_gl_sharing: OpenCL writes the GL buffer on the GPU */
    CAMBER_SHARING_ZERO_COPY, /* the OpenCL buffer is a persistent mapping of the GL buffer */
    CAMBER_SHARING_COPY,      /* copies through host memory, which works anywhere */
} camber_sharing;

/* How frames are drawn. */
typedef enum camber_rasterizer {
    /* GL if the surface's GL is hardware. OpenCL if there is no surface, or if its GL is a software rasteriser, which
     * takes several times as long for the same picture. A program that wants pictures in memory should open a surface
     * only if camber_surface_may_be_hardware returns true. */
    CAMBER_RASTERIZER_AUTO = 0,
    CAMBER_RASTERIZER_GL,     /* GLES shaders */
    CAMBER_RASTERIZER_OPENCL, /* OpenCL kernels, which need no surface */
} camber_rasterizer;

typedef struct camber_renderer_desc {
    camber_sharing sharing; /* if not AUTO, camber_renderer_create fails unless this path works */
    camber_rasterizer rasterizer;
} camber_renderer_desc;

typedef struct camber_renderer camber_renderer;

/* Makes a renderer, which draws frames of the meshes that are created for it.
 * surface may be NULL if OpenCL draws, since OpenCL needs no GL for pictures. If OpenCL draws and there is a surface,
 * only camber_renderer_render_texture uses it, and pixels reach it by the sharing path. desc may be NULL.
 * Returns CAMBER_ERROR_DEVICE (the requested sharing path does not work), CAMBER_ERROR_MEMORY.
 * No shader is built here: each is built when it is first used. */
CAMBER_API camber_status camber_renderer_create(camber_device *device, camber_surface *surface,
                                                const camber_renderer_desc *desc, camber_renderer **renderer);
CAMBER_API void camber_renderer_destroy(camber_renderer *renderer);
/* Releases the memory that kernels keep for the next frame, which then allocates it again. Call it before work that
 * needs the memory, such as encoding the picture. */
CAMBER_API void camber_renderer_trim(camber_renderer *renderer);
/* Returns the sharing path in use. CAMBER_SHARING_AUTO: there is no surface, so nothing is shared. */
CAMBER_API camber_sharing camber_renderer_get_sharing(const camber_renderer *renderer);
/* Returns the rasterizer that draws: GL or OpenCL, never AUTO. */
CAMBER_API camber_rasterizer camber_renderer_get_rasterizer(const camber_renderer *renderer);
/* The name of a rasterizer: "auto", "gl" or "cl". */
CAMBER_API const char *camber_rasterizer_get_name(camber_rasterizer rasterizer);
/* The name of a sharing path: "cl_khr_gl_sharing", "zero copy" or "copy". */
CAMBER_API const char *camber_sharing_get_name(camber_sharing sharing);

/* ---- Times of stages -------------------------------------------------------------------------------- */

/* How long a stage's kernels took. The set of stages and their names may change from version to version. */
typedef struct camber_stage_time {
    const char *name; /* owned by the library: "classify", ... */
    double ms;
} camber_stage_time;

#define CAMBER_STAGE_TIMES_MAX 24

typedef struct camber_stage_times {
    size_t count;
    camber_stage_time stages[CAMBER_STAGE_TIMES_MAX]; /* count of them, in the order in which they run */
} camber_stage_times;

/* Returns the time of the stage with that name. 0: the stage did not run, or no stage has that name. */
CAMBER_API double camber_stage_times_get_ms(const camber_stage_times *times, const char *name);

/* ---- Meshes ---------------------------------------------------------------------------------------- */

typedef enum camber_method {
    CAMBER_METHOD_STRIP = 0, /* two vertices per point, cut along the bisectors: one strip per polyline */
    CAMBER_METHOD_KITE,      /* bodies, and two triangles per round join */
    CAMBER_METHOD_FAN,       /* bodies, and a fan of triangles per round join */
} camber_method;

/* The name of a method: "strip", "kite" or "fan". */
CAMBER_API const char *camber_method_get_name(camber_method method);

typedef struct camber_tessellation_desc {
    const camber_stroke *strokes; /* stroke_count rows; every row of the polylines must be less than stroke_count */
    size_t stroke_count;
    camber_method method;
    float fan_tolerance_px; /* how far a fan's chord may be from its arc; at most 64 chords per half turn. 0: 0.25 */
    /* Each record stores how far along its polyline it is, which dashes, trims, ramps and images need. A record then
     * takes 32 bytes. */
    bool has_arc_length;
} camber_tessellation_desc;

/* How far the geometry reaches past the stroke's edge, so that every pixel an edge touches is shaded: exact
 * coverage reaches sqrt(1/2) px from the edge. */
#define CAMBER_PAD_PX 0.75f

typedef struct camber_mesh_info {
    camber_method method;
    bool strips;         /* triangle strips; else triangles */
    bool has_arc_length; /* as in the desc of the tessellation */
    /* If the mesh's renderer draws in OpenCL, it needs only points. The next three are then 0 until
     * camber_mesh_count_joins is called. */
    size_t record_count;      /* camber_record */
    size_t vertex_count;      /* for strips two per record, including the records between strips */
    size_t index_count;       /* for strips one per vertex, although none is stored */
    size_t bytes;             /* stored for drawing: points, or records, and the indices of kite and fan */
    size_t triangle_count;    /* non-degenerate; this and the following counts are 0 until camber_mesh_count_joins */
    size_t joins;             /* points with a join; the next two are among them */
    size_t tight_joins;       /* the inner side has no room: (h + pad) tan(turn / 2) > half the shorter neighbour */
    size_t split_joins;       /* turns past 127 degrees */
    size_t undrawn_dots;      /* dots with butt caps, which have no area */
    camber_stage_times times; /* of the last tessellation's stages; kernels classify when they first draw its lines */
} camber_mesh_info;

typedef struct camber_mesh camber_mesh;

/* Makes an empty mesh.
 * renderer will draw the mesh. NULL: the mesh can be read, but not drawn.
 * Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_mesh_create(camber_device *device, camber_renderer *renderer, camber_mesh **mesh);
CAMBER_API void camber_mesh_destroy(camber_mesh *mesh);
/* Gets a second mesh for the same renderer, which lives as long as this one, for things that are drawn among its lines,
 * such as labels. The first call makes the companion, which may have a companion, too. Tessellating a mesh empties its
 * companion.
 * Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_mesh_get_companion(camber_mesh *mesh, camber_mesh **companion);

/* Tessellates on the device, and replaces the mesh's earlier content. The output is in input order, and is the same
 * from run to run, byte for byte. The mesh keeps the polylines: a second call with the same object and other strokes
 * uploads nothing. A device that uses the host's memory borrows them (zero copy): after camber_polylines_destroy their
 * memory is freed only when the mesh takes other polylines or is destroyed.
 * Returns CAMBER_ERROR_ARGUMENT (a width or a limit that is not a number or out of range, a row without a
 * stroke), CAMBER_ERROR_LIMIT (more than 2^30 records of strips or 2^25 of kite and fan, or a polyline that needs more
 * than the largest buffer or half of the device's memory limit), CAMBER_ERROR_MEMORY, CAMBER_ERROR_DEVICE (a kernel
 * does not build: the log has the build log).
 * The first use of a method compiles its kernels, or loads them from the cache. After that the cost is linear in the
 * number of points. */
CAMBER_API camber_status camber_mesh_tessellate(camber_mesh *mesh, const camber_polylines *polylines,
                                                const camber_tessellation_desc *desc);
/* Returns a description of the last tessellation. Some counts are 0 until camber_mesh_count_joins is called (see
 * camber_mesh_info). */
CAMBER_API camber_mesh_info camber_mesh_get_info(const camber_mesh *mesh);
/* Counts the joins, triangles, records, vertices and indices of the last tessellation, unless they have been counted
 * already. camber_mesh_read counts them too.
 * Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_DEVICE, and the errors of camber_mesh_tessellate if a part has to be
 * tessellated again.
 * Cost: one pass over the points. */
CAMBER_API camber_status camber_mesh_count_joins(camber_mesh *mesh);

/* ---- Drawing --------------------------------------------------------------------------------------- */

/* A straight (not premultiplied) colour; each channel is 0 to 1. */
typedef struct camber_color {
    float r, g, b, a;
} camber_color;

/* Lengths of dashes and gaps in turn, from the start of a polyline. A list with an odd count is repeated twice, as in
 * SVG; in a MapLibre style, the last dash of such a list runs on into the first. The ends of dashes are round if the
 * stroke's caps are round, and straight otherwise. */
typedef struct camber_dash {
    /* count of them, in units of the paint's dash_unit_px; each is 0 or more, and their sum is above 0 */
    const float *lengths;
    size_t count; /* 1 to CAMBER_DASH_LENGTHS_MAX */
} camber_dash;

#define CAMBER_DASH_LENGTHS_MAX 128

typedef struct camber_ramp_stop {
    float place; /* a fraction of the line's length, not less than the previous stop's */
    camber_color color;
} camber_ramp_stop;

/* Colours along a line. Between two stops, colours are interpolated premultiplied; before the first stop and after the
 * last one, the colour is that of this stop. Two stops at the same position make a step, whose edge is anti-aliased by
 * exact area. */
typedef struct camber_ramp {
    const camber_ramp_stop *stops; /* count of them; positions ascend and are finite, colours are finite */
    size_t count;                  /* 1 to CAMBER_RAMP_STOPS_MAX */
} camber_ramp;

#define CAMBER_RAMP_STOPS_MAX 4096

/* An image to draw with: premultiplied RGBA8, rows from the top down. */
typedef struct camber_image {
    const uint8_t *rgba;
    uint32_t width, height; /* px; 1 to CAMBER_IMAGE_SIDE_MAX each */
    size_t stride_bytes;    /* from one row to the next. 0: 4 * width */
} camber_image;

#define CAMBER_IMAGE_SIDE_MAX 16384

/* How the winding number decides whether a point is inside rings. A ring that winds around the point clockwise as seen
 * adds 1 to the number, one that winds counter-clockwise adds -1. */
typedef enum camber_fill_rule {
    CAMBER_FILL_NONZERO = 0, /* inside if the winding number is not 0 */
    CAMBER_FILL_EVENODD,     /* inside if the winding number is odd */
} camber_fill_rule;

/* A fill for areas or for the whole picture: one colour, or one image repeated side by side. */
typedef struct camber_fill {
    camber_color color;
    const camber_image *image; /* drawn instead of the colour, with the colour's alpha. NULL: none */
    float width_px, height_px; /* the size of one copy in the picture. 0: the image's own */
    float x_px, y_px;          /* the top left corner of one copy in the picture */
    double bearing_deg;        /* bearing of the map that the copies are drawn on, as in camber_camera */
    camber_fill_rule rule;     /* decides what is inside an area */
} camber_fill;

/* How the lines of a row are drawn in one pass. Dashes, trims, ramps and images need a mesh with arc lengths. Several
 * paints may point to the same dash, ramp or image. Use the same pointer for equal ones, so that consecutive rows share
 * them on the device. */
typedef struct camber_paint {
    /* 0: nothing is drawn. The drawn line is width_px wide, or gap_px + 2 width_px if it has a gap; it may be at most
     * as wide as the stroke. */
    float width_px;
    camber_color color;
    float gap_px; /* 0: none. Otherwise the line is two rails, each width_px wide, and this is the space between them */
    float blur_px;                        /* 0: none. Otherwise edges fade inwards, over this distance plus one pixel */
    float translate_x_px, translate_y_px; /* moves the line from its polyline to where it is drawn */
    bool smooth_blur;                     /* the blur fades by a smooth step, 3 t^2 - 2 t^3, instead of evenly */
    const camber_dash *dash;              /* NULL: none */
    float dash_unit_px;                   /* the unit of the dash's lengths. 0: 1 */
    /* The line is not drawn between these two fractions of its length. A trim at an end removes the cap too. If
     * trim_end is not greater than trim_start, the whole line is drawn. */
    float trim_start, trim_end;
    const camber_ramp *ramp; /* color is multiplied by it. NULL: none */
    /* The line shows this image instead of the colour, with the colour's alpha, repeated from the start of the line. A
     * copy is as high as the stroke is wide, including the gap, and its top is on the right of the line's direction.
     * NULL: none. */
    const camber_image *image;
    float image_px; /* length of the line that one copy takes. 0: the length that keeps the image's aspect ratio */
    /* The row's polylines are rings, and their inside is filled; apart from this only the translation matters.
     * Consecutive areas of a pass with the same fill are one path: there is no seam where they meet or overlap, and a
     * translucent fill covers each pixel once. If the areas and lines of a pass alternate more than 64 times, or its
     * lines need more than 32 layers, all areas are drawn below the lines. Close the rings, as camber_areas_create
     * does: an open ring fills everything to its right. NULL: lines are drawn. */
    const camber_fill *fill;
} camber_paint;

typedef enum camber_overlap {
    /* A translucent pass covers each pixel once, however often its lines cross it: coverage is accumulated first and
     * composited once. Consecutive polylines with the same alpha are flattened together, in a layer. If a pass would
     * need more than 32 layers, all its polylines with the same alpha share a layer, the faintest at the bottom. If
     * such a pass has more than 16 alphas, all its polylines share one layer, in which only the last line at a pixel is
     * seen. */
    CAMBER_OVERLAP_FLATTEN = 0,
    CAMBER_OVERLAP_ACCUMULATE, /* overlaps of translucent lines darken */
    /* Like FLATTEN, but consecutive opaque polylines with the same colour are accumulated and composited once as well.
     * If edges of one or more lines meet in a pixel, the pixel then gets the exact area of their union, which drawing
     * one over the other misses. This is more exact and takes longer (docs/performance.md). */
    CAMBER_OVERLAP_UNITE,
} camber_overlap;

typedef enum camber_coverage {
    CAMBER_COVERAGE_EXACT = 0, /* the exact area of a pixel under a straight edge */
    CAMBER_COVERAGE_LINEAR,    /* a linear ramp one pixel wide across the edge: cheaper, with about twice the error */
} camber_coverage;

typedef enum camber_pass_kind {
    CAMBER_PASS_LINES = 0, /* draws polylines of a mesh, in order */
    CAMBER_PASS_FILL,      /* fills the picture; only fill and opacity of the pass are read */
} camber_pass_kind;

/* One step of a frame: lines of a mesh, or a fill. */
typedef struct camber_pass {
    camber_pass_kind kind;
    camber_mesh *mesh; /* created for the renderer that draws; not NULL for lines */
    size_t first_polyline;
    size_t polyline_count;      /* 0: to the last */
    const camber_paint *paints; /* paint_count of them, indexed by row; rows at or past paint_count are not drawn */
    size_t paint_count;
    camber_fill fill;
    camber_overlap overlap;
    float opacity; /* the pass is composited onto the picture as one layer with this opacity. 0: 1, and no layer */
    /* The polylines are in px of the picture as it is seen, whatever its pitch, and so are their paints' lengths: for
     * labels that stand upright. false: both are in the plane. It makes no difference without a pitch, or to fills. */
    bool upright;
} camber_pass;

/* A picture, made by drawing its passes one over the other. */
typedef struct camber_frame {
    uint32_t width, height;  /* px; 1 to 65535 each */
    camber_color background; /* zero: transparent */
    const camber_pass *passes;
    size_t pass_count;
    camber_coverage coverage;
    /* If a side is longer than this, the picture is drawn in several rectangles (areas). 0: the largest render target,
     * or less if that would take more than 64 MB; a UNITE layer takes 128 MB more. */
    uint32_t largest_area_px;
    /* The angle at which the plane of the polylines is seen: 0 is straight from above, 85 is the largest. A mesh of a
     * network has the pitch of its camera (camber_camera.pitch_deg), so a frame with such a mesh may leave this 0.
     * Frames of fills, and of meshes of polylines, must set it.
     * The camera looks at the picture's centre, where one px of the plane is one px of the picture. Its vertical field
     * of view is 36.87 degrees. Widths, dashes and translations are measured in the plane; blurs are not. Nothing is
     * drawn beyond 6.7 times the distance to the centre, which is at 85 % of the way to the horizon. */
    double pitch_deg;
} camber_frame;

typedef struct camber_frame_stats {
    size_t draw_calls;
    size_t areas;   /* rectangles that the picture was drawn in */
    double draw_ms; /* to clear, draw and finish; for a frame that overlaps others, the time that its calls take */
    double read_ms;
    camber_stage_times times; /* the stages of CAMBER_RASTERIZER_OPENCL, on the device's queue */
} camber_frame_stats;

/* Receives row_count rows of the picture, from the top down: width * 4 bytes each, premultiplied RGBA8. Returns false
 * to stop drawing. */
typedef bool camber_rows_fn(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count);

/* Draws a frame and passes its rows to `rows`.
 * rows may be NULL: the frame is then drawn and finished, but not read back. stats may be NULL.
 * Returns CAMBER_ERROR_ARGUMENT (a size or a pitch out of range; meshes whose cameras have different pitches; a dash, a
 * ramp or an image that breaks the rules of its own description; a dash, a ramp, an image or a trim with a mesh without
 * arc lengths), CAMBER_ERROR_LIMIT (more rows of strokes and paints, or more images in one pass, than textures can
 * hold; in OpenCL, more images in one frame than a buffer can hold), CAMBER_ERROR_DEVICE (a shader or a kernel does not
 * build, or GL or OpenCL reported an error), CAMBER_ERROR_MEMORY, CAMBER_ERROR_IO (rows returned false). */
CAMBER_API camber_status camber_renderer_render(camber_renderer *renderer, const camber_frame *frame,
                                                camber_rows_fn *rows, void *user, camber_frame_stats *stats);

/* The alignment in bytes that the caller's pixels need, so that kernels can write them in place. */
#define CAMBER_PIXELS_ALIGNMENT 128

/* Draws a frame into the caller's memory: rows from the top down, with stride_bytes from one row to the next.
 * stride_bytes is at least width * 4; 0 means width * 4. rgba must not be NULL.
 * The kernels write the pixels in place (zero copy) if OpenCL draws on the host's processor, rgba is aligned to
 * CAMBER_PIXELS_ALIGNMENT, width and height are multiples of 32, rows have no gaps, and the picture is drawn across its
 * whole width (up to 8192 px, unless the memory limit is lower). Otherwise rows are copied.
 * stats and the return values are as for camber_renderer_render. The pixels are undefined on failure. */
CAMBER_API camber_status camber_renderer_render_into(camber_renderer *renderer, const camber_frame *frame,
                                                     uint8_t *rgba, size_t stride_bytes, camber_frame_stats *stats);

/* Counts lines instead of drawing them: each pixel gets the sum, over all rows, of the area that a row's polylines
 * cover of it, times the red of the row's paint, any finite number. Coverage of consecutive polylines with the same row
 * is accumulated as in an opaque pass, so a line that crosses itself counts once; to count polylines one by one, give
 * each its own row. Sums are floats, are not limited, and are added in the same order in every run. The passes have
 * opaque lines, without fills, ramps and images, and the frame has no background. sums has rows from the top down, with
 * stride_bytes from one row to the next; 0 means width * 4. It is written in place as by camber_renderer_render_into.
 * Returns the errors of camber_renderer_render, and CAMBER_ERROR_ARGUMENT (a frame with anything else, or a renderer
 * that draws in GL). */
CAMBER_API camber_status camber_renderer_sum(camber_renderer *renderer, const camber_frame *frame, float *sums,
                                             size_t stride_bytes, camber_frame_stats *stats);

/* ---- Drawing into textures: for engines that draw more than lines ----------------------------------- */

/* A texture of the surface's GL context, or of a context that shares its objects (camber_surface_desc). Pixels are
 * premultiplied: an engine blends them over its own with glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA). */
typedef struct camber_texture {
    uint32_t name;  /* a GL_TEXTURE_2D of GL_RGBA8, as wide and high as the frame */
    bool keep;      /* the frame is drawn over the texture's content. false: it replaces the content */
    bool bottom_up; /* the picture's last row is at t = 0, as in GL framebuffers. false: its first row is */
    void *ready;    /* a GLsync that follows other contexts' work on the texture; GL waits for it. NULL: none */
} camber_texture;

/* Draws a frame into a texture and reads nothing back, so that an engine can draw below and above the lines. GL and
 * OpenCL renderers can draw into the same texture in turn. The surface's context stays current, so make your own
 * current again afterwards.
 * frame is drawn in one piece, so its sides are at most the surface's largest_target_px.
 * *drawn receives a GLsync that follows the last command, and has been flushed. Another context waits for it with
 * glWaitSync before it uses the texture, and the caller deletes it. If *drawn is NULL after the call, drawing is
 * complete. If drawn itself is NULL, the call waits.
 * Returns the errors of camber_renderer_render, and CAMBER_ERROR_ARGUMENT (no such texture, another size or format, a
 * renderer without a surface), CAMBER_ERROR_LIMIT (a side too long). The texture's pixels are undefined on failure.
 * Layers take up to 25 bytes more per px. */
CAMBER_API camber_status camber_renderer_render_texture(camber_renderer *renderer, const camber_frame *frame,
                                                        const camber_texture *texture, void **drawn);

#ifdef __cplusplus
}
#endif

#endif
