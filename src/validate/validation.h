/* All checks of `camber validate` on all devices: they compare the kernels with their CPU twin, and pictures with an
 * oracle that shares no formula with them. */
#ifndef CAMBER_VALIDATE_VALIDATION_H
#define CAMBER_VALIDATE_VALIDATION_H

#include "camber_proof.h"
#include "validate/coverage_truth.h"
#include "validate/results.h"

/* An image of a failure: expected and actual pixels. */
typedef struct camber_failure_image {
    size_t number; /* number of the check, counted from 1 */
    camber_window window;
    const float *truth;   /* of the window's pixels, 0 to 1 */
    const uint8_t *drawn; /* 0 to 255 */
} camber_failure_image;

/* Callbacks of the checks. */
typedef struct camber_validation_host {
    /* Returns the context's last error message and clears it; "" if there is none. It becomes the reason of a skip. */
    void (*take_message)(void *user, char *text, size_t size);
    /* Writes the image of a failure, and returns the name of its file, to be freed with free. May be NULL. */
    camber_status (*write_image)(void *user, const camber_failure_image *image, char **path);
    /* Reports how many scenes are done; count 1: the caller's input. May be NULL. */
    void (*progress)(void *user, size_t done, size_t count);
    void *user;
} camber_validation_host;

typedef struct camber_validation_desc {
    camber_context *context;
    camber_validation_host host;
    camber_results_listener listener;
    const char *match;            /* selects devices, as in camber_device_desc; NULL: all */
    uint64_t memory_bytes;        /* as in camber_device_desc */
    camber_backend backend;       /* the only GL back end to check; AUTO: all */
    camber_rasterizer rasterizer; /* the only rasterizer to check; AUTO: both */
    int method;                   /* the only method to check; -1: all */
    bool full; /* also check every method, every join and cap on each back end, and 1, 8 and 16 lanes */
    camber_coverage coverage;
    uint32_t windows; /* number of windows per picture that are compared with the oracle */
    const char *only; /* only groups whose name contains this text are run; NULL: all */
} camber_validation_desc;

/* Polylines, and how to check them. */
typedef struct camber_subject {
    const char *name;
    camber_lines lines;   /* borrowed */
    const uint32_t *rows; /* NULL: all 0 */
    bool keep_open;
    const camber_polylines *polylines;  /* made from the lines */
    const camber_stroke *strokes;       /* stroke_count of them; checks of meshes set joins and caps */
    const camber_stroke *drawn_strokes; /* stroke_count of them, for pictures */
    size_t stroke_count;
    bool fills; /* the lines are a user's rings, whose inside is drawn instead of lines; only for the check of pixels */
    /* name of a made-up scene. NULL: a user's lines, whose drawn strokes keep their joins and caps */
    const char *scene;
    uint32_t width, height; /* size of the picture, px */
    /* The network of which the polylines are a view, made by the CPU twin. NULL: none. */
    camber_network *network;
    camber_camera camera;
    camber_method method; /* for a network: the method to check */
} camber_subject;

/* A user's lines, and the network of which they are a view. */
typedef struct camber_validation_input {
    camber_subject subject;
    camber_network *network; /* NULL: a network is made from the subject's lines */
    camber_camera camera;    /* of the network */
    camber_tessellation_desc strokes;
    camber_subject map; /* the whole map: areas and lines */
    /* of the map, with its style; its meshes are set by the checks. No passes: there are no areas */
    camber_frame frame;
} camber_validation_input;

typedef struct camber_drawing_path camber_drawing_path;
typedef struct camber_checked_device camber_checked_device;

typedef struct camber_checked_devices {
    camber_checked_device *list; /* count of them */
    size_t count;
} camber_checked_devices;

typedef struct camber_validation {
    const camber_validation_desc *desc;
    camber_results results;
    camber_checked_devices devices;
    size_t picture_count; /* images of failures written so far */
} camber_validation;

/* Checks the input, or every made-up scene if it is NULL. Returns CAMBER_OK whatever the checks find, which is in
 * results; otherwise the failure that prevented a check. The caller closes the validation in any case. */
camber_status camber_validation_run(camber_validation *validation, const camber_validation_desc *desc,
                                    const camber_validation_input *input);
void camber_validation_close(camber_validation *validation);

#endif
