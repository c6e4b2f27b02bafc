/* map FILE: draws a map file in the built-in style, in eight frames of a moving camera: map-0.png to map-7.png. */
#include <camber_map.h>
#include <stdio.h>

enum { FRAMES = 8 };

static void print_message(void *user, camber_log_level level, const char *message) {
    if (level < CAMBER_LOG_INFO)
        fprintf(user, "map: %s\n", message);
}

static bool write_bytes(void *file, const void *bytes, size_t size_bytes) {
    return fwrite(bytes, 1, size_bytes, file) == size_bytes;
}

static bool write_rows(void *png, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    (void)first_row;
    return camber_png_write_rows(png, rgba, row_count) == CAMBER_OK;
}

static bool save(camber_context *context, camber_renderer *renderer, const camber_frame *frame, const char *path) {
    const camber_png_desc desc = {.width = frame->width, .height = frame->height, .opaque = true};
    camber_png *png = NULL;
    FILE *file = fopen(path, "wb");
    bool done =
        file && camber_png_create(context, &desc, (camber_sink){.write = write_bytes, .user = file}, &png) == CAMBER_OK;
    done = done && camber_renderer_render(renderer, frame, write_rows, png, NULL) == CAMBER_OK &&
           camber_png_finish(png) == CAMBER_OK;
    camber_png_destroy(png);
    return file && fclose(file) == 0 && done;
}

/* The camera turns, tilts and comes closer. The lines stay on the device; only the view changes. */
static bool fly(camber_context *context, camber_scene *scene, camber_mesh *mesh, camber_renderer *renderer) {
    const camber_scene_info whole = camber_scene_get_info(scene);
    for (int i = 0; i < FRAMES; i++) {
        const double share = (double)i / (FRAMES - 1);
        camber_view_desc view = {.kind = CAMBER_VIEW_CENTER, .width = 960, .height = 600};
        view.longitude = whole.longitude;
        view.latitude = whole.latitude;
        view.zoom = whole.zoom + 2.5 * share;
        view.bearing_deg = 40 * share;
        view.pitch_deg = 55 * share;
        if (camber_scene_move(scene, &view) != CAMBER_OK ||
            camber_scene_tessellate(scene, mesh, CAMBER_METHOD_STRIP) != CAMBER_OK)
            return false;
        const camber_frame frame = camber_scene_get_frame(scene, mesh);
        char path[32];
        snprintf(path, sizeof path, "map-%d.png", i);
        if (!save(context, renderer, &frame, path))
            return false;
    }
    return true;
}

int main(int argc, char **argv) {
    const camber_context_desc log = {.log = print_message, .log_user = stderr};
    const camber_source_desc source = {.path = argc > 1 ? argv[1] : "map.geojson"};
    const camber_scene_desc desc = {.view = {.width = 960, .height = 600}, .simplify_px = 0.1};
    camber_context *context = NULL;
    camber_style *style = NULL;
    camber_features *features = NULL;
    camber_scene *scene = NULL;
    camber_device *device = NULL;
    camber_renderer *renderer = NULL;
    camber_mesh *mesh = NULL;
    const bool done = camber_context_create(&log, &context) == CAMBER_OK &&
                      camber_style_create_builtin(context, CAMBER_THEME_LIGHT, &style) == CAMBER_OK &&
                      camber_features_create(context, style, &features) == CAMBER_OK &&
                      camber_features_read(features, &source) == CAMBER_OK &&
                      camber_scene_create(features, &desc, &scene) == CAMBER_OK &&
                      camber_device_create(context, NULL, &device) == CAMBER_OK &&
                      camber_renderer_create(device, NULL, NULL, &renderer) == CAMBER_OK &&
                      camber_mesh_create(device, renderer, &mesh) == CAMBER_OK && fly(context, scene, mesh, renderer);
    return done ? 0 : 1; /* a program that continues would destroy its objects, the last one first */
}
