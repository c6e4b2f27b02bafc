/* The input of a verb: a view of a map, or a file of polylines in pixels. */
#ifndef CAMBER_CLI_INPUT_H
#define CAMBER_CLI_INPUT_H

#include "cli/session.h"

#include "camber_print.h"

typedef struct camber_input {
    camber_session *session;
    const char *attribution;       /* from the options, or else from the data; NULL: none */
    size_t points_in, segments_in; /* as they were read */
    double read_ms, scene_ms;

    /* Polylines in pixels. */
    camber_lines lines, simplified; /* simplified is empty unless the options ask for it */
    camber_polylines *polylines;
    camber_stroke stroke;
    camber_paint paint;
    camber_pass pass;

    /* A map. */
    camber_view_desc view; /* from the options; if the style's own sources are drawn, the style supplies the rest */
    camber_style *style;
    const char *base_path; /* the style's paths are relative to this file's folder; NULL: to the working folder */
    camber_features *features;
    camber_scene *scene;
    camber_page *page;    /* the sheet that is drawn. NULL: none */
    camber_scene *filled; /* validate: the scene with areas, if there are any; scene is then without them. NULL: none */
    camber_polylines_stats drawn; /* render: counts of the lines in the picture, if they are to be told; else 0 */
} camber_input;

/* Reads the files that the options name. Returns an exit status; on failure a line has been printed. The input must be
 * closed in any case. */
int camber_input_open(camber_input *input, camber_session *session);
void camber_input_close(camber_input *input);

/* Makes the input of the kernels, each time it is called: projects a map, or cleans up polylines. */
int camber_input_project(camber_input *input);
/* If there is nothing to draw, prints a warning: "no line ... is in the view; ", followed by the consequence. */
void camber_input_warn_empty(const camber_input *input, const char *consequence);
/* Return the polylines and related arrays, which are valid after camber_input_project until its next call. */
const camber_polylines *camber_input_polylines(const camber_input *input);
const camber_lines *camber_input_lines(const camber_input *input);
/* The row of each polyline; NULL means that all rows are 0. */
const uint32_t *camber_input_rows(const camber_input *input);
const camber_stroke *camber_input_strokes(const camber_input *input, size_t *count);
/* Returns the network from which the polylines were made, with its camera and strokes; NULL if they were not made from
 * one. */
camber_network *camber_input_network(const camber_input *input, camber_camera *camera, camber_tessellation_desc *desc);
camber_frame camber_input_frame(camber_input *input, camber_mesh *mesh);
bool camber_input_opaque(const camber_input *input);

/* Tessellates with the method that the options select. */
camber_status camber_input_tessellate(const camber_input *input, camber_mesh *mesh);

/* A style document: a file, standard input, or one that ships with camber. */
typedef struct camber_style_input {
    const char *name;      /* name in messages */
    const char *base_path; /* its paths are relative to this file's folder; NULL: to the working folder */
    const char *text;
    size_t size_bytes;
    char *bytes; /* the text if it was read, to be freed; otherwise NULL */
} camber_style_input;

/* Prints how many objects INPUT refers to without containing them; usually there are none. */
void camber_input_say_missing(const camber_input *input);
/* Prints how often lines and areas cross the antimeridian; usually none does. */
void camber_input_say_split(const camber_input *input);
/* Compiles the style that the options select, or the built-in one. Returns an exit status; on failure a line has been
 * printed. */
int camber_input_make_style(camber_session *session, camber_theme theme, camber_style **style, const char **base_path);
/* Whether a built-in style has this name, and no file does. */
bool camber_input_ships(const char *name);
/* Reads a style. theme applies to built-in styles. Returns an exit status; on failure a line has been printed. */
int camber_input_read_style(camber_session *session, const char *path, camber_theme theme, camber_style_input *style);

/* Reads a whole file or standard input; free *bytes with free. Returns an exit status; on failure a line has been
 * printed. */
int camber_input_read_all(camber_report *report, const char *path, char **bytes, size_t *size_bytes);

#endif
