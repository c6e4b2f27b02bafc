/* A poster of real streets, as poppler reads and draws it: A2 at 300 dpi against camber's own picture of the sheet, and
 * every label that is shown found in its text. */
#include "test_fixture.h"

#include "map/scene.h"
#include "png_file.h"

#include "camber_map.h"
#include "camber_print.h"

#include <ctype.h>
#include <sys/wait.h>

enum { DPI = 300, BLOCK_PX = 64, FAR = 96 };

static const camber_page_desc SHEET = {
    .width_mm = 420, .height_mm = 594, .dpi = DPI, .title = "New York", .scale_bar = true, .north_arrow = true};

typedef struct poster {
    fixture *b;
    camber_style *style;
    camber_features *features;
    camber_page *page;
    camber_scene *scene;
    uint8_t *rgba;
    uint32_t width;
    char pdf[64], made[64];
} poster;

static bool write_bytes(void *file, const void *bytes, size_t size_bytes) {
    return fwrite(bytes, 1, size_bytes, file) == size_bytes;
}

static bool keep_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    const poster *p = user;
    memcpy(p->rgba + 4 * (size_t)p->width * first_row, rgba, 4 * (size_t)p->width * row_count);
    return true;
}

static void write_pdf(poster *p) {
    const int file = mkstemp(p->pdf);
    FILE *to = file >= 0 ? fdopen(file, "wb") : NULL;
    assert_non_null(to);
    const camber_sink sink = {.write = write_bytes, .user = to};
    assert_int_equal(camber_page_write(p->page, p->scene, NULL, NULL, CAMBER_PAGE_PDF, sink), CAMBER_OK);
    assert_int_equal(fclose(to), 0);
}

static void draw_sheet(poster *p) {
    const camber_page_info info = camber_page_get_info(p->page);
    camber_mesh *mesh = NULL;
    assert_int_equal(camber_mesh_create(p->b->on.device, fixture_any(p->b), &mesh), CAMBER_OK);
    p->width = info.width;
    p->rgba = malloc(4 * (size_t)info.width * info.height);
    assert_non_null(p->rgba);
    assert_int_equal(camber_scene_tessellate(p->scene, mesh, CAMBER_METHOD_STRIP), CAMBER_OK);
    assert_int_equal(camber_page_render(p->page, p->scene, fixture_any(p->b), mesh, keep_rows, p, NULL), CAMBER_OK);
    camber_mesh_destroy(mesh);
}

static void open_poster(poster *p, fixture *b, bool has_labels) {
    char path[4096];
    camber_scene_desc desc = {.view = {.kind = CAMBER_VIEW_FIT, .cover = true}, .simplify_px = 0.1};
    *p = (poster){.b = b, .pdf = "/tmp/camber-print-XXXXXX", .made = "/tmp/camber-text-XXXXXX"};
    snprintf(path, sizeof path, "%s/data/nyc.osm.pbf", getenv("CAMBER_DATA"));
    assert_int_equal(camber_style_create_builtin(b->context, CAMBER_THEME_LIGHT, &p->style), CAMBER_OK);
    assert_int_equal(camber_features_create(b->context, p->style, &p->features), CAMBER_OK);
    if (has_labels) {
        assert_int_equal(camber_features_read_fonts(p->features, NULL, NULL), CAMBER_OK);
        assert_int_equal(camber_features_read_sprites(p->features, DPI / 96.0, NULL), CAMBER_OK);
    }
    assert_int_equal(camber_features_read(p->features, &(camber_source_desc){.path = path}), CAMBER_OK);
    assert_int_equal(camber_page_create(b->context, &SHEET, &p->page), CAMBER_OK);
    camber_page_set_view(p->page, &desc.view);
    assert_int_equal(camber_scene_create(p->features, &desc, &p->scene), CAMBER_OK);
    const int file = mkstemp(p->made);
    assert_true(file >= 0);
    close(file);
    write_pdf(p);
}

static void close_poster(poster *p) {
    remove(p->pdf);
    remove(p->made);
    free(p->rgba);
    camber_scene_destroy(p->scene);
    camber_page_destroy(p->page);
    camber_features_destroy(p->features);
    camber_style_destroy(p->style);
}

/* Runs one of poppler's programs on the PDF, and reads what it made. */
static char *read_by(const poster *p, const char *command, const char *to, size_t *size) {
    char line[256];
    snprintf(line, sizeof line, "%s %s %s >%s", command, p->pdf, to, p->made);
    const int status = system(line);
    if (status == -1 || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
        fail_msg("%s failed", line);
    FILE *file = fopen(p->made, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    *size = (size_t)ftell(file);
    rewind(file);
    char *text = malloc(*size + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, *size, file), *size);
    text[*size] = '\0';
    fclose(file);
    return text;
}

/* ---- Pixels ---- */

typedef struct difference {
    double mean, worst_block;
    size_t far; /* values that differ by more than FAR */
} difference;

static unsigned levels_between(const uint8_t *ours, const uint8_t *theirs) {
    unsigned sum = 0;
    for (int c = 0; c < 3; c++)
        sum += (unsigned)abs(ours[c] - theirs[c]);
    return sum;
}

static difference compare(const poster *p, const uint8_t *rgba, uint32_t height) {
    difference d = {0};
    double sum = 0.0;
    for (uint32_t top = 0; top < height; top += BLOCK_PX)
        for (uint32_t left = 0; left < p->width; left += BLOCK_PX) {
            double of_block = 0.0;
            for (uint32_t y = top; y < top + BLOCK_PX && y < height; y++)
                for (uint32_t x = left; x < left + BLOCK_PX && x < p->width; x++) {
                    const size_t at = (size_t)p->width * y + x;
                    const unsigned levels = levels_between(p->rgba + 4 * at, rgba + 4 * at);
                    of_block += levels;
                    d.far += levels > 3 * FAR;
                }
            sum += of_block;
            d.worst_block = fmax(d.worst_block, of_block / (3.0 * BLOCK_PX * BLOCK_PX));
        }
    d.mean = sum / (3.0 * p->width * height);
    return d;
}

/* poppler's picture of the sheet and camber's have the same size, and differ little everywhere: a stray line, or a
 * hairline between neighbours, would show in a block. */
static void check_pixels(poster *p, difference most) {
    size_t size;
    draw_sheet(p);
    char *png = read_by(p, "pdftocairo -png -r 300 -singlefile", "-", &size);
    const png_pixels read = png_pixels_decode(png, size);
    assert_non_null(read.rgba);
    assert_int_equal(read.width, p->width);
    assert_int_equal(read.height, camber_page_get_info(p->page).height);
    const difference d = compare(p, read.rgba, read.height);
    printf("mean %.3f levels, worst block %.1f, far %zu\n", d.mean, d.worst_block, d.far);
    free(png);
    free(read.rgba);
    assert_true(d.mean < most.mean);
    assert_true(d.worst_block < most.worst_block);
    assert_true(d.far <= most.far);
}

static void test_pixels(void **state) {
    poster p;
    open_poster(&p, *state, true);
    check_pixels(&p, (difference){.mean = 0.8, .worst_block = 12, .far = 6000});
    close_poster(&p);
    open_poster(&p, *state, false);
    check_pixels(&p, (difference){.mean = 0.4, .worst_block = 10, .far = 1000}); /* the title and the frame */
    close_poster(&p);
}

/* ---- Text ---- */

/* Removes blanks: a label has several lines, and poppler puts blanks between distant letters. */
static size_t squeeze(char *text, size_t size) {
    size_t kept = 0;
    for (size_t i = 0; i < size; i++)
        if (!isspace((unsigned char)text[i]))
            text[kept++] = text[i];
    text[kept] = '\0';
    return kept;
}

static size_t count_in(const char *text, const char *word) {
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, word)); at++)
        count++;
    return count;
}

/* Whether the map's edge does not cut the label. */
static bool is_whole(const poster *p, const camber_box *box) {
    const camber_page_info info = camber_page_get_info(p->page);
    return box->x0 >= 0.0 && box->y0 >= 0.0 && box->x1 <= info.map_width && box->y1 <= info.map_height;
}

/* The text of a label without its blanks. False: it has none. */
static bool get_words(const camber_labels *labels, size_t i, char *words, size_t capacity) {
    const camber_label *label = labels->labels + i;
    if (label->byte_count >= capacity)
        return false;
    memcpy(words, labels->words + label->first_byte, label->byte_count);
    return squeeze(words, label->byte_count) > 0;
}

static void test_every_label_is_found(void **state) {
    poster p;
    size_t size, checked = 0, missing = 0;
    char words[512], others[512];
    open_poster(&p, *state, true);
    const camber_labels *labels = camber_scene_get_parts(p.scene).labels;
    char *text = read_by(&p, "pdftotext -raw", "-", &size);
    squeeze(text, size);
    for (size_t i = 0; i < labels->label_count; i++) {
        size_t same = 0;
        assert_true(is_whole(&p, &labels->labels[i].box));
        if (!get_words(labels, i, words, sizeof words))
            continue;
        for (size_t k = 0; k < labels->label_count; k++)
            same += get_words(labels, k, others, sizeof others) && strcmp(words, others) == 0;
        checked++;
        if (count_in(text, words) < same) {
            missing++;
            printf("%s is shown %zu times, and found %zu times\n", words, same, count_in(text, words));
        }
    }
    printf("%zu labels, of %zu, are looked for\n", checked, labels->label_count);
    free(text);
    close_poster(&p);
    assert_true(checked > 200);
    assert_int_equal(missing, 0);
}

int main(void) {
    if (!getenv("CAMBER_DATA") || !*getenv("CAMBER_DATA")) {
        puts("CAMBER_DATA is not set: no cities");
        return 77;
    }
    if (!camber_page_is_built() || system("command -v pdftocairo pdftotext >/dev/null") != 0) {
        puts("no Cairo, or no poppler (Debian: poppler-utils)");
        return 77;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_pixels), cmocka_unit_test(test_every_label_is_found)};
    return FIXTURE_RUN(tests);
}
