/* Runs `camber style`: checks a style document, and prints what is wrong with it and what it draws; or evaluates an
 * expression for given features, and prints the values as JSON. */
#include "cli/input.h"
#include "cli/verbs.h"

#ifdef CAMBER_MAP

#include <stdlib.h>
#include <string.h>

static bool write_out(void *user, const void *bytes, size_t size_bytes) {
    return fwrite(bytes, 1, size_bytes, user) == size_bytes;
}

static int evaluate(camber_session *session, const char *name, const char *bytes, size_t size_bytes) {
    const camber_sink sink = {.write = write_out, .user = stdout};
    const camber_status status = camber_style_evaluate(session->context, bytes, size_bytes, name, sink);
    if (status != CAMBER_OK)
        return camber_report_status(session->report, status);
    const int printed = camber_report_flush(session->report);
    if (printed == CAMBER_EXIT_DONE)
        camber_report_done(session->report, name, 0, camber_session_elapsed_ms(session), "evaluated");
    return printed;
}

/* ---- check ---- */

static int print_json(camber_report *out, const camber_style_report *report) {
    json_t *findings = json_array(), *types = json_array(), *sources = json_array();
    for (size_t i = 0; i < report->finding_count; i++) {
        const camber_style_finding *finding = report->findings + i;
        json_array_append_new(findings, json_pack("{s:s, s:o, s:o}", "severity", finding->error ? "error" : "warning",
                                                  "pointer", camber_json_text(finding->pointer), "message",
                                                  camber_json_text(finding->message)));
    }
    for (size_t i = 0; i < report->type_count; i++)
        json_array_append_new(types,
                              json_pack("{s:o, s:o, s:b}", "type", camber_json_text(report->types[i].type), "layers",
                                        camber_json_count(report->types[i].layers), "drawn", report->types[i].drawn));
    for (size_t i = 0; i < report->source_count; i++) {
        const camber_style_report_source *source = report->sources + i;
        json_array_append_new(sources, json_pack("{s:o, s:o, s:o, s:o}", "name", camber_json_text(source->name), "type",
                                                 camber_json_text(source->type), "line_layers",
                                                 camber_json_count(source->layers), "trouble",
                                                 source->trouble ? camber_json_text(source->trouble) : json_null()));
    }
    return camber_report_json(out, json_pack("{s:b, s:o, s:o, s:o, s:o}", "valid", report->error_count == 0, "errors",
                                             camber_json_count(report->error_count), "findings", findings, "layers",
                                             types, "sources", sources));
}

static void print_text(camber_report *out, const char *name, const camber_style_report *report) {
    for (size_t i = 0; i < report->finding_count; i++) {
        const camber_style_finding *finding = report->findings + i;
        camber_report_say(out, "%s: %s: %s%s%s", name, finding->error ? "error" : "warning", finding->pointer,
                          finding->pointer[0] ? ": " : "", finding->message);
    }
    for (size_t i = 0; i < report->type_count; i++)
        camber_report_say(out, "%zu layer%s of type %s: %s", report->types[i].layers,
                          report->types[i].layers == 1 ? "" : "s", report->types[i].type,
                          report->types[i].drawn ? "drawn" : "not drawn");
    for (size_t i = 0; i < report->source_count; i++) {
        const camber_style_report_source *source = report->sources + i;
        camber_report_say(out, "source %s of type %s, named by %zu layer%s: %s", source->name, source->type,
                          source->layers, source->layers == 1 ? "" : "s",
                          source->trouble ? source->trouble : "read when it is drawn");
    }
}

static void say_checked(camber_session *session, const char *name, const camber_style_report *report) {
    size_t layers = 0;
    for (size_t i = 0; i < report->type_count; i++)
        layers += report->types[i].layers;
    camber_report_done(session->report, name, 0, camber_session_elapsed_ms(session),
                       "no error in %s layer%s, %s warning%s", camber_figure_count(layers).text, camber_plural(layers),
                       camber_figure_count(report->finding_count).text, camber_plural(report->finding_count));
}

static int check(camber_session *session, const char *name, const char *bytes, size_t size_bytes) {
    camber_style_report *report = NULL;
    const camber_status status = camber_style_check(session->context, bytes, size_bytes, name, &report);
    if (status != CAMBER_OK)
        return camber_report_status(session->report, status);
    int exit_status = CAMBER_EXIT_DONE;
    if (session->options->json)
        exit_status = print_json(session->report, report);
    else
        print_text(session->report, name, report);
    if (exit_status == CAMBER_EXIT_DONE && report->error_count)
        exit_status = camber_report_fail(session->report, CAMBER_EXIT_DATA, "%s: %zu error%s; correct %s", name,
                                         report->error_count, report->error_count == 1 ? "" : "s",
                                         report->error_count == 1 ? "it" : "them");
    else if (exit_status == CAMBER_EXIT_DONE)
        say_checked(session, name, report);
    camber_style_report_destroy(report);
    return exit_status;
}

int camber_verb_style(camber_session *session) {
    const bool checks = strcmp(session->options->inputs[0], "check") == 0;
    const char *path = session->options->inputs[1];
    camber_style_input style = {0};
    int status = camber_session_need(session, CAMBER_NEEDS_CONTEXT);
    if (status == CAMBER_EXIT_DONE && checks)
        status = camber_input_read_style(session, path, CAMBER_THEME_LIGHT, &style);
    else if (status == CAMBER_EXIT_DONE)
        status = camber_input_read_all(session->report, path, &style.bytes, &style.size_bytes);
    if (status == CAMBER_EXIT_DONE)
        status =
            checks ? check(session, style.name, style.text, style.size_bytes)
                   : evaluate(session, strcmp(path, "-") == 0 ? "standard input" : path, style.bytes, style.size_bytes);
    free(style.bytes);
    return status;
}

#endif
