#include "torture.h"

enum { JOINS = 3, CAPS = 3 };

static bool is_inside(const torture_picture *drawn, int x, int y) {
    const int width = drawn->set->width, height = drawn->set->height;
    for (int v = y - 1; v <= y + 1; v++)
        for (int u = x - 1; u <= x + 1; u++)
            if (u < 0 || v < 0 || u >= width || v >= height ||
                drawn->truth[(size_t)v * (size_t)width + (size_t)u] < 1.0f)
                return false;
    return true;
}

/* A figure's points; a ring's are there twice, so that stretches run over its seam. */
typedef struct figure_line {
    float *points;
    size_t count;
    bool closed;
} figure_line;

static figure_line line_of(const torture_set *set, size_t figure) {
    const size_t first = set->lines.offsets[figure], count = set->lines.offsets[figure + 1] - first;
    const float *points = set->lines.points + 2 * first;
    figure_line line = {.points = malloc(4 * count * sizeof *points), .count = count};
    assert_non_null(line.points);
    memcpy(line.points, points, 2 * count * sizeof *points);
    line.closed = count > 2 && memcmp(points, points + 2 * (count - 1), 2 * sizeof *points) == 0;
    if (line.closed) {
        memcpy(line.points + 2 * count, points + 2, 2 * (count - 1) * sizeof *points);
        line.count += count - 1;
    }
    return line;
}

static double step_px(const figure_line *line, size_t i) {
    const float *p = line->points + 2 * i;
    return hypot((double)p[2] - (double)p[0], (double)p[3] - (double)p[1]);
}

/* Whether one stretch of the line, of two segments at least, covers the pixel by itself. */
static bool is_of_one_stretch(const figure_line *line, const camber_stroke *stroke, int x, int y) {
    camber_oracle_style style = {(double)stroke->width_px, stroke->join, CAMBER_CAP_BUTT, 2, false};
    camber_oracle_window pixel;
    bool covered = false;
    assert_true(camber_oracle_open(&pixel, x, y, 1, 1));
    for (size_t first = 0; first + 1 < line->count && !covered; first++) {
        size_t last = first + 1;
        double along = 0;
        for (; last + 1 < line->count && (along <= style.width_px / 2 || last < first + 2); last++)
            along += step_px(line, last);
        const bool at_end = !line->closed && (first == 0 || last + 1 == line->count);
        style.cap = at_end ? stroke->cap : CAMBER_CAP_BUTT;
        camber_oracle_clear(&pixel);
        assert_true(camber_oracle_stroke(&pixel, line->points + 2 * first, last + 1 - first, &style));
        covered = camber_oracle_coverage(&pixel, 0, 0) >= 1;
    }
    camber_oracle_close(&pixel);
    return covered;
}

typedef struct histogram {
    size_t counts[256];
} histogram;

static histogram count_levels(const torture_picture *drawn, const camber_window *cell) {
    histogram h = {{0}};
    for (int y = cell->y0; y < cell->y0 + cell->height; y++)
        for (int x = cell->x0; x < cell->x0 + cell->width; x++)
            if (is_inside(drawn, x, y))
                h.counts[drawn->alpha[(size_t)y * (size_t)drawn->set->width + (size_t)x]]++;
    return h;
}

torture_verdict torture_judge(const torture_picture *drawn, size_t figure) {
    const torture_set *set = drawn->set;
    const camber_window *cell = &set->figures[figure].cell;
    const histogram h = count_levels(drawn, cell);
    figure_line line = line_of(set, figure);
    torture_verdict v = {0};
    for (int level = 0; level < 256; level++) {
        v.inside += h.counts[level];
        v.level = h.counts[level] > h.counts[v.level] ? level : v.level;
    }
    v.worst = v.level;
    for (int y = cell->y0; y < cell->y0 + cell->height; y++)
        for (int x = cell->x0; x < cell->x0 + cell->width; x++) {
            const int level = drawn->alpha[(size_t)y * (size_t)set->width + (size_t)x];
            if (level == v.level || !is_inside(drawn, x, y))
                continue;
            const bool torn = is_of_one_stretch(&line, drawn->strokes + figure, x, y);
            const int apart = abs(level - v.level);
            v.torn += torn;
            v.torn_levels = torn && apart > v.torn_levels ? apart : v.torn_levels;
            v.meeting += !torn;
            if (apart > abs(v.worst - v.level))
                v.worst = level, v.x = x - cell->x0, v.y = y - cell->y0;
        }
    free(line.points);
    return v;
}

/* ---- The whole set ---- */

static camber_stroke *strokes_of(const torture_set *set, int join, int cap) {
    camber_stroke *strokes = calloc(set->count, sizeof *strokes);
    assert_non_null(strokes);
    for (size_t i = 0; i < set->count; i++)
        strokes[i] = (camber_stroke){(float)set->figures[i].width_px, (camber_join)join, (camber_cap)cap, 2};
    return strokes;
}

static const float *truth_of(torture_set *set, int style, const camber_stroke *strokes) {
    if (set->truths[style])
        return set->truths[style];
    const scene *s = &set->lines;
    const camber_lines lines = {s->points, s->offsets, s->point_count, s->polyline_count};
    const camber_truth_desc desc = {&lines, s->rows, strokes, false, CAMBER_TRUTH_UNION};
    float *truth = malloc((size_t)set->width * (size_t)set->height * sizeof *truth);
    assert_non_null(truth);
    assert_true(camber_truth_make(&desc, (camber_window){0, 0, set->width, set->height}, truth));
    return set->truths[style] = truth;
}

/* Half transparent, each figure flattened; gives alpha alone. */
static uint8_t *draw_alpha(const studio *s, camber_renderer *renderer, const torture_set *set,
                           const camber_tessellation_desc *desc) {
    camber_polylines *polylines = scene_polylines(s->context, &set->lines);
    camber_mesh *mesh = NULL;
    camber_paint *paints = calloc(set->count, sizeof *paints);
    assert_non_null(paints);
    for (size_t i = 0; i < set->count; i++)
        paints[i] = (camber_paint){.width_px = desc->strokes[i].width_px, .color = {1, 1, 1, 0.5f}};
    assert_int_equal(camber_mesh_create(s->device, renderer, &mesh), CAMBER_OK);
    assert_int_equal(camber_tessellate(mesh, polylines, desc), CAMBER_OK);
    const camber_pass pass = {.mesh = mesh, .paints = paints, .paint_count = set->count};
    const camber_frame frame = {
        .width = (uint32_t)set->width, .height = (uint32_t)set->height, .passes = &pass, .pass_count = 1};
    picture drawn = picture_draw(renderer, &frame);
    const size_t pixels = (size_t)set->width * (size_t)set->height;
    for (size_t i = 0; i < pixels; i++)
        drawn.rgba[i] = drawn.rgba[4 * i + 3];
    camber_mesh_destroy(mesh);
    camber_polylines_destroy(polylines);
    free(paints);
    return drawn.rgba;
}

/* All verdicts on a figure: the counts are sums, the rest is of the worst of them. */
typedef struct record {
    torture_verdict sum;
    size_t pictures; /* that differ */
    char how[64];
} record;

static torture_known judge_all(const torture_picture *drawn, record *records, const char *how) {
    torture_known found = {0};
    size_t judged = 0;
    for (size_t i = 0; i < drawn->set->count; i++) {
        const torture_verdict v = torture_judge(drawn, i);
        record *r = records + i;
        const torture_verdict before = r->sum;
        if (v.inside == 0) /* shorter than it is wide */
            continue;
        judged++;
        assert_true(v.level == 127 || v.level == 128);
        if (abs(v.worst - v.level) > abs(before.worst - before.level)) {
            r->sum = v;
            snprintf(r->how, sizeof r->how, "%s", how);
        }
        r->sum.torn = before.torn + v.torn;
        r->sum.torn_levels = v.torn_levels > before.torn_levels ? v.torn_levels : before.torn_levels;
        r->sum.meeting = before.meeting + v.meeting;
        r->pictures += v.torn + v.meeting > 0;
        found.torn += v.torn;
        found.torn_levels = v.torn_levels > found.torn_levels ? v.torn_levels : found.torn_levels;
        found.meeting += v.meeting;
    }
    assert_true(judged > drawn->set->count / 2);
    return found;
}

static void print_records(const torture_set *set, const record *records) {
    for (size_t i = 0; i < set->count; i++) {
        const torture_verdict *sum = &records[i].sum;
        if (records[i].pictures)
            printf("# %-30s in %2zu pictures %3zu px torn by up to %d, %4zu px meeting; worst %3d for %d at %d, %d of "
                   "its cell (%s)\n",
                   set->figures[i].name, records[i].pictures, sum->torn, sum->torn_levels, sum->meeting, sum->worst,
                   sum->level, sum->x, sum->y, records[i].how);
    }
}

void torture_check(const studio *s, torture_set *set, camber_method method, torture_known known) {
    static const char *const joins[] = {"round", "miter", "bevel"}, *const caps[] = {"butt", "round", "square"};
    record *records = calloc(set->count, sizeof *records);
    assert_non_null(records);
    torture_known most = {0};
    for (int i = 0; i < JOINS * CAPS; i++) {
        camber_stroke *strokes = strokes_of(set, i / CAPS, i % CAPS);
        const float *truth = truth_of(set, i, strokes);
        const camber_tessellation_desc desc = {strokes, set->count, method, 0, false};
        for (int b = 0; b < BACKENDS; b++) {
            if (!s->renderer[b])
                continue;
            char how[64];
            snprintf(how, sizeof how, "%s joins, %s caps, %s", joins[i / CAPS], caps[i % CAPS], BACKEND_NAME[b]);
            uint8_t *alpha = draw_alpha(s, s->renderer[b], set, &desc);
            const torture_known found = judge_all(&(torture_picture){set, strokes, truth, alpha}, records, how);
            most.torn = found.torn > most.torn ? found.torn : most.torn;
            most.torn_levels = found.torn_levels > most.torn_levels ? found.torn_levels : most.torn_levels;
            most.meeting = found.meeting > most.meeting ? found.meeting : most.meeting;
            free(alpha);
        }
        free(strokes);
    }
    print_records(set, records);
    free(records);
    printf(
        "# %s: in a picture up to %zu px torn by up to %d levels (known: %zu, %d), up to %zu px meeting (known: %zu)\n",
        camber_method_name(method), most.torn, most.torn_levels, known.torn, known.torn_levels, most.meeting,
        known.meeting);
    assert_true(most.torn <= known.torn && most.torn_levels <= known.torn_levels && most.meeting <= known.meeting);
}
