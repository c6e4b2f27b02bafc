/* The cache of encoded tiles: what stays, what goes, how many bytes it has, and what the tags of bodies say. */
#include "core.h"

#include "serve/gzip.h"
#include "serve/tile_cache.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum { BODY_BYTES = 1000, THREADS = 4, ROUNDS = 20000, PLACES = 500 };

static camber_tile_key key(uint64_t place) {
    return (camber_tile_key){place, 1, 0};
}

static camber_body *make_body(unsigned char value) {
    unsigned char bytes[BODY_BYTES];
    memset(bytes, value, sizeof bytes);
    camber_body *body = camber_body_create(bytes, sizeof bytes);
    assert_non_null(body);
    return body;
}

static void put(camber_tile_cache *cache, uint64_t place) {
    camber_body *body = make_body((unsigned char)place);
    camber_tile_cache_put(cache, key(place), body, camber_tile_cache_get_generation(cache, 0));
    camber_body_release(body);
}

static bool has(camber_tile_cache *cache, uint64_t place) {
    camber_body *body = camber_tile_cache_get(cache, key(place));
    const bool found = body != NULL;
    if (found)
        assert_int_equal(body->bytes[BODY_BYTES - 1], (unsigned char)place);
    camber_body_release(body);
    return found;
}

static void forgets_what_was_used_longest_ago(void **state) {
    camber_tile_cache *cache = camber_tile_cache_create(3 * (BODY_BYTES + 300), 1, NULL);
    (void)state;
    put(cache, 1);
    put(cache, 2);
    put(cache, 3);
    assert_true(has(cache, 1)); /* used: 2 is the oldest now */
    put(cache, 4);
    assert_true(has(cache, 1) && has(cache, 3) && has(cache, 4));
    assert_false(has(cache, 2));
    const camber_tile_cache_stats stats = camber_tile_cache_get_stats(cache);
    assert_int_equal(stats.tiles, 3);
    assert_int_equal(stats.hits, 4);
    assert_int_equal(stats.misses, 1);
    assert_true(stats.size_bytes >= 3 * BODY_BYTES && stats.size_bytes <= 3 * (BODY_BYTES + 300));
    camber_tile_cache_destroy(cache);
}

static void keeps_its_bound(void **state) {
    const size_t most = 100 * (BODY_BYTES + 300);
    camber_tile_cache *cache = camber_tile_cache_create(most, 1, NULL);
    (void)state;
    for (uint64_t place = 0; place < 10000; place++) {
        put(cache, place);
        assert_true(camber_tile_cache_get_stats(cache).size_bytes <= most);
    }
    assert_true(camber_tile_cache_get_stats(cache).tiles >= 100);
    assert_true(has(cache, 9999) && !has(cache, 0));
    void *bytes = calloc(1, most);
    camber_body *large = camber_body_create(bytes, most);
    camber_tile_cache_put(cache, key(77), large, camber_tile_cache_get_generation(cache, 0));
    assert_null(camber_tile_cache_get(cache, key(77))); /* and nothing went for it */
    assert_true(has(cache, 9999));
    camber_body_release(large);
    free(bytes);
    camber_tile_cache_destroy(cache);
}

static void grows(void **state) {
    camber_tile_cache *cache = camber_tile_cache_create(64 << 20, 1, NULL);
    (void)state;
    for (uint64_t place = 0; place < 5000; place++)
        put(cache, place);
    for (uint64_t place = 0; place < 5000; place++)
        assert_true(has(cache, place));
    put(cache, 7);
    assert_int_equal(camber_tile_cache_get_stats(cache).tiles, 5000);
    camber_tile_cache_destroy(cache);
}

/* A tile of one input is not kept among tiles of the next. */
static void begins_anew(void **state) {
    camber_tile_cache *cache = camber_tile_cache_create(1 << 20, 1, NULL);
    camber_body *late = make_body(9);
    (void)state;
    const uint64_t before = camber_tile_cache_get_generation(cache, 0);
    put(cache, 1);
    camber_tile_cache_clear(cache, 0, 0);
    assert_int_equal(camber_tile_cache_get_stats(cache).tiles, 0);
    assert_int_equal(camber_tile_cache_get_stats(cache).size_bytes, 0);
    camber_tile_cache_put(cache, key(9), late, before);
    assert_false(has(cache, 9) || has(cache, 1));
    camber_tile_cache_put(cache, key(9), late, camber_tile_cache_get_generation(cache, 0));
    assert_true(has(cache, 9));
    camber_body_release(late);
    camber_tile_cache_destroy(cache);
}

/* Maps share the memory, and nothing else. */
static void keeps_maps_apart(void **state) {
    camber_tile_cache *cache = camber_tile_cache_create(1 << 20, 2, NULL);
    camber_body *body = make_body(5);
    camber_tile_key other = key(5);
    (void)state;
    other.map = 1;
    put(cache, 5);
    assert_null(camber_tile_cache_get(cache, other));
    camber_tile_cache_put(cache, other, body, camber_tile_cache_get_generation(cache, 1));
    camber_tile_cache_clear(cache, 0, 0);
    assert_false(has(cache, 5));
    camber_body *found = camber_tile_cache_get(cache, other);
    assert_ptr_equal(found, body);
    assert_int_equal(camber_tile_cache_get_stats(cache).tiles, 1);
    camber_body_release(found);
    camber_body_release(body);
    camber_tile_cache_destroy(cache);
}

static void keeps_a_body_that_is_sent(void **state) {
    camber_tile_cache *cache = camber_tile_cache_create(BODY_BYTES + 300, 1, NULL);
    (void)state;
    put(cache, 1);
    camber_body *sent = camber_tile_cache_get(cache, key(1));
    put(cache, 2);
    assert_false(has(cache, 1));
    assert_int_equal(sent->bytes[0], 1);
    camber_body_release(sent);
    camber_tile_cache_destroy(cache);
}

static void tags_differ_where_bytes_do(void **state) {
    char tags[300][CAMBER_ETAG_SIZE];
    unsigned char bytes[300] = {0};
    (void)state;
    for (size_t i = 0; i < 300; i++) { /* one byte differs, or one is there more */
        bytes[i / 2] ^= i % 2 ? 0 : 1;
        camber_body *body = camber_body_create(bytes, i);
        memcpy(tags[i], body->etag, sizeof tags[i]);
        assert_true(tags[i][0] == '"' && tags[i][strlen(tags[i]) - 1] == '"' && strlen(tags[i]) > 16);
        for (size_t k = 0; k < i; k++)
            assert_string_not_equal(tags[k], tags[i]);
        camber_body_release(body);
    }
    camber_body *one = make_body(1), *same = make_body(1);
    assert_string_equal(one->etag, same->etag);
    camber_body_release(one);
    camber_body_release(same);
}

static void packs_and_unpacks(void **state) {
    static const char *const taken[] = {"gzip", "deflate, gzip", "gzip;q=0.5", "br;q=1, GZIP ; q=1", "*", "x,gzip"};
    static const char *const refused[] = {"", "identity", "gzip;q=0", "gzip; q=0.000", "gzipx", "x-gzip", "br"};
    camber_body *body = make_body('a'), *small = camber_body_create("abc", 3);
    (void)state;
    for (size_t i = 0; i < sizeof taken / sizeof *taken; i++)
        assert_true(camber_accepts_gzip(taken[i]));
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
        assert_false(camber_accepts_gzip(refused[i]));
    assert_false(camber_accepts_gzip(NULL));
    camber_body *packed = camber_body_gzip(body);
    assert_non_null(packed);
    assert_string_equal(packed->encoding, "gzip");
    assert_true(packed->size_bytes < body->size_bytes / 2);
    assert_string_not_equal(packed->etag, body->etag);
    camber_body *again = camber_body_gunzip(packed, BODY_BYTES);
    assert_non_null(again);
    assert_string_equal(again->etag, body->etag);
    assert_null(camber_body_gunzip(packed, BODY_BYTES - 1));
    assert_null(camber_body_gunzip(body, 1 << 20));
    assert_null(camber_body_gzip(small));
    packed->size_bytes -= 9; /* cut off */
    assert_null(camber_body_gunzip(packed, 1 << 20));
    camber_body_release(body);
    camber_body_release(small);
    camber_body_release(packed);
    camber_body_release(again);
}

static void *use(void *user) {
    camber_tile_cache *cache = user;
    unsigned state = 1;
    for (int i = 0; i < ROUNDS; i++) {
        state = state * 1103515245u + 12345u;
        const uint64_t place = (state >> 8) % PLACES;
        camber_body *body = camber_tile_cache_get(cache, key(place));
        if (body && body->bytes[5] != (unsigned char)place)
            return cache;
        camber_body_release(body);
        if (!body) {
            unsigned char bytes[BODY_BYTES];
            memset(bytes, (int)(unsigned char)place, sizeof bytes);
            body = camber_body_create(bytes, sizeof bytes);
            camber_tile_cache_put(cache, key(place), body, camber_tile_cache_get_generation(cache, 0));
            camber_body_release(body);
        }
        if (i % 4096 == 0)
            camber_tile_cache_clear(cache, 0, 0);
    }
    return NULL;
}

static void serves_threads(void **state) {
    camber_tile_cache *cache = camber_tile_cache_create(PLACES / 2 * BODY_BYTES, 1, NULL);
    pthread_t threads[THREADS];
    (void)state;
    for (int i = 0; i < THREADS; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, use, cache), 0);
    for (int i = 0; i < THREADS; i++) {
        void *wrong;
        pthread_join(threads[i], &wrong);
        assert_null(wrong);
    }
    camber_tile_cache_destroy(cache);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forgets_what_was_used_longest_ago),
        cmocka_unit_test(keeps_its_bound),
        cmocka_unit_test(grows),
        cmocka_unit_test(begins_anew),
        cmocka_unit_test(keeps_maps_apart),
        cmocka_unit_test(keeps_a_body_that_is_sent),
        cmocka_unit_test(tags_differ_where_bytes_do),
        cmocka_unit_test(packs_and_unpacks),
        cmocka_unit_test(serves_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
