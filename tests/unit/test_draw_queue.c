/* The queue of pictures, with a painter of the test's own: one drawing for all who wait, tiles at their places, bounds,
 * clients that have left, failures, and the end. */
#include "core.h"

#include "serve/draw_queue.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { QUEUED = 3, PICTURES = 2, MOST_ASKS = 64, MOST_PROBES = 100000 };

typedef struct stand {
    camber_tile_cache *cache;
    camber_metrics metrics;
    camber_draw_queue *drawing;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    bool held, fails; /* the painter waits; it cannot draw */
    int drawn, done, prepared;
    bool drawing_now;
} stand;

typedef struct asker {
    camber_tile_request ask;
    stand *stand;
    bool left, told;
} asker;

/* A tile is of one colour: its column and row. */
static camber_status paint(void *user, const camber_route_request *request, camber_rendered_picture *drawn) {
    stand *e = user;
    pthread_mutex_lock(&e->mutex);
    e->drawing_now = true;
    pthread_cond_broadcast(&e->changed);
    while (e->held)
        pthread_cond_wait(&e->changed, &e->mutex);
    e->drawing_now = false;
    e->drawn++;
    const bool fails = e->fails;
    pthread_mutex_unlock(&e->mutex);
    if (fails)
        return CAMBER_ERROR_DEVICE;
    const bool whole = request->route == CAMBER_ROUTE_STATIC;
    drawn->side = whole ? 1 : camber_draw_queue_side(2, request->zoom, request->ratio);
    drawn->tile_px = 16;
    drawn->width = drawn->height = 16 * drawn->side;
    drawn->opaque = true;
    if (!camber_rendered_picture_resize(drawn))
        return CAMBER_ERROR_MEMORY;
    for (uint32_t y = 0; y < drawn->height; y++)
        for (uint32_t x = 0; x < drawn->width; x++) {
            const uint32_t column = request->column / drawn->side * drawn->side + x / 16;
            const uint32_t row = request->row / drawn->side * drawn->side + y / 16;
            const uint8_t pixel[4] = {(uint8_t)column, (uint8_t)row, (uint8_t)request->zoom, 255};
            memcpy(drawn->rgba + 4 * ((size_t)y * drawn->width + x), pixel, 4);
        }
    return CAMBER_OK;
}

static bool prepare(void *user) {
    stand *e = user;
    pthread_mutex_lock(&e->mutex);
    e->prepared++;
    pthread_cond_broadcast(&e->changed);
    pthread_mutex_unlock(&e->mutex);
    return false;
}

static void take(camber_tile_request *ask) {
    asker *a = ask->user;
    pthread_mutex_lock(&a->stand->mutex);
    a->told = true;
    a->stand->done++;
    pthread_cond_broadcast(&a->stand->changed);
    pthread_mutex_unlock(&a->stand->mutex);
}

static bool has_left(const camber_tile_request *ask) {
    return ((const asker *)ask->user)->left;
}

static int set_up(void **state) {
    stand *e = calloc(1, sizeof *e);
    pthread_mutex_init(&e->mutex, NULL);
    pthread_cond_init(&e->changed, NULL);
    e->cache = camber_tile_cache_create(1 << 20, 1, NULL);
    const camber_draw_queue_desc desc = {.cache = e->cache,
                                         .metrics = &e->metrics,
                                         .draw = paint,
                                         .prepare = prepare,
                                         .user = e,
                                         .side = 2,
                                         .threads = 2,
                                         .most_queued = QUEUED,
                                         .most_pictures = PICTURES};
    e->drawing = camber_draw_queue_create(&desc);
    assert_non_null(e->drawing);
    *state = e;
    return 0;
}

static int tear_down(void **state) {
    stand *e = *state;
    camber_draw_queue_destroy(e->drawing);
    camber_tile_cache_destroy(e->cache);
    pthread_cond_destroy(&e->changed);
    pthread_mutex_destroy(&e->mutex);
    free(e);
    return 0;
}

static void hold(stand *e, bool held) {
    pthread_mutex_lock(&e->mutex);
    e->held = held;
    pthread_cond_broadcast(&e->changed);
    pthread_mutex_unlock(&e->mutex);
}

static void wait_done(stand *e, int count) {
    pthread_mutex_lock(&e->mutex);
    while (e->done < count)
        pthread_cond_wait(&e->changed, &e->mutex);
    pthread_mutex_unlock(&e->mutex);
}

static void wait_drawing(stand *e) {
    pthread_mutex_lock(&e->mutex);
    while (!e->drawing_now)
        pthread_cond_wait(&e->changed, &e->mutex);
    pthread_mutex_unlock(&e->mutex);
}

static bool ask(stand *e, asker *a, int zoom, uint32_t column, uint32_t row) {
    *a =
        (asker){.stand = e,
                .ask = {.request = {.route = CAMBER_ROUTE_TILE, .zoom = zoom, .column = column, .row = row, .ratio = 1},
                        .done = take,
                        .is_gone = has_left,
                        .user = a}};
    return camber_draw_queue_add(e->drawing, &a->ask);
}

/* The PNG of a tile has its colour in it, so tiles of two colours differ, and equal ones have equal tags. */
static void check_body(asker *a, const char *tag, bool equal) {
    assert_int_equal(a->ask.result, CAMBER_TILE_REQUEST_DONE);
    assert_memory_equal(a->ask.body->bytes, "\x89PNG", 4);
    if (tag)
        assert_int_equal(strcmp(a->ask.body->etag, tag) == 0, equal);
}

static void draws_once_for_all_who_wait(void **state) {
    stand *e = *state;
    asker askers[5];
    hold(e, true);
    for (uint32_t i = 0; i < 4; i++)
        assert_true(ask(e, &askers[i], 4, 6 + i % 2, 8 + i / 2));
    wait_drawing(e);
    assert_true(ask(e, &askers[4], 4, 6, 8)); /* it is being drawn */
    hold(e, false);
    wait_done(e, 5);
    assert_int_equal(e->drawn, 1);
    check_body(&askers[4], askers[0].ask.body->etag, true);
    for (int i = 1; i < 4; i++)
        check_body(&askers[i], askers[0].ask.body->etag, false);
    for (int i = 0; i < 5; i++)
        camber_body_release(askers[i].ask.body);
    assert_int_equal(camber_tile_cache_get_stats(e->cache).tiles, 4);
}

static void cuts_a_neighbour_of_a_kept_picture(void **state) {
    stand *e = *state;
    asker one, other, far;
    assert_true(ask(e, &one, 4, 6, 8));
    wait_done(e, 1);
    assert_true(ask(e, &other, 4, 7, 9));
    wait_done(e, 2);
    assert_int_equal(e->drawn, 1);
    check_body(&other, one.ask.body->etag, false);
    camber_tile_cache_clear(e->cache, 0, 0); /* another input: the picture is of the one before */
    assert_true(ask(e, &far, 4, 6, 9));
    wait_done(e, 3);
    assert_int_equal(e->drawn, 2);
    camber_body_release(one.ask.body);
    camber_body_release(other.ask.body);
    camber_body_release(far.ask.body);
}

/* Another input comes while a picture is drawn: those who ask from then on do not get that picture. */
static void does_not_join_what_is_old(void **state) {
    stand *e = *state;
    asker old, fresh;
    hold(e, true);
    assert_true(ask(e, &old, 4, 6, 8));
    wait_drawing(e);
    camber_tile_cache_clear(e->cache, 0, 0);
    assert_true(ask(e, &fresh, 4, 6, 8));
    hold(e, false);
    wait_done(e, 2);
    assert_int_equal(e->drawn, 2);
    camber_body_release(old.ask.body);
    camber_body_release(fresh.ask.body);
}

static void refuses_when_it_is_full(void **state) {
    stand *e = *state;
    asker askers[QUEUED + 2];
    hold(e, true);
    assert_true(ask(e, &askers[0], 6, 0, 0));
    wait_drawing(e); /* it does not wait any more */
    for (uint32_t i = 1; i <= QUEUED; i++)
        assert_true(ask(e, &askers[i], 6, 2 * i, 0));
    assert_false(ask(e, &askers[QUEUED + 1], 6, 40, 0));
    assert_int_equal(e->metrics.refused, 1);
    assert_int_equal(e->metrics.queued, QUEUED);
    hold(e, false);
    wait_done(e, QUEUED + 1);
    assert_false(askers[QUEUED + 1].told);
    for (int i = 0; i <= QUEUED; i++)
        camber_body_release(askers[i].ask.body);
}

static void does_not_draw_for_those_who_left(void **state) {
    stand *e = *state;
    asker first, gone, mixed[2];
    hold(e, true);
    assert_true(ask(e, &first, 6, 0, 0));
    wait_drawing(e);
    assert_true(ask(e, &gone, 6, 2, 0) && ask(e, &mixed[0], 6, 4, 0) && ask(e, &mixed[1], 6, 5, 0));
    gone.left = mixed[0].left = true;
    hold(e, false);
    wait_done(e, 4);
    assert_int_equal(e->drawn, 2);
    assert_int_equal(gone.ask.result, CAMBER_TILE_REQUEST_DROPPED);
    assert_int_equal(mixed[0].ask.result, CAMBER_TILE_REQUEST_DROPPED);
    assert_int_equal(mixed[1].ask.result, CAMBER_TILE_REQUEST_DONE);
    assert_int_equal(e->metrics.dropped, 1);
    camber_body_release(first.ask.body);
    camber_body_release(mixed[1].ask.body);
}

static void tells_what_fails(void **state) {
    stand *e = *state;
    asker bad, good;
    e->fails = true;
    assert_true(ask(e, &bad, 5, 1, 1));
    wait_done(e, 1);
    assert_int_equal(bad.ask.result, CAMBER_TILE_REQUEST_FAILED);
    assert_null(bad.ask.body);
    pthread_mutex_lock(&e->mutex);
    e->fails = false;
    pthread_mutex_unlock(&e->mutex);
    assert_true(ask(e, &good, 5, 1, 1));
    wait_done(e, 2);
    check_body(&good, NULL, true);
    camber_body_release(good.ask.body);
}

static void does_not_keep_static_pictures(void **state) {
    stand *e = *state;
    asker askers[3];
    for (int i = 0; i < 3; i++) {
        askers[i] = (asker){.stand = e,
                            .ask = {.request = {.route = CAMBER_ROUTE_STATIC, .width = 16, .height = 16, .ratio = 1},
                                    .done = take,
                                    .user = &askers[i]}};
        assert_true(camber_draw_queue_add(e->drawing, &askers[i].ask));
        wait_done(e, i + 1);
        check_body(&askers[i], NULL, true);
        camber_body_release(askers[i].ask.body);
    }
    assert_int_equal(e->drawn, 3);
    assert_int_equal(camber_tile_cache_get_stats(e->cache).tiles, 0);
}

static void ends_with_all_told(void **state) {
    stand *e = *state;
    asker askers[3];
    hold(e, true);
    assert_true(ask(e, &askers[0], 6, 0, 0));
    wait_drawing(e);
    assert_true(ask(e, &askers[1], 6, 2, 0) && ask(e, &askers[2], 6, 4, 0));
    /* The end waits for the picture that is being drawn; the others are not drawn. */
    pthread_t thread;
    assert_int_equal(
        pthread_create(&thread, NULL, (void *(*)(void *))(void (*)(void))camber_draw_queue_stop, e->drawing), 0);
    /* The end has begun once it takes nobody else, not even for the picture that is being drawn. */
    static asker probes[MOST_PROBES];
    int taken = 0;
    while (ask(e, &probes[taken], 6, 0, 0)) {
        assert_true(++taken < MOST_PROBES);
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
    hold(e, false);
    pthread_join(thread, NULL);
    assert_int_equal(e->done, 3 + taken);
    assert_int_equal(e->drawn, 1);
    assert_int_equal(askers[2].ask.result, CAMBER_TILE_REQUEST_DROPPED);
    assert_false(ask(e, &askers[2], 6, 8, 0));
    camber_body_release(askers[0].ask.body);
    for (int i = 0; i < taken; i++)
        camber_body_release(probes[i].ask.body);
}

static void prepares_when_woken(void **state) {
    stand *e = *state;
    pthread_mutex_lock(&e->mutex);
    while (e->prepared < 1)
        pthread_cond_wait(&e->changed, &e->mutex);
    pthread_mutex_unlock(&e->mutex);
    camber_draw_queue_wake(e->drawing);
    pthread_mutex_lock(&e->mutex);
    while (e->prepared < 2)
        pthread_cond_wait(&e->changed, &e->mutex);
    pthread_mutex_unlock(&e->mutex);
}

static void sides_follow_zoom_and_ratio(void **state) {
    (void)state;
    assert_int_equal(camber_draw_queue_side(8, 0, 1), 1);
    assert_int_equal(camber_draw_queue_side(8, 2, 1), 4);
    assert_int_equal(camber_draw_queue_side(8, 20, 1), 8);
    assert_int_equal(camber_draw_queue_side(8, 20, 2), 4);
    assert_int_equal(camber_draw_queue_side(2, 20, 4), 2);
    assert_int_equal(camber_draw_queue_side(2, 20, 8), 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(draws_once_for_all_who_wait, set_up, tear_down),
        cmocka_unit_test_setup_teardown(cuts_a_neighbour_of_a_kept_picture, set_up, tear_down),
        cmocka_unit_test_setup_teardown(does_not_join_what_is_old, set_up, tear_down),
        cmocka_unit_test_setup_teardown(refuses_when_it_is_full, set_up, tear_down),
        cmocka_unit_test_setup_teardown(does_not_draw_for_those_who_left, set_up, tear_down),
        cmocka_unit_test_setup_teardown(tells_what_fails, set_up, tear_down),
        cmocka_unit_test_setup_teardown(does_not_keep_static_pictures, set_up, tear_down),
        cmocka_unit_test_setup_teardown(ends_with_all_told, set_up, tear_down),
        cmocka_unit_test_setup_teardown(prepares_when_woken, set_up, tear_down),
        cmocka_unit_test(sides_follow_zoom_and_ratio),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
