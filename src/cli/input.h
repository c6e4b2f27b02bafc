/* What a verb works on: a view of a map, or a file of polylines in pixels. */
#ifndef CAMBER_CLI_INPUT_H
#define CAMBER_CLI_INPUT_H

#include "cli/session.h"

typedef struct camber_input {
    camber_session *session;
    const char *attribution;       /* of the options, or else of the data. NULL: none */
    size_t points_in, segments_in; /* as read */
    double read_ms, scene_ms;

    /* Polylines in pixels. */
    camber_lines lines, simplified; /* simplified: empty unless that is asked for */
    camber_polylines *polylines;
    camber_stroke stroke;
    camber_paint paint;
    camber_pass pass;

    /* A map. */
    camber_view_desc view; /* of the options, or where they have none of a style that is drawn from its own sources */
    camber_style *style;
    const char *base_path; /* of what the style names; NULL: the working folder */
    camber_features *features;
    camber_scene *scene;
} camber_input;

/* Reads the files that the options name. Returns an exit status, its line printed; the input can be closed in any
 * case. */
int camber_input_open(camber_input *input, camber_session *session);
void camber_input_close(camber_input *input);

/* Makes what the kernels read: projects a map, cleans polylines; again at every call. */
int camber_input_project(camber_input *input);
/* Warns where that is nothing: "no line ... is in the view; " and what comes of it. */
void camber_input_warn_empty(const camber_input *input, const char *consequence);
/* The parts, after camber_input_project and until the next. */
const camber_polylines *camber_input_polylines(const camber_input *input);
const camber_lines *camber_input_lines(const camber_input *input);
/* The row of each polyline; NULL: all 0. */
const uint32_t *camber_input_rows(const camber_input *input);
const camber_stroke *camber_input_strokes(const camber_input *input, size_t *count);
/* The network that the polylines are a view of, with its camera and strokes; NULL: they are none of one. */
camber_network *camber_input_network(const camber_input *input, camber_camera *camera, camber_tessellation_desc *desc);
camber_frame camber_input_frame(camber_input *input, camber_mesh *mesh);
bool camber_input_opaque(const camber_input *input);

/* Tessellates with the method of the options. */
camber_status camber_input_tessellate(const camber_input *input, camber_mesh *mesh);

/* A style document: a file, standard input, or one that ships with camber. */
typedef struct camber_style_input {
    const char *name;      /* stands in messages */
    const char *base_path; /* what its paths are relative to the folder of; NULL: to the working folder */
    const char *text;
    size_t size_bytes;
    char *bytes; /* the text where it was read, to be freed; else NULL */
} camber_style_input;

/* Whether the name is one of camber_style_list, and no file is called so. */
bool camber_input_ships(const char *name);
/* theme: of one that ships. Returns an exit status, its line printed. */
int camber_input_read_style(camber_session *session, const char *path, camber_theme theme, camber_style_input *style);

/* The whole file or standard input; *bytes is freed with free. Returns an exit status, its line printed. */
int camber_input_read_all(camber_report *report, const char *path, char **bytes, size_t *size_bytes);

#endif
