/* The n-th call that reads a set of tiles fails, for every n: pread of PMTiles, SQLite's functions of MBTiles, and
 * below them the memory and the system calls that SQLite asks for. The status says so in one line, nothing is kept, and
 * the next run reads the same. camber maps no files; SQLite's own reads are what stands in for them. */
#include "core.h"

#include "camber_map.h"
#include "features/features.h"
#include "tilemaker.h"

#include <errno.h>
#include <sys/types.h>

enum { CALLS_MAX = 20000, TILES = 3 };

static const char STYLE[] = "{\"version\": 8, \"layers\": [{\"id\": \"all\", \"type\": \"line\", \"paint\": "
                            "{\"line-width\": [\"case\", [\"has\", \"kind\"], 3, 2]}}]}";

/* ---- Calls that fail ---- */

typedef enum fault_kind {
    FAULT_NONE = 0,
    FAULT_SQLITE, /* its functions */
    FAULT_MEMORY, /* what they allocate */
    FAULT_SYSTEM, /* what they read by */
    FAULT_PREAD,
} fault_kind;

static struct {
    fault_kind kind;
    size_t calls, first, last; /* refused, counted from 1 */
    size_t refusals;
    const char *refused; /* the first */
    int code;            /* SQLite's, or errno */
    int pending;         /* SQLite's code of the last call, where that was refused */
} fault;

static bool refuses(fault_kind kind, const char *call) {
    if (kind == FAULT_SQLITE)
        fault.pending = 0;
    if (fault.kind != kind)
        return false;
    fault.calls++;
    if (fault.calls < fault.first || fault.calls > fault.last)
        return false;
    if (fault.refusals++ == 0)
        fault.refused = call;
    if (kind == FAULT_SQLITE)
        fault.pending = fault.code;
    return true;
}

static void arm(fault_kind kind, size_t n, bool forever, int code) {
    memset(&fault, 0, sizeof fault);
    fault.kind = kind;
    fault.first = n;
    fault.last = forever ? SIZE_MAX : n;
    fault.code = code;
}

/* CMakeLists.txt links these with --wrap. To bind a whole number asks for nothing, and does not fail. */
#define DECLARE(type, call, parameters)                                                                                \
    type __real_##call parameters;                                                                                     \
    type __wrap_##call parameters;

#define WRAP(type, refusal, call, parameters, arguments)                                                               \
    DECLARE(type, call, parameters)                                                                                    \
    type __wrap_##call parameters {                                                                                    \
        return refuses(FAULT_SQLITE, #call) ? (refusal) : __real_##call arguments;                                     \
    }

WRAP(int, fault.code, sqlite3_step, (sqlite3_stmt * statement), (statement))
WRAP(const unsigned char *, NULL, sqlite3_column_text, (sqlite3_stmt * statement, int at), (statement, at))
WRAP(const void *, NULL, sqlite3_column_blob, (sqlite3_stmt * statement, int at), (statement, at))

DECLARE(int, sqlite3_open_v2, (const char *path, sqlite3 **made, int flags, const char *vfs))
int __wrap_sqlite3_open_v2(const char *path, sqlite3 **made, int flags, const char *vfs) {
    if (!refuses(FAULT_SQLITE, "sqlite3_open_v2"))
        return __real_sqlite3_open_v2(path, made, flags, vfs);
    /* There is something to close even so, but where memory is short. */
    *made = NULL;
    if (fault.code != SQLITE_NOMEM)
        __real_sqlite3_open_v2(path, made, flags, vfs);
    return fault.code;
}

DECLARE(int, sqlite3_prepare_v2,
        (sqlite3 * database, const char *sql, int size, sqlite3_stmt **made, const char **rest))
int __wrap_sqlite3_prepare_v2(sqlite3 *database, const char *sql, int size, sqlite3_stmt **made, const char **rest) {
    if (!refuses(FAULT_SQLITE, "sqlite3_prepare_v2"))
        return __real_sqlite3_prepare_v2(database, sql, size, made, rest);
    *made = NULL;
    return fault.code;
}

DECLARE(int, sqlite3_errcode, (sqlite3 * database))
int __wrap_sqlite3_errcode(sqlite3 *database) {
    return fault.pending ? fault.pending : __real_sqlite3_errcode(database);
}

DECLARE(const char *, sqlite3_errmsg, (sqlite3 * database))
const char *__wrap_sqlite3_errmsg(sqlite3 *database) {
    return fault.pending ? sqlite3_errstr(fault.pending) : __real_sqlite3_errmsg(database);
}

/* ---- pread: by one of its two names ---- */

/* The fault of a call: it fails, is interrupted, reads a byte only, or comes to the end of a file that was longer. */
enum { CUT_OFF = 10000, SHORT };

static ssize_t refuse_read(void) {
    if (fault.code == CUT_OFF)
        return 0;
    errno = fault.code;
    return -1;
}

DECLARE(ssize_t, pread, (int file, void *bytes, size_t size, off_t at))
ssize_t __wrap_pread(int file, void *bytes, size_t size, off_t at) {
    if (!refuses(FAULT_PREAD, "pread"))
        return __real_pread(file, bytes, size, at);
    return fault.code == SHORT ? __real_pread(file, bytes, size > 0, at) : refuse_read();
}

DECLARE(ssize_t, pread64, (int file, void *bytes, size_t size, off_t at))
ssize_t __wrap_pread64(int file, void *bytes, size_t size, off_t at) {
    if (!refuses(FAULT_PREAD, "pread"))
        return __real_pread64(file, bytes, size, at);
    return fault.code == SHORT ? __real_pread64(file, bytes, size > 0, at) : refuse_read();
}

/* ---- Below SQLite ---- */

static sqlite3_mem_methods memory;

static void *allocate(int size) {
    return refuses(FAULT_MEMORY, "an allocation") ? NULL : memory.xMalloc(size);
}

static void *reallocate(void *block, int size) {
    return refuses(FAULT_MEMORY, "an allocation") ? NULL : memory.xRealloc(block, size);
}

/* Before SQLite is used for the first time. Every allocation is one, without a store of small ones. */
static void take_over_memory(void) {
    sqlite3_mem_methods own;
    assert_int_equal(sqlite3_config(SQLITE_CONFIG_GETMALLOC, &memory), SQLITE_OK);
    own = memory;
    own.xMalloc = allocate;
    own.xRealloc = reallocate;
    assert_int_equal(sqlite3_config(SQLITE_CONFIG_MALLOC, &own), SQLITE_OK);
    assert_int_equal(sqlite3_config(SQLITE_CONFIG_LOOKASIDE, 0, 0), SQLITE_OK);
}

static ssize_t read_of_sqlite(int file, void *bytes, size_t size, off_t at) {
    return refuses(FAULT_SYSTEM, "a read") ? refuse_read() : __real_pread(file, bytes, size, at);
}

static void take_over_reads(void) {
    sqlite3_vfs *vfs = sqlite3_vfs_find(NULL);
    sqlite3_syscall_ptr own;
    ssize_t (*read_own)(int, void *, size_t, off_t) = read_of_sqlite;
    memcpy(&own, &read_own, sizeof own);
    assert_non_null(vfs);
    assert_int_equal(vfs->xSetSystemCall(vfs, vfs->xGetSystemCall(vfs, "pread64") ? "pread64" : "pread", own),
                     SQLITE_OK);
}

/* ---- Files ---- */

typedef struct desk {
    host h;
    camber_context *context;
    char folder[64], mbtiles[128], pmtiles[128];
    const char *path;
    camber_style *style;
    uint64_t wanted; /* of the path */
} desk;

static blob make_tile(int at) {
    blob layer = begin_layer("roads", 4096), tile = {0};
    put_key(&layer, "kind");
    put_text_value(&layer, "street");
    put_feature(&layer, 1, 0, 0, false, (int[]){100 + at, 100, 900, 500 + at, 2000, 300}, 3);
    put_layer(&tile, &layer);
    return tile;
}

static void make_files(desk *d) {
    made_tile tiles[TILES] = {{1, 0, 0, {0}}, {1, 0, 1, {0}}, {1, 1, 1, {0}}}; /* as the curve goes */
    made_archive archive = {.directory_compression = 1, .tile_compression = 1, .type = 1, .min_zoom = 1, .max_zoom = 1};
    made_entry entries[TILES], leaf = {1, 0, 0, 0};
    static const char layers[] = "{\"vector_layers\":[{\"id\":\"roads\"}]}";
    for (int i = 0; i < TILES; i++) {
        tiles[i].content = make_tile(i);
        entries[i] = (made_entry){1 + (uint64_t)i, 1, archive.tiles.size, tiles[i].content.size};
        blob_put(&archive.tiles, tiles[i].content.bytes, tiles[i].content.size);
    }
    archive.leaves = directory_of(entries, TILES);
    leaf.size = archive.leaves.size;
    archive.root = directory_of(&leaf, 1);
    blob_put(&archive.metadata, layers, sizeof layers - 1);
    blob file = archive_of(&archive);
    assert_true(blob_write(&file, d->pmtiles));
    assert_true(write_mbtiles(d->mbtiles, tiles, TILES,
                              "INSERT INTO metadata VALUES ('format', 'pbf'), ('minzoom', '1'), ('maxzoom', '1'), "
                              "('json', '{\"vector_layers\":[{\"id\":\"roads\"}]}')"));
    blob *const made[] = {&file, &archive.root, &archive.leaves, &archive.metadata, &archive.tiles};
    for (size_t i = 0; i < sizeof made / sizeof *made; i++)
        blob_free(made[i]);
    for (int i = 0; i < TILES; i++)
        blob_free(&tiles[i].content);
}

static uint64_t hash_features(const camber_features *f) {
    uint64_t hash = camber_hash(CAMBER_HASH_START, f->points, 2 * f->point_count * sizeof *f->points);
    if (f->polyline_count)
        hash = camber_hash(hash, f->offsets, (f->polyline_count + 1) * sizeof *f->offsets);
    hash = camber_hash(hash, &f->feature_count, sizeof f->feature_count);
    return camber_hash(hash, &f->stats.damaged_features, sizeof f->stats.damaged_features);
}

static camber_status read_file(desk *d, uint64_t *hash) {
    const camber_source_desc desc = {.path = d->path};
    camber_features *features = NULL;
    camber_status status = camber_features_create(d->context, d->style, &features);
    if (status == CAMBER_OK)
        status = camber_features_read(features, &desc);
    *hash = status == CAMBER_OK ? hash_features(features) : 0;
    if (status != CAMBER_OK)
        assert_int_equal(features->point_count, 0);
    camber_features_destroy(features);
    return status;
}

static void choose(desk *d, const char *path) {
    d->path = path;
    d->h.warnings = 0;
    if (read_file(d, &d->wanted) != CAMBER_OK)
        fail_msg("%s", d->h.last);
    assert_int_equal(d->h.warnings, 0);
}

/* ---- Every call ---- */

/* A status that a fault may end with, next to that of a run that does without. */
typedef struct verdict {
    camber_status status, other;
    bool may_differ; /* what is damaged is left out, and said */
} verdict;

static void judge(desk *d, camber_status status, uint64_t hash, verdict wanted, size_t n) {
    const char *call = fault.refused ? fault.refused : "no call";
    fault.kind = FAULT_NONE;
    if (status == CAMBER_OK) {
        assert_int_equal(d->h.errors, 0);
        if (hash != d->wanted && !(wanted.may_differ && d->h.warnings))
            fail_msg("%s: call %zu, %s, was refused: other lines were read, and nothing was said", d->path, n, call);
        return;
    }
    if (status != wanted.status && status != wanted.other)
        fail_msg("%s: call %zu, %s, was refused: %s: %s", d->path, n, call, camber_status_get_name(status), d->h.last);
    assert_story(&d->h, NULL);
}

static void each_fails(desk *d, fault_kind kind, int code, verdict wanted, size_t least) {
    uint64_t hash;
    for (int forever = 0; forever < 2; forever++) {
        size_t n = 1, refusals = 1;
        for (; refusals; n++) {
            assert_true(n < CALLS_MAX);
            const size_t live = d->h.live_blocks;
            const sqlite3_int64 used = sqlite3_memory_used();
            d->h.errors = d->h.warnings = 0;
            arm(kind, n, forever, code);
            const camber_status status = read_file(d, &hash);
            refusals = fault.refusals;
            judge(d, status, hash, wanted, n);
            assert_true(refusals || status == CAMBER_OK);
            assert_int_equal(d->h.live_blocks, live);
            assert_int_equal(sqlite3_memory_used(), used);
            assert_int_equal(read_file(d, &hash), CAMBER_OK);
            assert_true(hash == d->wanted);
        }
        assert_true(n > least);
    }
}

static void test_sqlite(void **state) {
    desk *d = *state;
    choose(d, d->mbtiles);
    each_fails(d, FAULT_SQLITE, SQLITE_NOMEM, (verdict){CAMBER_ERROR_MEMORY, CAMBER_ERROR_MEMORY, false}, 10);
    each_fails(d, FAULT_SQLITE, SQLITE_IOERR, (verdict){CAMBER_ERROR_IO, CAMBER_ERROR_INPUT, false}, 10);
    each_fails(d, FAULT_SQLITE, SQLITE_BUSY, (verdict){CAMBER_ERROR_IO, CAMBER_ERROR_IO, false}, 10);
    each_fails(d, FAULT_SQLITE, SQLITE_CORRUPT, (verdict){CAMBER_ERROR_INPUT, CAMBER_ERROR_INPUT, false}, 10);
}

static void test_sqlite_memory(void **state) {
    desk *d = *state;
    choose(d, d->mbtiles);
    each_fails(d, FAULT_MEMORY, SQLITE_NOMEM, (verdict){CAMBER_ERROR_MEMORY, CAMBER_ERROR_MEMORY, false}, 30);
}

static void test_sqlite_reads(void **state) {
    desk *d = *state;
    choose(d, d->mbtiles);
    each_fails(d, FAULT_SYSTEM, EIO, (verdict){CAMBER_ERROR_IO, CAMBER_ERROR_INPUT, false}, 3);
    each_fails(d, FAULT_SYSTEM, CUT_OFF, (verdict){CAMBER_ERROR_IO, CAMBER_ERROR_INPUT, false}, 3);
}

static void test_pread(void **state) {
    desk *d = *state;
    choose(d, d->pmtiles);
    each_fails(d, FAULT_PREAD, EIO, (verdict){CAMBER_ERROR_IO, CAMBER_ERROR_IO, false}, 6);
    each_fails(d, FAULT_PREAD, CUT_OFF, (verdict){CAMBER_ERROR_INPUT, CAMBER_ERROR_INPUT, true}, 6);
}

/* No failures: the read goes on. */
static void test_pread_goes_on(void **state) {
    desk *d = *state;
    uint64_t hash;
    choose(d, d->pmtiles);
    for (size_t n = 1; n < 20; n++) {
        arm(FAULT_PREAD, n, false, EINTR);
        assert_int_equal(read_file(d, &hash), CAMBER_OK);
        assert_true(hash == d->wanted);
    }
    arm(FAULT_PREAD, 1, true, SHORT);
    assert_int_equal(read_file(d, &hash), CAMBER_OK);
    assert_true(hash == d->wanted && fault.refusals > 127);
    fault.kind = FAULT_NONE;
}

static int set_up(void **state) {
    desk *d = calloc(1, sizeof *d);
    assert_non_null(d);
    take_over_memory();
    take_over_reads();
    d->context = host_context(&d->h);
    folder_make(d->folder);
    snprintf(d->mbtiles, sizeof d->mbtiles, "%s/tiles.mbtiles", d->folder);
    snprintf(d->pmtiles, sizeof d->pmtiles, "%s/tiles.pmtiles", d->folder);
    make_files(d);
    assert_int_equal(camber_style_parse(d->context, STYLE, sizeof STYLE - 1, "style", &d->style), CAMBER_OK);
    *state = d;
    return 0;
}

static int tear_down(void **state) {
    desk *d = *state;
    camber_style_destroy(d->style);
    host_done(&d->h, d->context);
    folder_remove(d->folder);
    free(d);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sqlite), cmocka_unit_test(test_sqlite_memory), cmocka_unit_test(test_sqlite_reads),
        cmocka_unit_test(test_pread),  cmocka_unit_test(test_pread_goes_on),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
