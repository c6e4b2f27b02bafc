/* Any polylines, strokes and methods on the CPU twin: floats of any bits, rows and offsets that may be wrong; then GLB
 * of what came of it. A device, where replay.c's main has one, makes the twin's records, and draws its pixels.
 *
 *     u8 method | open << 2 | points' form << 3 | wild offsets << 5 | wild rows << 6
 *     u8 strokes, u8 polylines, f32 fan tolerance
 *     strokes: f32 width, f32 miter limit, u8 join | cap << 2
 *     polylines: u16 points (wild: the offset), u8 row (wild: any)
 *     points: two f32; two i8; two i16 / 16
 */
#include "fuzz_drawing.h"

#ifdef CAMBER_FUZZ_MAP
#include "camber_map.h"
#endif

#include <stdlib.h>
#include <string.h>

enum { STROKES_MAX = 8, POLYLINES_MAX = 255 };

static float take_coordinate(fuzz_reader *from, unsigned form) {
    switch (form) {
    case 0: return fuzz_take_float(from);
    case 1: return (float)(int8_t)fuzz_take(from, 1);
    default: return (float)(int16_t)fuzz_take(from, 2) * (1.0f / 16);
    }
}

typedef struct input {
    camber_stroke strokes[STROKES_MAX];
    size_t stroke_count;
    uint32_t offsets[POLYLINES_MAX + 1], rows[POLYLINES_MAX];
    float *points;
    camber_polylines_desc polylines;
    camber_tessellation_desc tessellation;
} input;

static void read_points(fuzz_reader *from, unsigned form, uint32_t wanted, input *made) {
    static const size_t coordinate_bytes[] = {4, 1, 2, 2};
    const size_t there = from->size / (2 * coordinate_bytes[form]);
    const size_t count = wanted < there ? wanted : there;
    made->points = calloc(count + 1, 2 * sizeof *made->points);
    REQUIRE(made->points);
    for (size_t i = 0; i < 2 * count; i++)
        made->points[i] = take_coordinate(from, form);
    made->polylines.point_count = count;
}

static void read_input(fuzz_reader *from, input *made) {
    const unsigned head = (unsigned)fuzz_take(from, 1), form = head >> 3 & 3;
    const bool wild_offsets = head & 32, wild_rows = head & 64;
    *made = (input){.stroke_count = fuzz_take(from, 1) % (STROKES_MAX + 1)};
    const size_t polyline_count = fuzz_take(from, 1);
    const float tolerance_px = fuzz_take_float(from);
    for (size_t i = 0; i < made->stroke_count; i++)
        made->strokes[i] = fuzz_take_stroke(from);
    for (size_t i = 0; i < polyline_count; i++) {
        const uint32_t points = (uint32_t)fuzz_take(from, 2), row = (uint32_t)fuzz_take(from, 1);
        made->offsets[i + 1] = wild_offsets ? points : made->offsets[i] + points % 64;
        made->rows[i] = wild_rows ? row << (row & 31) : made->stroke_count ? row % (uint32_t)made->stroke_count : 0;
    }
    read_points(from, form, made->offsets[polyline_count], made);
    /* Polylines that there are no points for are left out. */
    for (size_t i = 0; i <= polyline_count && !wild_offsets; i++)
        if (made->offsets[i] > made->polylines.point_count)
            made->offsets[i] = (uint32_t)made->polylines.point_count;
    made->polylines.points = made->points;
    made->polylines.offsets = made->offsets;
    made->polylines.polyline_count = polyline_count;
    made->polylines.rows = made->rows;
    made->polylines.keep_open = head & 4;
    made->tessellation =
        (camber_tessellation_desc){made->strokes, made->stroke_count, (camber_method)(head & 3), tolerance_px, false};
}

static void write_glb(fuzz_run *run, const camber_mesh_data *mesh, const input *from) {
#ifdef CAMBER_FUZZ_MAP
    const camber_glb_desc desc = {.strokes = from->strokes, .stroke_count = from->stroke_count};
    fuzz_bytes file = {0};
    if (fuzz_done(run, camber_glb_write(run->context, mesh, &desc, fuzz_sink(&file)))) {
        uint32_t size;
        REQUIRE(file.size >= 20 && memcmp(file.bytes, "glTF", 4) == 0);
        memcpy(&size, file.bytes + 8, sizeof size);
        REQUIRE(size == file.size);
    }
    free(file.bytes);
#else
    (void)run, (void)mesh, (void)from;
#endif
}

/* The mesh does not depend on what memory held. */
static void check_again(fuzz_run *run, const camber_polylines *polylines, const input *from,
                        const camber_mesh_data *mesh) {
    camber_mesh_data again = {0};
    if (!fuzz_tessellate(run, polylines, &from->tessellation, &again))
        return;
    REQUIRE(mesh->info.vertex_count == again.info.vertex_count && mesh->info.index_count == again.info.index_count);
    if (mesh->info.index_count) {
        REQUIRE(memcmp(mesh->vertices, again.vertices, mesh->info.vertex_count * sizeof *mesh->vertices) == 0);
        REQUIRE(mesh->info.record_count == again.info.record_count &&
                memcmp(mesh->records, again.records, mesh->info.record_count * sizeof *mesh->records) == 0);
        REQUIRE(memcmp(mesh->indices, again.indices, mesh->info.index_count * sizeof *mesh->indices) == 0);
    }
    camber_mesh_data_destroy(&again);
}

static fuzz_drawer drawer;

static void check_device(const input *from, const camber_mesh_data *expected) {
    camber_polylines *polylines = NULL;
    camber_mesh_data got = {0};
    REQUIRE(camber_polylines_create(drawer.context, &from->polylines, &polylines) == CAMBER_OK);
    REQUIRE(camber_mesh_tessellate(drawer.mesh, polylines, &from->tessellation) == CAMBER_OK);
    REQUIRE(camber_mesh_read(drawer.mesh, &got) == CAMBER_OK);
    REQUIRE(got.info.record_count == expected->info.record_count);
    REQUIRE(got.info.record_count == 0 ||
            memcmp(got.records, expected->records, got.info.record_count * sizeof *got.records) == 0);
    fuzz_drawer_draw(&drawer, from->strokes, from->stroke_count, false);
    camber_mesh_data_destroy(&got);
    camber_polylines_destroy(polylines);
}

/* Every point is kept or was counted as dropped. */
static bool adds_up(const camber_polylines *polylines) {
    const camber_polylines_stats stats = camber_polylines_get_stats(polylines);
    REQUIRE(stats.kept_points + stats.repeated_points + stats.invalid_points == stats.points);
    return true;
}

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    fuzz_reader from = {bytes, size};
    input made;
    camber_polylines *polylines = NULL;
    camber_mesh_data mesh = {0};
    read_input(&from, &made);
    if (fuzz_done(run, camber_polylines_create(run->context, &made.polylines, &polylines)) && adds_up(polylines) &&
        fuzz_tessellate(run, polylines, &made.tessellation, &mesh)) {
        check_again(run, polylines, &made, &mesh);
        write_glb(run, &mesh, &made);
        if (drawer.mesh && !run->refuse_at)
            check_device(&made, &mesh);
        camber_mesh_data_destroy(&mesh);
    }
    camber_polylines_destroy(polylines);
    free(made.points);
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
