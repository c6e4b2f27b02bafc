/* validate: an application's own check that camber draws correctly on this machine. Exits with 1 if it does not. */
#include <camber_proof.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SIDE = 64 };

static uint8_t pixels[SIDE * SIDE * 4];

static void print_message(void *user, camber_log_level level, const char *message) {
    if (level < CAMBER_LOG_INFO)
        fprintf(user, "validate: %s\n", message);
}

/* Checks that the device's mesh has the same bytes as the mesh that the CPU makes from the same lines. */
static bool is_exact(camber_context *context, camber_mesh *mesh, const camber_polylines *polylines,
                     const camber_tessellation_desc *desc) {
    camber_mesh_data device = {0}, twin = {0};
    bool exact = camber_mesh_read(mesh, &device) == CAMBER_OK &&
                 camber_mesh_data_tessellate(context, polylines, desc, &twin) == CAMBER_OK &&
                 device.info.record_count == twin.info.record_count;
    exact = exact && memcmp(device.records, twin.records, twin.info.record_count * sizeof *twin.records) == 0;
    camber_mesh_data_destroy(&device);
    camber_mesh_data_destroy(&twin);
    return exact;
}

/* Draws a band of 10.5 px across the picture. A pixel's alpha must be the share of it that the band covers. */
static int largest_error(float top, float bottom) {
    int largest = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float y = (float)(i / SIDE), covered = fminf(bottom, y + 1) - fmaxf(top, y);
        const int wanted = (int)(255 * fmaxf(covered, 0) + 0.5f), error = pixels[4 * i + 3] - wanted;
        largest = largest > error && largest > -error ? largest : error < 0 ? -error : error;
    }
    return largest;
}

int main(void) {
    const float points[] = {-50, 30.25f, 50, 30.25f, SIDE + 50, 30.25f};
    const uint32_t offsets[] = {0, 3};
    const camber_context_desc log = {.log = print_message, .log_user = stderr};
    const camber_polylines_desc line = {.points = points, .point_count = 3, .offsets = offsets, .polyline_count = 1};
    const camber_stroke stroke = {.width_px = 10.5f};
    const camber_tessellation_desc desc = {.strokes = &stroke, .stroke_count = 1};
    const camber_paint paint = {.width_px = 10.5f, .color = {0, 0, 0, 1}};
    camber_pass pass = {.paints = &paint, .paint_count = 1};
    const camber_frame frame = {.width = SIDE, .height = SIDE, .passes = &pass, .pass_count = 1};
    camber_context *context = NULL;
    camber_polylines *polylines = NULL;
    camber_device *device = NULL;
    camber_renderer *renderer = NULL;
    if (camber_context_create(&log, &context) != CAMBER_OK ||
        camber_polylines_create(context, &line, &polylines) != CAMBER_OK ||
        camber_device_create(context, NULL, &device) != CAMBER_OK ||
        camber_renderer_create(device, NULL, NULL, &renderer) != CAMBER_OK ||
        camber_mesh_create(device, renderer, &pass.mesh) != CAMBER_OK ||
        camber_mesh_tessellate(pass.mesh, polylines, &desc) != CAMBER_OK ||
        camber_renderer_render_into(renderer, &frame, pixels, 0, NULL) != CAMBER_OK)
        return 1;
    const bool exact = is_exact(context, pass.mesh, polylines, &desc);
    const int error = largest_error(25, 35.5f);
    printf("%s: the mesh is %s the CPU twin's; the largest error of a pixel is %d of 255\n",
           camber_device_get_info(device).name, exact ? "byte by byte" : "not", error);
    return exact && error <= 1 ? 0 : 1;
}
