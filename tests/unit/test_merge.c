/* Lines of one class that meet end to end become one: against what must hold of every node and segment, and against
 * GEOS where it is there. */
#include "core.h"

#include "features/features.h"
#include "style/style.h"

#include <math.h>

#ifdef CAMBER_GEOS
#include <geos_c.h>
#endif

enum { CLASSES = 3 };

typedef struct fixture {
    host h;
    camber_context *context;
    struct camber_style style;
    camber_features *features;
    uint32_t classes[CLASSES + 1]; /* the last: outlines */
} fixture;

static void begin(fixture *it) {
    static char *properties[] = {"highway"};
    it->context = host_context(&it->h);
    it->style =
        (struct camber_style){.context = it->context, .schema = {.properties = properties, .property_count = 1}};
    assert_int_equal(camber_features_create(it->context, &it->style, &it->features), CAMBER_OK);
    for (int i = 0; i <= CLASSES; i++) {
        const camber_value value = {.type = CAMBER_VALUE_NUMBER, .number = i % CLASSES};
        assert_int_equal(camber_features_find_class(it->features, 0,
                                                    i < CLASSES ? CAMBER_GEOMETRY_LINE : CAMBER_GEOMETRY_POLYGON,
                                                    &value, &it->classes[i]),
                         CAMBER_OK);
    }
}

static void end(fixture *it) {
    camber_features_destroy(it->features);
    host_done(&it->h, it->context);
}

static void add_part(const fixture *it, size_t count, const double *points) {
    assert_int_equal(camber_features_add_polyline(it->features, points, count), CAMBER_OK);
}

static void add(const fixture *it, int class_index, size_t count, const double *points) {
    assert_int_equal(camber_features_add_feature(it->features, it->classes[class_index]), CAMBER_OK);
    add_part(it, count, points);
}

static void merge(const fixture *it, bool directed) {
    assert_int_equal(camber_features_merge(it->features, 0, directed), CAMBER_OK);
}

static void expect_line(const fixture *it, size_t polyline, size_t count, const double *points) {
    const camber_features *set = it->features;
    assert_true(polyline < set->polyline_count);
    assert_int_equal(set->offsets[polyline + 1] - set->offsets[polyline], count);
    assert_memory_equal(set->points + 2 * set->offsets[polyline], points, 2 * count * sizeof *points);
}

static void test_known_lines(void **state) {
    (void)state;
    fixture it;
    begin(&it);
    add(&it, 0, 2, (double[]){2, 0, 3, 1});
    add(&it, 1, 2, (double[]){2, 0, 3, 0}); /* another class at a node changes nothing */
    add(&it, 0, 3, (double[]){0, 0, 1, 0, 2, 0});
    add(&it, 0, 2, (double[]){4, 0, 3, 1}); /* against the direction */
    merge(&it, false);
    assert_int_equal(it.features->polyline_count, 2);
    expect_line(&it, 0, 5, (double[]){0, 0, 1, 0, 2, 0, 3, 1, 4, 0});
    expect_line(&it, 1, 2, (double[]){2, 0, 3, 0});
    assert_int_equal(it.features->feature_counts[0], 3);
    assert_int_equal(it.features->feature_counts[1], 1);
    assert_int_equal(it.features->polyline_feature[0], 0);
    assert_int_equal(it.features->polyline_feature[1], 1);
    assert_int_equal(it.features->stats.merged_polylines, 2);
    end(&it);

    begin(&it);
    add(&it, 0, 2, (double[]){2, 0, 3, 1});
    add(&it, 0, 3, (double[]){0, 0, 1, 0, 2, 0});
    add(&it, 0, 2, (double[]){4, 0, 3, 1});
    merge(&it, true);
    assert_int_equal(it.features->polyline_count, 2);
    expect_line(&it, 0, 4, (double[]){0, 0, 1, 0, 2, 0, 3, 1});
    expect_line(&it, 1, 2, (double[]){4, 0, 3, 1});
    end(&it);
}

/* Three ends, or a ring's seam and an end, are a junction. Two loops become rings. */
static void test_junctions_and_rings(void **state) {
    (void)state;
    fixture it;
    begin(&it);
    add(&it, 0, 2, (double[]){0, 0, 1, 0});
    add(&it, 0, 2, (double[]){1, 0, 2, 1});
    add(&it, 0, 2, (double[]){1, 0, 2, -1});
    add(&it, 0, 4, (double[]){5, 5, 6, 5, 6, 6, 5, 5});
    add(&it, 0, 2, (double[]){5, 5, 4, 4});
    add(&it, 0, 2, (double[]){8, 8, 8, 8}); /* a dot */
    add(&it, 0, 2, (double[]){8, 8, 9, 9});
    add(&it, CLASSES, 2, (double[]){9, 9, 9, 8}); /* pieces of outlines */
    add(&it, CLASSES, 2, (double[]){9, 8, 8, 8});
    merge(&it, false);
    assert_int_equal(it.features->polyline_count, 9);
    assert_int_equal(it.features->stats.merged_polylines, 0);
    end(&it);

    for (int directed = 0; directed < 2; directed++) {
        begin(&it);
        add(&it, 0, 3, (double[]){1, 0, 1, 1, 0, 1});
        add(&it, 0, 3, (double[]){0, 1, 0, 0, 1, 0});
        add(&it, 1, 2, (double[]){1, 0, 1, 1});
        add(&it, 1, 3, (double[]){1, 0, 0, 0, 1, 1}); /* the other way round */
        merge(&it, directed);
        expect_line(&it, 0, 5, (double[]){1, 0, 1, 1, 0, 1, 0, 0, 1, 0});
        if (directed) {
            assert_int_equal(it.features->polyline_count, 3);
        } else {
            assert_int_equal(it.features->polyline_count, 2);
            expect_line(&it, 1, 4, (double[]){1, 0, 1, 1, 0, 0, 1, 0});
        }
        end(&it);
    }
}

/* By the straight rule the two ends that turn least go on, whatever else meets there; a bend ends both. */
static void test_straight_on(void **state) {
    (void)state;
    fixture it;
    begin(&it);
    add(&it, 0, 2, (double[]){0, 0, 10, 0});
    add(&it, 0, 2, (double[]){10, 0, 20, 5}); /* by 27 degrees */
    add(&it, 0, 2, (double[]){20, 0, 10, 0}); /* against its direction, and straighter */
    add(&it, 0, 2, (double[]){10, 9, 10, 0});
    add(&it, 0, 3, (double[]){10, 0, 10, 0, 10, -9});    /* a point that comes twice has no direction */
    add(&it, 0, 2, (double[]){20, 0, 20, 4});            /* a corner */
    add(&it, 1, 2, (double[]){20, 0, 30, 0});            /* another class */
    add(&it, 2, 4, (double[]){0, 0, 5, 1, 5, -1, 0, 0}); /* its own two ends */
    add(&it, 2, 2, (double[]){0, 0, -5, 5});             /* by 34 degrees from one of them */
    assert_int_equal(camber_features_merge(it.features, 0, CAMBER_MERGE_STRAIGHT), CAMBER_OK);
    assert_int_equal(it.features->polyline_count, 6);
    expect_line(&it, 0, 3, (double[]){0, 0, 10, 0, 20, 0});
    expect_line(&it, 1, 2, (double[]){10, 0, 20, 5});
    expect_line(&it, 2, 4, (double[]){10, 9, 10, 0, 10, 0, 10, -9});
    expect_line(&it, 3, 2, (double[]){20, 0, 20, 4});
    expect_line(&it, 4, 2, (double[]){20, 0, 30, 0});
    assert_int_equal(it.features->feature_counts[0], 2);
    assert_int_equal(it.features->feature_counts[5], 2);
    end(&it);
}

/* More ends than are looked at: those past them stay as they are. */
static void test_star(void **state) {
    (void)state;
    fixture it;
    begin(&it);
    for (int i = 0; i < 40; i++)
        add(&it, 0, 2, (double[]){0, 0, cos(0.1 + i), sin(0.1 + i)});
    assert_int_equal(camber_features_merge(it.features, 0, CAMBER_MERGE_STRAIGHT), CAMBER_OK);
    assert_in_range(it.features->polyline_count, 32, 39);
    end(&it);
}

/* A feature of two parts counts where its first is, and once. What was read before stays as it is. */
static void test_counts(void **state) {
    (void)state;
    fixture it;
    begin(&it);
    add(&it, 0, 2, (double[]){-1, 0, 0, 0});
    add(&it, 0, 2, (double[]){0, 0, 1, 0});
    add_part(&it, 2, (double[]){5, 0, 6, 0});
    add(&it, 0, 2, (double[]){1, 0, 2, 0});
    add(&it, 0, 2, (double[]){6, 0, 7, 0});
    assert_int_equal(it.features->feature_counts[2], 0);
    assert_int_equal(camber_features_merge(it.features, 1, false), CAMBER_OK);
    assert_int_equal(it.features->polyline_count, 3);
    expect_line(&it, 0, 2, (double[]){-1, 0, 0, 0});
    expect_line(&it, 1, 3, (double[]){0, 0, 1, 0, 2, 0});
    expect_line(&it, 2, 3, (double[]){5, 0, 6, 0, 7, 0});
    const uint32_t counts[] = {1, 2, 1}, firsts[] = {0, 1, 1};
    assert_memory_equal(it.features->feature_counts, counts, sizeof counts);
    assert_memory_equal(it.features->polyline_feature, firsts, sizeof firsts);
    end(&it);
}

/* ---- Any network ---- */

typedef struct segment {
    uint32_t class_index;
    double from[2], to[2];
} segment;

static int compare_segments(const void *a, const void *b) {
    const segment *p = a, *q = b;
    if (p->class_index != q->class_index)
        return p->class_index < q->class_index ? -1 : 1;
    const double d[] = {p->from[0] - q->from[0], p->from[1] - q->from[1], p->to[0] - q->to[0], p->to[1] - q->to[1]};
    for (int i = 0; i < 4; i++)
        if (d[i] < 0 || d[i] > 0)
            return d[i] < 0 ? -1 : 1;
    return 0;
}

static uint32_t class_of(const camber_features *set, size_t polyline) {
    return set->feature_class[set->polyline_feature[polyline]];
}

/* Sorted; directed: as they run, else from the left. */
static segment *list_segments(const camber_features *set, bool directed, size_t *count) {
    segment *list = calloc(set->point_count + 1, sizeof *list);
    assert_non_null(list);
    *count = 0;
    for (size_t i = 0; i < set->polyline_count; i++) {
        for (size_t k = set->offsets[i]; k + 1 < set->offsets[i + 1]; k++) {
            const double *p = set->points + 2 * k;
            const bool turned = !directed && (p[0] > p[2] || (p[0] == p[2] && p[1] > p[3]));
            segment *one = &list[(*count)++];
            one->class_index = class_of(set, i);
            memcpy(one->from, p + (turned ? 2 : 0), sizeof one->from);
            memcpy(one->to, p + (turned ? 0 : 2), sizeof one->to);
        }
    }
    qsort(list, *count, sizeof *list, compare_segments);
    return list;
}

typedef struct node_ends {
    size_t starts, ends, rings; /* a ring's seam counts as both too */
} node_ends;

/* Lines of a class that begin and end at a grid node; lines that go nowhere do not count. */
static node_ends ends_at(const camber_features *set, uint32_t class_index, double x, double y) {
    node_ends found = {0};
    for (size_t i = 0; i < set->polyline_count; i++) {
        const double *p = set->points + 2 * set->offsets[i], *q = set->points + 2 * (set->offsets[i + 1] - 1);
        bool dot = true;
        for (const double *r = p; r < q; r += 2)
            dot &= r[0] == r[2] && r[1] == r[3];
        if (dot || class_of(set, i) != class_index)
            continue;
        const bool starts = p[0] == x && p[1] == y, stops = q[0] == x && q[1] == y;
        found.starts += starts;
        found.ends += stops;
        found.rings += starts && stops;
    }
    return found;
}

enum { GRID = 7 };

typedef struct network_ends {
    node_ends at[CLASSES][GRID][GRID];
} network_ends;

static void count_ends(const fixture *it, network_ends *ends) {
    for (uint32_t c = 0; c < CLASSES; c++)
        for (int x = 0; x < GRID; x++)
            for (int y = 0; y < GRID; y++)
                ends->at[c][x][y] = ends_at(it->features, it->classes[c], x, y);
}

/* Where exactly two ends met there is none, or the seam of a ring; all others are as they were. */
static void check_node(node_ends before, node_ends after, bool directed) {
    const bool joins = before.starts + before.ends == 2 && before.rings == 0 && (!directed || before.starts == 1);
    if (joins && after.rings == 1)
        assert_true(after.starts == 1 && after.ends == 1);
    else if (joins)
        assert_true(after.starts + after.ends == 0);
    else if (directed)
        assert_true(after.starts == before.starts && after.ends == before.ends);
    else
        assert_true(after.starts + after.ends == before.starts + before.ends);
}

static void make_network(const fixture *it, uint64_t *seed) {
    const size_t lines = 2 + camber_random_below(seed, 40), classes = 1 + camber_random_below(seed, CLASSES);
    for (size_t i = 0; i < lines; i++) {
        double points[2 * 6];
        const size_t count = 1 + camber_random_below(seed, 6);
        for (size_t k = 0; k < count; k++) {
            points[2 * k] = (double)camber_random_below(seed, GRID);
            points[2 * k + 1] = (double)camber_random_below(seed, GRID);
        }
        if (i > 0 && camber_random_below(seed, 8) == 0)
            add_part(it, count, points);
        else
            add(it, (int)camber_random_below(seed, classes), count, points);
    }
}

static size_t total_features(const camber_features *set) {
    size_t sum = 0;
    for (size_t i = 0; i < set->polyline_count; i++) {
        sum += set->feature_counts[i];
        assert_true(i == 0 || set->polyline_feature[i] >= set->polyline_feature[i - 1]);
    }
    return sum;
}

static void test_any_network(void **state) {
    (void)state;
    uint64_t seed = 1;
    size_t merged = 0, rings = 0;
    for (int round = 0; round < 3000; round++) {
        const bool directed = round % 2;
        fixture it;
        network_ends before, after;
        begin(&it);
        make_network(&it, &seed);
        size_t count_before, count_after;
        segment *segments_before = list_segments(it.features, directed, &count_before);
        count_ends(&it, &before);
        const size_t polylines = it.features->polyline_count;
        merge(&it, directed);
        segment *segments_after = list_segments(it.features, directed, &count_after);
        count_ends(&it, &after);
        assert_int_equal(count_before, count_after);
        assert_memory_equal(segments_before, segments_after, count_before * sizeof *segments_before);
        for (int c = 0; c < CLASSES; c++)
            for (int x = 0; x < GRID; x++)
                for (int y = 0; y < GRID; y++) {
                    check_node(before.at[c][x][y], after.at[c][x][y], directed);
                    rings += after.at[c][x][y].rings > before.at[c][x][y].rings;
                }
        assert_int_equal(total_features(it.features), it.features->feature_count);
        assert_int_equal(it.features->polyline_count + it.features->stats.merged_polylines, polylines);
        merged += it.features->stats.merged_polylines;
        free(segments_after);
        free(segments_before);
        end(&it);
    }
    assert_true(merged > 3000 && rings > 30);
}

/* ---- Ends ---- */

/* Class 0 is below class 1; class 2 has no part in it. */
static double rank_ends(const camber_style *style, const char *source_layer, const camber_feature_view *feature) {
    (void)style;
    (void)source_layer;
    return feature->values->number < 2.0 ? feature->values->number : CAMBER_NO_RANK;
}

static void begin_ends(fixture *it) {
    uint32_t layer;
    begin(it);
    it->style.schema.rank_ends = rank_ends;
    assert_int_equal(camber_features_find_layer(it->features, "", &layer), CAMBER_OK);
}

/* How many dots of a class are at a point. */
static size_t dots_at(const camber_features *set, double number, double x, double y) {
    size_t count = 0;
    for (size_t i = 0; i < set->polyline_count; i++) {
        const camber_feature_class *class = &set->classes[class_of(set, i)];
        const double *at = set->points + 2 * set->offsets[i];
        if (!class->is_ends || at[0] != x || at[1] != y)
            continue;
        assert_int_equal(set->offsets[i + 1] - set->offsets[i], 1);
        count += set->values[class->first_value].number == number;
    }
    return count;
}

static void test_known_ends(void **state) {
    (void)state;
    static const struct {
        const char *what;
        int classes[3];
        double points[3][4]; /* two points a line */
        size_t dots[2];      /* at 0, 0: of class 0 and 1 */
    } cases[] = {
        {"alone", {1, 1, 1}, {{-1, 0, 0, 0}, {5, 5, 6, 6}, {6, 7, 8, 9}}, {0, 1}},
        {"goes on below", {1, 0, 1}, {{-1, 0, 0, 0}, {0, 0, 1, 0}, {6, 7, 8, 9}}, {1, 0}},
        {"two below", {1, 0, 0}, {{-1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}, {1, 0}},
        {"an equal corner", {1, 1, 0}, {{-1, 0, 0, 0}, {0, 0, 0, 1}, {0, 0, 1, 1}}, {1, 1}},
        {"others do not count", {1, 2, 2}, {{-1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}, {0, 1}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        fixture it;
        begin_ends(&it);
        for (int k = 0; k < 3; k++)
            add(&it, cases[i].classes[k], 2, cases[i].points[k]);
        assert_int_equal(camber_features_add_ends(it.features, 0), CAMBER_OK);
        for (int c = 0; c < 2; c++)
            if (dots_at(it.features, c, 0, 0) != cases[i].dots[c])
                fail_msg("%s: %zu dots of class %d", cases[i].what, dots_at(it.features, c, 0, 0), c);
        camber_features_count(it.features);
        assert_int_equal(it.features->stats.features, 3);
        assert_int_equal(it.features->stats.polylines, 3);
        assert_int_equal(it.features->stats.points, 6);
        end(&it);
    }
    /* A line that passes covers the ends of those that are not above it. */
    fixture it;
    begin_ends(&it);
    add(&it, 1, 3, (double[]){-1, 0, 0, 0, 1, 0});
    add(&it, 1, 2, (double[]){0, 0, 0, 1});
    add(&it, 0, 2, (double[]){0, 0, 0, -1});
    add(&it, 0, 3, (double[]){4, 0, 5, 0, 6, 0});
    add(&it, 1, 2, (double[]){5, 0, 5, 1});
    assert_int_equal(camber_features_add_ends(it.features, 0), CAMBER_OK);
    assert_int_equal(dots_at(it.features, 0, 0, 0) + dots_at(it.features, 1, 0, 0), 0);
    assert_int_equal(dots_at(it.features, 0, 5, 0) + dots_at(it.features, 1, 5, 0), 0);
    assert_int_equal(dots_at(it.features, 1, -1, 0), 1);
    end(&it);
}

static double rank_of(const camber_features *set, size_t polyline) {
    const camber_feature_class *class = &set->classes[class_of(set, polyline)];
    const double number = set->values[class->first_value].number;
    return class->geometry == CAMBER_GEOMETRY_LINE && !class->is_ends && number < 2.0 ? number : CAMBER_NO_RANK;
}

/* The lines at a grid node, by class: ends, two of a line of one point, and lines that do not end there. */
typedef struct node_lines {
    size_t ends[2], passes[2];
} node_lines;

static node_lines lines_at(const camber_features *set, size_t polylines, double x, double y) {
    node_lines found = {0};
    for (size_t i = 0; i < polylines; i++) {
        const double rank = rank_of(set, i);
        const double *p = set->points + 2 * set->offsets[i];
        const size_t count = set->offsets[i + 1] - set->offsets[i];
        const bool ring = count > 2 && p[0] == p[2 * count - 2] && p[1] == p[2 * count - 1];
        for (size_t k = ring; k < count && rank >= 0.0; k++)
            if (p[2 * k] == x && p[2 * k + 1] == y)
                (!ring && (k == 0 || k + 1 == count) ? found.ends : found.passes)[(int)rank] += count > 1 ? 1 : 2;
    }
    return found;
}

static void test_any_ends(void **state) {
    (void)state;
    uint64_t seed = 7;
    size_t round_ends = 0, flat_ends = 0;
    for (int round = 0; round < 1000; round++) {
        fixture it;
        begin_ends(&it);
        make_network(&it, &seed);
        const size_t polylines = it.features->polyline_count;
        assert_int_equal(camber_features_add_ends(it.features, 0), CAMBER_OK);
        for (int x = 0; x < GRID; x++)
            for (int y = 0; y < GRID; y++) {
                const node_lines at = lines_at(it.features, polylines, x, y);
                const size_t high = at.ends[1] + at.passes[1], low = at.ends[0] + at.passes[0];
                const bool upper = at.ends[1] && !at.passes[1] && (high > 1 || low == 0);
                const bool lower = at.ends[0] && (high ? !at.passes[1] : !at.passes[0]);
                assert_int_equal(dots_at(it.features, 1, x, y), upper);
                assert_int_equal(dots_at(it.features, 0, x, y), lower);
                round_ends += (size_t)upper + lower;
                flat_ends += at.ends[1] && !upper;
            }
        end(&it);
    }
    print_message("%zu nodes with round ends, %zu with flat ones\n", round_ends, flat_ends);
    assert_true(round_ends > 1000 && flat_ends > 1000);
}

static void test_memory(void **state) {
    (void)state;
    fixture it;
    begin(&it);
    for (int i = 0; i < 5; i++)
        add(&it, 0, 2, (double[]){i, 0, i + 1, 0});
    size_t refused = 0;
    camber_status status = CAMBER_ERROR_MEMORY;
    for (size_t n = 1; status == CAMBER_ERROR_MEMORY; n++) {
        const size_t live = it.h.live_blocks;
        it.h.refuse_first = it.h.calls + n;
        it.h.refuse_count = 1;
        status = camber_features_merge(it.features, 0, false);
        assert_int_equal(it.h.live_blocks, live);
        if (status == CAMBER_OK)
            break;
        refused++;
        assert_int_equal(it.features->polyline_count, 5);
        expect_line(&it, 4, 2, (double[]){4, 0, 5, 0});
    }
    assert_int_equal(status, CAMBER_OK);
    assert_true(refused > 8);
    it.h.refuse_first = 0;
    assert_int_equal(it.features->polyline_count, 1);
    end(&it);
}

/* ---- Real cities against GEOS ---- */

#ifdef CAMBER_GEOS
typedef struct sums {
    size_t lines;
    double length;
} sums;

static double length_of(const double *points, size_t count) {
    double sum = 0;
    for (size_t i = 0; i + 1 < count; i++)
        sum += hypot(points[2 * i + 2] - points[2 * i], points[2 * i + 3] - points[2 * i + 1]);
    return sum;
}

/* Lines that have a length. */
static sums sum_class(const camber_features *set, uint32_t class_index) {
    sums made = {0};
    for (size_t i = 0; i < set->polyline_count; i++) {
        const double length = length_of(set->points + 2 * set->offsets[i], set->offsets[i + 1] - set->offsets[i]);
        made.lines += length > 0 && class_of(set, i) == class_index;
        made.length += class_of(set, i) == class_index ? length : 0;
    }
    return made;
}

static sums merge_with_geos(GEOSContextHandle_t geos, const camber_features *set, uint32_t class_index) {
    GEOSGeometry **lines = calloc(set->polyline_count + 1, sizeof *lines);
    unsigned count = 0;
    assert_non_null(lines);
    for (size_t i = 0; i < set->polyline_count; i++) {
        const unsigned points = (unsigned)(set->offsets[i + 1] - set->offsets[i]);
        if (points < 2 || class_of(set, i) != class_index)
            continue;
        GEOSCoordSequence *sequence = GEOSCoordSeq_create_r(geos, points, 2);
        for (unsigned k = 0; k < points; k++) {
            const double *p = set->points + 2 * (set->offsets[i] + k);
            GEOSCoordSeq_setXY_r(geos, sequence, k, p[0], p[1]);
        }
        lines[count++] = GEOSGeom_createLineString_r(geos, sequence);
    }
    GEOSGeometry *all = GEOSGeom_createCollection_r(geos, GEOS_MULTILINESTRING, lines, count);
    GEOSGeometry *made = GEOSLineMerge_r(geos, all);
    sums found = {.lines = (size_t)GEOSGetNumGeometries_r(geos, made)};
    assert_int_equal(GEOSLength_r(geos, made, &found.length), 1);
    GEOSGeom_destroy_r(geos, made);
    GEOSGeom_destroy_r(geos, all);
    free(lines);
    return found;
}

static void check_city(const char *path) {
    fixture it;
    begin(&it);
    camber_features *apart = NULL;
    assert_int_equal(camber_features_create(it.context, &it.style, &apart), CAMBER_OK);
    assert_int_equal(camber_features_read(apart, &(camber_source_desc){.path = path, .keep_apart = true}), CAMBER_OK);
    camber_features_destroy(it.features);
    assert_int_equal(camber_features_create(it.context, &it.style, &it.features), CAMBER_OK);
    assert_int_equal(camber_features_read(it.features, &(camber_source_desc){.path = path}), CAMBER_OK);
    assert_int_equal(it.features->class_count, apart->class_count);
    assert_int_equal(total_features(it.features), apart->feature_count);
    GEOSContextHandle_t geos = GEOS_init_r();
    for (uint32_t c = 0; c < apart->class_count; c++) {
        const sums own = sum_class(it.features, c), theirs = merge_with_geos(geos, apart, c);
        assert_int_equal(own.lines, theirs.lines);
        assert_true(fabs(own.length - theirs.length) <= 1e-9 * theirs.length);
    }
    GEOS_finish_r(geos);
    print_message("%s: %zu lines, %zu merged\n", strrchr(path, '/') + 1, apart->polyline_count,
                  it.features->polyline_count);
    camber_features_destroy(apart);
    end(&it);
}
#endif

static void test_cities_against_geos(void **state) {
    (void)state;
#ifdef CAMBER_GEOS
    static const char *const files[] = {"porto_portugal.osm.pbf", "nyc.osm.pbf", "columbus.osm.pbf",
                                        "Helsinki-1327152.osm.pbf", "beijing-2013.geojson"};
    const char *data = getenv("CAMBER_DATA");
    if (!data) {
        print_message("CAMBER_DATA is not set: real cities are not merged\n");
        skip();
    }
    for (size_t i = 0; data && i < sizeof files / sizeof *files; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/data/%s", data, files[i]);
        check_city(path);
    }
#else
    print_message("built without GEOS (libgeos-dev): its lines are not compared\n");
    skip();
#endif
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_lines), cmocka_unit_test(test_junctions_and_rings),
        cmocka_unit_test(test_straight_on), cmocka_unit_test(test_star),
        cmocka_unit_test(test_counts),      cmocka_unit_test(test_any_network),
        cmocka_unit_test(test_known_ends),  cmocka_unit_test(test_any_ends),
        cmocka_unit_test(test_memory),      cmocka_unit_test(test_cities_against_geos),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
