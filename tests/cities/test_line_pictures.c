/* Another engine's pictures of layers: of lines (CAMBER_DATA/line-tests), of fills and backgrounds, and of circles
 * (fill-tests and circle-tests, where the argument names that). camber draws each style, and all but the exceptions
 * below come as close as the style asks, by pixelmatch's measure, in GL and in OpenCL. What does not stays in the
 * suite's folder of the build tree, or in cl/ of that. */
#include "core.h"
#include "pixelmatch.h"
#include "png_file.h"

#include <dirent.h>
#include <jansson.h>
#include <sys/wait.h>

enum { USUAL_PX = 512, PATH_SIZE = 1024, STYLES_MAX = 256 };

typedef struct picture_suite {
    char *folder;        /* absolute */
    char out[PATH_SIZE]; /* of the build tree */
} picture_suite;
static const double THRESHOLD = 0.13, USUAL_SHARE = 0.00015;

typedef enum reason {
    NOT_YET, /* camber does not draw it so far */
    FLAW,    /* the picture shows what the engine does wrong, or draws by another rule */
} reason;

#define BUTTS "butt ends are not anti-aliased there: whole pixels where lines end, 20 to 22 of them where 19 may differ"
#define SHORT                                                                                                          \
    "butt ends are not anti-aliased there; bends of segments shorter than the line is wide lose what the segments "    \
    "cover"
#define ANEW                                                                                                           \
    "dashes begin anew where a tile cuts a line there, and at a polygon's first point with the length of its last "    \
    "side behind them; camber's run on, from the first point"
#define RIMS                                                                                                           \
    "an image that is enlarged or seen aslant has a dark rim there: transparent px of the sprite count as black"
#define TWICE "its PNG has colours that are multiplied by their alpha already, where a PNG's are not"
#define DARKER "lines of one opacity darken where they overlap, themselves too; camber flattens them"

/* Pictures that are farther off, and by how much at most. One that has come close must go from here. */
static const struct {
    const char *name;
    reason reason;
    double share;
    const char *why;
} exceptions[] = {
    {"background-pattern/pitch", FLAW, 0.1, RIMS},
    {"background-pattern/zoomed", FLAW, 0.115, RIMS},
    {"circle-pitch-scale/map", NOT_YET, 0.044, "circles lie flat on the map with a pitch, and do not face the viewer"},
    {"circle-stroke-width/default", FLAW, 0.0035, TWICE},
    {"fill-color/opacity", FLAW, 0.2, TWICE},
    {"fill-opacity/overlapping", FLAW, 0.04,
     "areas of one opacity darken where they overlap there; camber's layer covers a pixel once"},
    {"fill-outline-color/property-function", FLAW, 0.013,
     "outlines are whole pixels there, in colours that are multiplied by their alpha; camber's lie where they are"},
    {"fill-pattern/@2x", FLAW, 0.001, "transparent px of the sprite count as black there: its images have dark rims"},
    {"fill-pattern/opacity", FLAW, 0.1, TWICE},
    {"line-blur/default", FLAW, 0.0002, BUTTS},
    {"line-cap/butt", FLAW, 0.0005, SHORT},
    {"line-color/default", FLAW, 0.0005, SHORT},
    {"line-color/function", FLAW, 0.0005, SHORT},
    {"line-dasharray/default", FLAW, 0.0002, BUTTS},
    {"line-dasharray/function", FLAW, 0.004, ANEW},
    {"line-dasharray/long-segment", FLAW, 0.07, ANEW},
    {"line-dasharray/slant", FLAW, 0.015, ANEW},
    {"line-gap-width/property-function", FLAW, 0.0025,
     "bands of segments shorter than their gap are wide lie over each other in another order"},
    {"line-join/round-transparent", FLAW, 0.032, DARKER},
    {"line-offset/default", FLAW, 0.0002, BUTTS},
    {"line-offset/literal", FLAW, 0.0015,
     "its lines bend where they turn sharply: segments that are too short on the inner side run backwards"},
    {"line-offset/property-function", FLAW, 0.0006, "the same; butt ends are not anti-aliased there"},
    {"line-opacity/literal", FLAW, 0.027, DARKER},
    {"line-opacity/property-function", FLAW, 0.017, DARKER},
    {"line-pattern/literal", FLAW, 0.28,
     "images have their own size there, are drawn out where lines bend, and begin anew where a tile cuts a line; "
     "camber's "
     "are as high as the line is wide, as today's specification says"},
    {"line-pattern/pitch", FLAW, 0.12,
     "its pitch of 90 is drawn as 60 there, the most that engine had, and as 85 here; images as in "
     "line-pattern/literal"},
    {"line-pitch/default", FLAW, 0.0005, SHORT},
    {"line-pitch/pitch30", FLAW, 0.0008, SHORT "; lines that are seen small are blurred inwards, and so are thinner"},
    {"line-translate-anchor/map", FLAW, 0.0006,
     "tiles are cut off at their borders after the translation: it leaves a white stripe"},
    {"line-translate/default", FLAW, 0.0002, BUTTS},
    {"line-translate/literal", FLAW, 0.0002, BUTTS},
    {"line-width/function", FLAW, 0.001, SHORT},
    {"line-width/very-overscaled", FLAW, 0.03, "the style asks for zoom 21; that engine draws none beyond 20"},
};
enum { EXCEPTIONS = sizeof exceptions / sizeof *exceptions };

typedef enum style_change {
    NO_CHANGE = 0,
    DARKENED, /* overlaps darken */
    HELD,     /* the zoom is 20 at most */
} style_change;

/* Proof that a reason holds: with this changed in its style camber's picture comes so close. */
static const struct {
    const char *name;
    style_change change;
    double share; /* 0: what the style asks for */
} proofs[] = {
    {"line-join/round-transparent", DARKENED, 0.0045}, /* a round join is drawn twice there */
    {"line-opacity/literal", DARKENED, 0},
    {"line-opacity/property-function", DARKENED, 0.002}, /* butt ends, and bends of short segments */
    {"line-width/very-overscaled", HELD, 0},
};
enum { PROOFS = sizeof proofs / sizeof *proofs };

typedef struct style_case {
    char name[256]; /* "line-join/round" */
    uint32_t width, height;
    double ratio, share;
} style_case;

typedef struct rgba {
    uint32_t width, height;
    uint8_t *pixels;
} rgba;

static bool read_png(const char *path, rgba *read) {
    const png_pixels found = png_pixels_read(path);
    *read = (rgba){found.width, found.height, found.rgba};
    return found.rgba != NULL;
}

static void write_png(const char *path, const rgba *written) {
    png_pixels_write(path, written->pixels, written->width, written->height);
}

/* ---- Close-ups ---- */

enum { CLOSE_PX = 40, CLOSE_SCALE = 8 };

/* The window with the most red pixels. */
static void find_worst(const rgba *difference, uint32_t *left, uint32_t *top) {
    size_t most = 0;
    *left = *top = 0;
    for (uint32_t y = 0; y + CLOSE_PX <= difference->height; y += CLOSE_PX / 4)
        for (uint32_t x = 0; x + CLOSE_PX <= difference->width; x += CLOSE_PX / 4) {
            size_t count = 0;
            for (uint32_t i = 0; i < CLOSE_PX * CLOSE_PX; i++) {
                const uint8_t *p =
                    difference->pixels + 4 * ((size_t)(y + i / CLOSE_PX) * difference->width + x + i % CLOSE_PX);
                count += p[0] == 255 && p[1] == 0;
            }
            if (count > most) {
                most = count;
                *left = x;
                *top = y;
            }
        }
}

/* Theirs, ours and the difference side by side, where they differ most. */
static void write_close_up(const char *path, const rgba *const pictures[3]) {
    enum { SIDE = CLOSE_PX * CLOSE_SCALE };
    rgba made = {3 * SIDE, SIDE, malloc((size_t)3 * SIDE * SIDE * 4)};
    uint32_t left, top;
    assert_non_null(made.pixels);
    find_worst(pictures[2], &left, &top);
    for (size_t y = 0; y < SIDE; y++)
        for (size_t x = 0; x < 3 * SIDE; x++) {
            const rgba *from = pictures[x / SIDE];
            const size_t column = left + x % SIDE / CLOSE_SCALE, row = top + y / CLOSE_SCALE;
            memcpy(made.pixels + 4 * (y * 3 * SIDE + x), from->pixels + 4 * (row * from->width + column), 4);
        }
    write_png(path, &made);
    free(made.pixels);
}

/* ---- Styles ---- */

/* local:// becomes the folder of the pictures. */
static void localize(json_t *json, const char *folder) {
    json_t *value;
    const char *key;
    size_t i;
    json_object_foreach(json, key, value) {
        const char *text = json_string_value(value);
        char path[2 * PATH_SIZE];
        if (text && strncmp(text, "local://", 8) == 0) {
            snprintf(path, sizeof path, "file://%s/%s", folder, text + 8);
            json_string_set(value, path);
        }
        localize(value, folder);
    }
    json_array_foreach(json, i, value) {
        const char *text = json_string_value(value);
        char path[2 * PATH_SIZE];
        if (text && strncmp(text, "local://", 8) == 0) {
            snprintf(path, sizeof path, "file://%s/%s", folder, text + 8);
            json_string_set(value, path);
        }
        localize(value, folder);
    }
}

static uint32_t count_of(const json_t *test, const char *key, uint32_t usual) {
    const json_t *json = json_object_get(test, key);
    return json_is_number(json) ? (uint32_t)json_number_value(json) : usual;
}

static void change_style(json_t *style, style_change change) {
    const json_t *zoom = json_object_get(style, "zoom");
    json_t *layer;
    size_t i;
    if (change == HELD && json_number_value(zoom) > 20)
        json_object_set_new(style, "zoom", json_integer(20));
    if (change != DARKENED)
        return;
    json_array_foreach(json_object_get(style, "layers"), i, layer) {
        json_object_set_new(layer, "metadata", json_pack("{s:s}", "camber:overlap", "accumulate"));
    }
}

/* Writes the style where camber reads it, and what it asks for. */
static void prepare(style_case *c, const char *folder, style_change change, const char *out) {
    char path[2 * PATH_SIZE];
    snprintf(path, sizeof path, "%s/tests/%s/style.json", folder, c->name);
    json_t *style = json_load_file(path, 0, NULL);
    if (!style)
        fail_msg("%s cannot be read", path);
    const json_t *test = json_object_get(json_object_get(style, "metadata"), "test");
    const json_t *ratio = json_object_get(test, "pixelRatio"), *diff = json_object_get(test, "diff");
    c->width = count_of(test, "width", USUAL_PX);
    c->height = count_of(test, "height", USUAL_PX);
    c->ratio = json_is_number(ratio) ? json_number_value(ratio) : 1;
    c->share = json_is_number(diff) ? json_number_value(diff) : USUAL_SHARE;
    localize(style, folder);
    change_style(style, change);
    assert_int_equal(json_dump_file(style, out, 0), 0);
    json_decref(style);
}

static int run(const style_case *c, const char *style, const char *picture, const char *log) {
    char size[64], ratio[32];
    snprintf(size, sizeof size, "%ux%u", c->width, c->height);
    snprintf(ratio, sizeof ratio, "%g", c->ratio);
    const pid_t child = fork();
    if (child == 0) {
        if (!freopen(log, "w", stderr))
            _exit(126);
        execl(CAMBER_TOOL, CAMBER_TOOL, "render", "--style", style, "-o", picture, "--force", "--size", size, "--ratio",
              ratio, "--draw", draws_in_cl() ? "cl" : "gl", (char *)NULL);
        _exit(127);
    }
    int status = 0;
    assert_true(child > 0 && waitpid(child, &status, 0) == child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* ---- Verdicts ---- */

static int exception_of(const char *name) {
    for (int i = 0; i < EXCEPTIONS; i++)
        if (strcmp(exceptions[i].name, name) == 0)
            return i;
    return -1;
}

static bool judge_proof(const style_case *c, style_change change, double share) {
    double most = c->share;
    for (int i = 0; i < PROOFS; i++)
        if (strcmp(proofs[i].name, c->name) == 0 && proofs[i].share > 0)
            most = proofs[i].share;
    printf("%-36s %.5f of %.5f: %s: %s\n", "", share, most, change == HELD ? "at zoom 20" : "where overlaps darken",
           share <= most ? "close" : "BUT THAT IS NOT WHY");
    return share <= most;
}

static bool judge(const style_case *c, double share) {
    const int e = exception_of(c->name);
    if (e < 0) {
        printf("%-36s %.5f of %.5f: %s\n", c->name, share, c->share, share <= c->share ? "close" : "TOO FAR");
        return share <= c->share;
    }
    const bool close = share <= c->share, kept = !close && share <= exceptions[e].share;
    printf("%-36s %.5f of %.5f: %s: %s%s\n", c->name, share, c->share,
           exceptions[e].reason == NOT_YET ? "not yet" : "theirs", exceptions[e].why,
           close  ? "; BUT IT IS CLOSE: take it out of the exceptions"
           : kept ? ""
                  : "; BUT FARTHER OFF THAN THAT");
    return kept;
}

static bool compare(const style_case *c, const char *folder, style_change change, const char *base) {
    char path[2 * PATH_SIZE];
    rgba expected = {0}, actual = {0};
    snprintf(path, sizeof path, "%s/tests/%s/expected.png", folder, c->name);
    assert_true(read_png(path, &expected));
    snprintf(path, sizeof path, "%s.actual.png", base);
    assert_true(read_png(path, &actual));
    if (expected.width != actual.width || expected.height != actual.height)
        fail_msg("%s: %u x %u px, not %u x %u", c->name, actual.width, actual.height, expected.width, expected.height);
    const size_t count = (size_t)expected.width * expected.height;
    rgba difference = {expected.width, expected.height, malloc(4 * count)};
    assert_non_null(difference.pixels);
    const pixelmatch_pair pair = {expected.pixels, actual.pixels, (int)expected.width, (int)expected.height,
                                  difference.pixels};
    const double share = (double)pixelmatch_count(&pair, THRESHOLD) / (double)count;
    if (share > c->share && !change) {
        snprintf(path, sizeof path, "%s.expected.png", base);
        write_png(path, &expected);
        snprintf(path, sizeof path, "%s.difference.png", base);
        write_png(path, &difference);
        snprintf(path, sizeof path, "%s.close.png", base);
        write_close_up(path, (const rgba *const[]){&expected, &actual, &difference});
    }
    free(difference.pixels);
    free(actual.pixels);
    free(expected.pixels);
    return change ? judge_proof(c, change, share) : judge(c, share);
}

static void print_file(const char *path) {
    char line[512];
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file))
        printf("    %s", line);
    if (file)
        fclose(file);
}

static bool draw(style_case *c, const picture_suite *suite, style_change change) {
    char base[PATH_SIZE], style[2 * PATH_SIZE], picture[2 * PATH_SIZE], log[2 * PATH_SIZE];
    const int folded = snprintf(base, sizeof base, "%.700s/", suite->out);
    snprintf(base + folded, sizeof base - (size_t)folded, "%s", c->name);
    for (char *at = base + folded; *at; at++)
        *at = *at == '/' ? '-' : *at;
    snprintf(style, sizeof style, "%s%s.json", base, change ? ".changed" : "");
    snprintf(picture, sizeof picture, "%s.actual.png", base);
    snprintf(log, sizeof log, "%s.log", base);
    remove(picture);
    prepare(c, suite->folder, change, style);
    const int status = run(c, style, picture, log);
    if (status == 0)
        return compare(c, suite->folder, change, base);
    const int e = exception_of(c->name);
    printf("%-36s exit status %d%s%s\n", c->name, status, e >= 0 ? ": not yet: " : "", e >= 0 ? exceptions[e].why : "");
    print_file(log);
    return e >= 0 && exceptions[e].reason == NOT_YET;
}

static bool draw_case(style_case *c, const picture_suite *suite) {
    bool proven = true;
    for (int i = 0; i < PROOFS; i++)
        if (strcmp(proofs[i].name, c->name) == 0)
            proven &= draw(c, suite, proofs[i].change);
    return draw(c, suite, NO_CHANGE) && proven;
}

/* ---- All of them ---- */

static int compare_cases(const void *left, const void *right) {
    return strcmp(((const style_case *)left)->name, ((const style_case *)right)->name);
}

static size_t list_cases(const char *folder, style_case *cases) {
    char path[2 * PATH_SIZE];
    size_t count = 0;
    snprintf(path, sizeof path, "%s/tests", folder);
    DIR *properties = opendir(path);
    for (struct dirent *property; properties && (property = readdir(properties));) {
        if (property->d_name[0] == '.')
            continue;
        snprintf(path, sizeof path, "%s/tests/%s", folder, property->d_name);
        DIR *styles = opendir(path);
        for (struct dirent *style; styles && (style = readdir(styles));)
            if (style->d_name[0] != '.' && count < STYLES_MAX)
                snprintf(cases[count++].name, sizeof cases->name, "%.100s/%.100s", property->d_name, style->d_name);
        if (styles)
            closedir(styles);
    }
    if (properties)
        closedir(properties);
    qsort(cases, count, sizeof *cases, compare_cases);
    return count;
}

static void test_pictures(void **state) {
    static style_case cases[STYLES_MAX];
    const picture_suite *suite = *state;
    const size_t count = list_cases(suite->folder, cases);
    size_t bad = 0;
    assert_in_range(count, 1, STYLES_MAX - 1);
    for (size_t i = 0; i < count; i++)
        bad += !draw_case(cases + i, suite);
    size_t seen = 0; /* of the exceptions */
    for (size_t i = 0; i < count; i++)
        seen += exception_of(cases[i].name) >= 0;
    printf("%zu pictures, %zu of them exceptions\n", count, seen);
    if (bad)
        fail_msg("%zu of %zu pictures; see %s", bad, count, suite->out);
}

/* The measure itself: a level off counts nothing, a black pixel on white does, a smooth edge that moved by half a pixel
 * does not. */
static void test_measure(void **state) {
    (void)state;
    enum { SIDE = 16, BYTES = 4 * SIDE * SIDE };
    uint8_t a[BYTES], b[BYTES], difference[BYTES];
    const pixelmatch_pair pair = {a, b, SIDE, SIDE, difference};
    memset(a, 255, BYTES);
    memset(b, 254, BYTES);
    assert_int_equal(pixelmatch_count(&pair, THRESHOLD), 0);
    memset(b, 255, BYTES);
    memset(b + 4 * (5 * SIDE + 5), 0, 3);
    assert_int_equal(pixelmatch_count(&pair, THRESHOLD), 1);
    assert_int_equal(difference[4 * (5 * SIDE + 5) + 1], 0);
    /* Transparent is white. */
    memset(b, 0, BYTES);
    assert_int_equal(pixelmatch_count(&pair, THRESHOLD), 0);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            for (int c = 0; c < 3; c++) {
                a[4 * (y * SIDE + x) + c] = x < 8 ? 0 : x == 8 ? 128 : 255;
                b[4 * (y * SIDE + x) + c] = x < 8 ? 0 : 255;
                b[4 * (y * SIDE + x) + 3] = 255;
            }
    assert_int_equal(pixelmatch_count(&pair, THRESHOLD), 0);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            for (int c = 0; c < 3; c++) {
                const int edge = 4 * x - y; /* slanted */
                a[4 * (y * SIDE + x) + c] = (uint8_t)(edge < 20 ? 0 : edge < 24 ? (edge - 20) * 64 : 255);
                b[4 * (y * SIDE + x) + c] = (uint8_t)(edge < 18 ? 0 : edge < 22 ? (edge - 18) * 64 : 255);
            }
    assert_true(pixelmatch_count(&pair, THRESHOLD) < SIDE / 2);
}

int main(int argc, char **argv) {
    char folder[PATH_SIZE] = "";
    const char *data = getenv("CAMBER_DATA"), *name = argc > 1 ? argv[1] : "line-tests";
    picture_suite suite;
    snprintf(folder, sizeof folder, "%s/%s", data ? data : "", name);
    snprintf(suite.out, sizeof suite.out, "%s/%s%s", CAMBER_PICTURES_FOLDER, name, draws_in_cl() ? "/cl" : "");
    suite.folder = data ? realpath(folder, NULL) : NULL;
    if (!suite.folder || access(suite.folder, R_OK) != 0) {
        printf("skipped: CAMBER_DATA has no %s\n", name);
        free(suite.folder);
        return 77;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_measure),
                                       cmocka_unit_test_prestate(test_pictures, &suite)};
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    free(suite.folder);
    return failed;
}
