/* Pixels against the oracle: every join and cap over turns, widths and lengths; dots, rings, directions, cuts, ink. */
#include "core.h"

#include "sheet.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double widths_px[] = {0.3, 0.5, 1, 1.5, 2, 3, 5, 8, 16, 32, 64};
static const double lengths_px[] = {0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 100};
enum { WIDTHS = sizeof widths_px / sizeof *widths_px, LENGTHS = sizeof lengths_px / sizeof *lengths_px };
static const char *const join_names[] = {"round", "miter", "bevel"}, *const cap_names[] = {"butt", "round", "square"};

/* ---- Figures ---- */

/* xorshift64*: S. Vigna, "An experimental exploration of Marsaglia's xorshift generators, scrambled". */
typedef struct dice {
    uint64_t state;
} dice;

static double between(dice *d, double least, double most) {
    d->state ^= d->state >> 12;
    d->state ^= d->state << 25;
    d->state ^= d->state >> 27;
    return least + (most - least) * (double)((d->state * 2685821657736338717ull) >> 11) * 0x1p-53;
}

/* A turtle that leaves points. */
typedef struct path {
    float points[2 * 1024];
    size_t count;
    double x, y, direction;
} path;

static void leave_point(path *p) {
    if (p->count == 1024)
        abort();
    p->points[2 * p->count] = (float)p->x;
    p->points[2 * p->count++ + 1] = (float)p->y;
}

/* At a place and in a direction by chance. */
static void begin(path *p, dice *d) {
    p->count = 0;
    p->x = between(d, 0, 1), p->y = between(d, 0, 1);
    p->direction = between(d, -M_PI, M_PI);
    leave_point(p);
}

static void go(path *p, double length, double turn) {
    p->direction += turn;
    p->x += length * cos(p->direction);
    p->y += length * sin(p->direction);
    leave_point(p);
}

static void reverse(const path *p, path *reversed) {
    *reversed = *p;
    for (size_t i = 0; i < p->count; i++)
        memcpy(reversed->points + 2 * i, p->points + 2 * (p->count - 1 - i), 2 * sizeof(float));
}

static camber_oracle_style style_of(double width_px, int join, int cap) {
    return (camber_oracle_style){width_px, (camber_join)join, (camber_cap)cap, 2.2, false};
}

/* The bounds of a group of figures, in 255ths. */
typedef struct limits {
    double mean;
    int max;
} limits;

/* A sheet, and how all that was drawn on it did. */
typedef struct trial {
    sheet *sheet;
    dice dice;
    bool good;
} trial;

static bool begin_trial(trial *t, camber_method method) {
    *t = (trial){NULL, {88172645463325252ull}, true};
    return sheet_open(method, &t->sheet);
}

static void end_trial(trial *t) {
    sheet_close(t->sheet);
    assert_true(t->good);
}

static void check(trial *t, const tally *errors, limits most) {
    t->good = tally_check(errors, most.mean, most.max) && t->good;
}

static void add(trial *t, tally *errors, const path *p, const camber_oracle_style *style, const char *label) {
    sheet_add(t->sheet, &(figure){p->points, p->count, *style, errors, label, NULL, 0, NULL});
}

/* Draws p and another path that is the same stroke. */
static void add_twins(trial *t, tally tallies[2], const path *p, const path *q, const camber_oracle_style *style,
                      const char *label) {
    sheet_add(t->sheet, &(figure){p->points, p->count, *style, tallies, label, q->points, q->count, tallies + 1});
}

/* ---- Turns ---- */

enum { TO_90, TO_150, TO_180, TURN_GROUPS };

/* Turns of 0 to 180 degrees, to the left and to the right. Past 150 the arms lie over each other, each anti-aliased,
 * and a + b - ab is not their union. */
static void add_turns(trial *t, int steps, int join, int cap, tally tallies[TURN_GROUPS]) {
    for (int w = 0; w < WIDTHS; w++) {
        const double h = widths_px[w] / 2;
        const camber_oracle_style style = style_of(widths_px[w], join, cap);
        for (int i = 0; i <= steps; i++) {
            const double degrees = 180.0 * i / steps, arm = 1.5 * h + 5;
            path p;
            char label[64];
            begin(&p, &t->dice);
            go(&p, arm, 0);
            go(&p, arm + 1, (i % 2 ? 1 : -1) * degrees * M_PI / 180);
            snprintf(label, sizeof label, "width %g turn %g", widths_px[w], degrees);
            add(t, tallies + (degrees <= 90 ? TO_90 : degrees <= 150 ? TO_150 : TO_180), &p, &style, label);
        }
    }
}

static void check_turns(camber_method method, int steps, const limits bounds[TURN_GROUPS]) {
    trial t;
    if (draws_in_cl() && method != CAMBER_METHOD_STRIP)
        skip(); /* drawn as strips are */
    assert_true(begin_trial(&t, method));
    for (int i = 0; i < 9; i++) {
        static const char *const ranges[TURN_GROUPS] = {"0 to 90", "90 to 150", "150 to 180"};
        char names[TURN_GROUPS][64];
        tally tallies[TURN_GROUPS] = {0};
        for (int k = 0; k < TURN_GROUPS; k++) {
            tallies[k].name = names[k];
            snprintf(names[k], sizeof names[k], "%s, %s %s, turns of %s", camber_method_get_name(method),
                     join_names[i / 3], cap_names[i % 3], ranges[k]);
        }
        add_turns(&t, steps, i / 3, i % 3, tallies);
        sheet_flush(t.sheet);
        for (int k = 0; k < TURN_GROUPS; k++)
            check(&t, tallies + k, bounds[k]);
    }
    end_trial(&t);
}

static void test_turns_of_strips(void **state) {
    (void)state;
    check_turns(CAMBER_METHOD_STRIP, 180, (limits[]){{0.21, 64}, {0.26, 88}, {0.54, 92}});
}

static void test_turns_of_kites(void **state) {
    (void)state;
    check_turns(CAMBER_METHOD_KITE, 60, (limits[]){{0.22, 60}, {0.26, 75}, {0.66, 96}});
}

static void test_turns_of_fans(void **state) {
    (void)state;
    check_turns(CAMBER_METHOD_FAN, 60, (limits[]){{0.23, 70}, {0.26, 75}, {0.66, 96}});
}

/* ---- Lengths ---- */

/* A segment alone, the last of two, the middle one of three. */
enum { ALONE, LAST, INNER, PLACES };
/* Shorter than a pixel, than half the width, or neither. */
enum { TINY, SHORT, LONG, SPANS };

static void add_length(trial *t, const camber_oracle_style *style, double length, tally tallies[PLACES][SPANS]) {
    const double arm = style->width_px + 3;
    const double in = between(&t->dice, -1.5, 1.5), out = between(&t->dice, -1.5, 1.5);
    const int span = length < 1 ? TINY : length < style->width_px / 2 ? SHORT : LONG;
    for (int place = 0; place < PLACES; place++) {
        path p;
        char label[64];
        snprintf(label, sizeof label, "width %g length %g turns %.0f %.0f", style->width_px, length, in * 180 / M_PI,
                 out * 180 / M_PI);
        begin(&p, &t->dice);
        if (place != ALONE)
            go(&p, arm, 0);
        go(&p, length, in);
        if (place == INNER)
            go(&p, arm, out);
        add(t, &tallies[place][span], &p, style, label);
    }
}

static void check_lengths(camber_method method, int copies, const limits bounds[PLACES][SPANS]) {
    static const char *const places[PLACES] = {"alone", "last", "inner"};
    static const char *const spans[SPANS] = {"under 1 px", "under half the width", "longer"};
    trial t;
    if (draws_in_cl() && method != CAMBER_METHOD_STRIP)
        skip();
    assert_true(begin_trial(&t, method));
    for (int i = 0; i < 9; i++) {
        char names[PLACES][SPANS][64];
        tally tallies[PLACES][SPANS] = {0};
        for (int k = 0; k < PLACES * SPANS; k++) {
            tallies[k / SPANS][k % SPANS].name = names[k / SPANS][k % SPANS];
            snprintf(names[k / SPANS][k % SPANS], sizeof names[0][0], "%s, %s %s, %s segment %s",
                     camber_method_get_name(method), join_names[i / 3], cap_names[i % 3], places[k / SPANS],
                     spans[k % SPANS]);
        }
        for (int k = 0; k < LENGTHS * WIDTHS; k++) {
            const camber_oracle_style style = style_of(widths_px[k % WIDTHS], i / 3, i % 3);
            for (int n = style.width_px > 20 ? copies / 4 : copies; n > 0; n--)
                add_length(&t, &style, lengths_px[k / WIDTHS], tallies);
        }
        sheet_flush(t.sheet);
        for (int k = 0; k < PLACES * SPANS; k++)
            check(&t, &tallies[k / SPANS][k % SPANS], bounds[k / SPANS][k % SPANS]);
    }
    end_trial(&t);
}

static void test_lengths_of_strips(void **state) {
    (void)state;
    check_lengths(CAMBER_METHOD_STRIP, 12,
                  (const limits[PLACES][SPANS]){{{1.4, 55}, {0.47, 22}, {0.6, 54}},
                                                {{0.46, 72}, {0.24, 64}, {0.5, 54}},
                                                {{0.36, 95}, {0.19, 126}, {0.47, 56}}});
}

static void test_lengths_of_kites(void **state) {
    (void)state;
    check_lengths(CAMBER_METHOD_KITE, 4,
                  (const limits[PLACES][SPANS]){{{1.4, 50}, {0.54, 22}, {0.6, 55}},
                                                {{0.48, 118}, {0.25, 102}, {0.53, 62}},
                                                {{0.37, 95}, {0.2, 110}, {0.5, 66}}});
}

static void test_lengths_of_fans(void **state) {
    (void)state;
    check_lengths(CAMBER_METHOD_FAN, 4,
                  (const limits[PLACES][SPANS]){{{1.4, 50}, {0.54, 22}, {0.6, 55}},
                                                {{1.25, 140}, {0.52, 140}, {0.56, 70}},
                                                {{0.4, 135}, {0.2, 115}, {0.56, 70}}});
}

/* ---- Ends that turn within the width ---- */

/* A last segment that turns by more than a right angle, lines that end in three pieces under a pixel, a curl tighter
 * than half the width, and two segments that left holes at 12 px. Of three pieces the first does not know of the cap.
 */
enum { SHARP_END, PIECES_END, CURL, HOOK, ENDS };

static void add_end(trial *t, int kind, double width_px, path *p) {
    static const float hook[] = {101, 55.98F, 98, 56, 95.918F, 54.102F};
    const double arm = width_px + 3, side = between(&t->dice, -1, 1) < 0 ? -1 : 1;
    begin(p, &t->dice);
    if (kind == HOOK) {
        for (int i = 0; i < 3; i++) {
            p->points[2 * i] = hook[2 * i] - 96 + (float)p->x;
            p->points[2 * i + 1] = hook[2 * i + 1] - 54 + (float)p->y;
        }
        p->count = 3;
        return;
    }
    go(p, arm, 0);
    if (kind == SHARP_END) {
        const double turn = side * between(&t->dice, 1.6, 2.8); /* compilers call arguments in orders of their own */
        go(p, width_px * between(&t->dice, 0.02, 0.5), turn);
    }
    for (int i = 0; kind == PIECES_END && i < 3; i++) {
        const double turn = between(&t->dice, -0.6, 0.6);
        go(p, between(&t->dice, 0.02, 0.9), turn);
    }
    for (int i = 0; kind == CURL && i < 8; i++)
        go(p, width_px * 0.12, side * 0.6);
}

static void check_ends(camber_method method, const limits bounds[ENDS][2]) {
    static const char *const kinds[ENDS] = {"sharp last segments", "three pieces at the end", "curls", "a hook"};
    trial t;
    if (draws_in_cl() && method != CAMBER_METHOD_STRIP)
        skip();
    assert_true(begin_trial(&t, method));
    for (int kind = 0; kind < ENDS; kind++) {
        char names[2][64];
        tally tallies[2] = {{.name = names[0]}, {.name = names[1]}};
        for (int i = 0; i < 2; i++)
            snprintf(names[i], sizeof names[i], "%s, %s, %s", camber_method_get_name(method), kinds[kind],
                     i ? "other caps" : "butt caps");
        for (int i = 0; i < 540; i++) {
            const double width_px = kind == HOOK ? 12 : widths_px[5 + i % (WIDTHS - 5)];
            const camber_oracle_style style = style_of(width_px, i / 6 % 3, i / 18 % 3);
            path p;
            char label[64];
            snprintf(label, sizeof label, "width %g %s %s", width_px, join_names[i / 6 % 3], cap_names[i / 18 % 3]);
            add_end(&t, kind, width_px, &p);
            add(&t, tallies + (style.cap != CAMBER_CAP_BUTT), &p, &style, label);
        }
        sheet_flush(t.sheet);
        check(&t, tallies, bounds[kind][0]);
        check(&t, tallies + 1, bounds[kind][1]);
    }
    end_trial(&t);
}

static void test_ends_of_strips(void **state) {
    (void)state;
    check_ends(CAMBER_METHOD_STRIP, (const limits[ENDS][2]){{{0.17, 66}, {0.18, 70}},
                                                            {{0.29, 190}, {0.2, 90}},
                                                            {{0.12, 28}, {0.13, 32}},
                                                            {{1.7, 57}, {0.75, 52}}});
}

static void test_ends_of_kites(void **state) {
    (void)state;
    check_ends(CAMBER_METHOD_KITE, (const limits[ENDS][2]){{{0.17, 98}, {0.18, 70}},
                                                           {{0.3, 190}, {0.2, 90}},
                                                           {{0.12, 28}, {0.13, 32}},
                                                           {{1.7, 57}, {0.75, 52}}});
}

/* ---- Round joins that are not round ---- */

/* Below the limit they are miters, and past the miter limit (1.15: 59 degrees) bevels. */
static void test_round_limit(void **state) {
    (void)state;
    for (int method = CAMBER_METHOD_STRIP; method <= CAMBER_METHOD_FAN; method++) {
        trial t;
        tally errors = {.name = "round joins with a limit"}, round = {.name = "round joins past it"};
        assert_true(begin_trial(&t, (camber_method)method));
        for (int i = 0; i < 600; i++) {
            camber_oracle_style style = style_of(i % 2 ? 20 : 48, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT);
            style.round_limit = i % 3 ? 1.41421 : 1.05; /* 90 and 35.5 degrees */
            style.miter_limit = i % 3 == 1 ? 1.15 : 2;
            const double turn = 0.2 + 1.8 * (i % 100) / 100;
            path p;
            char label[64];
            snprintf(label, sizeof label, "width %g turn %.0f limit %g", style.width_px, turn * 180 / M_PI,
                     style.round_limit);
            begin(&p, &t.dice);
            go(&p, 90, 0);
            go(&p, 90, i % 7 < 3 ? turn : -turn);
            add(&t, style.round_limit * cos(turn / 2) > 1 ? &errors : &round, &p, &style, label);
        }
        sheet_flush(t.sheet);
        const int max = method == CAMBER_METHOD_FAN ? 70 : 50;
        check(&t, &errors, (limits){0.1, max});
        check(&t, &round, (limits){0.11, max});
        end_trial(&t);
    }
}

/* ---- Dots and rings ---- */

static void test_dots(void **state) {
    (void)state;
    trial t;
    tally tallies[] = {{.name = "dots, round"}, {.name = "dots, square"}};
    assert_true(begin_trial(&t, CAMBER_METHOD_STRIP));
    for (int w = 0; w < WIDTHS; w++)
        for (int i = 0; i < 60; i++) {
            const int cap = i % 2 ? CAMBER_CAP_SQUARE : CAMBER_CAP_ROUND;
            const camber_oracle_style style = style_of(widths_px[w], CAMBER_JOIN_ROUND, cap);
            path p;
            char label[64];
            snprintf(label, sizeof label, "width %g", widths_px[w]);
            begin(&p, &t.dice);
            if (i % 3 == 0)
                leave_point(&p);
            add(&t, tallies + i % 2, &p, &style, label);
        }
    sheet_flush(t.sheet);
    check(&t, tallies, (limits){0.5, 52});
    check(&t, tallies + 1, (limits){0.04, 4});
    end_trial(&t);
}

/* Bounds: of rings with few sides, and of those with many. */
static void check_rings(camber_method method, limits few, limits many) {
    static const int sides[] = {3, 4, 24};
    trial t;
    if (draws_in_cl() && method != CAMBER_METHOD_STRIP)
        skip();
    assert_true(begin_trial(&t, method));
    for (int k = 0; k < 9; k++) {
        const int n = sides[k % 3];
        char name[64];
        tally errors = {.name = name};
        snprintf(name, sizeof name, "%s, rings of %d sides, %s", camber_method_get_name(method), n, join_names[k / 3]);
        for (int i = 0; i < WIDTHS * 8; i++) {
            camber_oracle_style style = style_of(widths_px[i % WIDTHS], k / 3, CAMBER_CAP_BUTT);
            const double side = (3 + style.width_px) * between(&t.dice, 0.3, 4) * (n > 4 ? 0.3 : 1);
            path p;
            char label[64];
            begin(&p, &t.dice);
            for (int c = 1; c < n; c++)
                go(&p, side, (i % 2 ? 2 : -2) * M_PI / n);
            memcpy(p.points + 2 * p.count++, p.points, 2 * sizeof *p.points);
            style.closed = true;
            snprintf(label, sizeof label, "width %g side %.2f", style.width_px, side);
            add(&t, &errors, &p, &style, label);
        }
        sheet_flush(t.sheet);
        check(&t, &errors, n < 24 ? few : many);
    }
    end_trial(&t);
}

static void test_rings_of_strips(void **state) {
    (void)state;
    check_rings(CAMBER_METHOD_STRIP, (limits){0.14, 80}, (limits){0.1, 125});
}

static void test_rings_of_kites(void **state) {
    (void)state;
    check_rings(CAMBER_METHOD_KITE, (limits){0.14, 80}, (limits){0.1, 125});
}

static void test_rings_of_fans(void **state) {
    (void)state;
    check_rings(CAMBER_METHOD_FAN, (limits){0.14, 80}, (limits){0.2, 125});
}

/* ---- The same stroke by other points ---- */

static void test_direction_does_not_matter(void **state) {
    (void)state;
    trial t;
    tally tallies[] = {{.name = "forwards"}, {.name = "backwards"}};
    assert_true(begin_trial(&t, CAMBER_METHOD_STRIP));
    for (int i = 0; i < 1500; i++) {
        const camber_oracle_style style = style_of(widths_px[i % (WIDTHS - 2)], i / 11 % 3, i / 33 % 3);
        path p, q;
        begin(&p, &t.dice);
        for (int k = 0; k < 4; k++) {
            const double turn = between(&t.dice, -1.5, 1.5);
            go(&p, between(&t.dice, 0.3, 20), turn);
        }
        reverse(&p, &q);
        add_twins(&t, tallies, &p, &q, &style, "");
    }
    sheet_flush(t.sheet);
    check(&t, tallies, (limits){0.7, 75});
    /* A few pixels whose centre lies on a bisector go to the other segment. */
    check(&t, tallies + 1, (limits){0.002, 10});
    end_trial(&t);
}

/* Pieces shorter than a pixel are stated apart: only the last two of them know of the cap, and below 0.03 px the
 * rounding of coordinates turns them by a degree. */
static void test_cuts_do_not_show(void **state) {
    (void)state;
    enum { UNCUT, CUT };
    trial t;
    tally all[2][2] = {{{.name = "straight lines"}, {.name = "cut to pieces under 1 px"}},
                       {{.name = "straight lines"}, {.name = "cut to pieces from 1 px"}}};
    assert_true(begin_trial(&t, CAMBER_METHOD_STRIP));
    for (int i = 0; i < 900; i++) {
        const camber_oracle_style style = style_of(widths_px[i % WIDTHS], i / 11 % 3, i / 33 % 3);
        const double piece = lengths_px[i / 100], length = piece < 0.3 ? 100 * piece : 30;
        const int pieces = (int)(length / piece) + 1;
        path p, q;
        char label[64];
        begin(&p, &t.dice);
        q = p;
        go(&p, piece * pieces, 0);
        for (int k = 1; k <= pieces; k++) {
            q.x = p.points[0] + ((double)p.points[2] - p.points[0]) * k / pieces;
            q.y = p.points[1] + ((double)p.points[3] - p.points[1]) * k / pieces;
            leave_point(&q);
        }
        snprintf(label, sizeof label, "width %g pieces of %g px", style.width_px, piece);
        add_twins(&t, all[piece >= 1], &p, &q, &style, label);
    }
    sheet_flush(t.sheet);
    check(&t, &all[0][UNCUT], (limits){0.3, 54});
    check(&t, &all[0][CUT], (limits){0.5, 155});
    check(&t, &all[1][UNCUT], (limits){0.3, 54});
    check(&t, &all[1][CUT], (limits){0.005, 2});
    end_trial(&t);
}

/* ---- Ink ---- */

/* Lines thinner than a pixel get paler, not thinner or thicker. */
static void test_thin_lines_keep_their_ink(void **state) {
    (void)state;
    static const struct {
        double width_px, turn, bound; /* relative */
    } cases[] = {{0.3, 0, 0.008}, {0.3, 0.5, 0.01}, {0.1, 0, 0.008}, {0.1, 0.5, 0.01}, {0.03, 0, 0.02}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        trial t;
        tally errors = {.name = "thin lines"};
        assert_true(begin_trial(&t, CAMBER_METHOD_STRIP));
        for (int i = 0; i < 200; i++) {
            const camber_oracle_style style = style_of(cases[c].width_px, i % 3, i / 3 % 3);
            path p;
            begin(&p, &t.dice);
            for (int k = 0; k < 10; k++)
                go(&p, 6, between(&t.dice, -cases[c].turn, cases[c].turn));
            add(&t, &errors, &p, &style, "");
        }
        sheet_flush(t.sheet);
        const double error = errors.ink / errors.true_ink - 1;
        printf("# ink of %g px, turns to %.0f degrees: %+.3f %% (bound %.1f)\n", cases[c].width_px,
               cases[c].turn * 180 / M_PI, 100 * error, 100 * cases[c].bound);
        t.good = fabs(error) <= cases[c].bound;
        end_trial(&t);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_turns_of_strips),  cmocka_unit_test(test_turns_of_kites),
        cmocka_unit_test(test_turns_of_fans),    cmocka_unit_test(test_lengths_of_strips),
        cmocka_unit_test(test_lengths_of_kites), cmocka_unit_test(test_lengths_of_fans),
        cmocka_unit_test(test_ends_of_strips),   cmocka_unit_test(test_ends_of_kites),
        cmocka_unit_test(test_round_limit),      cmocka_unit_test(test_dots),
        cmocka_unit_test(test_rings_of_strips),  cmocka_unit_test(test_rings_of_kites),
        cmocka_unit_test(test_rings_of_fans),    cmocka_unit_test(test_direction_does_not_matter),
        cmocka_unit_test(test_cuts_do_not_show), cmocka_unit_test(test_thin_lines_keep_their_ink),
    };
    sheet *probe;
    const bool can_draw = sheet_open(CAMBER_METHOD_STRIP, &probe);
    sheet_close(probe);
    if (!can_draw)
        return 77;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
