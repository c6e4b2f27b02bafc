/* Devices, and the kernels in the cache folder. */
#include "core.h"

#include "gpu/opencl/pocl.h"
#include "residency/mesh.h"

#include <dirent.h>
#include <sys/stat.h>
#include <sys/wait.h>

/* ---- Without a platform: in a child, before anything here loads one ---- */

/* The child's findings, as its exit status. */
enum { CHILD_OK = 0, CHILD_LISTED, CHILD_STATUS, CHILD_STORY, CHILD_TOUCHED, CHILD_LEAK };

static int open_without_platform(void) {
    host h = {0};
    const camber_context_desc desc = host_desc(&h);
    camber_context *context = NULL;
    const camber_device_info *info = (const camber_device_info *)(const void *)&h;
    if (camber_context_create(&desc, &context) != CAMBER_OK)
        return CHILD_STATUS;
    if (camber_device_list(context, NULL, 0, &info) != CAMBER_OK || info)
        return CHILD_LISTED;
    camber_device *const untouched = (camber_device *)(void *)&h;
    camber_device *device = untouched;
    if (camber_device_create(context, NULL, &device) != CAMBER_ERROR_DEVICE)
        return CHILD_STATUS;
    if (h.errors != 1 || !strstr(h.last, "OpenCL") || !strstr(h.last, "; install"))
        return CHILD_STORY;
    if (device != untouched)
        return CHILD_TOUCHED;
    camber_context_destroy(context);
    return h.live_blocks == 0 ? CHILD_OK : CHILD_LEAK;
}

static void test_no_platform(void **state) {
    (void)state;
    char folder[64];
    folder_make(folder);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        setenv("OCL_ICD_VENDORS", folder, 1); /* both loaders read it */
        unsetenv("OCL_ICD_FILENAMES");
        _exit(open_without_platform());
    }
    int status = -1;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), CHILD_OK);
    folder_remove(folder);
}

/* ---- Devices ---- */

static void test_device_list(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_device_info infos[64];
    const size_t count = list_devices(context, infos, 64);
    assert_true(count >= 1);
    const camber_device_info *past = infos;
    assert_int_equal(camber_device_list(context, NULL, count, &past), CAMBER_OK);
    assert_null(past);
    for (size_t i = 0; i < count; i++) {
        assert_true(infos[i].name[0] && infos[i].platform[0] && infos[i].driver[0]);
        assert_memory_equal(infos[i].version, "OpenCL ", 7);
        assert_true(infos[i].compute_units > 0 && infos[i].memory_bytes > 0 && infos[i].largest_buffer_bytes > 0);
    }
    host_done(&h, context);
}

static camber_status open_match(camber_context *context, const char *match, camber_device_info *info) {
    camber_device *device = NULL;
    const camber_status status = camber_device_create(context, &(camber_device_desc){.match = match}, &device);
    if (status == CAMBER_OK)
        *info = camber_device_get_info(device);
    camber_device_destroy(device);
    return status;
}

static void test_device_match(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_device_info infos[64], info;
    size_t of_type[3] = {0};
    const size_t count = list_devices(context, infos, 64);
    for (size_t i = 0; i < count; i++) {
        of_type[infos[i].type]++;
        char part[128];
        snprintf(part, sizeof part, "%s", infos[i].platform);
        for (char *c = part; *c; c++) /* case is ignored */
            *c = (char)(*c >= 'a' && *c <= 'z' ? *c - 32 : *c);
        assert_int_equal(open_match(context, part + 1, &info), CAMBER_OK);
        assert_string_equal(info.platform, infos[i].platform);
        assert_int_equal(open_match(context, infos[i].name, &info), CAMBER_OK);
    }
    assert_int_equal(h.errors, 0);
    const char *const kinds[] = {"cpu", "gpu", "CPU", "Gpu"};
    for (size_t i = 0; i < 4; i++) {
        const camber_device_type type = i % 2 ? CAMBER_DEVICE_TYPE_GPU : CAMBER_DEVICE_TYPE_CPU;
        h.errors = 0;
        assert_int_equal(open_match(context, kinds[i], &info), of_type[type] ? CAMBER_OK : CAMBER_ERROR_DEVICE);
        if (of_type[type])
            assert_int_equal(info.type, type);
        else
            assert_story(&h, kinds[i]);
    }
    h.errors = 0;
    assert_int_equal(open_match(context, "no such device", &info), CAMBER_ERROR_DEVICE);
    assert_story(&h, infos[0].name); /* the cure: what there is */
    assert_non_null(strstr(h.last, "'no such device'"));
    host_done(&h, context);
}

/* Devices of equal names are told apart by their numbers. */
static void test_device_number(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_device_info infos[64];
    camber_device *device = NULL;
    const size_t count = list_devices(context, infos, 64);
    for (uint32_t i = 0; i < count; i++) {
        const camber_device_desc all = {.number = i + 1}, named = {.match = infos[i].name, .number = 1};
        assert_int_equal(camber_device_create(context, &all, &device), CAMBER_OK);
        const camber_device_info info = camber_device_get_info(device);
        assert_string_equal(info.name, infos[i].name);
        assert_string_equal(info.platform, infos[i].platform);
        camber_device_destroy(device);
        const camber_device_info *found = NULL;
        assert_int_equal(camber_device_list(context, infos[i].name, 0, &found), CAMBER_OK);
        assert_string_equal(found->name, infos[i].name);
        assert_int_equal(camber_device_list(context, infos[i].name, count, &found), CAMBER_OK);
        assert_null(found);
        assert_int_equal(camber_device_list(context, "no such device", 0, &found), CAMBER_OK);
        assert_null(found);
        assert_int_equal(camber_device_create(context, &named, &device), CAMBER_OK);
        assert_string_equal(camber_device_get_info(device).name, infos[i].name);
        camber_device_destroy(device);
    }
    const camber_device_desc past = {.number = (uint32_t)count + 1};
    assert_int_equal(camber_device_create(context, &past, &device), CAMBER_ERROR_DEVICE);
    assert_story(&h, infos[0].name);
    host_done(&h, context);
}

/* ---- The cache ---- */

/* Opens a device anew with a cache folder, tessellates a line, holds it against the twin. Gives whether the kernels
 * were built from source. */
static bool tessellate_once(const char *cache_dir, camber_method method) {
    host h = {0};
    camber_context_desc context_desc = host_desc(&h);
    context_desc.cache_dir = cache_dir;
    camber_context *context = NULL;
    camber_device *device = NULL;
    camber_mesh *mesh = NULL;
    camber_program *program = NULL;
    camber_polylines *polylines = NULL;
    camber_mesh_data data, twin;
    assert_int_equal(camber_context_create(&context_desc, &context), CAMBER_OK);
    assert_int_equal(camber_device_create(context, NULL, &device), CAMBER_OK);
    assert_int_equal(camber_mesh_create(device, NULL, &mesh), CAMBER_OK);
    const float points[] = {0, 0, 10, 0, 10, 10, 30, 5, 30, 50};
    const uint32_t offsets[] = {0, 5};
    assert_int_equal(
        camber_polylines_create(context, &(camber_polylines_desc){points, 5, offsets, 1, NULL, false}, &polylines),
        CAMBER_OK);
    assert_int_equal(camber_device_program(device, (camber_program_desc){.method = method}, &program), CAMBER_OK);
    const bool built = program->built;
    const camber_stroke stroke = {3, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0};
    const camber_tessellation_desc desc = {&stroke, 1, method, 0, false};
    assert_int_equal(camber_mesh_tessellate(mesh, polylines, &desc), CAMBER_OK);
    assert_int_equal(camber_mesh_read(mesh, &data), CAMBER_OK);
    assert_int_equal(camber_mesh_data_tessellate(context, polylines, &desc, &twin), CAMBER_OK);
    assert_int_equal(data.info.vertex_count, twin.info.vertex_count);
    assert_int_equal(data.info.index_count, twin.info.index_count);
    assert_memory_equal(data.indices, twin.indices, twin.info.index_count * sizeof *twin.indices);
    assert_int_equal(h.errors, 0);
    camber_mesh_data_destroy(&twin);
    camber_mesh_data_destroy(&data);
    camber_polylines_destroy(polylines);
    camber_mesh_destroy(mesh);
    camber_device_destroy(device);
    host_done(&h, context);
    return built;
}

/* The path of the folder's only file. */
static void only_file(const char *folder, char path[512]) {
    DIR *dir = opendir(folder);
    assert_non_null(dir);
    size_t count = 0;
    for (struct dirent *entry = readdir(dir); entry; entry = readdir(dir)) {
        if (entry->d_name[0] == '.')
            continue;
        snprintf(path, 512, "%s/%s", folder, entry->d_name);
        count++;
    }
    closedir(dir);
    assert_int_equal(count, 1);
}

static unsigned char *read_all(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    unsigned char *bytes = malloc(16 << 20);
    assert_non_null(bytes);
    *size = fread(bytes, 1, 16 << 20, file);
    fclose(file);
    return bytes;
}

static void write_all(const char *path, const void *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void test_second_run_loads(void **state) {
    (void)state;
    char folder[64], path[512];
    struct stat before, after;
    folder_make(folder);
    assert_true(tessellate_once(folder, CAMBER_METHOD_STRIP));
    only_file(folder, path);
    assert_int_equal(stat(path, &before), 0);
    assert_true(before.st_size > 100);
    for (int i = 0; i < 3; i++)
        assert_false(tessellate_once(folder, CAMBER_METHOD_STRIP));
    assert_int_equal(stat(path, &after), 0);
    assert_true(before.st_ino == after.st_ino && before.st_size == after.st_size); /* not written again */
    /* Each method has its own file. */
    assert_true(tessellate_once(folder, CAMBER_METHOD_KITE));
    assert_true(tessellate_once(folder, CAMBER_METHOD_FAN));
    for (int method = 0; method < 3; method++)
        assert_false(tessellate_once(folder, (camber_method)method));
    folder_remove(folder);
}

/* Cut off at any length, a bit wrong, another's, or whole by its hash and yet no program: built anew and replaced. */
static void test_damaged_files_are_ignored(void **state) {
    (void)state;
    char folder[64], path[512];
    size_t size = 0, again = 0;
    folder_make(folder);
    assert_true(tessellate_once(folder, CAMBER_METHOD_STRIP));
    only_file(folder, path);
    unsigned char *good = read_all(path, &size);
    unsigned char *bad = malloc(size);
    assert_non_null(bad);
    for (int damage = 0; damage < 10; damage++) {
        const size_t cuts[] = {0, 1, 7, 8, 9, size / 2, size - 1};
        memcpy(bad, good, size);
        size_t bad_size = size;
        if (damage < 7) {
            bad_size = cuts[damage];
        } else if (damage == 7) {
            bad[size / 3] ^= 4;
        } else if (damage == 8) {
            bad[3] ^= 4; /* of the hash */
        } else {         /* noise behind a hash that fits it */
            uint64_t seed = 12;
            for (size_t i = 8; i < size; i++)
                bad[i] = (unsigned char)camber_random_bits(&seed);
            const uint64_t hash = camber_hash(CAMBER_HASH_START, bad + 8, size - 8);
            memcpy(bad, &hash, sizeof hash);
        }
        write_all(path, bad, bad_size);
        assert_true(tessellate_once(folder, CAMBER_METHOD_STRIP));
        unsigned char *now = read_all(path, &again);
        assert_int_equal(again, size);
        free(now);
        assert_false(tessellate_once(folder, CAMBER_METHOD_STRIP));
    }
    free(bad);
    free(good);
    folder_remove(folder);
}

static void test_unwritable_cache(void **state) {
    (void)state;
    char folder[64], below[128];
    folder_make(folder);
    snprintf(below, sizeof below, "%s/file", folder);
    write_all(below, "x", 1);
    snprintf(below, sizeof below, "%s/file/cache", folder);
    assert_true(tessellate_once(below, CAMBER_METHOD_STRIP));
    assert_true(tessellate_once(below, CAMBER_METHOD_STRIP));
    assert_true(tessellate_once("", CAMBER_METHOD_STRIP));
    folder_remove(folder);
}

/* ---- Binaries of PoCL ---- */

enum { CODE_BYTES = 5, BINARY_BYTES = 77 + 8 + 8 + 15 + 4 + CODE_BYTES + 3 };

/* Makes a binary with CODE_BYTES of code, and "end" in place of kernels. From version 10 on it has the size of globals,
 * which is 0. Returns the binary's size. */
static size_t make_binary(unsigned char binary[BINARY_BYTES], unsigned char version) {
    static const unsigned char FILE_SIZE[8] = {15 + 4 + CODE_BYTES}, NAME_SIZE[4] = {11}, CODE_SIZE[4] = {CODE_BYTES};
    memset(binary, 0, BINARY_BYTES);
    memcpy(binary, "poclbin", 8);
    binary[16] = version;
    binary[24] = version > 9 ? 2 : 0;
    memset(binary + 36, 'P', 40);
    unsigned char *at = binary + 77 + (version > 9 ? 8 : 0);
    memcpy(at, FILE_SIZE, 8);
    memcpy(at + 8, NAME_SIZE, 4);
    memcpy(at + 12, "/program.bc", 11);
    memcpy(at + 23, CODE_SIZE, 4);
    memcpy(at + 27, "ABCDEend", CODE_BYTES + 3);
    return (size_t)(at + 27 + CODE_BYTES + 3 - binary);
}

static void test_pocl_strip(void **state) {
    (void)state;
    unsigned char binary[BINARY_BYTES], whole[BINARY_BYTES];
    for (unsigned char version = 8; version <= 13; version++) {
        const size_t size = make_binary(binary, version);
        const bool known = version >= 9 && version <= 12;
        size_t left = size;
        assert_int_equal(camber_pocl_strip(binary, &left), known);
        assert_int_equal(left, known ? size - CODE_BYTES : size);
        if (known) {
            const unsigned char *at = binary + left - 3 - 27;
            assert_memory_equal(at, "\x13\0\0\0\0\0\0\0\x0b\0\0\0/no-code.bc\0\0\0\0end", 30);
            assert_memory_equal(binary + 36, "cPPP", 4);    /* a folder of its own */
            assert_false(camber_pocl_strip(binary, &left)); /* there is no code any more */
        }
    }
    /* A binary that is cut short, or has another byte in a size, a name or the version, stays as it is. */
    const size_t size = make_binary(whole, 9);
    for (size_t left = 0; left < size - 3; left++) {
        size_t now = left;
        memcpy(binary, whole, size);
        assert_false(camber_pocl_strip(binary, &now));
        assert_int_equal(now, left);
        assert_memory_equal(binary, whole, size);
    }
    for (size_t i = 0; i < 77 + 27; i++) {
        size_t now = size;
        memcpy(binary, whole, size);
        binary[i] ^= 0x80;
        const bool counts = i < 8 || (i >= 16 && i < 20) || i >= 77;
        assert_int_equal(camber_pocl_strip(binary, &now), !counts);
    }
}

int main(void) {
    const struct CMUnitTest first[] = {cmocka_unit_test(test_no_platform), cmocka_unit_test(test_pocl_strip)};
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_device_list),
        cmocka_unit_test(test_device_match),
        cmocka_unit_test(test_device_number),
        cmocka_unit_test(test_second_run_loads),
        cmocka_unit_test(test_damaged_files_are_ignored),
        cmocka_unit_test(test_unwritable_cache),
    };
    char pocl_cache[64];
    pocl_cache_apart(pocl_cache);
    setenv("CAMBER_KERNELS", "", 1);
    int failed = cmocka_run_group_tests_name("no platform", first, NULL, NULL);
    if (device_is_there())
        failed += cmocka_run_group_tests_name("program", tests, NULL, NULL);
    else if (failed == 0) {
        puts("skipped: no OpenCL device");
        failed = 77;
    }
    folder_remove(pocl_cache);
    return failed;
}
