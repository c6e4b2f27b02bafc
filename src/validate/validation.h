/* All checks of `camber validate` on all devices: the kernels against their CPU twin, and pictures against an oracle
 * that shares no formula with them. */
#ifndef CAMBER_VALIDATE_VALIDATION_H
#define CAMBER_VALIDATE_VALIDATION_H

#include "camber_proof.h"
#include "validate/coverage_truth.h"
#include "validate/results.h"

/* A picture of a failure: what should be there, and what was drawn. */
typedef struct camber_failure_image {
    size_t number; /* of the check, from 1 */
    camber_window window;
    const float *truth;   /* of the window's pixels, 0 to 1 */
    const uint8_t *drawn; /* 0 to 255 */
} camber_failure_image;

/* Whom the checks ask. */
typedef struct camber_validation_host {
    /* Gives the context's last error message, "" where there is none, and forgets it: it is the reason of a skip. */
    void (*take_message)(void *user, char *text, size_t size);
    /* Writes the picture of a failure and gives its file's name, to be freed with free. NULL: none is wanted. */
    camber_status (*write_image)(void *user, const camber_failure_image *image, char **path);
    /* How many of the scenes are done, 0 to 1. NULL: nobody wants to know. */
    void (*progress)(void *user, double fraction);
    void *user;
} camber_validation_host;

typedef struct camber_validation_desc {
    camber_context *context;
    camber_validation_host host;
    camber_results_listener listener;
    const char *match;            /* of devices, as camber_device_desc has it. NULL: all */
    uint64_t memory_bytes;        /* camber_device_desc's */
    camber_backend backend;       /* the only one of GL. AUTO: all */
    camber_rasterizer rasterizer; /* the only kind that draws. AUTO: both */
    int method;                   /* the only one. -1: all */
    bool full; /* by every method, with every join and cap on each back end, and with 1, 8 and 16 lanes */
    camber_coverage coverage;
    uint32_t windows; /* of each picture, that are held against the oracle */
    const char *only; /* part of the names of the groups that are checked. NULL: all */
} camber_validation_desc;

/* Polylines and how they are checked. */
typedef struct camber_subject {
    const char *name;
    camber_lines lines;   /* borrowed */
    const uint32_t *rows; /* NULL: all 0 */
    bool keep_open;
    const camber_polylines *polylines;  /* of the lines */
    const camber_stroke *strokes;       /* stroke_count; the checks of meshes set joins and caps */
    const camber_stroke *drawn_strokes; /* stroke_count: as pictures have them */
    size_t stroke_count;
    bool fills; /* a user's rings: what is inside of them is drawn in place of lines, for the check of pixels alone */
    const char
        *scene; /* its name, where it is made up. NULL: a user's, whose drawn strokes keep their joins and caps */
    uint32_t width, height; /* of the picture, px */
    /* The network that a camera sees as this subject; polylines are the CPU twin's then. NULL: none. */
    camber_network *network;
    camber_camera camera;
    camber_method method; /* of a network, the one that it is checked with */
} camber_subject;

/* A user's lines, and the network that they are a view of. */
typedef struct camber_validation_input {
    camber_subject subject;
    camber_network *network; /* NULL: one is made of the subject's lines */
    camber_camera camera;    /* of the network */
    camber_tessellation_desc strokes;
    camber_subject map; /* with its areas, lines and all */
    camber_frame frame; /* of the map, as styled; meshes are those of the checks. No passes: there are no areas */
} camber_validation_input;

typedef struct camber_drawing_path camber_drawing_path;
typedef struct camber_checked_device camber_checked_device;

typedef struct camber_checked_devices {
    camber_checked_device *list; /* count */
    size_t count;
} camber_checked_devices;

typedef struct camber_validation {
    const camber_validation_desc *desc;
    camber_results results;
    camber_checked_devices devices;
    size_t picture_count; /* of failures, written so far */
} camber_validation;

/* Checks the input, or where it is NULL every made-up scene. Returns CAMBER_OK whatever the checks find; results has
 * that. Else what kept it from checking. The caller closes the validation in any case. */
camber_status camber_validation_run(camber_validation *validation, const camber_validation_desc *desc,
                                    const camber_validation_input *input);
void camber_validation_close(camber_validation *validation);

#endif
