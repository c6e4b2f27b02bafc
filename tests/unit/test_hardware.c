/* Signs of GL hardware, before GL is opened. */
#include "core.h"

#include "gpu/hardware.h"

#include <fcntl.h>
#include <sys/stat.h>

static void put(const char *folder, const char *name, mode_t mode) {
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    const int file = open(path, O_CREAT | O_RDWR, mode);
    assert_true(file >= 0);
    close(file);
}

static void test_nodes(void **state) {
    (void)state;
    char folder[64], dri[128];
    folder_make(folder);
    assert_false(camber_hardware_in(folder));
    assert_false(camber_hardware_in("/nowhere"));
    snprintf(dri, sizeof dri, "%s/dri", folder);
    assert_int_equal(mkdir(dri, 0700), 0);
    assert_false(camber_hardware_in(folder));
    put(dri, "card0", 0600); /* a screen without a renderer */
    assert_false(camber_hardware_in(folder));
    if (geteuid() != 0) { /* whom no mode keeps out */
        put(dri, "renderD129", 0);
        assert_false(camber_hardware_in(folder));
    }
    put(dri, "renderD128", 0600);
    assert_true(camber_hardware_in(folder));
    folder_remove(folder);
}

static void test_drivers_of_their_own(void **state) {
    (void)state;
    static const char *const names[] = {"nvidiactl", "dxg", "mali0", "kgsl-3d0"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char folder[64];
        folder_make(folder);
        put(folder, names[i], 0600);
        assert_true(camber_hardware_in(folder));
        folder_remove(folder);
    }
}

/* A surface that is hardware was foreseen. */
static void test_surfaces(void **state) {
    (void)state;
    static const camber_surface_desc osmesa = {CAMBER_BACKEND_OSMESA};
    assert_false(camber_surface_may_be_hardware(&osmesa));
    camber_context *context = NULL;
    camber_surface *surface = NULL;
    assert_int_equal(camber_context_create(NULL, &context), CAMBER_OK);
    if (camber_surface_create(context, NULL, &surface) == CAMBER_OK && !camber_surface_get_info(surface).software)
        assert_true(camber_surface_may_be_hardware(NULL));
    camber_surface_destroy(surface);
    camber_context_destroy(context);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_nodes), cmocka_unit_test(test_drivers_of_their_own),
                                       cmocka_unit_test(test_surfaces)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
