/* The checks. Each runs on a subject and all devices, adds its findings to the results, and returns CAMBER_OK whatever
 * it finds; otherwise the status of the failure that prevented the check. */
#ifndef CAMBER_VALIDATE_CHECKS_H
#define CAMBER_VALIDATE_CHECKS_H

#include "validate/devices.h"

/* ---- Subjects ---- */

/* Tessellates the subject on the device. */
camber_status camber_subject_tessellate(const camber_subject *subject, camber_mesh *mesh,
                                        const camber_tessellation_desc *desc);
/* Whether the subject is checked with a method. */
bool camber_subject_takes(const camber_subject *subject, const camber_validation_desc *desc, camber_method method);

/* Whether pictures of a method are checked. If all checks are requested, the pictures of all methods are checked;
 * otherwise only those of the method that was selected, or of strips, which are the default. */
bool camber_draws_method(const camber_validation_desc *desc, camber_method method);

/* Moves the camera so that a pixel of its picture becomes the centre. */
void camber_camera_center(camber_camera *camera, double x, double y);

/* ---- Checks: check_*.c ---- */

camber_status camber_check_meshes(camber_validation *validation, const camber_subject *subject);
/* Checks the subject as a network with several cameras. network: the network of which the subject is a view, with its
 * camera and strokes; NULL: a network is made from the subject's lines. */
camber_status camber_check_networks(camber_validation *validation, const camber_subject *subject,
                                    camber_network *network, const camber_camera *camera,
                                    const camber_tessellation_desc *desc);
camber_status camber_check_pixels(camber_validation *validation, const camber_subject *subject);
/* Compares the kernels that draw with their twin. */
camber_status camber_check_drawing(camber_validation *validation, const camber_subject *subject);
/* Compares the kernels that draw with their twin for a frame, whose passes draw the subject. */
camber_status camber_check_frame(camber_validation *validation, const camber_subject *subject,
                                 const camber_frame *frame);
/* Checks the areas of a frame, whose passes draw the subject: the frame as it is, and the pixels of each layer of
 * areas. */
camber_status camber_check_areas(camber_validation *validation, const camber_subject *subject,
                                 const camber_frame *frame);
/* Checks the CPU twin's offset lines: whether they have the right distance from the original lines. */
camber_status camber_check_offsets(camber_validation *validation);
/* Checks gaps, blurs, dashes, trims, ramps, images and areas, flat and tilted, on lines of its own. Each is a group. */
camber_status camber_check_along(camber_validation *validation);

/* ---- Styles: check_meshes.c ---- */

/* Sets a row's join and cap. number counts the styles with which a subject is checked. */
typedef void camber_style_fn(camber_stroke *stroke, size_t row, size_t number);
/* Gives consecutive rows different joins and caps. */
void camber_style_mixed(camber_stroke *stroke, size_t row, size_t number);
void camber_style_kept(camber_stroke *stroke, size_t row, size_t number);
/* Returns the subject's strokes with their joins and caps set. Free them with free; NULL: memory is exhausted. */
camber_stroke *camber_strokes_styled(const camber_stroke *strokes, size_t count, camber_style_fn *style, size_t number);
const char *camber_join_name(camber_join join);
const char *camber_cap_name(camber_cap cap);

/* ---- Comparison of meshes: mesh_diff.c ---- */

/* A tessellation that was read back. Valid when zeroed; must be closed in any case. */
typedef struct camber_mesh_state {
    bool has_stages; /* otherwise it has only the mesh */
    bool of_network;
    camber_mesh_data mesh;
    camber_stages stages;
} camber_mesh_state;

camber_status camber_mesh_state_read(camber_mesh *mesh, bool with_stages, camber_mesh_state *state);
void camber_mesh_state_close(camber_mesh_state *state);

/* Finds the first element that is not as expected, with its stage. Returns false if there is none. expected must have
 * its stages, which say to which point a vertex belongs. */
bool camber_mesh_states_differ(const camber_mesh_state *got, const camber_mesh_state *expected,
                               camber_finding *finding);

/* ---- Images of failures: failure_images.c ---- */

/* Makes the host write truth, drawn and their difference, if it wants them, and stores the name of the file in the
 * finding. */
camber_status camber_failure_image_write(camber_validation *validation, camber_window window, const float *truth,
                                         const uint8_t *drawn, camber_finding *finding);
/* Does the same for a mesh on the device, around the finding's point. */
camber_status camber_failure_image_of_mesh(camber_validation *validation, const camber_checked_device *checked,
                                           const camber_subject *subject, const camber_tessellation_desc *desc,
                                           camber_finding *finding);

/* ---- Bounds: pixel_bounds.c ---- */

/* Finds the bounds for a made-up scene, "a segment" or "areas"; or for a user's lines (NULL), of whose joins
 * tight_share are tight or split. Returns false if the scene is not drawn. */
bool camber_bounds_of_pixels(const char *scene, double tight_share, camber_coverage coverage,
                             camber_pixel_bounds *bounds);
/* Returns the bounds for united lines, given those for lines that are drawn one over the other. */
camber_pixel_bounds camber_bounds_of_united(const char *scene, camber_pixel_bounds over);
/* Returns the bounds for lines that were simplified for a camera. */
camber_pixel_bounds camber_bounds_of_simplified(camber_pixel_bounds whole);
/* Returns the bounds if no pixel's error is larger than the oracle's own error may be. */
camber_pixel_bounds camber_bounds_of_few(camber_pixel_bounds most, const camber_pixel_error *error);
/* Returns the bounds for comparing two pictures: of two GL back ends, or of GL and OpenCL. */
camber_pixel_bounds camber_bounds_of_drawers(bool alike);
/* Finds the first bound that is exceeded. Returns false if none is. */
bool camber_bounds_are_passed(const camber_pixel_bounds *is, const camber_pixel_bounds *most, camber_finding *finding);

#endif
