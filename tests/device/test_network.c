/* Networks: the device's slots against the twin's, and the twin's against the polylines that the camera should see. */
#include "scene.h"

#include "residency/parts.h"

/* Devices with work-groups of given sizes are OpenCL's; the others are the processor itself, if the build has kernels
 * for it. */
static const camber_device_desc DEVICES[] = {{.work_group_size = 256},
                                             {.work_group_size = 64},
                                             {.work_group_size = 128},
                                             {.largest_buffer_bytes = 12288},
                                             {.work_group_size = 64, .largest_buffer_bytes = 40000},
                                             {0},
                                             {.match = "opencl", .largest_buffer_bytes = 12288}};
enum { DEVICE_COUNT = sizeof DEVICES / sizeof *DEVICES };

typedef struct network_devices {
    host h;
    camber_context *context;
    camber_device *devices[DEVICE_COUNT];
    camber_mesh *meshes[DEVICE_COUNT];
    bool rounds; /* the device divides as the host does */
} network_devices;

static int set_up(void **state) {
    network_devices *b = calloc(1, sizeof *b);
    if (!b)
        return -1;
    b->context = host_context(&b->h);
    for (size_t i = 0; i < DEVICE_COUNT; i++)
        if (camber_device_create(b->context, DEVICES + i, b->devices + i) != CAMBER_OK ||
            camber_mesh_create(b->devices[i], NULL, b->meshes + i) != CAMBER_OK)
            return -1;
    b->rounds = b->devices[0]->rounds_correctly;
    *state = b;
    return 0;
}

static int tear_down(void **state) {
    network_devices *b = *state;
    for (size_t i = 0; i < DEVICE_COUNT; i++) {
        camber_mesh_destroy(b->meshes[i]);
        camber_device_destroy(b->devices[i]);
    }
    host_done(&b->h, b->context);
    free(b);
    return 0;
}

/* ---- Worlds: scenes of 1000 x 1000 in world coordinates ---- */

typedef struct world {
    double *points;
    size_t *offsets;
    float *importance;
    camber_network_entry *entries;
    size_t point_count, polyline_count;
} world;

static const double WORLD_X = 0.4821, WORLD_Y = 0.3757, WORLD_UNIT = 1e-7; /* a city at zoom 16 */

static world world_make(const camber_made_scene *s, uint64_t seed) {
    world w = {.point_count = s->point_count, .polyline_count = s->polyline_count};
    w.points = malloc((s->point_count + 1) * 2 * sizeof *w.points);
    w.importance = malloc((s->point_count + 1) * sizeof *w.importance);
    w.offsets = malloc((s->polyline_count + 1) * sizeof *w.offsets);
    w.entries = calloc(s->polyline_count + 1, sizeof *w.entries);
    assert_true(w.points && w.importance && w.offsets && w.entries);
    for (size_t i = 0; i < s->point_count; i++) {
        w.points[2 * i] = WORLD_X + WORLD_UNIT * (double)s->points[2 * i];
        w.points[2 * i + 1] = WORLD_Y + WORLD_UNIT * (double)s->points[2 * i + 1];
        w.importance[i] = (float)(WORLD_UNIT * pow(10, camber_random_between(&seed, -3, 2)));
    }
    for (size_t i = 0; i <= s->polyline_count; i++)
        w.offsets[i] = s->offsets[i];
    for (size_t i = 0; i < s->polyline_count; i++)
        w.entries[i] = (camber_network_entry){(uint32_t)i, s->rows[i], 0};
    return w;
}

static void world_free(world *w) {
    free(w->entries);
    free(w->importance);
    free(w->offsets);
    free(w->points);
    *w = (world){0};
}

static camber_network_desc world_desc(const world *w) {
    return (camber_network_desc){.points = w->points,
                                 .offsets = w->offsets,
                                 .polyline_count = w->polyline_count,
                                 .importance = w->importance,
                                 .entries = w->entries,
                                 .entry_count = w->polyline_count};
}

static camber_network *network_make(network_devices *b, const camber_network_desc *desc) {
    camber_network *network = NULL;
    assert_int_equal(camber_network_create(b->context, desc, &network), CAMBER_OK);
    return network;
}

/* A camera that sees 1000 / zoom units across, somewhere in the world. */
static camber_camera camera_make(uint64_t *seed, double zoom, double simplify_px) {
    static const double bearings[] = {0, 90, 33.7, -145, 360}, pitches[] = {0, 0, 45, 85};
    return (camber_camera){.x = WORLD_X + WORLD_UNIT * camber_random_between(seed, 0, 1000),
                           .y = WORLD_Y + WORLD_UNIT * camber_random_between(seed, 0, 1000),
                           .scale_px = zoom / WORLD_UNIT,
                           .bearing_deg = bearings[camber_random_below(seed, 5)],
                           .pitch_deg = pitches[camber_random_below(seed, 4)],
                           .width = (uint32_t)(1 + camber_random_below(seed, 1000)),
                           .height = (uint32_t)(1 + camber_random_below(seed, 1000)),
                           .simplify_px = simplify_px};
}

static const double ZOOMS[] = {1e-7, 0.01, 0.4, 1, 3, 20, 700, 1e6};
static const double TOLERANCES[] = {0, 0.1, 3};
enum { ZOOM_COUNT = 8 };

/* Narrow strokes, so that the window is no larger than need be. */
static void narrow_strokes(camber_stroke strokes[CAMBER_KERNEL_ROWS]) {
    scene_strokes(strokes);
    for (int i = 0; i < CAMBER_KERNEL_ROWS; i++) {
        strokes[i].width_px = (float)(1 + i);
        strokes[i].miter_limit = 2;
    }
}

/* ---- Device and twin ---- */

static void *read_words(const network_devices *b, size_t which, camber_buffer *buffer, size_t words) {
    void *bytes = malloc(4 * words);
    assert_non_null(bytes);
    assert_int_equal(camber_buffer_read(b->devices[which], buffer, 4 * words, bytes), CAMBER_OK);
    return bytes;
}

static void compare_words(const network_devices *b, size_t which, camber_buffer *buffer, const void *expected,
                          size_t words) {
    uint32_t *got = read_words(b, which, buffer, words);
    for (size_t i = 0; i < words; i++)
        if (memcmp(got + i, (const uint32_t *)expected + i, 4) != 0)
            fail_msg("device %zu: word %zu of %zu is %08x, the twin's is %08x", which, i, words, got[i],
                     ((const uint32_t *)expected)[i]);
    free(got);
}

/* Slots of a part, with the sentinels around them. */
static void compare_part(const network_devices *b, size_t which, const camber_mesh_part *part,
                         const camber_polylines *twin) {
    const camber_mesh *mesh = b->meshes[which];
    const size_t first = twin->first_slots[part->first_polyline];
    const size_t end = twin->first_slots[part->first_polyline + part->polyline_count];
    assert_int_equal(part->slot_count, (end - first + b->devices[which]->block - 1) / b->devices[which]->block *
                                           b->devices[which]->block);
    for (size_t i = 0; i <= part->polyline_count; i += i + 1 < part->polyline_count && i % 7 == 0 ? 2 : 1)
        assert_int_equal(camber_part_given_slot(mesh, part, part->first_polyline + i),
                         twin->first_slots[part->first_polyline + i] - first);
    if (part->slot_count == 0)
        return;
    const size_t words = part->slot_count + 2, given = end - first;
    const void *arrays[] = {twin->x, twin->y, twin->info};
    camber_buffer *const buffers[] = {part->x, part->y, part->info};
    for (int k = 0; k < 3; k++) {
        uint32_t *expected = calloc(words, 4);
        assert_non_null(expected);
        memcpy(expected + 1, (const uint32_t *)arrays[k] + 1 + first, 4 * given);
        compare_words(b, which, buffers[k], expected, words);
        free(expected);
    }
}

/* Tessellates what the camera sees on a device; gives how many slots the twin has. */
static size_t compare(network_devices *b, size_t which, camber_network *network, const camber_camera *camera,
                      const camber_tessellation_desc *desc) {
    camber_polylines *twin = NULL;
    camber_mesh *mesh = b->meshes[which];
    assert_int_equal(camber_network_project(network, camera, desc, &twin), CAMBER_OK);
    assert_int_equal(camber_mesh_tessellate_network(mesh, network, camera, desc), CAMBER_OK);
    assert_true(camber_mesh_holds_network(mesh, network));
    for (size_t i = 0; b->rounds && i < mesh->part_count; i++)
        compare_part(b, which, mesh->parts + i, twin);
    camber_mesh_data device, twins;
    assert_int_equal(camber_mesh_read(mesh, &device), CAMBER_OK);
    assert_int_equal(camber_mesh_data_tessellate(b->context, twin, desc, &twins), CAMBER_OK);
    if (b->rounds) {
        assert_int_equal(device.info.vertex_count, twins.info.vertex_count);
        assert_int_equal(device.info.joins, twins.info.joins);
        assert_int_equal(device.info.triangle_count, twins.info.triangle_count);
        assert_int_equal(device.info.record_count, twins.info.record_count);
        if (device.info.record_count)
            assert_memory_equal(device.records, twins.records, device.info.record_count * sizeof *twins.records);
        if (device.info.vertex_count)
            assert_memory_equal(device.vertices, twins.vertices, device.info.vertex_count * sizeof *twins.vertices);
    }
    camber_mesh_data_destroy(&device);
    camber_mesh_data_destroy(&twins);
    const size_t slots = twin->first_slots[twin->polyline_count];
    camber_polylines_destroy(twin);
    return slots;
}

static void test_device_equals_twin(void **state) {
    network_devices *b = *state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    narrow_strokes(strokes);
    uint64_t seed = 7;
    for (size_t which = 0; which < CAMBER_KERNEL_SCENES; which++) {
        camber_made_scene s = scene_make(which);
        world w = world_make(&s, 5 + which);
        const camber_network_desc from = world_desc(&w);
        camber_network *network = network_make(b, &from);
        size_t slots = 0;
        for (size_t i = 0; i < 3 * ZOOM_COUNT; i++) {
            const camber_camera camera = camera_make(&seed, ZOOMS[i % ZOOM_COUNT], TOLERANCES[i / ZOOM_COUNT]);
            const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, (camber_method)(i % 3), 0, false};
            slots += compare(b, i % 3, network, &camera, &desc);
        }
        assert_true(slots > 1000);
        camber_network_destroy(network);
        world_free(&w);
        camber_made_scene_free(&s);
    }
}

/* All points in one place, or nearer to each other than a double tells, are a dot in any view. */
static void test_draws_a_dot(void **state) {
    network_devices *b = *state;
    static const double apart[] = {0, 4.9e-324, 1e-310, 1e-200, 1e-31, 1e-20},
                        scales[] = {1, 512, 2147483648.0, 5.5e11};
    const camber_stroke stroke = {.width_px = 8, .cap = CAMBER_CAP_ROUND};
    const camber_tessellation_desc desc = {&stroke, 1, CAMBER_METHOD_STRIP, 0, false};
    const size_t offsets[] = {0, 2};
    for (size_t i = 0; i < sizeof apart / sizeof *apart; i++) {
        const double points[] = {0, 0, apart[i], -apart[i]};
        camber_network *network =
            network_make(b, &(camber_network_desc){.points = points, .offsets = offsets, .polyline_count = 1});
        for (size_t k = 0; k < sizeof scales / sizeof *scales; k++) {
            const camber_camera camera = {
                .scale_px = scales[k], .width = 64, .height = 32, .pitch_deg = k % 2 ? 60 : 0};
            camber_lines lines;
            assert_int_equal(camber_network_project_lines(network, &camera, &desc, &lines), CAMBER_OK);
            assert_int_equal(lines.polyline_count, 1);
            for (size_t n = 0; n < lines.point_count; n++) {
                assert_true(fabsf(lines.points[2 * n] - 32) < 0.01f);
                assert_true(fabsf(lines.points[2 * n + 1] - 16) < 0.01f);
            }
            camber_lines_destroy(&lines);
            assert_true(compare(b, k % 3, network, &camera, &desc) > 0);
            assert_int_equal(camber_mesh_tessellate_network(b->meshes[0], network, &camera, &desc), CAMBER_OK);
            assert_int_equal(camber_mesh_count_joins(b->meshes[0]), CAMBER_OK);
            assert_true(camber_mesh_get_info(b->meshes[0]).triangle_count > 0);
        }
        camber_network_destroy(network);
    }
}

/* Each valid point of an entry of dots is a dot, whatever it matters, and none closes a ring. */
static void test_dots(void **state) {
    network_devices *b = *state;
    static const double points[] = {0, 0, 1, 0, 1, 0, NAN, 0, 2, 1, 3, 1, 0, 0};
    static const size_t offsets[] = {0, 7};
    static const float importance[7] = {0};
    const camber_stroke strokes[] = {{.width_px = 8, .cap = CAMBER_CAP_ROUND}};
    const camber_tessellation_desc desc = {strokes, 1, CAMBER_METHOD_STRIP, 0, false};
    const camber_camera camera = {.x = 1.5, .y = 0.5, .scale_px = 10, .width = 64, .height = 32, .simplify_px = 1000};
    for (int dots = 0; dots < 2; dots++) {
        const camber_network_entry entry = {.is_dots = dots};
        const camber_network_desc from = {.points = points,
                                          .offsets = offsets,
                                          .polyline_count = 1,
                                          .importance = importance,
                                          .entries = &entry,
                                          .entry_count = 1,
                                          .least_importance = 5};
        camber_network *network = network_make(b, &from);
        const camber_polylines_stats stats = camber_network_get_stats(network);
        assert_int_equal(stats.dots, dots ? 6 : 0);
        assert_int_equal(stats.kept_points, dots ? 6 : 4);
        assert_int_equal(stats.kept_segments, dots ? 0 : 2);
        assert_int_equal(stats.invalid_points, 1);
        assert_int_equal(stats.rings, 0);
        camber_lines lines;
        assert_int_equal(camber_network_project_lines(network, &camera, &desc, &lines), CAMBER_OK);
        assert_int_equal(lines.polyline_count, dots ? 6 : 2);
        assert_int_equal(lines.point_count, dots ? 6 : 4);
        camber_lines_destroy(&lines);
        assert_true(compare(b, 0, network, &camera, &desc) > 0);
        camber_network_destroy(network);
    }
}

/* Sections, parts cut in two for their slots and parts split for their output. */
static void test_parts_equal_twin(void **state) {
    network_devices *b = *state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    narrow_strokes(strokes);
    uint64_t seed = 77;
    camber_made_scene s = scene_make(0);
    world w = world_make(&s, 3);
    const camber_network_desc from = world_desc(&w);
    camber_network *network = network_make(b, &from);
    for (size_t i = 0; i < 2 * ZOOM_COUNT; i++) {
        const camber_camera camera = camera_make(&seed, ZOOMS[i % ZOOM_COUNT], TOLERANCES[i / ZOOM_COUNT]);
        const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, (camber_method)(i % 3), 0, false};
        compare(b, 3 + i % 2, network, &camera, &desc);
    }
    assert_true(b->meshes[3]->held->section_count > 1);
    assert_true(b->meshes[3]->part_count > b->meshes[3]->held->section_count);
    camber_network_destroy(network);
    world_free(&w);
    camber_made_scene_free(&s);
}

/* ---- The camera's view ---- */

static void project(const camber_camera *camera, const double *place, double *px) {
    const double angle = camera->bearing_deg * SCENE_PI / 180, c = cos(angle), s = sin(angle);
    const double dx = (place[0] - camera->x) * camera->scale_px, dy = (place[1] - camera->y) * camera->scale_px;
    px[0] = dx * c + dy * s + 0.5 * camera->width;
    px[1] = dy * c - dx * s + 0.5 * camera->height;
}

static double distance_to(const double *p, const float *a, const float *b) {
    const double ax = (double)a[0], ay = (double)a[1], dx = (double)b[0] - ax, dy = (double)b[1] - ay;
    const double length = dx * dx + dy * dy, along = (p[0] - ax) * dx + (p[1] - ay) * dy;
    const double t = length > 0 ? fmin(1, fmax(0, along / length)) : 0;
    return hypot(p[0] - ax - t * dx, p[1] - ay - t * dy);
}

/* The distance of a place from the pieces of an entry. */
static double distance_to_entry(const camber_lines *lines, const uint32_t *entries, size_t entry, const double *p) {
    double least = INFINITY;
    for (size_t i = 0; i < lines->polyline_count; i++)
        for (size_t k = lines->offsets[i]; entries[i] == entry && k + 1 < lines->offsets[i + 1]; k++)
            least = fmin(least, distance_to(p, lines->points + 2 * k, lines->points + 2 * k + 2));
    return least;
}

/* Every place of a polyline in the picture lies on a piece of its entry, and pieces end outside the window or where the
 * polyline does. */
static size_t check_seen(const world *w, const camber_camera *camera, const camber_lines *lines,
                         const uint32_t *entries) {
    size_t seen = 0;
    for (size_t entry = 0; entry < w->polyline_count; entry++) {
        for (size_t i = w->offsets[entry]; i + 1 < w->offsets[entry + 1]; i++) {
            double a[2], b[2];
            project(camera, w->points + 2 * i, a);
            project(camera, w->points + 2 * i + 2, b);
            if (!isfinite(a[0] + a[1] + b[0] + b[1]) || (a[0] == b[0] && a[1] == b[1]))
                continue;
            for (int k = 0; k <= 8; k++) {
                const double p[2] = {a[0] + (b[0] - a[0]) * k / 8, a[1] + (b[1] - a[1]) * k / 8};
                if (p[0] < 0 || p[1] < 0 || p[0] > camera->width || p[1] > camera->height)
                    continue;
                seen++;
                const double d = distance_to_entry(lines, entries, entry, p);
                if (!(d < 0.01))
                    fail_msg("entry %zu, point %zu + %d/8 at %g, %g: %g px from its pieces", entry, i, k, p[0], p[1],
                             d);
            }
        }
    }
    return seen;
}

static bool lies_on_border(const float *p, const camber_camera *camera, float margin) {
    return p[0] <= -margin + 0.1f || p[1] <= -margin + 0.1f || p[0] >= (float)camera->width + margin - 0.1f ||
           p[1] >= (float)camera->height + margin - 0.1f;
}

/* Whether a pixel is an end of the entry's polyline. */
static bool is_end(const world *w, const camber_camera *camera, size_t entry, const float *p) {
    double a[2], b[2];
    project(camera, w->points + 2 * w->offsets[entry], a);
    project(camera, w->points + 2 * w->offsets[entry + 1] - 2, b);
    return hypot(a[0] - (double)p[0], a[1] - (double)p[1]) < 0.01 ||
           hypot(b[0] - (double)p[0], b[1] - (double)p[1]) < 0.01;
}

static void test_sees_all_in_the_picture(void **state) {
    network_devices *b = *state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    narrow_strokes(strokes);
    const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, CAMBER_METHOD_STRIP, 0, false};
    uint64_t seed = 99;
    size_t seen = 0, cut = 0;
    for (size_t which = 0; which < 3; which++) {
        camber_made_scene s = scene_make(which);
        world w = world_make(&s, which);
        const camber_network_desc from = world_desc(&w);
        camber_network *network = network_make(b, &from);
        for (size_t i = 0; i < 12; i++) {
            camber_camera camera = camera_make(&seed, i % 2 ? 6 : 30, 0);
            camera.pitch_deg = 0; /* test_pitch.c has pictures of others */
            camber_lines lines;
            assert_int_equal(camber_network_project_lines(network, &camera, &desc, &lines), CAMBER_OK);
            seen += check_seen(&w, &camera, &lines, lines.entries);
            for (size_t k = 0; k < lines.point_count; k++)
                for (size_t axis = 0; axis < 2; axis++) {
                    const float most = axis ? (float)camera.height : (float)camera.width,
                                at = lines.points[2 * k + axis];
                    /* a piece that touches the window, and the next one */
                    const float beyond = 64.01f + 2 * CAMBER_PIECE_PX;
                    assert_true(at >= -beyond && at <= most + beyond);
                }
            for (size_t k = 0; k < lines.polyline_count; k++) {
                const float *first = lines.points + 2 * lines.offsets[k],
                            *last = lines.points + 2 * lines.offsets[k + 1] - 2;
                const bool ring = first[0] == last[0] && first[1] == last[1];
                const bool border = lies_on_border(first, &camera, 64) && lies_on_border(last, &camera, 64);
                cut += border;
                assert_true(ring || lies_on_border(first, &camera, 64) || is_end(&w, &camera, lines.entries[k], first));
                assert_true(ring || lies_on_border(last, &camera, 64) || is_end(&w, &camera, lines.entries[k], last));
                /* A seam is no end: a ring is whole, or cut at the border twice. */
                if (which == 2 && !ring)
                    assert_true(border || lines.offsets[k + 1] - lines.offsets[k] == 1 ||
                                w.offsets[lines.entries[k] + 1] - w.offsets[lines.entries[k]] <= 3);
            }
            camber_lines_destroy(&lines);
        }
        camber_network_destroy(network);
        world_free(&w);
        camber_made_scene_free(&s);
    }
    assert_true(seen > 1000 && cut > 100);
}

/* A camera that sees everything at tolerance 0: what camber_polylines_create makes of the same points. */
static void test_keeps_everything(void **state) {
    network_devices *b = *state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, CAMBER_METHOD_STRIP, 0, false};
    for (size_t which = 0; which < 5; which++) {
        camber_made_scene s = scene_make(which);
        world w = world_make(&s, which);
        for (size_t i = 0; i < s.point_count; i++)
            if (!camber_point_is_valid(s.points + 2 * i))
                w.points[2 * i] = (double)NAN;
        const camber_network_desc from = world_desc(&w);
        camber_network *network = network_make(b, &from);
        const camber_camera camera = {.x = WORLD_X + 500 * WORLD_UNIT,
                                      .y = WORLD_Y + 500 * WORLD_UNIT,
                                      .scale_px = 1 / WORLD_UNIT,
                                      .width = 20000,
                                      .height = 20000};
        camber_polylines *plain = scene_polylines(b->context, &s), *seen = NULL;
        assert_int_equal(camber_network_project(network, &camera, &desc, &seen), CAMBER_OK);
        const camber_polylines_stats had = plain->stats, got = seen->stats;
        assert_int_equal(got.kept_points, had.kept_points);
        assert_int_equal(got.kept_segments, had.kept_segments);
        assert_int_equal(got.rings, had.rings);
        assert_int_equal(got.dots, had.dots);
        assert_int_equal(camber_network_get_stats(network).invalid_points, had.invalid_points);
        assert_int_equal(camber_network_get_stats(network).repeated_points, had.repeated_points);
        size_t k = 0; /* sentinels that turned out not to be needed are told apart by their words alone */
        for (size_t i = 1; i <= plain->slot_count; i++) {
            if (!(plain->info[i] & CAMBER_POINT_REAL))
                continue;
            do
                k++;
            while (k <= seen->slot_count && !(seen->info[k] & CAMBER_POINT_REAL));
            assert_int_equal(seen->info[k], plain->info[i]);
            assert_true(fabsf(seen->x[k] - 9500 - plain->x[i]) < 0.01f);
            assert_true(fabsf(seen->y[k] - 9500 - plain->y[i]) < 0.01f);
        }
        camber_polylines_destroy(seen);
        camber_polylines_destroy(plain);
        camber_network_destroy(network);
        world_free(&w);
        camber_made_scene_free(&s);
    }
}

/* Points go by their importance, and by nothing else. */
static void test_drops_by_importance(void **state) {
    network_devices *b = *state;
    const double points[] = {0, 0, 0.1, 0.1, 0.2, 0, 0.3, 0.1, 0.4, 0};
    const float importance[] = {0, 0.02f, (float)NAN, 0.01f, -1};
    const size_t offsets[] = {0, 5};
    const camber_stroke stroke = {.width_px = 2};
    const camber_tessellation_desc desc = {&stroke, 1, CAMBER_METHOD_STRIP, 0, false};
    camber_network *network = network_make(
        b, &(camber_network_desc){.points = points, .offsets = offsets, .polyline_count = 1, .importance = importance});
    static const struct {
        double simplify_px;
        size_t kept;
    } cases[] = {{0, 5}, {0.99, 5}, {1.01, 4}, {1.99, 4}, {2.01, 3}, {1e6, 3}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const camber_camera camera = {
            .x = 0.2, .scale_px = 100, .width = 50, .height = 50, .simplify_px = cases[i].simplify_px};
        camber_polylines *seen = NULL;
        assert_int_equal(camber_network_project(network, &camera, &desc, &seen), CAMBER_OK);
        assert_int_equal(seen->stats.kept_points, cases[i].kept);
        camber_polylines_destroy(seen);
        compare(b, 0, network, &camera, &desc);
    }
    camber_network_destroy(network);
}

/* The first one of two points on the same pixel decides into how many pieces the segment from there is halved, for the
 * segment after that, too. */
static void test_pieces_from_the_same_pixel(void **state) {
    network_devices *b = *state;
    const camber_stroke stroke = {.width_px = 2};
    const camber_tessellation_desc desc = {&stroke, 1, CAMBER_METHOD_STRIP, 0, false};
    const double step = exp2(-31), px = step * 16777214 / 1536;
    size_t joint = 0;
    for (int i = 0; i < 400; i++) {
        const double x = 0.5 + 1536 * px + i % 20 * step, y = 0.5 + 10 * px;
        const double points[] = {x,   y,   x + step, y,   0.5, 0.5 - 1000 * px, 0.5 + 300 * px, y, 0.0, 0.0, 0.0,
                                 0.0, 1.0, 1.0,      1.0, 1.0};
        const size_t offsets[] = {0, 4, 6, 8};
        camber_network *network =
            network_make(b, &(camber_network_desc){.points = points, .offsets = offsets, .polyline_count = 3});
        const camber_camera camera = {.x = 0.5 + 1000 * px,
                                      .y = 0.5 + 50 * px,
                                      .scale_px = (1 + (i / 20 - 10) * exp2(-24)) / px,
                                      .width = 2200,
                                      .height = 100};
        camber_lines lines;
        assert_int_equal(camber_network_project_lines(network, &camera, &desc, &lines), CAMBER_OK);
        size_t halves = 0; /* the end of two pieces, one before and one after the point outside */
        for (size_t k = 0; k < lines.point_count; k++)
            halves += fabsf(lines.points[2 * k + 1] + 495) < 5;
        assert_int_equal(halves, lines.polyline_count == 1 ? 0 : 2);
        joint += lines.polyline_count == 1 && lines.point_count == 3;
        camber_lines_destroy(&lines);
        camber_network_destroy(network);
    }
    assert_true(joint > 0);
}

/* ---- Failures ---- */

static camber_status make_and_look(camber_context *context, void *user) {
    const camber_stroke stroke = {.width_px = 2};
    const camber_tessellation_desc desc = {&stroke, 1, CAMBER_METHOD_STRIP, 0, false};
    const camber_camera camera = {.scale_px = 100, .width = 50, .height = 50};
    camber_network *network = NULL;
    camber_lines lines = {0};
    camber_status status = camber_network_create(context, user, &network);
    if (status == CAMBER_OK)
        status = camber_network_project_lines(network, &camera, &desc, &lines);
    camber_network_destroy(network);
    camber_lines_destroy(&lines);
    return status;
}

static camber_status draw_on_device(camber_context *context, void *user) {
    const camber_stroke stroke = {.width_px = 2};
    const camber_tessellation_desc desc = {&stroke, 1, CAMBER_METHOD_STRIP, 0, false};
    const camber_camera camera = {.scale_px = 100, .width = 50, .height = 50};
    network_devices *b = user;
    const double points[] = {0, 0, 0.1, 0.1, NAN, 0, 0.3, 0.1, 0.4, 0};
    const size_t offsets[] = {0, 5};
    camber_network *network = NULL;
    camber_mesh *mesh = NULL;
    camber_status status = camber_network_create(
        context, &(camber_network_desc){.points = points, .offsets = offsets, .polyline_count = 1}, &network);
    if (status == CAMBER_OK)
        status = camber_mesh_create(b->devices[0], NULL, &mesh);
    if (status == CAMBER_OK)
        status = camber_mesh_tessellate_network(mesh, network, &camera, &desc);
    camber_network_destroy(network);
    camber_mesh_destroy(mesh);
    return status;
}

static void test_allocations_fail(void **state) {
    network_devices *b = *state;
    const double points[] = {0, 0, 0.1, 0.1, NAN, 0, 0.3, 0.1, 0.4, 0};
    const size_t offsets[] = {0, 5};
    camber_network_desc desc = {.points = points, .offsets = offsets, .polyline_count = 1};
    each_allocation_fails(&b->h, make_and_look, b->context, &desc);
    assert_int_equal(draw_on_device(b->context, b), CAMBER_OK); /* the kernels are there */
    each_allocation_fails(&b->h, draw_on_device, b->context, b);
}

static void test_wrong_input(void **state) {
    network_devices *b = *state;
    const double points[] = {0, 0, 1, 1};
    const size_t offsets[] = {0, 2}, falling[] = {2, 0};
    const camber_network_entry far = {.polyline = 1}, row = {.row = 1u << 24};
    const camber_network_desc wrong[] = {
        {.points = points, .offsets = falling, .polyline_count = 1},
        {.points = points, .offsets = offsets, .polyline_count = 1, .entries = &far, .entry_count = 1},
        {.points = points, .offsets = offsets, .polyline_count = 1, .entries = &row, .entry_count = 1}};
    camber_network *network = NULL;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(camber_network_create(b->context, wrong + i, &network), CAMBER_ERROR_INPUT);
        assert_story(&b->h, "network: ");
    }
    network = network_make(b, &(camber_network_desc){.points = points, .offsets = offsets, .polyline_count = 1});
    const camber_stroke stroke = {.width_px = 2};
    const camber_tessellation_desc desc = {&stroke, 1, CAMBER_METHOD_STRIP, 0, false};
    const camber_camera cameras[] = {{.scale_px = 0, .width = 1, .height = 1},
                                     {.scale_px = NAN, .width = 1, .height = 1},
                                     {.x = INFINITY, .scale_px = 1, .width = 1, .height = 1},
                                     {.scale_px = 1e19, .width = 1, .height = 1}, /* the network has steps of 2^-31 */
                                     {.scale_px = 1, .width = 0, .height = 1},
                                     {.scale_px = 1, .width = 65536, .height = 1},
                                     {.scale_px = 1, .width = 1, .height = 1, .simplify_px = -1},
                                     /* the network has no importance */
                                     {.scale_px = 1, .width = 1, .height = 1, .simplify_px = 0.1}};
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras; i++) {
        assert_int_equal(camber_mesh_tessellate_network(b->meshes[0], network, cameras + i, &desc),
                         CAMBER_ERROR_ARGUMENT);
        assert_story(&b->h, "camera: ");
        assert_false(b->meshes[0]->done);
    }
    const camber_camera good = {.scale_px = 1, .width = 1, .height = 1};
    assert_int_equal(camber_mesh_tessellate_network(b->meshes[0], network, &good, &(camber_tessellation_desc){0}),
                     CAMBER_ERROR_ARGUMENT);
    assert_story(&b->h, "row 0");
    camber_network_destroy(network);
    network = network_make(b, &(camber_network_desc){0});
    assert_int_equal(camber_mesh_tessellate_network(b->meshes[0], network, &good, &desc), CAMBER_OK);
    assert_int_equal(camber_mesh_get_info(b->meshes[0]).vertex_count, 0);
    camber_network_destroy(network);
}

int main(void) {
    if (!device_is_there()) {
        fprintf(stderr, "no OpenCL device\n");
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_device_equals_twin),
        cmocka_unit_test(test_draws_a_dot),
        cmocka_unit_test(test_dots),
        cmocka_unit_test(test_parts_equal_twin),
        cmocka_unit_test(test_sees_all_in_the_picture),
        cmocka_unit_test(test_keeps_everything),
        cmocka_unit_test(test_drops_by_importance),
        cmocka_unit_test(test_pieces_from_the_same_pixel),
        cmocka_unit_test(test_allocations_fail),
        cmocka_unit_test(test_wrong_input),
    };
    const int failed = cmocka_run_group_tests(tests, set_up, tear_down);
    return failed;
}
