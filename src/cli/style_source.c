#include "cli/style_source.h"

#include <stdlib.h>
#include <string.h>

/* The source that all line layers name; NULL: none does, and *several: they name more than one. */
static const char *only_source(const json_t *style, bool *several) {
    const char *only = NULL;
    const json_t *layer;
    size_t i;
    *several = false;
    json_array_foreach(json_object_get(style, "layers"), i, layer) {
        const char *type = json_string_value(json_object_get(layer, "type"));
        const char *source = json_string_value(json_object_get(layer, "source"));
        if (!type || !source || strcmp(type, "line") != 0)
            continue;
        *several = *several || (only && strcmp(only, source) != 0);
        only = source;
    }
    return *several ? NULL : only;
}

/* What a source of type geojson or vector names, if it is a file: without its scheme. */
static const char *file_of(const json_t *source) {
    static const char *const schemes[] = {"mbtiles://", "file://"};
    const char *type = json_string_value(json_object_get(source, "type"));
    if (!type || (strcmp(type, "geojson") != 0 && strcmp(type, "vector") != 0))
        return NULL;
    const char *text = json_string_value(json_object_get(source, strcmp(type, "geojson") == 0 ? "data" : "url"));
    for (size_t i = 0; text && i < sizeof schemes / sizeof *schemes; i++)
        if (strncmp(text, schemes[i], strlen(schemes[i])) == 0)
            return text + strlen(schemes[i]);
    return text && !strstr(text, "://") && *text ? text : NULL;
}

static char *beside(const char *style_path, const char *file) {
    const char *slash = strrchr(style_path, '/');
    if (!slash || file[0] == '/')
        return strdup(file);
    const size_t folder = (size_t)(slash - style_path) + 1;
    const size_t size = folder + strlen(file) + 1;
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%.*s%s", (int)folder, style_path, file);
    return path;
}

int camber_style_source(camber_report *report, const char *style_path, const char *bytes, size_t size_bytes,
                        char **path) {
    json_t *style = json_loadb(bytes, size_bytes, 0, NULL);
    int status = CAMBER_EXIT_DONE;
    bool several = false;
    const char *name = only_source(style, &several);
    const char *file = name ? file_of(json_object_get(json_object_get(style, "sources"), name)) : NULL;
    if (several)
        status =
            camber_report_fail(report, CAMBER_EXIT_USAGE,
                               "%s: its lines come from several sources; give the file to draw as INPUT", style_path);
    else if (name && !file)
        status =
            camber_report_fail(report, CAMBER_EXIT_USAGE,
                               "%s: its source \"%s\" is no file; give the file to draw as INPUT", style_path, name);
    else if (file && !(*path = beside(style_path, file)))
        status = camber_report_fail(report, CAMBER_EXIT_INTERNAL, "%s: out of memory; give it more", style_path);
    json_decref(style);
    return status;
}
