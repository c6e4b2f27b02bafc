/* Linked shader programs in the cache folder: taken from there, and built anew where what lies there is no program. */
#include "gl_fault.h"
#include "pictures.h"

#include <dirent.h>

static const char NAME[] = "shaders-";

/* A line, drawn with a surface and a renderer of their own; gives the picture and how many shaders were compiled. */
static picture draw_anew(const char *cache_dir, camber_backend backend, size_t *compiled) {
    host h = {0};
    camber_context_desc context_desc = host_desc(&h);
    context_desc.cache_dir = cache_dir;
    camber_context *context = NULL;
    camber_device *device = NULL;
    camber_surface *surface = NULL;
    camber_renderer *renderer = NULL;
    camber_mesh *mesh = NULL;
    camber_polylines *polylines = NULL;
    assert_int_equal(camber_context_create(&context_desc, &context), CAMBER_OK);
    assert_int_equal(camber_device_create(context, NULL, &device), CAMBER_OK);
    assert_int_equal(camber_surface_create(context, &(camber_surface_desc){backend}, &surface), CAMBER_OK);
    assert_int_equal(
        camber_renderer_create(device, surface, &(camber_renderer_desc){.rasterizer = CAMBER_RASTERIZER_GL}, &renderer),
        CAMBER_OK);
    assert_int_equal(camber_mesh_create(device, renderer, &mesh), CAMBER_OK);
    const float points[] = {4, 4, 40, 30, 60, 8};
    const uint32_t offsets[] = {0, 3};
    const camber_stroke stroke = {6, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0};
    const camber_paint paint = {.width_px = 6, .color = {0.2f, 0.4f, 0.6f, 0.5f}};
    assert_int_equal(
        camber_polylines_create(context, &(camber_polylines_desc){points, 3, offsets, 1, NULL, false}, &polylines),
        CAMBER_OK);
    assert_int_equal(
        camber_mesh_tessellate(mesh, polylines, &(camber_tessellation_desc){&stroke, 1, CAMBER_METHOD_STRIP, 0, false}),
        CAMBER_OK);
    fault_on(surface);
    fault.only = "CompileShader"; /* counted, none fails */
    const camber_pass pass = {.mesh = mesh, .paints = &paint, .paint_count = 1};
    picture drawn =
        picture_draw(renderer, &(camber_frame){.width = 64, .height = 40, .passes = &pass, .pass_count = 1});
    *compiled = fault.calls;
    fault_off();
    assert_int_equal(h.errors + h.warnings, 0);
    camber_polylines_destroy(polylines);
    camber_mesh_destroy(mesh);
    camber_renderer_destroy(renderer);
    camber_surface_destroy(surface);
    camber_device_destroy(device);
    host_done(&h, context);
    return drawn;
}

typedef enum damage { CUT, CHANGED, EMPTY, EXCHANGED, DAMAGES } damage;

/* Does to each program in the folder what damage says; gives how many there are. */
static size_t spoil(const char *folder, damage how) {
    char path[512], other[512] = "";
    size_t count = 0;
    DIR *dir = opendir(folder);
    assert_non_null(dir);
    for (struct dirent *entry = readdir(dir); entry; entry = readdir(dir)) {
        if (strncmp(entry->d_name, NAME, strlen(NAME)) != 0)
            continue;
        count++;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (how == CUT)
            assert_int_equal(truncate(path, 1000), 0);
        if (how == EMPTY)
            assert_int_equal(truncate(path, 0), 0);
        if (how == CHANGED) {
            FILE *file = fopen(path, "r+b");
            assert_non_null(file);
            fseek(file, 200, SEEK_SET);
            const int byte = fgetc(file);
            fseek(file, 200, SEEK_SET);
            fputc(byte ^ 1, file);
            fclose(file);
        }
        if (how == EXCHANGED && other[0])
            assert_int_equal(rename(path, other), 0); /* one under another's name */
        snprintf(other, sizeof other, "%s", path);
    }
    closedir(dir);
    return count;
}

static void test_cache(void **state) {
    fixture *s = *state;
    for (int i = 0; i < CAMBER_FIXTURE_BACKENDS; i++) {
        if (!s->on.renderer[i])
            continue;
        GLint formats = 0;
        assert_int_equal(camber_surface_make_current(s->on.surface[i]), CAMBER_OK);
        s->on.surface[i]->gl.GetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
        if (formats == 0) {
            printf("%s keeps no programs\n", fixture_name(i));
            continue;
        }
        char folder[64];
        size_t built, compiled;
        folder_make(folder);
        picture wanted = draw_anew(folder, fixture_backend(i), &built);
        assert_true(built >= 4); /* the strokes and the flattening, two each */
        picture again = draw_anew(folder, fixture_backend(i), &compiled);
        assert_int_equal(compiled, 0);
        picture_assert_same(&wanted, &again);
        picture_free(&again);
        for (damage how = 0; how < DAMAGES; how++) {
            assert_int_equal(2 * spoil(folder, how), built);
            again = draw_anew(folder, fixture_backend(i), &compiled);
            assert_int_equal(compiled, built);
            picture_assert_same(&wanted, &again);
            picture_free(&again);
            again = draw_anew(folder, fixture_backend(i), &compiled); /* mended */
            assert_int_equal(compiled, 0);
            picture_free(&again);
        }
        picture_free(&wanted);
        folder_remove(folder);
    }
}

int main(void) {
    if (!fixture_begin())
        return 77;
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_cache)};
    const int failed = cmocka_run_group_tests(tests, fixture_set_up, fixture_tear_down);
    return failed;
}
