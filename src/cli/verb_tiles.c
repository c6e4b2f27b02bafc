/* The actions of the verb tiles that show, verify and merge archives. verb_tiles_draw.c draws tiles. */
#include "cli/verbs.h"

#ifdef CAMBER_MAP

#include "cli/tiles_files.h"

#include <string.h>

/* ---- show ---- */

static json_t *numbers(const double *values, size_t count) {
    json_t *array = json_array();
    for (size_t i = 0; i < count; i++)
        json_array_append_new(array, json_real(values[i]));
    return array;
}

static int show_json(camber_report *report, const camber_tiles_info *info) {
    json_t *zooms = json_array();
    for (size_t i = 0; i < info->zoom_count; i++)
        json_array_append_new(zooms, json_pack("{s:i, s:o, s:o}", "zoom", info->zooms[i].zoom, "tiles",
                                               camber_json_count((size_t)info->zooms[i].tiles), "bytes",
                                               camber_json_count((size_t)info->zooms[i].size_bytes)));
    json_t *object =
        json_pack("{s:s, s:s, s:s, s:i, s:i, s:o, s:o, s:o, s:o, s:o, s:o}", "format", info->format, "type", info->type,
                  "compression", info->compression, "min_zoom", info->min_zoom, "max_zoom", info->max_zoom, "tiles",
                  camber_json_count((size_t)info->tiles), "entries", camber_json_count((size_t)info->entries),
                  "contents", camber_json_count((size_t)info->contents), "zooms", zooms, "bounds",
                  info->has_bounds ? numbers(info->bounds, 4) : json_null(), "center",
                  info->has_center ? numbers(info->center, 3) : json_null());
    json_object_set_new(object, "schema", info->schema ? json_string(info->schema) : json_null());
    json_object_set_new(object, "metadata", json_loads(info->metadata, 0, NULL));
    json_object_set_new(object, "fingerprint", info->fingerprint ? camber_json_text(info->fingerprint) : json_null());
    json_object_set_new(object, "shard", info->shards ? json_integer(info->shard) : json_null());
    json_object_set_new(object, "shards", info->shards ? json_integer(info->shards) : json_null());
    return camber_report_json(report, object);
}

/* Texts in a file may contain anything; control characters are not sent to the terminal. */
static void print_text(const char *name, const char *text) {
    printf("%-12s", name);
    for (; *text; text++)
        putchar((unsigned char)*text < 0x20 || *text == 0x7f ? '?' : *text);
    putchar('\n');
}

static int show_text(camber_report *report, const char *path, const camber_tiles_info *info) {
    const double *b = info->bounds, *c = info->center;
    print_text("archive", path);
    printf("format      %s, tiles of type %s, compression %s\n", info->format, info->type, info->compression);
    printf("zooms       %d to %d\n", info->min_zoom, info->max_zoom);
    if (info->has_bounds)
        printf("bounds      %.7f,%.7f,%.7f,%.7f\n", b[0], b[1], b[2], b[3]);
    if (info->has_center)
        printf("centre      %.7f,%.7f at zoom %.0f\n", c[0], c[1], c[2]);
    printf("tiles       %s, in %s entries, with %s different contents\n", camber_figure_count(info->tiles).text,
           camber_figure_count(info->entries).text, camber_figure_count(info->contents).text);
    for (size_t i = 0; i < info->zoom_count; i++)
        printf("  zoom %2d   %13s tiles %19s bytes\n", info->zooms[i].zoom,
               camber_figure_count(info->zooms[i].tiles).text, camber_figure_count(info->zooms[i].size_bytes).text);
    if (strcmp(info->type, "pbf") == 0)
        printf("schema      %s\n",
               info->schema ? info->schema : "none that the style city knows; its layers are drawn plainly");
    print_text("metadata", info->metadata);
    if (info->fingerprint)
        print_text("fingerprint", info->fingerprint);
    if (info->shards)
        printf("shard       %u of %u\n", info->shard, info->shards);
    return camber_report_flush(report);
}

static int show(camber_session *session, const char *path) {
    camber_tiles_info *info = NULL;
    const camber_status status = camber_tiles_show(session->context, path, &info);
    if (status != CAMBER_OK)
        return camber_report_status(session->report, status);
    const int exit_status =
        session->options->json ? show_json(session->report, info) : show_text(session->report, path, info);
    uint64_t size_bytes = 0;
    for (size_t i = 0; i < info->zoom_count; i++)
        size_bytes += info->zooms[i].size_bytes;
    if (exit_status == CAMBER_EXIT_DONE)
        camber_tiles_say_done(session, path, "", info->tiles, size_bytes);
    camber_tiles_info_destroy(info);
    return exit_status;
}

/* ---- verify ---- */

static int verify_json(camber_report *report, const char *path, const camber_tiles_findings *found) {
    json_t *list = json_array();
    for (size_t i = 0; i < found->count; i++)
        json_array_append_new(list, json_pack("{s:s, s:o}", "severity", found->findings[i].error ? "error" : "warning",
                                              "message", camber_json_text(found->findings[i].message)));
    return camber_report_json(report, json_pack("{s:o, s:b, s:o, s:o}", "archive", camber_json_text(path), "valid",
                                                found->count == 0, "findings", list, "left_out",
                                                camber_json_count(found->left_out)));
}

static int verify(camber_session *session, const char *path) {
    camber_report *report = session->report;
    camber_tiles_findings *found = NULL;
    const camber_status status = camber_tiles_verify(session->context, path, &found);
    if (status != CAMBER_OK)
        return camber_report_status(report, status);
    int exit_status = CAMBER_EXIT_DONE;
    if (session->options->json)
        exit_status = verify_json(report, path, found);
    bool broken = false;
    for (size_t i = 0; i < found->count; i++)
        broken = broken || found->findings[i].error;
    for (size_t i = 0; i < found->count && !session->options->json; i++)
        camber_report_say(report, "%s: %s: %s", path, found->findings[i].error ? "error" : "warning",
                          found->findings[i].message);
    if (exit_status == CAMBER_EXIT_DONE && found->count)
        exit_status = camber_report_fail(report, CAMBER_EXIT_CHECK, "%s: %s problem%s found%s; rebuild the archive%s",
                                         path, camber_figure_count(found->count + found->left_out).text,
                                         camber_plural(found->count + found->left_out),
                                         found->left_out ? ", the first of each kind listed" : "",
                                         broken ? "" : ", or rewrite it with camber tiles merge");
    if (exit_status == CAMBER_EXIT_DONE)
        camber_tiles_say_done(session, path, "no problem found in ", found->tiles, found->size_bytes);
    camber_tiles_findings_destroy(found);
    return exit_status;
}

/* ---- merge ---- */

static void say_merged(camber_session *session) {
    const size_t parts = session->options->input_count - 1;
    char what[96];
    snprintf(what, sizeof what, "%s part%s with ", camber_figure_count(parts).text, camber_plural(parts));
    camber_tiles_say_done(session, session->options->output, what, 0, 0);
}

static int merge(camber_session *session) {
    const camber_options *options = session->options;
    camber_tiles_files files = {.session = session};
    int found = camber_tiles_look_at_output(session, options->output);
    if (found == CAMBER_EXIT_DONE)
        found = camber_tiles_files_name(&files, options->output);
    if (found != CAMBER_EXIT_DONE)
        return found;
    const camber_tiles_merge_desc desc = {options->inputs + 1, options->input_count - 1, options->output,
                                          options->force,      camber_tiles_files_guard, &files};
    const camber_status status = camber_tiles_merge(session->context, &desc);
    camber_tiles_files_release(&files);
    camber_report_erase_bar(session->report);
    if (status == CAMBER_OK)
        say_merged(session);
    return camber_report_status(session->report, status);
}

int camber_verb_tiles(camber_session *session) {
    const char *action = camber_options_tiles_action(session->options), *path = session->options->inputs[1];
    if (!action)
        return camber_verb_tiles_draw(session);
    const int status = camber_session_need(session, CAMBER_NEEDS_CONTEXT);
    if (status != CAMBER_EXIT_DONE)
        return status;
    if (strcmp(action, "show") == 0)
        return show(session, path);
    return strcmp(action, "verify") == 0 ? verify(session, path) : merge(session);
}

#endif
