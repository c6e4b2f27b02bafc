/* Texts: glyphs are compared with those of hb-shape, levels with Unicode's test file; lines, anchors, outlines, signed
 * distances, and text, fonts and glyphs that are hostile. */
#include "core.h"

#include "base/embedded.h"
#include "text/contours.h"
#include "text/distances.h"
#include "text/fonts.h"

#include <math.h>
#include <pthread.h>
#include <sys/stat.h>
#include <time.h>

static const char *const noto_sans[] = {"Noto Sans"};

typedef struct maker {
    host h;
    camber_context *context;
    camber_fonts *fonts;
} maker;

static void make_fonts(maker *m, const camber_fonts_desc *desc) {
    m->context = host_context(&m->h);
    assert_int_equal(camber_fonts_create(m->context, desc, &m->fonts), CAMBER_OK);
}

/* Only with the fonts that are shipped. */
static void make_shipped(maker *m) {
    make_fonts(m, &(camber_fonts_desc){.no_system = true});
}

static void unmake(maker *m) {
    camber_fonts_destroy(m->fonts);
    host_done(&m->h, m->context);
}

static camber_text_run run_of(const char *text, const char *const *fonts) {
    return (camber_text_run){.text = text, .size_bytes = strlen(text), .fonts = fonts, .font_count = 1};
}

static camber_text *shape(maker *m, const char *text, const char *const *fonts, camber_text_desc desc) {
    const camber_text_run run = run_of(text, fonts);
    camber_text *made = NULL;
    desc.runs = &run;
    desc.run_count = 1;
    assert_int_equal(camber_text_shape(m->fonts, &desc, &made), CAMBER_OK);
    return made;
}

static void assert_near(double a, double b) {
    if (fabs(a - b) > 1e-4)
        fail_msg("%.6f is not %.6f", a, b);
}

/* ---- Shaping ---- */

/* Compares a text of one direction and one font with hb-shape. */
static void check_beside(maker *m, const char *font, const char *text, const char *language) {
    const char *const fonts[] = {font};
    camber_text *made = shape(m, text, fonts, (camber_text_desc){.language = language});
    const uint32_t source = m->fonts->glyphs[made->glyphs[0].glyph].source;
    const camber_face *face = m->fonts->sources[source].face;
    char command[1024];
    snprintf(command, sizeof command,
             "hb-shape --no-glyph-names --no-clusters --remove-default-ignorables %s%s \"%s\" \"%s\"",
             language ? "--language=" : "", language ? language : "", m->fonts->sources[source].name, text);
    FILE *output = popen(command, "r");
    double x = made->left;
    assert_non_null(output);
    assert_int_equal(fgetc(output), '[');
    for (size_t i = 0; i < made->glyph_count; i++) {
        unsigned number = 0;
        int dx = 0, dy = 0, advance = 0;
        char after = 0;
        if (i)
            assert_int_equal(fgetc(output), '|');
        assert_int_equal(fscanf(output, "%u%c", &number, &after), 2);
        if (after == '@')
            assert_int_equal(fscanf(output, "%d,%d%c", &dx, &dy, &after), 3);
        assert_int_equal(fscanf(output, "%d", &advance), 1);
        const camber_text_glyph *glyph = &made->glyphs[i];
        if (m->fonts->glyphs[glyph->glyph].source != source || m->fonts->glyphs[glyph->glyph].number != number)
            fail_msg("%s: glyph %zu is %u, not %u", text, i, m->fonts->glyphs[glyph->glyph].number, number);
        assert_near(glyph->advance, (double)advance / (double)face->units_per_em);
        assert_near(glyph->x, x + (double)dx / (double)face->units_per_em);
        x += (double)advance / (double)face->units_per_em;
    }
    assert_int_equal(fgetc(output), ']');
    assert_int_equal(pclose(output), 0);
    camber_text_destroy(made);
}

static void test_beside_hb_shape(void **state) {
    (void)state;
    static const char *const texts[][3] = {
        {"Noto Sans", "V\xc3\xa4nern, AVAST office", NULL},
        {"Noto Sans Bold", "\xd0\x9c\xd0\xbe\xd1\x81\xd0\xba\xd0\xb2\xd0\xb0", NULL},
        {"Noto Sans", "\xce\x91\xce\xb8\xce\xae\xce\xbd\xce\xb1", NULL},
        {"Noto Sans", "Hanoi e\xcc\x82\xcc\x81 o\xcc\x88\xcc\xa3", NULL},
        {"Noto Sans", "\xd0\xb1\xd0\xb3\xd0\xb4", "sr"},
        {"Noto Sans Arabic", "\xd8\xa7\xd9\x84\xd9\x82\xd8\xa7\xd9\x87\xd8\xb1\xd8\xa9", "ar"},
        {"Noto Sans Hebrew", "\xd7\xaa\xd6\xbc\xd6\xb5\xd7\x9c \xd7\x90\xd6\xb8\xd7\x91\xd6\xb4\xd7\x99\xd7\x91", NULL},
        {"Noto Sans Devanagari", "\xe0\xa4\x95\xe0\xa5\x8d\xe0\xa4\xb7\xe0\xa5\x87\xe0\xa4\xa4\xe0\xa5\x8d\xe0\xa4\xb0",
         NULL},
        {"Noto Sans Thai", "\xe0\xb8\x81\xe0\xb8\xa3\xe0\xb8\xb8\xe0\xb8\x87\xe0\xb8\x99\xe0\xb9\x89\xe0\xb8\xb3",
         NULL},
        {"Noto Sans Khmer", "\xe1\x9e\x97\xe1\x9f\x92\xe1\x9e\x93\xe1\x9f\x86\xe1\x9e\x96\xe1\x9f\x81\xe1\x9e\x89",
         NULL},
        {"Noto Sans Myanmar", "\xe1\x80\x99\xe1\x80\xbc\xe1\x80\xad\xe1\x80\xaf\xe1\x80\xb7", NULL},
    };
    maker m;
    if (system("hb-shape --version > /dev/null 2>&1") != 0) {
        print_message("there is no hb-shape (Debian: libharfbuzz-bin): texts are not compared with it\n");
        skip();
    }
    make_fonts(&m, NULL);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        if (camber_fonts_find_stack(m.fonts, &texts[i][0], 1, NULL, &(uint32_t){0}) == CAMBER_OK && m.h.warnings) {
            print_message("there is no %s: its texts are not compared\n", texts[i][0]);
            m.h.warnings = 0;
            continue;
        }
        if (m.fonts->index.entries[camber_font_index_find(&m.fonts->index, texts[i][0])].bytes)
            continue; /* hb-shape cannot read the shipped one */
        check_beside(&m, texts[i][0], texts[i][1], texts[i][2]);
    }
    unmake(&m);
}

/* ---- Both directions ---- */

/* Reads numbers between white space, up to a semicolon or a line's end. x stands for 255. */
static size_t read_numbers(const char **at, int base, uint32_t *numbers, size_t most) {
    size_t count = 0;
    while (**at && **at != ';' && **at != '\n') {
        char *end;
        assert_true(count < most);
        if (**at == 'x') {
            numbers[count++] = 255;
            ++*at;
        } else {
            numbers[count++] = (uint32_t)strtoul(*at, &end, base);
            *at = end;
        }
        while (**at == ' ')
            ++*at;
    }
    *at += **at == ';';
    return count;
}

static void test_bidi_beside_unicode(void **state) {
    (void)state;
    enum { MOST = 256 };
    FILE *file = fopen("/usr/share/unicode/BidiCharacterTest.txt", "r");
    if (!file) {
        print_message("there is no BidiCharacterTest.txt (Debian: unicode-data): levels are not compared with it\n");
        skip();
    }
    host h;
    camber_context *context = host_context(&h);
    char line[4096];
    size_t number = 0, compared = 0;
    while (fgets(line, sizeof line, file)) {
        uint32_t codes[MOST], direction[1], base[1], wanted[MOST], found[MOST];
        uint8_t levels[MOST];
        const char *at = line;
        if (line[0] == '#' || line[0] == '\n' || number++ % 7)
            continue;
        const size_t count = read_numbers(&at, 16, codes, MOST);
        read_numbers(&at, 10, direction, 1);
        read_numbers(&at, 10, base, 1);
        assert_int_equal(read_numbers(&at, 10, wanted, MOST), count);
        assert_int_equal(
            camber_bidi_find_levels(context, codes, count, direction[0] == 2 ? -1 : (int)direction[0], levels),
            CAMBER_OK);
        /* White space at the end is cut from lines, so that its level (rule L1) does not count. */
        size_t end = count;
        while (end && (wanted[end - 1] == base[0] || wanted[end - 1] == 255))
            end--;
        size_t kept = 0;
        for (size_t i = 0; i < end; i++) {
            if (wanted[i] == 255)
                continue;
            if (levels[i] != wanted[i])
                fail_msg("line %zu: level %zu is %u, not %u: %s", number, i, levels[i], wanted[i], line);
            levels[kept++] = levels[i];
        }
        camber_bidi_find_order(levels, kept, found);
        compared++;
    }
    fclose(file);
    assert_true(compared > 10000);
    host_done(&h, context);
}

static void test_order(void **state) {
    (void)state;
    static const uint8_t levels[] = {0, 1, 2, 2, 1, 0};
    static const uint32_t wanted[] = {0, 4, 2, 3, 1, 5};
    uint32_t order[6];
    camber_bidi_find_order(levels, 6, order);
    assert_memory_equal(order, wanted, sizeof wanted);
}

/* A name of both directions: the Latin part stands to the right of what follows it in Hebrew text. */
static void test_both_directions(void **state) {
    (void)state;
    maker m;
    make_shipped(&m);
    camber_text *text = shape(&m, "\xd7\x90\xd7\x91 ab \xd7\x92", noto_sans, (camber_text_desc){0});
    static const uint32_t bytes[] = {8, 7, 5, 6, 4, 2, 0};
    assert_int_equal(text->glyph_count, 7);
    for (size_t i = 0; i < 7; i++)
        assert_int_equal(text->glyphs[i].byte, bytes[i]);
    assert_int_equal(m.h.warnings, 1); /* no font has Hebrew letters */
    camber_text_destroy(text);
    unmake(&m);
}

/* ---- Lines and anchors ---- */

static void check_lines(maker *m, const char *text, float max_width_em, const char *wanted) {
    char found[256] = "";
    const camber_text_desc desc = {.max_width_em = max_width_em};
    camber_text *made = shape(m, text, noto_sans, desc);
    for (size_t i = 0; i < made->line_count; i++) {
        const camber_text_line *line = &made->lines[i];
        snprintf(found + strlen(found), sizeof found - strlen(found), "%s", i ? "|" : "");
        for (size_t g = line->first; g < line->first + line->count; g++)
            snprintf(found + strlen(found), sizeof found - strlen(found), "%c", text[made->glyphs[g].byte]);
    }
    assert_string_equal(found, wanted);
    camber_text_destroy(made);
}

static void test_breaks(void **state) {
    (void)state;
    maker m;
    make_shipped(&m);
    check_lines(&m, "", 10.0f, "");
    check_lines(&m, "Reykjavik", 1.0f, "Reykjavik");
    check_lines(&m, "Avenue of the Americas", 8.0f, "Avenue of the|Americas");
    check_lines(&m, "Avenue of the Americas", 0.0f, "Avenue of the Americas");
    check_lines(&m, "Avenue\nof the Americas", 0.0f, "Avenue|of the Americas");
    check_lines(&m, "a\n\nb", 0.0f, "a||b");
    check_lines(&m, "a\n\xcc\x81", 0.0f, "a|\xcc");
    check_lines(&m, "a\x1c.\xc2\x85.", 0.0f, "a|.|.");
    check_lines(&m, "  a  \n  b ", 10.0f, "a|b");
    check_lines(&m, "Frankfurt-Hoechst/Sued", 5.0f, "Frankfurt-|Hoechst/|Sued");
    check_lines(&m, "Praha (Prag) (Prague)", 6.0f, "Praha (Prag)|(Prague)");
    assert_int_equal(m.h.warnings, 0);
    unmake(&m);
}

/* MapLibre's search for line breaks, without what makes it fast; it fills ends, and returns their number. */
typedef struct plain_break {
    double x, badness;
    size_t end, prior;
} plain_break;

static double plain_badness(double width, double average, double penalty, bool is_last) {
    const double raggedness = (width - average) * (width - average);
    if (is_last)
        return width < average ? raggedness / 2.0 : raggedness * 2.0;
    return raggedness + fabs(penalty) * penalty;
}

/* made.badness is the penalty of its place. */
static plain_break plain_evaluate(const plain_break *breaks, size_t count, plain_break made, double average,
                                  bool is_last) {
    const double penalty = made.badness;
    made.badness = plain_badness(made.x, average, penalty, is_last);
    made.prior = SIZE_MAX;
    for (size_t i = 0; i < count; i++) {
        const double badness = plain_badness(made.x - breaks[i].x, average, penalty, is_last) + breaks[i].badness;
        if (badness <= made.badness) {
            made.badness = badness;
            made.prior = i;
        }
    }
    return made;
}

static size_t plain_lines(const camber_shaping *shaping, double max_width_em, size_t *ends) {
    plain_break breaks[256];
    size_t count = 0, line_count = 0;
    double width = 0.0, x = 0.0;
    for (size_t i = 0; i < shaping->count; i++)
        width += (double)shaping->characters[i].width_em * 24.0;
    const double lines = ceil(width / (max_width_em * 24.0)), average = width / (lines > 1.0 ? lines : 1.0);
    for (size_t i = 0; i + 1 < shaping->count; i++) {
        const uint32_t code = shaping->codes[i], next = shaping->codes[i + 1];
        double penalty = code == '\n' ? -10000.0 : 0.0;
        if (code != ' ' && code != '\n')
            x += (double)shaping->characters[i].width_em * 24.0;
        penalty += code == '(' ? 50.0 : 0.0;
        penalty += next == ')' ? 50.0 : 0.0;
        if (strchr("\n &)+-/", (int)code) || (next == '(' && i + 2 < shaping->count)) {
            breaks[count] =
                plain_evaluate(breaks, count, (plain_break){.x = x, .end = i + 1, .badness = penalty}, average, false);
            count++;
        }
    }
    x += (double)shaping->characters[shaping->count - 1].width_em * 24.0;
    const plain_break last = plain_evaluate(breaks, count, (plain_break){.x = x, .end = shaping->count}, average, true);
    for (size_t at = last.prior; at != SIZE_MAX; at = breaks[at].prior)
        line_count++;
    ends[line_count] = last.end;
    size_t line = line_count;
    for (size_t at = last.prior; at != SIZE_MAX; at = breaks[at].prior)
        ends[--line] = breaks[at].end;
    return line_count + 1;
}

/* Random texts break as the plain search breaks them. */
static void test_breaks_plainly(void **state) {
    (void)state;
    static const char letters[] = "abciMW  -()/\nE";
    maker m;
    uint64_t random = 1;
    make_shipped(&m);
    for (int n = 0; n < 2000; n++) {
        char text[64];
        size_t ends[256];
        const size_t size = 1 + (size_t)(n % 60);
        for (size_t i = 0; i < size; i++) {
            random = random * 6364136223846793005ull + 1442695040888963407ull;
            text[i] = letters[(random >> 33) % (sizeof letters - 1)];
        }
        text[0] = text[size - 1] = 'x'; /* which is not cut off */
        text[size] = 0;
        const float max_width_em = 1.0f + (float)(n % 7);
        camber_text *made = shape(&m, text, noto_sans, (camber_text_desc){.max_width_em = max_width_em});
        const size_t count = plain_lines(&m.fonts->shaping, (double)max_width_em, ends);
        if (made->line_count != count)
            fail_msg("'%s' at %g em has %zu lines, not %zu", text, (double)max_width_em, made->line_count, count);
        for (size_t i = 0; i < count; i++)
            if (made->lines[i].count && made->glyphs[made->lines[i].first].byte >= ends[i])
                fail_msg("'%s' at %g em: line %zu does not end at %zu", text, (double)max_width_em, i, ends[i]);
        camber_text_destroy(made);
    }
    unmake(&m);
}

static void test_anchors(void **state) {
    (void)state;
    maker m;
    make_shipped(&m);
    camber_text *text = shape(&m, "long line\nb", noto_sans, (camber_text_desc){.justify = CAMBER_JUSTIFY_LEFT});
    const float width = text->right - text->left;
    assert_int_equal(text->line_count, 2);
    assert_near(text->bottom - text->top, 2.4);
    assert_near(text->left, -width / 2.0f);
    assert_near(text->lines[0].width, width);
    assert_near(text->glyphs[0].x, text->left);
    assert_near(text->glyphs[text->lines[1].first].x, text->left);
    /* Noto Sans has an ascender of 1.069 em. */
    assert_near(text->glyphs[0].y, -0.6 - 17.0 / 24.0 + 1.069);
    const float x = text->glyphs[0].x, y = text->glyphs[0].y;
    camber_text_place(text, CAMBER_ANCHOR_TOP_RIGHT, CAMBER_JUSTIFY_AUTO);
    assert_near(text->right, 0.0);
    assert_near(text->top, 0.0);
    assert_near(text->glyphs[0].x, -width);
    assert_near(text->glyphs[0].y, y + 1.2);
    assert_near(text->glyphs[text->lines[1].first].x, -text->lines[1].width);
    camber_text_place(text, CAMBER_ANCHOR_CENTER, CAMBER_JUSTIFY_LEFT);
    assert_near(text->glyphs[0].x, x);
    assert_near(text->glyphs[0].y, y);
    camber_text_destroy(text);
    unmake(&m);
}

static void test_spacing_and_scale(void **state) {
    (void)state;
    maker m;
    make_shipped(&m);
    camber_text *plain = shape(&m, "office", noto_sans, (camber_text_desc){0});
    camber_text *wide = shape(&m, "office", noto_sans, (camber_text_desc){.letter_spacing_em = 0.1f});
    assert_int_equal(wide->glyph_count, 6);
    assert_true(wide->right - wide->left > plain->right - plain->left + 0.45f);
    camber_text *back = shape(&m, "office", noto_sans, (camber_text_desc){.letter_spacing_em = -4.0f});
    assert_true(back->lines[0].width < -16.0f);
    assert_near(back->glyphs[0].x, -back->lines[0].width / 2.0f);
    assert_near(back->right, back->left);
    camber_text_destroy(plain);
    camber_text_destroy(wide);
    camber_text_destroy(back);
    camber_text_run runs[3] = {
        run_of("H", noto_sans), {.image_width_em = 0.5f, .image_height_em = 0.4f}, run_of("H", noto_sans)};
    camber_text *mixed = NULL;
    runs[2].scale = 0.5f;
    assert_int_equal(camber_text_shape(m.fonts, &(camber_text_desc){.runs = runs, .run_count = 3}, &mixed), CAMBER_OK);
    assert_int_equal(mixed->glyph_count, 3);
    assert_int_equal(mixed->glyphs[1].glyph, CAMBER_NO_GLYPH);
    assert_int_equal(mixed->glyphs[2].run, 2);
    assert_near(mixed->glyphs[0].y, mixed->glyphs[2].y);
    assert_near(mixed->glyphs[1].y, 7.0 / 24.0 - 0.4); /* it stands on the bottom of the ems */
    assert_near(mixed->glyphs[2].x, mixed->glyphs[1].x + 0.5);
    assert_near(mixed->glyphs[2].scale, 0.5);
    camber_text_destroy(mixed);
    unmake(&m);
}

/* ---- Outlines ---- */

static double area_of(const camber_outline *outline) {
    double area = 0.0;
    for (size_t r = 0; r < outline->ring_count; r++)
        for (uint32_t i = outline->offsets[r], end = outline->offsets[r + 1], j = end - 1; i < end; j = i++) {
            const float *a = outline->points + 2 * (size_t)j, *b = outline->points + 2 * (size_t)i;
            area += ((double)a[0] * (double)b[1] - (double)b[0] * (double)a[1]) / 2.0;
        }
    return area;
}

static double perimeter_of(const camber_outline *outline) {
    double length = 0.0;
    for (size_t r = 0; r < outline->ring_count; r++)
        for (uint32_t i = outline->offsets[r], end = outline->offsets[r + 1], j = end - 1; i < end; j = i++) {
            const float *a = outline->points + 2 * (size_t)j, *b = outline->points + 2 * (size_t)i;
            length += hypot((double)a[0] - (double)b[0], (double)a[1] - (double)b[1]);
        }
    return length;
}

static void check_outlines(maker *m, const char *const *fonts, double o_area) {
    camber_text *text = shape(m, "oi H", fonts, (camber_text_desc){0});
    static const size_t rings[] = {2, 2, 0, 1};
    camber_outline outline, fine, again;
    for (size_t i = 0; i < 4; i++) {
        assert_int_equal(camber_fonts_get_outline(m->fonts, text->glyphs[i].glyph, 0.0f, &outline), CAMBER_OK);
        assert_int_equal(outline.ring_count, rings[i]);
        assert_true(i == 2 || area_of(&outline) > 0.01);
        assert_int_equal(camber_fonts_get_outline(m->fonts, text->glyphs[i].glyph, 0.0f, &again), CAMBER_OK);
        assert_ptr_equal(again.points, outline.points);
        assert_int_equal(camber_fonts_get_outline(m->fonts, text->glyphs[i].glyph, 1e-5f, &fine), CAMBER_OK);
        assert_true(fabs(area_of(&fine) - area_of(&outline)) < 0.01);
        if (i == 0)
            assert_true(fabs(area_of(&fine) - o_area) < 0.02);
        if (i == 3)
            assert_true(fabsf(outline.bottom) < 0.01f && outline.top < -0.6f && outline.top > -0.8f);
    }
    camber_text_destroy(text);
}

/* Below 20 px strokes are 0.2 px * (1 - size / 20) wider, in whatever order sizes are asked for. */
static void test_small_outlines(void **state) {
    (void)state;
    static const struct {
        float size_px, wider_px;
    } sizes[] = {{10.0f, 0.1f}, {20.0f, 0.0f}, {12.0f, 0.08f}, {48.0f, 0.0f}, {16.0f, 0.04f}, {10.0f, 0.1f}};
    maker m;
    make_shipped(&m);
    camber_text *text = shape(&m, "lo", noto_sans, (camber_text_desc){0});
    const uint32_t l = text->glyphs[0].glyph, o = text->glyphs[1].glyph;
    camber_outline plain, sized, ring;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const float size = sizes[i].size_px;
        assert_int_equal(camber_fonts_get_outline(m.fonts, l, 0.0f, &plain), CAMBER_OK);
        assert_int_equal(camber_fonts_get_sized_outline(m.fonts, l, size, &sized), CAMBER_OK);
        const float wider = (sized.right - sized.left) - (plain.right - plain.left);
        const float higher = (sized.bottom - sized.top) - (plain.bottom - plain.top);
        assert_true(fabsf(wider * size - sizes[i].wider_px) < 0.01f && fabsf(higher - wider) < 1e-5f);
        assert_true(fabsf(sized.left + sized.right - plain.left - plain.right) < 1e-5f);
        /* The hole becomes smaller as the outside becomes larger. */
        assert_int_equal(camber_fonts_get_outline(m.fonts, o, 1.0f / 32.0f / size, &plain), CAMBER_OK);
        assert_int_equal(camber_fonts_get_sized_outline(m.fonts, o, size, &ring), CAMBER_OK);
        assert_int_equal(ring.ring_count, 2);
        assert_true(sizes[i].wider_px > 0.0f || ring.points == plain.points);
        const double widened = (area_of(&ring) - area_of(&plain)) * (double)size;
        assert_true(fabs(widened - 0.5 * perimeter_of(&plain) * (double)sizes[i].wider_px) < 0.02);
    }
    const float tiny[] = {1e-30f, 1e-3f, 1.0f, 1e30f};
    for (size_t i = 0; i < 4; i++) {
        assert_int_equal(camber_fonts_get_sized_outline(m.fonts, o, tiny[i], &sized), CAMBER_OK);
        assert_true(sized.left > -0.1f && sized.right < 0.7f);
    }
    camber_text_destroy(text);
    unmake(&m);
}

static void test_outlines(void **state) {
    (void)state;
    maker m;
    make_shipped(&m);
    check_outlines(&m, noto_sans, 0.122);
    unmake(&m);
}

/* ---- Glyphs as signed distances ---- */

typedef struct glyph_folder {
    const char *folder;
    uint8_t bytes[1 << 20];
} glyph_folder;

static camber_status read_range(void *user, const char *stack, uint32_t first, const uint8_t **bytes,
                                size_t *size_bytes) {
    glyph_folder *from = user;
    char path[4096];
    snprintf(path, sizeof path, "%s/%s/%u-%u.pbf", from->folder, stack, first, first + 255);
    FILE *file = fopen(path, "rb");
    if (!file)
        return CAMBER_ERROR_NOT_FOUND;
    *size_bytes = fread(from->bytes, 1, sizeof from->bytes, file);
    *bytes = from->bytes;
    fclose(file);
    return CAMBER_OK;
}

static bool open_ranges(maker *m, glyph_folder *folder, char path[2048]) {
    const char *data = getenv("CAMBER_DATA");
    snprintf(path, 2048, "%s/symbol-tests/glyphs", data ? data : "");
    if (!data || access(path, R_OK)) {
        print_message("CAMBER_DATA has no symbol-tests: its glyphs are not read\n");
        return false;
    }
    folder->folder = path;
    make_fonts(m, &(camber_fonts_desc){.no_system = true, .glyphs = read_range, .glyphs_user = folder});
    return true;
}

static void test_ranges(void **state) {
    (void)state;
    static const char *const names[] = {"Open Sans Semibold", "Arial Unicode MS Bold"};
    static glyph_folder folder;
    char path[2048];
    maker m;
    if (!open_ranges(&m, &folder, path))
        skip();
    camber_text_run run = run_of("oH", names);
    run.font_count = 2;
    camber_text *text = NULL;
    camber_outline outline;
    assert_int_equal(camber_text_shape(m.fonts, &(camber_text_desc){.runs = &run, .run_count = 1}, &text), CAMBER_OK);
    assert_int_equal(text->glyph_count, 2);
    assert_near(text->glyphs[0].advance, 14.0 / 24.0);
    assert_near(text->glyphs[0].y, 9.0 / 24.0);
    assert_int_equal(camber_fonts_get_outline(m.fonts, text->glyphs[0].glyph, 0.0f, &outline), CAMBER_OK);
    assert_int_equal(outline.ring_count, 2);
    assert_true(area_of(&outline) > 0.1 && area_of(&outline) < 0.25);
    camber_outline small;
    assert_int_equal(camber_fonts_get_sized_outline(m.fonts, text->glyphs[0].glyph, 10.0f, &small), CAMBER_OK);
    assert_ptr_equal(small.points, outline.points); /* distances are drawn as they are */
    assert_int_equal(camber_fonts_get_outline(m.fonts, text->glyphs[1].glyph, 0.0f, &outline), CAMBER_OK);
    assert_true(fabsf(outline.bottom) < 0.01f);
    camber_text_destroy(text);
    assert_int_equal(m.h.warnings, 0);
    /* Vietnamese letters are of a range that is not there; the shipped font draws them on the same baseline. */
    run.text = "o\xe1\xba\xa1";
    run.size_bytes = 4;
    assert_int_equal(camber_text_shape(m.fonts, &(camber_text_desc){.runs = &run, .run_count = 1}, &text), CAMBER_OK);
    assert_int_equal(text->glyph_count, 2);
    assert_near(text->glyphs[1].y, text->glyphs[0].y);
    assert_true(m.fonts->sources[m.fonts->glyphs[text->glyphs[1].glyph].source].face != NULL);
    camber_text_destroy(text);
    unmake(&m);
}

/* A stroke of 0.6 px that no pixel's centre is in has its outline all the same. */
static void test_thin_strokes(void **state) {
    (void)state;
    enum { WIDTH = 24, HEIGHT = 12 };
    uint8_t values[WIDTH * HEIGHT];
    host h;
    camber_context *context = host_context(&h);
    for (int turn = 0; turn < 2; turn++)
        for (int place = 0; place < 8; place++) {
            const float middle = 5.0f + (float)place / 8.0f;
            const size_t wide = turn ? HEIGHT : WIDTH, high = turn ? WIDTH : HEIGHT;
            for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
                const float along = (float)(turn ? i / wide : i % wide), across = (float)(turn ? i % wide : i / wide);
                const float out_along = fabsf(along - 11.5f) - 7.5f, out_across = fabsf(across - middle) - 0.3f;
                const float out = out_along > 0.0f && out_across > 0.0f ? hypotf(out_along, out_across)
                                                                        : fmaxf(out_along, out_across);
                values[i] = (uint8_t)fmaxf(255.0f - floorf(64.0f + 32.0f * out), 0.0f);
            }
            float *refined = camber_distances_refine(context, values, wide, high);
            camber_outline_maker made = {.context = context};
            camber_outline outline;
            void *block = NULL;
            assert_non_null(refined);
            camber_contours_trace(&(camber_contour_source){.values = refined,
                                                           .width = CAMBER_DISTANCE_STEPS * ((uint32_t)wide - 1) + 1,
                                                           .height = CAMBER_DISTANCE_STEPS * ((uint32_t)high - 1) + 1,
                                                           .scale = 1.0f / CAMBER_DISTANCE_STEPS},
                                  &made);
            assert_int_equal(camber_outline_finish(&made, &outline, &block), CAMBER_OK);
            assert_int_equal(outline.ring_count, 1);
            assert_true(fabs(area_of(&outline) - 15.0 * 0.6) < 1.0);
            camber_free(context, block);
            camber_free(context, refined);
        }
    host_done(&h, context);
}

/* Arabic letters are drawn in the forms in which they join, and with ligatures, if there are glyphs for these. */
static void test_arabic_ranges(void **state) {
    (void)state;
    static const char *const names[] = {"Open Sans Semibold", "Arial Unicode MS Bold"};
    /* From left to right: lam and alef as one, a space, then beh with alef before it. */
    static const uint32_t wanted[] = {0xfefb, ' ', 0xfe8f, 0xfe8d};
    static glyph_folder folder;
    char path[2048];
    maker m;
    if (!open_ranges(&m, &folder, path))
        skip();
    camber_text_run run = run_of("\xd8\xa7\xd8\xa8 \xd9\x84\xd8\xa7", names);
    run.font_count = 2;
    camber_text *text = NULL;
    const camber_text_desc desc = {.runs = &run, .run_count = 1, .letter_spacing_em = 0.5f};
    assert_int_equal(camber_text_shape(m.fonts, &desc, &text), CAMBER_OK);
    assert_int_equal(text->glyph_count, 4);
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(m.fonts->glyphs[text->glyphs[i].glyph].number, wanted[i]);
    assert_true(text->right - text->left < 2.5f); /* without the spacing */
    assert_int_equal(m.h.warnings, 0);
    camber_text_destroy(text);
    unmake(&m);
}

/* Ideographs stand upright below each other, Latin letters are turned, and lines follow each other to the left. */
static void test_vertical(void **state) {
    (void)state;
    static const char *const names[] = {"NotoCJK"};
    static glyph_folder folder;
    char path[2048];
    maker m;
    if (!open_ranges(&m, &folder, path))
        skip();
    /* U+4E2D, U+5C0F, then H and U+3042 in a second line */
    camber_text *text =
        shape(&m, "\xe4\xb8\xad\xe5\xb0\x8f\nH\xe3\x81\x82", names,
              (camber_text_desc){.vertical = true, .anchor = CAMBER_ANCHOR_TOP_RIGHT, .justify = CAMBER_JUSTIFY_AUTO});
    assert_true(text->vertical);
    assert_int_equal(text->line_count, 2);
    assert_int_equal(text->glyph_count, 4);
    assert_near(text->right, 0.0);
    assert_near(text->left, -2.4);
    assert_near(text->bottom, 2.0);
    for (int i = 0; i < 2; i++) {
        camber_outline outline;
        const camber_text_glyph *glyph = &text->glyphs[i];
        assert_false(glyph->turned);
        assert_near(glyph->advance, 1.0);
        assert_int_equal(camber_fonts_get_outline(m.fonts, glyph->glyph, 0.0f, &outline), CAMBER_OK);
        /* It is in the middle of its square. */
        assert_true(fabsf(glyph->x + (outline.left + outline.right) / 2.0f + 0.6f) < 0.1f);
        assert_true(fabsf(glyph->y + (outline.top + outline.bottom) / 2.0f - 0.5f - (float)i) < 0.15f);
    }
    assert_true(text->glyphs[2].turned);
    assert_near(text->glyphs[2].y, 0.0);
    assert_true(fabsf(text->glyphs[2].x + 1.8f + 9.0f / 24.0f) < 0.1f);
    assert_false(text->glyphs[3].turned);
    camber_text_destroy(text);
    unmake(&m);
}

/* A full stop takes its vertical form between ideographs, and is turned between letters. */
static void test_vertical_punctuation(void **state) {
    (void)state;
    static const char *const names[] = {"NotoCJK"};
    static glyph_folder folder;
    char path[2048];
    maker m;
    if (!open_ranges(&m, &folder, path))
        skip();
    camber_text *text = shape(&m, "\xe4\xb8\xad.\xe5\xb0\x8f", names, (camber_text_desc){.vertical = true});
    assert_int_equal(text->glyph_count, 3);
    assert_false(text->glyphs[1].turned);
    assert_near(text->glyphs[1].advance, 1.0);
    assert_int_equal(m.fonts->glyphs[text->glyphs[1].glyph].number, 0x30fb);
    camber_text_destroy(text);
    text = shape(&m, "\xe4\xb8\xad.H", names, (camber_text_desc){.vertical = true});
    assert_true(text->glyphs[1].turned);
    assert_int_equal(m.fonts->glyphs[text->glyphs[1].glyph].number, '.');
    camber_text_destroy(text);
    unmake(&m);
}

/* ---- Fonts ---- */

static void test_names(void **state) {
    (void)state;
    camber_font_name name = camber_font_name_split("Open Sans Semibold Italic");
    assert_true(name.family_key == camber_font_name_key("OpenSans", NULL));
    assert_true(name.style.weight == 600.0f && name.style.is_italic && name.style.width == 100.0f);
    name = camber_font_name_split("Noto Sans Semi-Bold");
    assert_true(name.style.weight == 600.0f && !name.style.is_italic);
    name = camber_font_name_split("Roboto Condensed Light");
    assert_true(name.style.weight == 300.0f && name.style.width == 75.0f);
    assert_true(name.family_key == camber_font_name_key("Roboto", NULL));
    name = camber_font_name_split("Noto Sans Regular");
    assert_true(name.whole_key == camber_font_name_key("Noto Sans", NULL) && name.whole_key == name.family_key);
    name = camber_font_name_split("Bold");
    assert_true(name.family_key == camber_font_name_key("Bold", NULL));
    assert_string_equal(camber_font_name_package("Noto Sans CJK JP Bold"), "fonts-noto-cjk");
    assert_string_equal(camber_font_name_package("Open Sans Bold"), "fonts-open-sans");
    assert_null(camber_font_name_package("Metropolis Light"));
}

static void test_missing_font(void **state) {
    (void)state;
    static const char *const names[] = {"Metropolis Light"};
    maker m;
    make_shipped(&m);
    for (int i = 0; i < 2; i++) {
        camber_text *text = shape(&m, "Oslo", names, (camber_text_desc){0});
        assert_int_equal(text->glyph_count, 4);
        camber_text_destroy(text);
        assert_int_equal(m.h.warnings, 1);
    }
    unmake(&m);
    m.context = host_context(&m.h);
    const char *const folders[] = {"/nonexistent/fonts"};
    const camber_fonts_desc desc = {.folders = folders, .folder_count = 1};
    assert_int_equal(camber_fonts_create(m.context, &desc, &m.fonts), CAMBER_ERROR_NOT_FOUND);
    assert_story(&m.h, "/nonexistent/fonts");
    host_done(&m.h, m.context);
}

/* Fonts of a folder are found by the names in them, whatever the files are called. */
static void test_folder(void **state) {
    (void)state;
    static const char *const names[] = {"Noto Sans Semibold"}, *const plain[] = {"Noto Sans Regular"};
    char folder[64], inner[80], path[96];
    folder_make(folder);
    snprintf(inner, sizeof inner, "%s/inner", folder);
    assert_int_equal(mkdir(inner, 0700), 0);
    snprintf(path, sizeof path, "%s/a.ttf", inner);
    file_write(path, camber_font_regular, camber_font_regular_size);
    snprintf(path, sizeof path, "%s/b.otf", folder);
    file_write(path, camber_font_bold, camber_font_bold_size);
    maker m;
    const char *const folders[] = {folder};
    make_fonts(&m, &(camber_fonts_desc){.folders = folders, .folder_count = 1, .no_system = true});
    camber_text *text = shape(&m, "a", names, (camber_text_desc){0});
    assert_string_equal(m.fonts->sources[m.fonts->glyphs[text->glyphs[0].glyph].source].name, path);
    camber_text_destroy(text);
    text = shape(&m, "a", plain, (camber_text_desc){0});
    assert_non_null(strstr(m.fonts->sources[m.fonts->glyphs[text->glyphs[0].glyph].source].name, "inner/a.ttf"));
    camber_text_destroy(text);
    assert_int_equal(m.h.warnings, 0);
    unmake(&m);
    folder_remove(folder);
}

/* A pictograph that no font has is left out, and told once. */
static void test_pictograph(void **state) {
    (void)state;
    maker m;
    make_shipped(&m);
    for (int i = 0; i < 2; i++) {
        camber_text *text =
            shape(&m, "a\xf0\x9f\x9a\x80\xef\xb8\x8f z\xf0\x9f\x9a\x81", noto_sans, (camber_text_desc){0});
        assert_int_equal(text->glyph_count, 3);
        assert_int_equal(m.h.warnings, 1);
        camber_text_destroy(text);
    }
    unmake(&m);
}

/* A script that no font has is told once, with the package that has it. */
static void test_missing_scripts(void **state) {
    (void)state;
    static const char *const scripts[][3] = {
        {"\xd8\xa7\xd9\x84", "Arabic", "fonts-noto-core"},
        {"\xd7\xaa", "Hebrew", "fonts-noto-core"},
        {"\xe0\xa4\xa6", "Devanagari", "fonts-noto-core"},
        {"\xe0\xb8\x81", "Thai", "fonts-noto-core"},
        {"\xe1\x9e\x97", "Khmer", "fonts-noto-core"},
        {"\xe1\x80\x9b", "Myanmar", "fonts-noto-core"},
        {"\xe5\x8c\x97\xe3\x82\xbf\xe3\x83\xbc\xe3\x81\x8c\xec\x84\x9c", "Chinese, Japanese and Korean",
         "fonts-noto-cjk"},
        {"\xf0\x9f\x98\x80", "pictograph", "fonts-symbola"},
        {"\xf0\x90\x8e\xa0", "Xpeo", "fonts-noto-core"}, /* Old Persian */
    };
    maker m;
    make_shipped(&m);
    for (size_t i = 0; i < sizeof scripts / sizeof *scripts; i++)
        for (int round = 0; round < 2; round++) {
            camber_text *text = shape(&m, scripts[i][0], noto_sans, (camber_text_desc){0});
            assert_int_equal(m.h.warnings, i + 1);
            assert_non_null(strstr(m.h.warning, scripts[i][1]));
            assert_non_null(strstr(m.h.warning, scripts[i][2]));
            camber_text_destroy(text);
        }
    unmake(&m);
}

/* Marks that a letter's font does not have take the letter with them. */
static void test_marks(void **state) {
    (void)state;
    maker m;
    make_fonts(&m, NULL);
    static const char *const names[] = {"Noto Sans", "DejaVu Sans"};
    camber_text_run run = run_of("x\xcc\x81 o\xe2\x83\x9d", names); /* U+20DD encloses its letter */
    run.font_count = 2;
    camber_text *text = NULL;
    assert_int_equal(camber_text_shape(m.fonts, &(camber_text_desc){.runs = &run, .run_count = 1}, &text), CAMBER_OK);
    if (m.h.warnings) {
        print_message("there is no Noto Sans or no DejaVu Sans: marks are not looked at\n");
        camber_text_destroy(text);
        unmake(&m);
        skip();
    }
    assert_int_equal(text->glyph_count, 5);
    assert_int_equal(m.fonts->glyphs[text->glyphs[0].glyph].source, m.fonts->glyphs[text->glyphs[1].glyph].source);
    assert_int_equal(m.fonts->glyphs[text->glyphs[3].glyph].source, m.fonts->glyphs[text->glyphs[4].glyph].source);
    camber_text_destroy(text);
    unmake(&m);
}

/* Contexts of several threads use fontconfig at the same time. */
static void *shape_in_thread(void *user) {
    static const char *const names[] = {"Noto Sans Bold", "DejaVu Sans"};
    camber_context *context = NULL;
    camber_fonts *fonts = NULL;
    camber_text *text = NULL;
    const camber_text_run run = {
        .text = "Oslo \xd7\x90 \xe0\xb8\x81 \xe2\x82\xbf", .size_bytes = 15, .fonts = names, .font_count = 2};
    bool *is_done = user;
    if (camber_context_create(NULL, &context) == CAMBER_OK && camber_fonts_create(context, NULL, &fonts) == CAMBER_OK)
        *is_done = camber_text_shape(fonts, &(camber_text_desc){.runs = &run, .run_count = 1}, &text) == CAMBER_OK &&
                   text->glyph_count == 10;
    camber_text_destroy(text);
    camber_fonts_destroy(fonts);
    camber_context_destroy(context);
    return NULL;
}

static void test_threads(void **state) {
    (void)state;
    pthread_t threads[4];
    bool is_done[4] = {false};
    for (int i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, shape_in_thread, &is_done[i]), 0);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(pthread_join(threads[i], NULL), 0);
        assert_true(is_done[i]);
    }
}

/* ---- Hostile input ---- */

static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

static void check_long(maker *m, const char *part, float max_width_em) {
    const size_t size = (size_t)1 << 20, part_size = strlen(part);
    char *text = malloc(size);
    for (size_t i = 0; i < size; i++)
        text[i] = part[i % part_size];
    const camber_text_run run = {.text = text, .size_bytes = size, .fonts = noto_sans, .font_count = 1};
    const camber_text_desc desc = {.runs = &run, .run_count = 1, .max_width_em = max_width_em};
    camber_text *made = NULL;
    const double start = seconds();
    assert_int_equal(camber_text_shape(m->fonts, &desc, &made), CAMBER_OK);
    print_message("a megabyte of %zu bytes again and again: %.2f s, %zu lines\n", part_size, seconds() - start,
                  made->line_count);
    for (size_t i = 0; i < made->glyph_count; i++)
        assert_true(isfinite(made->glyphs[i].x) && isfinite(made->glyphs[i].y));
    camber_text_destroy(made);
    free(text);
}

static void test_long(void **state) {
    (void)state;
    maker m;
    make_shipped(&m);
    check_long(&m, "\xcc\x81", 10.0f);                  /* marks without a letter */
    check_long(&m, "a\xcc\x81\xcc\xa3\xcc\x8a", 10.0f); /* and with one */
    check_long(&m, "\xe2\x80\xae", 0.0f);               /* overrides of the direction */
    check_long(&m, "a\xe2\x80\xae\xd7\x90 ", 10.0f);
    check_long(&m, "a b-", 1e6f);
    check_long(&m, "a ", 10.0f);
    check_long(&m, "\n", 10.0f);
    const camber_text_run run = {.text = "", .size_bytes = ((size_t)1 << 20) + 1, .fonts = noto_sans, .font_count = 1};
    camber_text *made = NULL;
    assert_int_equal(camber_text_shape(m.fonts, &(camber_text_desc){.runs = &run, .run_count = 1}, &made),
                     CAMBER_ERROR_LIMIT);
    assert_story(&m.h, "bytes");
    unmake(&m);
}

static void test_invalid(void **state) {
    (void)state;
    maker m;
    make_shipped(&m);
    static const struct {
        const char *text;
        size_t size_bytes, glyph_count;
    } texts[] = {
        {"a\0b", 3, 2},          /* NUL */
        {"a\xff\xc0\xaf", 4, 4}, /* what is never UTF-8 */
        {"\xed\xa0\x80", 3, 3},  /* half of a surrogate pair */
        {"\xf4\x90\x80\x80", 4, 4},
        {"\xe2\x82", 2, 2},      /* cut off */
        {"a\x1b[31m\x7f", 7, 5}, /* control characters */
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        const camber_text_run run = {
            .text = texts[i].text, .size_bytes = texts[i].size_bytes, .fonts = noto_sans, .font_count = 1};
        camber_text *made = NULL;
        assert_int_equal(camber_text_shape(m.fonts, &(camber_text_desc){.runs = &run, .run_count = 1}, &made),
                         CAMBER_OK);
        assert_int_equal(made->glyph_count, texts[i].glyph_count);
        camber_text_destroy(made);
    }
    unmake(&m);
}

/* Files of a folder that are no fonts, or cut off. */
static void test_broken_files(void **state) {
    (void)state;
    char folder[64], path[80];
    static const size_t sizes[] = {0, 1, 12, 100, 5000, 60000};
    folder_make(folder);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        snprintf(path, sizeof path, "%s/%zu.ttf", folder, i);
        file_write(path, camber_font_regular, sizes[i]);
    }
    maker m;
    const char *const folders[] = {folder};
    make_fonts(&m, &(camber_fonts_desc){.folders = folders, .folder_count = 1, .no_system = true});
    camber_text *text = shape(&m, "Oslo \xe2\x86\x92 \xd7\x90", noto_sans, (camber_text_desc){0});
    for (size_t i = 0; i < text->glyph_count; i++) {
        camber_outline outline;
        assert_int_equal(camber_fonts_get_outline(m.fonts, text->glyphs[i].glyph, 0.0f, &outline), CAMBER_OK);
    }
    camber_text_destroy(text);
    unmake(&m);
    folder_remove(folder);
}

/* ---- Texts that are remembered ---- */

static camber_text *recall(maker *m, const char *key, uint64_t hash, const char *text) {
    const camber_text_run run = run_of(text, noto_sans);
    const camber_text_desc desc = {.runs = &run, .run_count = 1};
    const camber_text_key all = {key, strlen(key), hash};
    camber_text *made = NULL;
    assert_int_equal(camber_text_recall(m->fonts, &all, &desc, &made), CAMBER_OK);
    return made;
}

/* Whether both texts have the same glyphs in the same places. The texts are destroyed. */
static bool take_equal(camber_text *a, camber_text *b) {
    bool equal = a->glyph_count == b->glyph_count && a->line_count == b->line_count && a->left == b->left &&
                 a->right == b->right && a->top == b->top && a->bottom == b->bottom && a->glyphs != b->glyphs;
    for (size_t i = 0; i < a->glyph_count && equal; i++)
        equal = a->glyphs[i].glyph == b->glyphs[i].glyph && a->glyphs[i].x == b->glyphs[i].x &&
                a->glyphs[i].y == b->glyphs[i].y && a->glyphs[i].byte == b->glyphs[i].byte;
    for (size_t i = 0; i < a->line_count && equal; i++)
        equal = a->lines[i].first == b->lines[i].first && a->lines[i].count == b->lines[i].count &&
                a->lines[i].width == b->lines[i].width;
    camber_text_destroy(a);
    camber_text_destroy(b);
    return equal;
}

static void test_remembered(void **state) {
    (void)state;
    maker m;
    char long_text[101], long_key[4001], lines[101];
    make_shipped(&m);
    memset(long_text, 'w', 100);
    long_text[100] = '\0';
    /* A key decides, not the desc: what is found has not been shaped again. */
    assert_true(take_equal(recall(&m, "a", 1, "Oslo"), shape(&m, "Oslo", noto_sans, (camber_text_desc){0})));
    assert_true(take_equal(recall(&m, "a", 1, "Bergen"), shape(&m, "Oslo", noto_sans, (camber_text_desc){0})));
    /* Keys of one hash share a slot, and each has its own text all the same. */
    assert_true(take_equal(recall(&m, "b", 1, "Bergen"), shape(&m, "Bergen", noto_sans, (camber_text_desc){0})));
    assert_true(take_equal(recall(&m, "ab", 1, "Trondheim"), shape(&m, "Trondheim", noto_sans, (camber_text_desc){0})));
    assert_true(take_equal(recall(&m, "a", 1, "Moss"), shape(&m, "Moss", noto_sans, (camber_text_desc){0})));
    /* Long texts are not remembered. */
    assert_true(take_equal(recall(&m, "c", 2, long_text), shape(&m, long_text, noto_sans, (camber_text_desc){0})));
    assert_true(take_equal(recall(&m, "c", 2, "Voss"), shape(&m, "Voss", noto_sans, (camber_text_desc){0})));
    /* Nor are texts of few glyphs whose keys are long or that have many lines. */
    memset(long_key, 'k', 4000);
    long_key[4000] = '\0';
    memset(lines, '\n', 100);
    lines[100] = '\0';
    assert_true(take_equal(recall(&m, long_key, 3, "Moss"), shape(&m, "Moss", noto_sans, (camber_text_desc){0})));
    assert_true(take_equal(recall(&m, long_key, 3, "Voss"), shape(&m, "Voss", noto_sans, (camber_text_desc){0})));
    assert_true(take_equal(recall(&m, "d", 4, lines), shape(&m, lines, noto_sans, (camber_text_desc){0})));
    assert_true(take_equal(recall(&m, "d", 4, "Voss"), shape(&m, "Voss", noto_sans, (camber_text_desc){0})));
    unmake(&m);
}

static camber_status recall_once(camber_context *context, void *user) {
    const camber_text_run run = run_of("Oslo", noto_sans);
    const camber_text_desc desc = {.runs = &run, .run_count = 1};
    const camber_text_key key = {"a", 1, 1};
    camber_fonts *fonts = NULL;
    camber_text *texts[2] = {NULL, NULL};
    (void)user;
    camber_status status = camber_fonts_create(context, &(camber_fonts_desc){.no_system = true}, &fonts);
    for (size_t i = 0; i < 2 && !status; i++)
        status = camber_text_recall(fonts, &key, &desc, texts + i);
    for (size_t i = 0; i < 2; i++)
        camber_text_destroy(texts[i]);
    camber_fonts_destroy(fonts);
    return status;
}

static camber_status shape_once(camber_context *context, void *user) {
    const camber_text_run run = run_of("Oslo \xd7\x90 (M\xc3\xbchle)", noto_sans);
    camber_fonts *fonts = NULL;
    camber_text *text = NULL;
    camber_outline outline;
    (void)user;
    camber_status status = camber_fonts_create(context, &(camber_fonts_desc){.no_system = true}, &fonts);
    if (!status)
        status =
            camber_text_shape(fonts, &(camber_text_desc){.runs = &run, .run_count = 1, .max_width_em = 4.0f}, &text);
    if (!status)
        status = camber_fonts_get_outline(fonts, text->glyphs[0].glyph, 0.0f, &outline);
    camber_text_destroy(text);
    camber_fonts_destroy(fonts);
    return status;
}

static void test_no_memory(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    each_allocation_fails(&h, shape_once, context, NULL);
    each_allocation_fails(&h, recall_once, context, NULL);
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_beside_hb_shape),
        cmocka_unit_test(test_bidi_beside_unicode),
        cmocka_unit_test(test_order),
        cmocka_unit_test(test_both_directions),
        cmocka_unit_test(test_breaks),
        cmocka_unit_test(test_breaks_plainly),
        cmocka_unit_test(test_anchors),
        cmocka_unit_test(test_spacing_and_scale),
        cmocka_unit_test(test_outlines),
        cmocka_unit_test(test_small_outlines),
        cmocka_unit_test(test_ranges),
        cmocka_unit_test(test_thin_strokes),
        cmocka_unit_test(test_arabic_ranges),
        cmocka_unit_test(test_vertical),
        cmocka_unit_test(test_vertical_punctuation),
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_missing_font),
        cmocka_unit_test(test_folder),
        cmocka_unit_test(test_pictograph),
        cmocka_unit_test(test_missing_scripts),
        cmocka_unit_test(test_marks),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_long),
        cmocka_unit_test(test_invalid),
        cmocka_unit_test(test_broken_files),
        cmocka_unit_test(test_remembered),
        cmocka_unit_test(test_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
