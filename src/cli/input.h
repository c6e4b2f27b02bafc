/* The input of a verb: a view of a map, or a file of polylines in pixels. */
#ifndef CAMBER_CLI_INPUT_H
#define CAMBER_CLI_INPUT_H

#include "cli/session.h"

typedef struct camber_input {
    camber_session *session;
    const char *attribution;       /* from the options, or else from the data. NULL: none */
    size_t points_in, segments_in; /* as read */
    double read_ms, scene_ms;

    /* Polylines in pixels. */
    camber_lines lines, simplified; /* simplified: empty unless that is asked for */
    camber_polylines *polylines;
    camber_stroke stroke;
    camber_paint paint;
    camber_pass pass;

    /* A map. */
    camber_view_desc
        view; /* from the options; what they leave open comes from a style that is drawn from its own sources */
    camber_style *style;
    const char *base_path; /* the style's paths are relative to its folder. NULL: to the working folder */
    camber_features *features;
    camber_scene *scene;
    camber_scene *filled; /* validate: with areas, where there are any; scene is without them then. NULL: none */
    camber_polylines_stats drawn; /* render: of the lines in the picture, which are released once they are counted */
} camber_input;

/* Reads the files that the options name. Returns an exit status, its line printed; the input can be closed in any
 * case. */
int camber_input_open(camber_input *input, camber_session *session);
void camber_input_close(camber_input *input);

/* Makes the input of the kernels anew: projects a map, or cleans polylines. */
int camber_input_project(camber_input *input);
/* Warns if there is nothing to draw: "no line ... is in the view; " and then the consequence. */
void camber_input_warn_empty(const camber_input *input, const char *consequence);
/* The polylines and their parts. Valid after camber_input_project and until its next call. */
const camber_polylines *camber_input_polylines(const camber_input *input);
const camber_lines *camber_input_lines(const camber_input *input);
/* The row of each polyline; NULL: all 0. */
const uint32_t *camber_input_rows(const camber_input *input);
const camber_stroke *camber_input_strokes(const camber_input *input, size_t *count);
/* The network that the polylines show, with its camera and strokes. NULL: they show none. */
camber_network *camber_input_network(const camber_input *input, camber_camera *camera, camber_tessellation_desc *desc);
camber_frame camber_input_frame(camber_input *input, camber_mesh *mesh);
bool camber_input_opaque(const camber_input *input);

/* Tessellates with the method that the options name. */
camber_status camber_input_tessellate(const camber_input *input, camber_mesh *mesh);

/* A style document: a file, standard input, or one that ships with camber. */
typedef struct camber_style_input {
    const char *name;      /* its name in messages */
    const char *base_path; /* its paths are relative to this file's folder. NULL: to the working folder */
    const char *text;
    size_t size_bytes;
    char *bytes; /* the text if it was read, to be freed; else NULL */
} camber_style_input;

/* Prints how much INPUT names without having it; mostly nothing. */
void camber_input_say_missing(const camber_input *input);
/* Says how often lines and areas go over the antimeridian; mostly none does. */
void camber_input_say_split(const camber_input *input);
/* Compiles the style that the options name, or the built-in one. Returns an exit status, its line printed. */
int camber_input_make_style(camber_session *session, camber_theme theme, camber_style **style, const char **base_path);
/* Whether a style that ships has this name, and no file has. */
bool camber_input_ships(const char *name);
/* Reads a style. theme is for a style that ships. Returns an exit status, its line printed. */
int camber_input_read_style(camber_session *session, const char *path, camber_theme theme, camber_style_input *style);

/* Reads a whole file or standard input; free *bytes with free. Returns an exit status, its line printed. */
int camber_input_read_all(camber_report *report, const char *path, char **bytes, size_t *size_bytes);

#endif
