/* The checks of validate: a subject on all rigs. */
#ifndef CAMBER_VALIDATE_CHECKS_H
#define CAMBER_VALIDATE_CHECKS_H

#include "camber_proof.h"
#include "validate/coverage_truth.h"
#include "validate/devices.h"

/* Polylines and what they are checked with. */
typedef struct camber_subject {
    const char *name;
    camber_lines lines;   /* borrowed */
    const uint32_t *rows; /* NULL: all 0 */
    bool keep_open;
    const camber_polylines *polylines;  /* of the lines */
    const camber_stroke *strokes;       /* stroke_count; joins and caps are set by the checks of meshes */
    const camber_stroke *drawn_strokes; /* stroke_count: as pictures have them */
    size_t stroke_count;
    const char *scene; /* that is built in. NULL: what a user brought, whose drawn strokes keep their joins and caps */
    uint32_t width, height; /* of the picture, px */
    /* What of a network a camera sees; polylines are the CPU twin's then. NULL: none. */
    camber_network *network;
    camber_camera camera;
    camber_method method; /* of a network, the one that it is checked with */
} camber_subject;

typedef struct camber_validation {
    camber_session *session;
    camber_results verdicts;
    camber_checked_devices rigs;
    size_t picture_count; /* of differences, written so far */
} camber_validation;

/* Tessellates the subject on the device. */
camber_status camber_subject_tessellate(const camber_subject *subject, camber_mesh *mesh,
                                        const camber_tessellation_desc *desc);
/* Whether the subject is checked with a method. */
bool camber_subject_takes(const camber_subject *subject, const camber_options *options, camber_method method);

/* Whether what is drawn of a method is checked: all of it with --full, else that of the method that was asked for, or
 * of strips, which users draw. */
bool camber_draws_method(const camber_options *options, camber_method method);

/* Each returns an exit status, its line printed: what a check found is no failure of the call. */
int camber_check_meshes(camber_validation *validation, const camber_subject *subject);
/* The subject as a network under several cameras. network: the one that the subject is a view of, with its camera and
 * strokes; NULL: one is made of the subject's lines. */
int camber_check_networks(camber_validation *validation, const camber_subject *subject, camber_network *network,
                          const camber_camera *camera, const camber_tessellation_desc *desc);
int camber_check_pixels(camber_validation *validation, const camber_subject *subject);
/* The kernels that draw against their twin. */
int camber_check_drawing(camber_validation *validation, const camber_subject *subject);
/* Lines beside others, of the CPU twin: how far they lie from these. */
int camber_check_offsets(camber_validation *validation);
/* Gaps, blurs, dashes, trims and ramps, of lines of its own. */
int camber_check_along(camber_validation *validation);
/* Moves a camera to a pixel of its picture. */
void camber_camera_center(camber_camera *camera, double x, double y);

/* Sets a row's join and cap; number counts through what a subject is checked with. */
typedef void camber_style_fn(camber_stroke *stroke, size_t row, size_t number);
/* Rows of different joins and caps beside each other. */
void camber_style_mixed(camber_stroke *stroke, size_t row, size_t number);
void camber_style_kept(camber_stroke *stroke, size_t row, size_t number);
/* The subject's strokes with their joins and caps set, freed with free; NULL: out of memory. */
camber_stroke *camber_strokes_styled(const camber_stroke *strokes, size_t count, camber_style_fn *style, size_t number);
const char *camber_join_name(camber_join join);
const char *camber_cap_name(camber_cap cap);

/* ---- Meshes that differ: sight.c ---- */

/* What can be seen of a tessellation. Valid when zeroed; closed in any case. */
typedef struct camber_mesh_state {
    bool has_stages; /* else the mesh only */
    bool of_network;
    camber_mesh_data mesh;
    camber_stages stages;
} camber_mesh_state;

camber_status camber_mesh_state_read(camber_mesh *mesh, bool with_stages, camber_mesh_state *sight);
void camber_mesh_state_close(camber_context *context, camber_mesh_state *sight);

/* The first element where what was got differs from what was expected, with its stage; false: none does. expected
 * has its stages, which tell whose a vertex is. */
bool camber_mesh_states_differ(const camber_mesh_state *got, const camber_mesh_state *expected,
                               camber_finding *finding);

/* ---- Pictures of failures: evidence.c ---- */

/* Writes truth | drawn | difference to --pictures, where that was asked for, and names it in the finding. */
int camber_failure_image_write(camber_validation *validation, camber_window window, const float *truth,
                               const uint8_t *drawn, camber_finding *finding);
/* The same of what a mesh on the rig looks like about the finding's point. */
int camber_failure_image_of_mesh(camber_validation *validation, const camber_checked_device *rig,
                                 const camber_subject *subject, const camber_tessellation_desc *desc,
                                 camber_finding *finding);
/* Whether --pictures can be written to: known before the work. */
int camber_evidence_check(const camber_session *session);

/* ---- Bounds: bounds.c ---- */

/* Of a built-in scene or "a segment", or NULL for a user's lines, a share of whose joins is tight or split. false: it
 * is not drawn. */
bool camber_bounds_of_pixels(const char *scene, double tight_share, camber_coverage coverage,
                             camber_pixel_bounds *bounds);
/* The same for lines that are united, from those of lines that are drawn one over the other. */
camber_pixel_bounds camber_bounds_of_united(const char *scene, camber_pixel_bounds over);
/* And for lines that a camera leaves points of out. */
camber_pixel_bounds camber_bounds_of_simplified(camber_pixel_bounds whole);
/* And for what is nowhere farther from the oracle than that may be from the truth. */
camber_pixel_bounds camber_bounds_of_few(camber_pixel_bounds most, const camber_pixel_error *error);
/* Of one picture against another: of two GL back ends, or of GL and OpenCL. */
camber_pixel_bounds camber_bounds_of_drawers(bool alike);
/* Which of the bounds is passed first; false: none. */
bool camber_bounds_are_passed(const camber_pixel_bounds *is, const camber_pixel_bounds *most, camber_finding *finding);

/* ---- Drawing: drawing.c ---- */

typedef struct camber_drawing {
    const camber_stroke *strokes; /* stroke_count: all rows are drawn, at their full widths */
    size_t stroke_count;
    uint32_t width, height; /* px */
    camber_coverage coverage;
    camber_overlap overlap;
} camber_drawing;

/* Draws the path's mesh, opaque white on black, in one pass. levels takes width * height. */
camber_status camber_draw_levels(const camber_drawing_path *path, const camber_drawing *drawing, uint8_t *levels);
/* Counts the same, line by line. */
camber_status camber_draw_count(const camber_drawing_path *path, const camber_drawing *drawing, camber_overdraw *sum);

#endif
