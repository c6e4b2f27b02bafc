/* The checks themselves: a subject on all devices. Each returns CAMBER_OK whatever it finds, and adds that to the
 * results; else the status that kept it from checking. */
#ifndef CAMBER_VALIDATE_CHECKS_H
#define CAMBER_VALIDATE_CHECKS_H

#include "validate/devices.h"

/* ---- Subjects ---- */

/* Tessellates the subject on the device. */
camber_status camber_subject_tessellate(const camber_subject *subject, camber_mesh *mesh,
                                        const camber_tessellation_desc *desc);
/* Whether the subject is checked with a method. */
bool camber_subject_takes(const camber_subject *subject, const camber_validation_desc *desc, camber_method method);

/* Whether pictures of a method are checked: all of them where the checks are full, else those of the method that was
 * asked for, or of strips, which users draw. */
bool camber_draws_method(const camber_validation_desc *desc, camber_method method);

/* Moves a camera to a pixel of its picture. */
void camber_camera_center(camber_camera *camera, double x, double y);

/* ---- Checks: check_*.c ---- */

camber_status camber_check_meshes(camber_validation *validation, const camber_subject *subject);
/* The subject as a network under several cameras. network: the one that the subject is a view of, with its camera and
 * strokes; NULL: one is made of the subject's lines. */
camber_status camber_check_networks(camber_validation *validation, const camber_subject *subject,
                                    camber_network *network, const camber_camera *camera,
                                    const camber_tessellation_desc *desc);
camber_status camber_check_pixels(camber_validation *validation, const camber_subject *subject);
/* The kernels that draw against their twin. */
camber_status camber_check_drawing(camber_validation *validation, const camber_subject *subject);
/* The same of a frame: its passes draw the subject. */
camber_status camber_check_frame(camber_validation *validation, const camber_subject *subject,
                                 const camber_frame *frame);
/* The areas of a frame, whose passes draw the subject: the frame as it is, and the pixels of each layer of areas. */
camber_status camber_check_areas(camber_validation *validation, const camber_subject *subject,
                                 const camber_frame *frame);
/* The CPU twin's lines beside others: how far they lie from these. */
camber_status camber_check_offsets(camber_validation *validation);
/* Gaps, blurs, dashes, trims, ramps, images and areas, flat and tilted, on lines of its own: a group each. */
camber_status camber_check_along(camber_validation *validation);

/* ---- Styles: check_meshes.c ---- */

/* Sets a row's join and cap; number counts through the styles that a subject is checked with. */
typedef void camber_style_fn(camber_stroke *stroke, size_t row, size_t number);
/* Rows of different joins and caps beside each other. */
void camber_style_mixed(camber_stroke *stroke, size_t row, size_t number);
void camber_style_kept(camber_stroke *stroke, size_t row, size_t number);
/* The subject's strokes with their joins and caps set, freed with free; NULL: out of memory. */
camber_stroke *camber_strokes_styled(const camber_stroke *strokes, size_t count, camber_style_fn *style, size_t number);
const char *camber_join_name(camber_join join);
const char *camber_cap_name(camber_cap cap);

/* ---- Meshes that differ: mesh_diff.c ---- */

/* A tessellation as it is read back. Valid when zeroed; closed in any case. */
typedef struct camber_mesh_state {
    bool has_stages; /* else the mesh only */
    bool of_network;
    camber_mesh_data mesh;
    camber_stages stages;
} camber_mesh_state;

camber_status camber_mesh_state_read(camber_mesh *mesh, bool with_stages, camber_mesh_state *state);
void camber_mesh_state_close(camber_mesh_state *state);

/* Finds the first element that is not as expected, with its stage; false: there is none. expected has its stages, which
 * tell whose a vertex is. */
bool camber_mesh_states_differ(const camber_mesh_state *got, const camber_mesh_state *expected,
                               camber_finding *finding);

/* ---- Pictures of failures: failure_images.c ---- */

/* Has the host write truth, drawn and their difference, where it wants them, and names the file in the finding. */
camber_status camber_failure_image_write(camber_validation *validation, camber_window window, const float *truth,
                                         const uint8_t *drawn, camber_finding *finding);
/* The same of the mesh that the device makes, about the finding's point. */
camber_status camber_failure_image_of_mesh(camber_validation *validation, const camber_checked_device *checked,
                                           const camber_subject *subject, const camber_tessellation_desc *desc,
                                           camber_finding *finding);

/* ---- Bounds: pixel_bounds.c ---- */

/* The bounds of a made-up scene, of "a segment", of "areas", or of a user's lines (NULL), a share of whose joins is
 * tight or split. false: it is not drawn. */
bool camber_bounds_of_pixels(const char *scene, double tight_share, camber_coverage coverage,
                             camber_pixel_bounds *bounds);
/* The same for lines that are united, from those of lines that are drawn one over the other. */
camber_pixel_bounds camber_bounds_of_united(const char *scene, camber_pixel_bounds over);
/* And for lines that a camera leaves points out of. */
camber_pixel_bounds camber_bounds_of_simplified(camber_pixel_bounds whole);
/* And for an error that is nowhere larger than the oracle's own may be. */
camber_pixel_bounds camber_bounds_of_few(camber_pixel_bounds most, const camber_pixel_error *error);
/* One picture against another: of two GL back ends, or of GL and OpenCL. */
camber_pixel_bounds camber_bounds_of_drawers(bool alike);
/* Which of the bounds is passed first; false: none. */
bool camber_bounds_are_passed(const camber_pixel_bounds *is, const camber_pixel_bounds *most, camber_finding *finding);

#endif
