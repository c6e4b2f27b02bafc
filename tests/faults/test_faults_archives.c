/* Writing an archive: the n-th call fails, for every n, of allocations, of the calls that write files, and of SQLite's.
 * The status says so in one line, the archive that was there stays as it was, no half of one is left, and the same
 * writing succeeds afterwards, to the same bytes. */
#include "core.h"

#include "archive/archive.h"
#include "archive/pmtiles.h"
#include "tile_maker.h"

#include <errno.h>
#include <sqlite3.h>
#include <sys/types.h>

enum { TILES = 85, UNIT = 17, CALLS_MAX = 100000 };

/* ---- Calls that fail ---- */

static struct {
    bool armed;
    size_t calls, at; /* counted from 1 */
    size_t refusals;
    int cause;
    const char *refused;
} fault;

static bool refuses(const char *call) {
    if (!fault.armed || ++fault.calls != fault.at)
        return false;
    fault.refusals++;
    fault.refused = call;
    errno = fault.cause;
    return true;
}

/* CMakeLists.txt links these with --wrap. */
#define WRAP(type, refusal, call, parameters, arguments)                                                               \
    type __real_##call parameters;                                                                                     \
    type __wrap_##call parameters;                                                                                     \
    type __wrap_##call parameters {                                                                                    \
        return refuses(#call) ? (refusal) : __real_##call arguments;                                                   \
    }

WRAP(ssize_t, -1, pwrite, (int file, const void *bytes, size_t size, off_t at), (file, bytes, size, at))
WRAP(ssize_t, -1, pwrite64, (int file, const void *bytes, size_t size, off_t at), (file, bytes, size, at))
WRAP(int, -1, rename, (const char *from, const char *to), (from, to))
WRAP(int, -1, ftruncate, (int file, off_t size), (file, size))
WRAP(int, -1, ftruncate64, (int file, off_t size), (file, size))
WRAP(int, -1, mkdir, (const char *path, mode_t mode), (path, mode))
WRAP(int, SQLITE_FULL, sqlite3_step, (sqlite3_stmt * statement), (statement))

/* Disks are not what is tested: a sync that does not fail does nothing. */
int __wrap_fsync(int file);
int __wrap_fsync(int file) {
    (void)file;
    return refuses("fsync") ? -1 : 0;
}

/* ---- Writing ---- */

typedef struct place {
    host host;
    camber_context *context;
    char folder[64], path[128];
} place;

static camber_status add_tiles(camber_archive_writer *writer) {
    unsigned char bytes[MADE_TILE_BYTES];
    camber_status status = CAMBER_OK;
    for (uint64_t number = 0; number < TILES && status == CAMBER_OK; number++) {
        const int zoom = camber_archive_zoom(number);
        camber_tile_index tile;
        camber_pmtiles_locate(number - camber_archive_first(zoom), zoom, &tile.column, &tile.row);
        const size_t size = make_tile(made_tile_value(number), bytes);
        status = camber_archive_writer_add(writer, zoom, tile, bytes, size);
        if (status == CAMBER_OK && number % UNIT == UNIT - 1)
            status = camber_archive_writer_end_unit(writer, number / UNIT);
    }
    return status;
}

static camber_status write_archive(place *p) {
    camber_archive_writer *writer = NULL;
    camber_archive_desc desc = {
        .path = p->path, .type = CAMBER_TILE_PNG, .force = true, .fingerprint = "input=made style=plain"};
    assert_true(camber_archive_get_format(p->path, &desc.format));
    camber_status status = camber_archive_writer_create(p->context, &desc, &writer);
    if (status == CAMBER_OK)
        status = add_tiles(writer);
    if (status == CAMBER_OK)
        status = camber_archive_writer_finish(writer);
    camber_archive_writer_destroy(writer);
    return status;
}

static uint64_t hash_of(place *p, const char *name) {
    char path[160], *bytes = NULL;
    size_t size = 0;
    snprintf(path, sizeof path, "%s%s", p->path, name);
    assert_int_equal(camber_read_file(p->context, path, CAMBER_NAMED_BY_CALLER, &bytes, &size), CAMBER_OK);
    const uint64_t hash = camber_hash(CAMBER_HASH_START, bytes, size);
    camber_free(p->context, bytes);
    return hash;
}

static bool has_whole(const place *p) {
    char path[160];
    snprintf(path, sizeof path, "%s.camber-whole", p->path);
    return access(path, F_OK) == 0;
}

/* An archive of other bytes stands there before. */
static uint64_t put_old(place *p, const char *inner) {
    if (*inner)
        return hash_of(p, inner);
    FILE *file = fopen(p->path, "wb");
    assert_non_null(file);
    assert_true(fputs("old", file) >= 0);
    assert_int_equal(fclose(file), 0);
    return hash_of(p, "");
}

static void fail_once(place *p, const char *inner, uint64_t whole, bool memory, size_t n, size_t *refusals) {
    const uint64_t old = put_old(p, inner);
    p->host.errors = 0;
    p->host.calls = 0;
    p->host.refuse_first = memory ? n : 0;
    p->host.refuse_count = 1;
    fault.armed = !memory;
    fault.calls = 0;
    fault.at = n;
    fault.refusals = 0;
    const camber_status status = write_archive(p);
    const bool refused = memory ? p->host.calls >= n : fault.refusals > 0;
    fault.armed = false;
    p->host.refuse_first = 0;
    *refusals += refused;
    assert_false(has_whole(p));
    if (status != CAMBER_OK) {
        assert_true(refused);
        assert_int_equal(p->host.errors, 1);
        assert_non_null(strstr(p->host.last, ";"));
        assert_int_equal(hash_of(p, inner), old);
    } else {
        assert_int_equal(hash_of(p, inner), whole);
    }
}

static void each_fails(const char *ending, const char *inner, bool memory, int cause) {
    place p = {.folder = "/tmp/camber-faults-XXXXXX"};
    assert_non_null(mkdtemp(p.folder));
    p.context = host_context(&p.host);
    snprintf(p.path, sizeof p.path, "%s/out%s", p.folder, ending);
    assert_int_equal(write_archive(&p), CAMBER_OK);
    const uint64_t whole = hash_of(&p, inner);
    size_t refusals = 0, before = SIZE_MAX;
    fault.cause = cause;
    for (size_t n = 1; n < CALLS_MAX && before != refusals; n++) {
        before = refusals;
        fail_once(&p, inner, whole, memory, n, &refusals);
    }
    print_message("%s, %s: %zu calls\n", ending, memory ? "memory" : strerror(cause), refusals);
    assert_true(refusals >= 10);
    assert_int_equal(write_archive(&p), CAMBER_OK);
    assert_int_equal(hash_of(&p, inner), whole);
    host_done(&p.host, p.context);
    char command[96];
    snprintf(command, sizeof command, "rm -rf '%s'", p.folder);
    assert_int_equal(system(command), 0);
}

static void test_pmtiles(void **state) {
    (void)state;
    each_fails(".pmtiles", "", false, ENOSPC);
    each_fails(".pmtiles", "", false, EIO);
    each_fails(".pmtiles", "", true, 0);
}

static void test_mbtiles(void **state) {
    (void)state;
    each_fails(".mbtiles", "", false, ENOSPC);
    each_fails(".mbtiles", "", true, 0);
}

static void test_folder(void **state) {
    (void)state;
    each_fails("/", "/1/0/0.png", false, EROFS);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pmtiles),
        cmocka_unit_test(test_mbtiles),
        cmocka_unit_test(test_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
