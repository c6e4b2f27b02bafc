/* Draws a mesh on a device as lines over each other, united, in a group, and filled, and wants of each stage what the
 * twin makes. */
#include "fuzz_drawing.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH_PX = 200, HEIGHT_PX = 120, PASSES = 3, ROWS_MAX = 16 };

void fuzz_drawer_open(fuzz_drawer *drawer) {
    const camber_renderer_desc desc = {.rasterizer = CAMBER_RASTERIZER_OPENCL};
    camber_device *device = NULL;
    *drawer = (fuzz_drawer){0};
#ifdef CAMBER_FUZZ_ALONE
    if (!getenv("CAMBER_FUZZ_DEVICE"))
        return;
#endif
    if (camber_context_create(NULL, &drawer->context) != CAMBER_OK ||
        camber_device_create(drawer->context, &(camber_device_desc){0}, &device) != CAMBER_OK)
        return;
    REQUIRE(camber_renderer_create(device, NULL, &desc, &drawer->renderer) == CAMBER_OK);
    REQUIRE(camber_mesh_create(device, drawer->renderer, &drawer->mesh) == CAMBER_OK);
}

static bool is_drawn(uint32_t box) {
    return (box & 255u) <= (box >> 16 & 255u);
}

static void require_equal_words(const float *got, const float *expected, size_t words) {
    REQUIRE(memcmp(got, expected, sizeof(float) * words) == 0);
}

static void compare(const camber_drawing_stages *got, const camber_drawing_stages *expected) {
    const size_t tiles = (size_t)expected->columns * expected->rows;
    REQUIRE(got->segment_count == expected->segment_count);
    REQUIRE(!got->arc_lengths == !expected->arc_lengths && !got->planes == !expected->planes);
    for (size_t i = 0; i < expected->segment_count; i++) {
        const size_t word = expected->segment_words * i, measure = expected->arc_length_words * i,
                     plane = expected->plane_words * i;
        REQUIRE(got->boxes[i] == expected->boxes[i]);
        if (!is_drawn(got->boxes[i]))
            continue;
        require_equal_words(got->segments + word, expected->segments + word, expected->segment_words);
        if (expected->arc_lengths)
            require_equal_words(got->arc_lengths + measure, expected->arc_lengths + measure,
                                expected->arc_length_words);
        if (expected->planes)
            require_equal_words(got->planes + plane, expected->planes + plane, expected->plane_words);
    }
    REQUIRE(memcmp(got->starts, expected->starts, 4 * (tiles + 1)) == 0);
    REQUIRE(expected->starts[tiles] == 0 ||
            memcmp(got->lists, expected->lists, 4 * (size_t)expected->starts[tiles]) == 0);
    REQUIRE(memcmp(got->rgba, expected->rgba, 4 * (size_t)WIDTH_PX * HEIGHT_PX) == 0);
}

/* Fills of neighbouring rows. */
static const camber_fill fills[] = {{.color = {1, 0.5f, 0, 1}},
                                    {.color = {0, 0.5f, 1, 0.5f}, .rule = CAMBER_FILL_EVENODD}};

/* Without bands beside lines, with them, and a plane that is seen at an angle: a variant of the kernels each. Then with
 * the inside of the lines filled, too. */
static const struct {
    float gap_px, blur_px;
    double pitch_deg;
    bool fills;
} variants[] = {{0, 0, 0, false}, {1.5f, 0.8f, 0, false}, {0, 0, 50, false}, {0, 0, 0, true}, {0, 0, 50, true}};

static void draw(const fuzz_drawer *drawer, const camber_stroke *strokes, size_t stroke_count, size_t variant) {
    static const float widths[PASSES] = {1.0f, 0.6f, 0.3f}, alphas[PASSES] = {1.0f, 0.5f, 0.7f};
    camber_paint paints[PASSES][ROWS_MAX] = {{{0}}};
    camber_pass passes[PASSES];
    camber_drawing_stages got = {0}, expected = {0};
    REQUIRE(stroke_count <= ROWS_MAX);
    for (int k = 0; k < PASSES; k++) {
        passes[k] = (camber_pass){.mesh = drawer->mesh, .paints = paints[k], .paint_count = stroke_count};
        for (size_t i = 0; i < stroke_count; i++)
            paints[k][i] = (camber_paint){.width_px = widths[k] * strokes[i].width_px,
                                          .color = {0.5f * (float)k, k == 1 ? 1.0f : 0.1f * (float)i, 0.5f, alphas[k]},
                                          .translate_x_px = 0.7f * (float)k,
                                          .gap_px = i % 2 ? variants[variant].gap_px : 0,
                                          .blur_px = k == 2 ? variants[variant].blur_px : 0,
                                          .fill = variants[variant].fills && k != 1 ? fills + i % 2 : NULL};
    }
    passes[1].overlap = CAMBER_OVERLAP_UNITE;
    passes[2].overlap = CAMBER_OVERLAP_ACCUMULATE;
    passes[2].opacity = 0.6f;
    const camber_frame frame = {.width = WIDTH_PX,
                                .height = HEIGHT_PX,
                                .background = {0.2f, 0.3f, 0.4f, 0.5f},
                                .passes = passes,
                                .pass_count = PASSES,
                                .pitch_deg = variants[variant].pitch_deg};
    REQUIRE(camber_renderer_read_stages(drawer->renderer, &frame, &got) == CAMBER_OK);
    REQUIRE(camber_drawing_stages_rasterize(drawer->renderer, &frame, &expected) == CAMBER_OK);
    compare(&got, &expected);
    camber_drawing_stages_destroy(&got);
    camber_drawing_stages_destroy(&expected);
}

void fuzz_drawer_draw(const fuzz_drawer *drawer, const camber_stroke *strokes, size_t stroke_count, bool has_camera) {
    for (size_t i = 0; i < sizeof variants / sizeof *variants; i++)
        if (!has_camera || !(variants[i].pitch_deg > 0))
            draw(drawer, strokes, stroke_count, i);
}
