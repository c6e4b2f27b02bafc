/* Writes --color, --fill and --width into a built-in style, as defaults of the state that its plain layers read. */
#include "cli/plain.h"

#ifdef CAMBER_MAP

#include <stdlib.h>
#include <string.h>

bool camber_plain_is_given(const camber_options *options) {
    return options->color || options->fill || options->width > 0;
}

typedef struct answer {
    char text[1024];
    size_t size;
} answer;

/* Fails if the answer is too long to be a colour. */
static bool collect(void *user, const void *bytes, size_t size_bytes) {
    answer *to = user;
    if (size_bytes > sizeof to->text - to->size)
        return false;
    memcpy(to->text + to->size, bytes, size_bytes);
    to->size += size_bytes;
    return true;
}

/* Whether the text is a colour of the style language. */
static bool is_color(camber_session *session, const char *text) {
    json_t *question = json_pack("{s:[s,s], s:[[{},{}]]}", "expression", "to-color", text, "inputs");
    char *json = question ? json_dumps(question, JSON_COMPACT) : NULL;
    answer given = {.size = 0};
    const camber_sink sink = {.write = collect, .user = &given};
    const bool asked =
        json && camber_style_evaluate(session->context, json, strlen(json), "a colour", sink) == CAMBER_OK;
    json_t *parsed = asked ? json_loadb(given.text, given.size, 0, NULL) : NULL;
    const bool good = json_is_array(json_array_get(json_object_get(parsed, "outputs"), 0));
    json_decref(parsed);
    json_decref(question);
    free(json);
    return good;
}

/* Takes ownership of value. */
static bool set(json_t *state, const char *name, json_t *value) {
    return json_object_set_new(json_object_get(state, name), "default", value) == 0;
}

static int fail_style(camber_session *session) {
    return camber_report_fail(session->report, CAMBER_EXIT_USAGE,
                              "--color, --fill, --width: have no effect on this style; choose --style city "
                              "or roads, or change the document");
}

static int fail_color(camber_session *session, const char *option, const char *text) {
    return camber_report_fail(session->report, CAMBER_EXIT_USAGE,
                              "--%s %s: is not a colour; give a CSS name, #RRGGBB or rgb(...)", option, text);
}

int camber_plain_apply(camber_session *session, camber_style_input *style) {
    const camber_options *options = session->options;
    const struct {
        const char *option, *state, *color;
    } colors[] = {{"color", "plain-color", options->color}, {"fill", "plain-fill", options->fill}};
    for (size_t i = 0; i < sizeof colors / sizeof *colors; i++)
        if (colors[i].color && !is_color(session, colors[i].color))
            return fail_color(session, colors[i].option, colors[i].color);
    json_t *document = json_loadb(style->text, style->size_bytes, 0, NULL);
    json_t *state = json_object_get(document, "state");
    if (style->bytes || !json_object_get(state, "plain-width")) {
        json_decref(document);
        return fail_style(session);
    }
    bool made = true;
    for (size_t i = 0; i < sizeof colors / sizeof *colors; i++)
        made = made && (!colors[i].color || set(state, colors[i].state, json_string(colors[i].color)));
    if (made && options->width > 0)
        made = set(state, "plain-width", json_real(options->width));
    if (made)
        style->bytes = json_dumps(document, JSON_COMPACT);
    json_decref(document);
    if (!style->bytes)
        return camber_report_fail(session->report, CAMBER_EXIT_INTERNAL, "the style: out of memory; give it more");
    style->text = style->bytes;
    style->size_bytes = strlen(style->bytes);
    return CAMBER_EXIT_DONE;
}

#endif
