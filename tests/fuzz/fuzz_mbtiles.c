/* An MBTiles that SQL makes: read as a file, and through a style's source.
 *
 * The input is statements, which a database in memory runs under strict limits; those that fail are passed over. What
 * came of it, views and broken schemas included, is then a file that camber opens as any other. */
#include "fuzz_tile_file.h"

#include <sqlite3.h>
#include <stdlib.h>
#include <string.h>

/* Limits for making the database: the target tests reading it. */
enum { STEPS_A_CALL = 1000, MOST_CALLS = 100, LARGEST_VALUE_BYTES = 1 << 16, LARGEST_FILE_BYTES = 1 << 20 };

/* Where the SQL makes none; then it runs once more, over these. */
static const char tables[] = "CREATE TABLE IF NOT EXISTS metadata (name, value);"
                             "CREATE TABLE IF NOT EXISTS tiles (zoom_level, tile_column, tile_row, tile_data);";

/* ---- Making ---- */

static int count_steps(void *user) {
    return ++*(int *)user > MOST_CALLS;
}

/* Nothing but the database in memory: no other files, and of the settings those alone that a file carries. */
static int allow(void *user, int action, const char *first, const char *second, const char *database,
                 const char *trigger) {
    static const char *const settings[] = {"application_id",     "auto_vacuum",  "encoding",       "page_size",
                                           "recursive_triggers", "user_version", "writable_schema"};
    (void)user, (void)second, (void)database, (void)trigger;
    if (action == SQLITE_ATTACH || action == SQLITE_DETACH)
        return SQLITE_DENY;
    if (action != SQLITE_PRAGMA)
        return SQLITE_OK;
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++)
        if (sqlite3_stricmp(first, settings[i]) == 0)
            return SQLITE_OK;
    return SQLITE_DENY;
}

static sqlite3 *open_database(int *calls) {
    sqlite3 *made = NULL;
    REQUIRE(sqlite3_open_v2(":memory:", &made, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, NULL) == SQLITE_OK);
    sqlite3_limit(made, SQLITE_LIMIT_LENGTH, LARGEST_VALUE_BYTES);
    sqlite3_progress_handler(made, STEPS_A_CALL, count_steps, calls);
    sqlite3_set_authorizer(made, allow, NULL);
    return made;
}

static void run_statements(sqlite3 *database, const char *sql) {
    while (*sql) {
        const char *rest = NULL;
        sqlite3_stmt *statement = NULL;
        if (sqlite3_prepare_v2(database, sql, -1, &statement, &rest) == SQLITE_OK) {
            while (sqlite3_step(statement) == SQLITE_ROW)
                ;
        } else {
            rest = sql + strcspn(sql, ";\n");
            rest += *rest != 0;
        }
        sqlite3_finalize(statement);
        sql = rest;
    }
}

/* Returns the database as a file, to be freed with sqlite3_free. NULL: the SQL has made none, as within a transaction.
 */
static unsigned char *make_file(const uint8_t *bytes, size_t size, size_t *made_bytes) {
    int calls = 0;
    sqlite3 *database = open_database(&calls);
    char *sql = malloc(size + 1);
    REQUIRE(sql);
    memcpy(sql, bytes, size);
    sql[size] = 0;
    run_statements(database, sql);
    calls = 0;
    if (sqlite3_exec(database, "SELECT 1 FROM tiles LIMIT 0", NULL, NULL, NULL) != SQLITE_OK) {
        sqlite3_exec(database, tables, NULL, NULL, NULL);
        run_statements(database, sql);
    }
    free(sql);
    calls = 0;
    if (!sqlite3_get_autocommit(database))
        sqlite3_exec(database, "COMMIT", NULL, NULL, NULL);
    sqlite3_set_authorizer(database, NULL, NULL); /* to be written takes settings too */
    sqlite3_int64 length = 0;
    unsigned char *made = sqlite3_serialize(database, "main", &length, 0);
    sqlite3_close(database);
    *made_bytes = made ? (size_t)length : 0;
    return made;
}

/* ---- All of it ---- */

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    size_t made_bytes;
    unsigned char *made = make_file(bytes, size, &made_bytes);
    if (made_bytes > 0 && made_bytes <= LARGEST_FILE_BYTES)
        fuzz_read_tiles(run, made, made_bytes, "mbtiles");
    sqlite3_free(made);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    fuzz_each(bytes, size, use);
    return 0;
}
