/* Subjects of checks: a network and a camera, or polylines. */
#include "validate/checks.h"

#include <math.h>

camber_status camber_subject_tessellate(const camber_subject *s, camber_mesh *mesh,
                                        const camber_tessellation_desc *desc) {
    return s->network ? camber_mesh_tessellate_network(mesh, s->network, &s->camera, desc)
                      : camber_mesh_tessellate(mesh, s->polylines, desc);
}

void camber_camera_center(camber_camera *camera, double x, double y) {
    const double angle = camera->bearing_deg * 3.14159265358979323846 / 180, c = cos(angle), s = sin(angle);
    const double dx = (x - 0.5 * camera->width) / camera->scale_px, dy = (y - 0.5 * camera->height) / camera->scale_px;
    camera->x += dx * c - dy * s;
    camera->y += dx * s + dy * c;
}
