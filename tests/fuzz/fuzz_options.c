/* The tool's command line: arguments between zero bytes or line ends. */
#include "fuzz.h"

#include "cli/input.h"
#include "cli/options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MESSAGE_BYTES = 512 };

/* The tool's own looks at files, too, and knows maps. */
bool camber_input_ships(const char *name) {
    return strcmp(name, "roads") == 0 || strcmp(name, "transit") == 0;
}

typedef struct arguments {
    char *text; /* what they point into */
    char **items;
    int count;
} arguments;

static arguments split(const uint8_t *bytes, size_t size) {
    arguments made = {.text = malloc(size + 1), .items = calloc(size + 3, sizeof *made.items)};
    static char name[] = "camber";
    REQUIRE(made.text && made.items);
    memcpy(made.text, bytes, size);
    made.text[size] = 0;
    made.items[made.count++] = name;
    for (size_t i = 0; i <= size; i++) {
        if (i == 0 || made.text[i - 1] == 0)
            made.items[made.count++] = made.text + i;
        if (i < size && made.text[i] == '\n')
            made.text[i] = 0;
    }
    if (made.items[made.count - 1] == made.text + size) /* as each line has an end */
        made.count--;
    made.items[made.count] = NULL;
    return made;
}

static bool is_within(double number, double least, double most) {
    return number >= least && number <= most;
}

/* Not given, or within. */
static bool may_be(double number, double least, double most) {
    return isnan(number) || is_within(number, least, most);
}

static void check_view(const camber_options *o) {
    const camber_view_desc *view = &o->view;
    const double width = view->width * view->ratio, height = view->height * view->ratio;
    REQUIRE(is_within(view->ratio, 1e-3, 1e3) && view->width >= 1 && view->height >= 1);
    REQUIRE(is_within(width, 0.5, 65535.5) && is_within(height, 0.5, 65535.5));
    REQUIRE(width * height <= 2147483648.0 + 65536.0);
    REQUIRE(view->kind == (o->has_bbox ? CAMBER_VIEW_BBOX : o->has_center ? CAMBER_VIEW_CENTER : CAMBER_VIEW_FIT));
    REQUIRE(fabs(view->longitude) <= 180 && fabs(view->latitude) <= 90 && is_within(view->zoom, -2, 30));
    REQUIRE(!o->has_bbox || (view->south < view->north && fabs(view->south) <= 90 && fabs(view->north) <= 90));
    REQUIRE(!o->has_bbox || (fabs(view->west) <= 180 && fabs(view->east) <= 180));
    REQUIRE(!(o->has_bbox && o->has_center));
    REQUIRE(is_within(view->pitch_deg, 0, 85) && is_within(view->bearing_deg, -1e6, 1e6));
}

/* Checks what camber_options says of its members. */
static void check_values(const camber_options *o) {
    REQUIRE(is_within(o->format, -1, 3) && is_within(o->theme, -1, 1) && is_within(o->method, -1, 2));
    REQUIRE(is_within(o->coverage, 0, 1) && is_within(o->backend, 0, 2) && is_within(o->sharing, 0, 3));
    REQUIRE(is_within(o->draw, 0, 2) && is_within(o->completion, -1, 1));
    REQUIRE(may_be(o->zoom, -2, 30) && may_be(o->bearing_deg, -1e6, 1e6) && may_be(o->pitch_deg, 0, 85));
    REQUIRE(is_within(o->simplify_px, 0, 1e6) && is_within(o->width_px, 0, 16384));
    REQUIRE(is_within(o->fan_tolerance_px, 0, 16384));
    REQUIRE(o->quality <= 100 && o->threads <= 1024 && is_within(o->runs, 1, 100000) &&
            is_within(o->windows, 8, 100000));
    REQUIRE(o->memory_bytes == 0 || is_within((double)o->memory_bytes, 65536, 1099511627776.0));
}

static void check_texts(const camber_options *o, const arguments *given) {
    REQUIRE(o->input_count + o->where_count < (size_t)given->count);
    REQUIRE(o->where == (o->where_count ? o->wheres[0] : NULL));
    for (size_t i = 0; i < o->where_count; i++)
        REQUIRE(o->wheres[i][0]);
    const char *const texts[] = {o->output,   o->dump,  o->polylines, o->plot,  o->junit,
                                 o->pictures, o->style, o->layer,     o->device};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        REQUIRE(!texts[i] || texts[i][0]);
}

/* Verbs that draw have all that they need. */
static void check_done(const camber_options *o) {
    REQUIRE(o->verb != CAMBER_VERB_NONE);
    if (o->verb == CAMBER_VERB_STYLE) {
        REQUIRE(o->input_count == 2);
        return;
    }
    if (o->verb == CAMBER_VERB_TILES && camber_options_tiles_action(o))
        return;
    check_view(o);
    if (o->verb == CAMBER_VERB_SERVE)
        REQUIRE((o->input_count || o->style) && o->most_ratio <= 8 && o->most_px <= 16384);
    if (o->verb == CAMBER_VERB_TILES) {
        REQUIRE(o->output && (o->input_count || o->style) && is_within(o->format, 0, 2));
        REQUIRE(o->min_zoom <= o->max_zoom && o->max_zoom <= 24);
        for (size_t i = 0; i < o->place_count; i++)
            REQUIRE(is_within(o->places[i].zoom, 0, 24) && !(o->places[i].column >> o->places[i].zoom) &&
                    !(o->places[i].row >> o->places[i].zoom));
    }
    REQUIRE(o->verb != CAMBER_VERB_INFO || o->input_count == 0);
    if (o->verb == CAMBER_VERB_RENDER || o->verb == CAMBER_VERB_TESSELLATE)
        REQUIRE(o->output && (o->input_count || o->style));
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    arguments given = split(bytes, size);
    camber_options options;
    char message[MESSAGE_BYTES];
    memset(message, 'x', sizeof message);
    memset(&options, 0xa5, sizeof options);
    const int status = camber_options_parse(given.count, given.items, &options, message, sizeof message);
    if (status == CAMBER_EXIT_DONE) {
        check_values(&options);
        check_texts(&options, &given);
        if (!options.help && !options.version && options.completion < 0)
            check_done(&options);
    } else {
        REQUIRE(status == CAMBER_EXIT_USAGE);
        REQUIRE(memchr(message, 0, sizeof message) && message[0] && !strchr(message, '\n'));
    }
    camber_options_free(&options);
    free(given.items);
    free(given.text);
    return 0;
}
