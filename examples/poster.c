/* poster FILE: prints a map on a sheet of A3 with a title and a scale bar: poster.pdf, with true vectors and text. */
#include <camber_print.h>
#include <stdio.h>

static void print_message(void *user, camber_log_level level, const char *message) {
    if (level < CAMBER_LOG_INFO)
        fprintf(user, "poster: %s\n", message);
}

static bool write_bytes(void *file, const void *bytes, size_t size_bytes) {
    return fwrite(bytes, 1, size_bytes, file) == size_bytes;
}

/* Without a renderer there is no device: only blurs and patterns of lines need one. */
static bool write_page(camber_page *page, camber_scene *scene, const char *path) {
    FILE *file = fopen(path, "wb");
    const camber_sink sink = {.write = write_bytes, .user = file};
    const bool done = file && camber_page_write(page, scene, NULL, NULL, CAMBER_PAGE_PDF, sink) == CAMBER_OK;
    return file && fclose(file) == 0 && done;
}

int main(int argc, char **argv) {
    const camber_context_desc log = {.log = print_message, .log_user = stderr};
    const camber_source_desc source = {.path = argc > 1 ? argv[1] : "map.geojson"};
    camber_page_desc sheet = {.margin_mm = 12, .title = "A map", .scale_bar = true, .north_arrow = true};
    camber_scene_desc desc = {.view = {.kind = CAMBER_VIEW_FIT, .cover = true}, .simplify_px = 0.1};
    camber_context *context = NULL;
    camber_style *style = NULL;
    camber_features *features = NULL;
    camber_page *page = NULL;
    camber_scene *scene = NULL;
    if (!camber_page_is_built()) {
        fprintf(stderr, "poster: this camber was built without Cairo\n");
        return 77;
    }
    camber_paper_find("A3", &sheet.width_mm, &sheet.height_mm);
    bool done = camber_context_create(&log, &context) == CAMBER_OK &&
                camber_style_create_builtin(context, CAMBER_THEME_LIGHT, &style) == CAMBER_OK &&
                camber_features_create(context, style, &features) == CAMBER_OK &&
                camber_features_read_fonts(features, NULL, NULL) == CAMBER_OK && /* labels */
                camber_features_read_sprites(features, 2, NULL) == CAMBER_OK &&  /* their icons */
                camber_features_read(features, &source) == CAMBER_OK &&
                camber_page_create(context, &sheet, &page) == CAMBER_OK &&
                camber_page_set_credit(page, camber_features_get_attribution(features)) == CAMBER_OK;
    if (done)
        camber_page_set_view(page, &desc.view); /* as large as the sheet leaves room for */
    done = done && camber_scene_create(features, &desc, &scene) == CAMBER_OK && write_page(page, scene, "poster.pdf");
    camber_scene_destroy(scene);
    camber_page_destroy(page);
    camber_features_destroy(features);
    camber_style_destroy(style);
    camber_context_destroy(context);
    return done ? 0 : 1;
}
