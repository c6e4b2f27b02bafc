/* Any network under any camera: world coordinates, importance, entries and cameras of any bits. The slots do not depend
 * on how chunks are cut, which is what the device does, and lie in the window; a device, where replay.c's main has one,
 * makes the twin's bytes, and draws its pixels.
 *
 *     u8 method | open << 2 | coordinates' form << 3 | bare << 5 | wild offsets << 6 | wild camera << 7
 *     u8 strokes, u8 polylines, u8 entries (bare: each polyline once)
 *     camera: u16 width, u16 height; wild: five f64, else i16 x, y in 1/16, i8 zoom, i16 bearing in 1/64, u8 tolerance
 *             (an odd bearing has a pitch)
 *     strokes: f32 width, f32 miter limit, u8 join | cap << 2
 *     polylines: u16 points (wild: the offset); entries: u8 polyline, u8 row, coordinate shift
 *     points: two coordinates (f64; i8; i16 / 16; f32), u8 importance (bare: none)
 */
#include "fuzz_drawing.h"

#include "kernels/cull.h"
#include "points/network.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STROKES_MAX = 8, POLYLINES_MAX = 255 };

typedef struct input {
    camber_stroke strokes[STROKES_MAX];
    size_t offsets[POLYLINES_MAX + 1];
    camber_network_entry entries[POLYLINES_MAX];
    double *points;
    float *importance;
    camber_network_desc network;
    camber_camera camera;
    camber_tessellation_desc tessellation;
} input;

/* ---- Reading ---- */

static double take_coordinate(fuzz_reader *from, unsigned form) {
    switch (form) {
    case 0: return fuzz_take_double(from);
    case 1: return (int8_t)fuzz_take(from, 1);
    case 2: return (int16_t)fuzz_take(from, 2) / 16.0;
    default: return (double)fuzz_take_float(from);
    }
}

static camber_camera take_camera(fuzz_reader *from, bool wild) {
    camber_camera camera = {.width = (uint32_t)fuzz_take(from, 2), .height = (uint32_t)fuzz_take(from, 2)};
    if (wild) {
        camera.x = fuzz_take_double(from);
        camera.y = fuzz_take_double(from);
        camera.scale_px = fuzz_take_double(from);
        camera.bearing_deg = fuzz_take_double(from);
        camera.simplify_px = fuzz_take_double(from);
        return camera;
    }
    camera.width = 1 + camera.width % 2048;
    camera.height = 1 + camera.height % 2048;
    camera.x = (int16_t)fuzz_take(from, 2) / 16.0;
    camera.y = (int16_t)fuzz_take(from, 2) / 16.0;
    camera.scale_px = exp2((int8_t)fuzz_take(from, 1) / 4.0);
    const unsigned bearing = (unsigned)fuzz_take(from, 2);
    camera.bearing_deg = (int16_t)bearing / 64.0;
    camera.pitch_deg = bearing & 1u ? (bearing >> 1 & 127u) * (85.0 / 127.0) : 0.0;
    camera.simplify_px = (double)fuzz_take(from, 1) / 16.0;
    return camera;
}

static void read_points(fuzz_reader *from, unsigned form, bool bare, size_t wanted, input *made) {
    static const size_t coordinate_bytes[] = {8, 1, 2, 4};
    const size_t there = from->size / (2 * coordinate_bytes[form] + !bare);
    const size_t count = wanted < there ? wanted : there;
    made->points = calloc(count + 1, 2 * sizeof *made->points);
    made->importance = calloc(count + 1, sizeof *made->importance);
    REQUIRE(made->points && made->importance);
    for (size_t i = 0; i < count; i++) {
        made->points[2 * i] = take_coordinate(from, form);
        made->points[2 * i + 1] = take_coordinate(from, form);
        const int byte = bare ? 0 : (int8_t)fuzz_take(from, 1);
        made->importance[i] = byte == -128 ? NAN : byte == 127 ? INFINITY : (float)byte / 16;
    }
    /* Polylines that there are no points for are left out: offsets are the caller's promise. */
    for (size_t i = 0; i <= made->network.polyline_count; i++)
        if (made->offsets[i] > count)
            made->offsets[i] = count;
}

static void read_input(fuzz_reader *from, input *made) {
    const unsigned head = (unsigned)fuzz_take(from, 1), form = head >> 3 & 3;
    const bool bare = head & 32, wild_offsets = head & 64;
    *made = (input){.tessellation = {.method = (camber_method)((head & 3) % 3)}};
    const size_t stroke_count = fuzz_take(from, 1) % (STROKES_MAX + 1), polyline_count = fuzz_take(from, 1);
    const size_t entry_count = fuzz_take(from, 1);
    made->camera = take_camera(from, head & 128);
    for (size_t i = 0; i < stroke_count; i++)
        made->strokes[i] = fuzz_take_stroke(from);
    for (size_t i = 0; i < polyline_count; i++) {
        const size_t points = fuzz_take(from, 2);
        made->offsets[i + 1] = wild_offsets ? points : made->offsets[i] + points % 256;
    }
    for (size_t i = 0; i < entry_count && !bare; i++) {
        made->entries[i].polyline = (uint32_t)fuzz_take(from, 1);
        made->entries[i].row = (uint32_t)fuzz_take(from, 1);
        made->entries[i].shift_x = take_coordinate(from, form);
        if (!wild_offsets && polyline_count)
            made->entries[i].polyline %= (uint32_t)polyline_count;
        if (!wild_offsets && stroke_count)
            made->entries[i].row %= (uint32_t)stroke_count;
    }
    made->network = (camber_network_desc){.offsets = made->offsets,
                                          .polyline_count = polyline_count,
                                          .entries = bare ? NULL : made->entries,
                                          .entry_count = bare ? 0 : entry_count,
                                          .keep_open = head & 4};
    size_t wanted = 0;
    for (size_t i = 0; i <= polyline_count; i++)
        wanted = made->offsets[i] > wanted ? made->offsets[i] : wanted;
    read_points(from, form, bare, wanted, made);
    made->network.points = made->points;
    made->network.importance = bare ? NULL : made->importance;
    made->tessellation.strokes = made->strokes;
    made->tessellation.stroke_count = stroke_count;
}

/* ---- Requirements ---- */

static void check_network(const camber_network *network) {
    const camber_polylines_stats stats = camber_network_get_stats(network);
    REQUIRE(stats.kept_points + stats.repeated_points + stats.invalid_points == stats.points);
    REQUIRE(stats.kept_points == network->point_count);
    for (size_t i = 0; i < network->point_count; i++)
        REQUIRE(network->x[i] >= 0 && network->y[i] >= 0 && network->importance[i] >= 0.0f);
    for (size_t i = 0; i < network->stretch_count; i++)
        REQUIRE(network->stretches[i].first < network->stretches[i + 1].first);
}

/* How far outside the picture a point may lie. */
static double margin_of(const input *from) {
    double reach = 0, beside = 0, looks = 0;
    for (size_t i = 0; i < from->tessellation.stroke_count; i++) {
        const camber_stroke *stroke = from->strokes + i;
        const double limit = stroke->miter_limit > 0 ? (double)stroke->miter_limit : 2;
        const double offset = fabs((double)stroke->offset_px);
        reach = fmax(reach, 0.5 * (double)stroke->width_px * fmax(limit, 1.5));
        beside = fmax(beside, offset * fmax(limit, 1.1));
        looks = fmax(looks, 8 * offset); /* what is as near may hide a line beside another */
    }
    return 80 + fmin(reach, 70000) + fmin(beside, 70000) + looks;
}

/* Pieces begin and end, points are in the window or end a piece of a segment that touches it or the next piece, and
 * those that follow each other differ. */
static void check_slots(const camber_polylines *slots, const input *from) {
    const camber_camera *camera = &from->camera;
    const double pieces = 2 * 1.4143 * (double)CAMBER_PIECE_PX;
    const double margin = margin_of(from) * 1.0001, wide = camera->width, high = camera->height;
    /* A tilted camera sees 14 times as far as to its centre at most. */
    const bool tilted = camera->pitch_deg > 0;
    const double aside = tilted ? 14 * wide + 2 * margin * (2 + wide / high) : margin + pieces;
    const double ahead = tilted ? 30 * high + 300 + margin : margin + pieces;
    const double behind = tilted ? 2 * high + 10 + margin : margin + pieces;
    bool open = false;
    for (size_t i = 0; i <= slots->polyline_count; i++)
        REQUIRE(slots->first_slots[i] <= slots->slot_count &&
                (i == 0 || slots->first_slots[i - 1] <= slots->first_slots[i]));
    for (size_t i = 1; i <= slots->slot_count; i++) {
        const uint32_t info = slots->info[i];
        REQUIRE(isfinite(slots->x[i]) && isfinite(slots->y[i]));
        REQUIRE((double)slots->x[i] >= -aside && (double)slots->x[i] <= wide + aside);
        REQUIRE((double)slots->y[i] >= -ahead && (double)slots->y[i] <= high + behind);
        if (!(info & CAMBER_POINT_REAL)) {
            REQUIRE(!open);
            continue;
        }
        REQUIRE(open == !(info & CAMBER_POINT_FIRST));
        REQUIRE(info >> CAMBER_POINT_ROW_SHIFT < from->tessellation.stroke_count);
        open = !(info & CAMBER_POINT_LAST);
    }
    REQUIRE(!open);
}

/* Survey and project as the device runs them: chunk after chunk, each from the run of its first point. */
static void check_chunks(fuzz_run *run, const camber_network *network, const input *from,
                         const camber_polylines *twin) {
    camber_projection p;
    if (!fuzz_done(run, camber_network_aim(network, &from->camera, &from->tessellation, &p)))
        return;
    const camber_stretch *first = network->stretches;
    size_t at = 1;
    for (uint32_t chunk = 0; chunk * CAMBER_CULL_CHUNK < network->point_count; chunk++) {
        float x[3 * CAMBER_CULL_CHUNK] = {0}, y[3 * CAMBER_CULL_CHUNK] = {0};
        camber_u32 info[3 * CAMBER_CULL_CHUNK] = {0}, begin, end;
        camber_walk counts = camber_network_walk(network), puts = counts;
        camber_chunk_bounds(&p, chunk, &begin, &end);
        while (first[1].first <= begin)
            first++;
        camber_walk_chunk(&counts, &p, first, begin, end);
        REQUIRE(counts.at <= sizeof x / sizeof *x);
        puts.slot_x = x;
        puts.slot_y = y;
        puts.slot_info = info;
        puts.puts = 1;
        camber_walk_chunk(&puts, &p, first, begin, end);
        REQUIRE(puts.at == counts.at && at + puts.at <= twin->slot_count + 1);
        for (camber_u32 i = 0; i < puts.at; i++, at++)
            REQUIRE(x[i] == twin->x[at] && y[i] == twin->y[at] && info[i] == twin->info[at]);
    }
    REQUIRE(at == twin->first_slots[twin->polyline_count] + 1);
}

/* Pieces are parts of entries, in their order. */
static void check_lines(fuzz_run *run, const camber_network *network, const input *from) {
    camber_lines lines = {0};
    if (!fuzz_done(run, camber_network_project_lines(network, &from->camera, &from->tessellation, &lines)))
        return;
    fuzz_check_lines(&lines);
    for (size_t i = 0; i < lines.polyline_count; i++) {
        REQUIRE(lines.offsets[i] < lines.offsets[i + 1] && lines.entries[i] < network->entry_count);
        REQUIRE(i == 0 || lines.entries[i - 1] <= lines.entries[i]);
    }
    camber_lines_destroy(&lines);
}

/* ---- On a device ---- */

static fuzz_drawer drawer;

static void check_device(const input *from) {
    camber_network *network = NULL;
    camber_polylines *twin = NULL;
    camber_mesh_data got = {0}, expected = {0};
    REQUIRE(camber_network_create(drawer.context, &from->network, &network) == CAMBER_OK);
    const camber_status status =
        camber_mesh_tessellate_network(drawer.mesh, network, &from->camera, &from->tessellation);
    REQUIRE(status == camber_network_project(network, &from->camera, &from->tessellation, &twin));
    if (status == CAMBER_OK) {
        REQUIRE(camber_mesh_read(drawer.mesh, &got) == CAMBER_OK);
        REQUIRE(camber_mesh_data_tessellate(drawer.context, twin, &from->tessellation, &expected) == CAMBER_OK);
        REQUIRE(got.info.record_count == expected.info.record_count &&
                got.info.index_count == expected.info.index_count);
        REQUIRE(got.info.record_count == 0 ||
                memcmp(got.records, expected.records, got.info.record_count * sizeof *got.records) == 0);
        fuzz_drawer_draw(&drawer, from->tessellation.strokes, from->tessellation.stroke_count, true);
    }
    camber_mesh_data_destroy(&got);
    camber_mesh_data_destroy(&expected);
    camber_polylines_destroy(twin);
    camber_network_destroy(network);
}

/* ---- The target ---- */

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    fuzz_reader reader = {bytes, size};
    input from;
    camber_network *network = NULL;
    camber_polylines *slots = NULL;
    read_input(&reader, &from);
    if (fuzz_done(run, camber_network_create(run->context, &from.network, &network))) {
        check_network(network);
        if (fuzz_done(run, camber_network_project(network, &from.camera, &from.tessellation, &slots))) {
            check_slots(slots, &from);
            check_chunks(run, network, &from, slots);
            check_lines(run, network, &from);
            fuzz_tessellate(run, slots, &from.tessellation, NULL);
        }
        if (drawer.mesh && !run->refuse_at)
            check_device(&from);
    }
    camber_polylines_destroy(slots);
    camber_network_destroy(network);
    free(from.points);
    free(from.importance);
}

int LLVMFuzzerInitialize(int *argument_count, char ***arguments) {
    (void)argument_count;
    (void)arguments;
    fuzz_drawer_open(&drawer);
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    fuzz_each(bytes, size, use);
    return 0;
}
