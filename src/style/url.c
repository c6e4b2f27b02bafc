/* Resolves URLs of a style: strips the scheme, decodes escapes, and joins relative paths to a folder. */
#include "style/url.h"

#include <ctype.h>

static bool starts_with(const char *text, const char *start) {
    return strncmp(text, start, strlen(start)) == 0;
}

static bool has_scheme(const char *text) {
    size_t length = 0;
    while (isalnum((unsigned char)text[length]) || (length && strchr("+.-", text[length]) && text[length]))
        length++;
    return length && starts_with(text + length, "://");
}

static int hex_digit(char c) {
    return isdigit((unsigned char)c) ? c - '0' : isxdigit((unsigned char)c) ? tolower((unsigned char)c) - 'a' + 10 : -1;
}

/* Decodes %20 and the like. %00 stays as it is. */
static void decode_escapes(char *text) {
    char *out = text;
    for (; *text; text++) {
        const int high = *text == '%' ? hex_digit(text[1]) : -1, low = high >= 0 ? hex_digit(text[2]) : -1;
        if (low >= 0 && high + low > 0) {
            *out++ = (char)(16 * high + low);
            text += 2;
        } else {
            *out++ = *text;
        }
    }
    *out = 0;
}

static char *join(camber_context *context, const char *base_path, const char *path) {
    const char *slash = base_path && path[0] != '/' ? strrchr(base_path, '/') : NULL;
    const size_t folder = slash ? (size_t)(slash + 1 - base_path) : 0, length = strlen(path);
    char *joined = camber_alloc(context, folder + length + 1, 1);
    if (!joined)
        return NULL;
    if (folder)
        memcpy(joined, base_path, folder);
    memcpy(joined + folder, path, length + 1);
    return joined;
}

bool camber_url_is_remote(const char *text) {
    return starts_with(text, "http://") || starts_with(text, "https://") || starts_with(text, "mapbox://");
}

/* rest: the part after mbtiles:// or pmtiles://. */
static camber_status fail_scheme(camber_context *context, const char *what, const char *text, const char *rest) {
    if (camber_url_is_remote(rest))
        return camber_fail(context, CAMBER_ERROR_INPUT,
                           "%s: %s is a network address, and a style's sources are read from files only; download it, "
                           "and name the file",
                           what, text);
    return camber_fail(context, CAMBER_ERROR_INPUT,
                       "%s: %s has an unknown scheme; name a path, file://, mbtiles:// or pmtiles://", what, text);
}

camber_status camber_url_resolve(camber_context *context, const char *what, const char *text, const char *base_path,
                                 camber_url *url) {
    camber_url made = {CAMBER_URL_FILE, NULL};
    const char *rest = text;
    if (starts_with(rest, "mbtiles://") || starts_with(rest, "pmtiles://")) {
        made.kind = rest[0] == 'm' ? CAMBER_URL_MBTILES : CAMBER_URL_PMTILES;
        rest += strlen("mbtiles://");
    }
    const bool is_file = starts_with(rest, "file://");
    if (has_scheme(rest) && !is_file)
        return fail_scheme(context, what, text, rest);
    if (is_file) {
        rest += strlen("file://");
        if (starts_with(rest, "localhost/"))
            rest += strlen("localhost");
    }
    made.path = join(context, base_path, rest);
    if (!made.path)
        return CAMBER_ERROR_MEMORY;
    if (is_file)
        decode_escapes(made.path);
    /* This is how other programs name the tiles inside an archive. */
    static const char tail[] = "/{z}/{x}/{y}";
    const size_t length = strlen(made.path), cut = sizeof tail - 1;
    if (made.kind != CAMBER_URL_FILE && length > cut && strcmp(made.path + length - cut, tail) == 0)
        made.path[length - cut] = 0;
    *url = made;
    return CAMBER_OK;
}
