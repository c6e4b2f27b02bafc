/* Checks the options of `camber serve`. */
#include "cli/options_table.h"

#include <string.h>

/* Checks the form ADDRESS:PORT; ADDRESS is an IPv4 address, an IPv6 address in brackets, or localhost. The server
 * parses it fully. */
static bool is_address(const char *text) {
    const char *colon = strrchr(text, ':');
    if (!colon || colon == text || strlen(colon + 1) < 1 || strlen(colon + 1) > 5)
        return false;
    return strspn(colon + 1, "0123456789") == strlen(colon + 1);
}

/* Checks for http or https, a host, an optional path, and no character that would end a header or a JSON string. */
static bool is_url(const char *text) {
    const char *host = strncmp(text, "http://", 7) == 0 ? text + 7 : strncmp(text, "https://", 8) == 0 ? text + 8 : "";
    if (!*host || *host == '/' || strlen(text) > 200)
        return false;
    for (; *host; host++)
        if (*host <= ' ' || *host >= 0x7f || strchr("\"'<>\\^`{|}?#;,", *host))
            return false;
    return true;
}

static bool is_origin(const char *text) {
    return strcmp(text, "*") == 0 || strcmp(text, "null") == 0 ||
           (is_url(text) && !strchr(strstr(text, "//") + 2, '/'));
}

const char *camber_options_split_input(const char *input, size_t *name_length) {
    const char *equals = strchr(input, '=');
    const size_t length = equals ? (size_t)(equals - input) : 0, first = length ? strcspn(input, "/=") : 0;
    bool is_name = length > 0 && length <= CAMBER_MAP_NAME_SIZE - 1 && *input != '-';
    for (size_t i = 0; i < first; i++)
        is_name = is_name && ((input[i] >= 'a' && input[i] <= 'z') || (input[i] >= 'A' && input[i] <= 'Z') ||
                              (input[i] >= '0' && input[i] <= '9') || input[i] == '-' || input[i] == '_');
    is_name =
        is_name && first > 0 && (first == length || (length == first + 5 && memcmp(input + first, "/dark", 5) == 0));
    *name_length = is_name ? length : 0;
    return is_name ? equals + 1 : input;
}

/* Whether an input has this name; without length characters: no name. */
static bool has_input_of(const camber_options *options, const char *name, size_t length) {
    bool found = false;
    for (size_t i = 0; i < options->input_count; i++) {
        size_t other;
        (void)camber_options_split_input(options->inputs[i], &other);
        found = found || (other == length && memcmp(options->inputs[i], name, length) == 0);
    }
    return found;
}

/* Checks the name of one input. */
static int check_name(const camber_option_reader *p, const char *input, size_t length) {
    static const char *const taken[] = {"page", "static", "subtrees", "health", "metrics", "events"};
    const char *slash = memchr(input, '/', length);
    const size_t base = slash ? (size_t)(slash - input) : length;
    const bool is_dark = length == 4 && memcmp(input, "dark", 4) == 0;
    for (size_t i = 0; i < sizeof taken / sizeof *taken; i++)
        if (base == strlen(taken[i]) && memcmp(input, taken[i], base) == 0)
            return camber_options_refuse(p, "%s: the server has a path of this name; choose another one", input);
    if (slash && base == 4 && memcmp(input, "dark", 4) == 0)
        return camber_options_refuse(p, "%s: dark is the name of a dark theme; choose another one", input);
    if (is_dark || slash) {
        if (!has_input_of(p->options, input, is_dark ? 0 : base))
            return camber_options_refuse(p, "%s: a dark theme of no map; also give the light one, as %.*s%sINPUT",
                                         input, is_dark ? 0 : (int)base, input, is_dark ? "" : "=");
    } else if (has_input_of(p->options, input, 0)) {
        return camber_options_refuse(p, "%s: another input has no name; give each of them one, as NAME=INPUT", input);
    }
    return input[length + 1] ? CAMBER_EXIT_DONE
                             : camber_options_refuse(p, "%s: no input after the name; give NAME=INPUT", input);
}

static int check_names(const camber_option_reader *p) {
    const camber_options *options = p->options;
    size_t named = 0;
    for (size_t i = 0; i < options->input_count; i++) {
        size_t length;
        const char *path = camber_options_split_input(options->inputs[i], &length);
        named += length > 0;
        const int status = length ? check_name(p, options->inputs[i], length) : CAMBER_EXIT_DONE;
        if (status != CAMBER_EXIT_DONE)
            return status;
        if (strcmp(path, "-") == 0)
            return camber_options_refuse(p, "serve: standard input cannot be read again at SIGHUP; name a file");
    }
    if (named && (options->renderd || options->edit))
        return camber_options_refuse(
            p, "--%s: works with one map; serve it alone, without NAME=", options->renderd ? "renderd" : "edit");
    if (named && options->name && !has_input_of(options, "", 0))
        return camber_options_refuse(p, "--name: each map has its own name; leave it out");
    return CAMBER_EXIT_DONE;
}

int camber_options_check_serve(camber_options *options, char *message, size_t message_size) {
    const camber_option_reader it = {options, message, message_size, NULL}, *p = &it;
    if (!options->input_count && !options->style && !options->edit)
        return camber_options_refuse(
            p, "serve: no input; give a file with lines, such as city.osm.pbf, or an archive of tiles");
    const int status = check_names(p);
    if (status != CAMBER_EXIT_DONE)
        return status;
    if (options->style && strcmp(options->style, "-") == 0)
        return camber_options_refuse(p, "--style -: cannot be read again at SIGHUP; name a file");
    const bool listens = !options->listen || is_address(options->listen);
    if (!listens || (options->metrics && !is_address(options->metrics)))
        return camber_options_refuse(
            p, "--%s %.64s: not an address; give ADDRESS:PORT, as in 127.0.0.1:8080 or [::1]:8080",
            listens ? "metrics" : "listen", listens ? options->metrics : options->listen);
    if (options->public_url && !is_url(options->public_url))
        return camber_options_refuse(p, "--public-url: not a URL; give one such as https://example.org/map");
    if (options->cors && !is_origin(options->cors))
        return camber_options_refuse(p, "--cors: not an origin; give *, or one such as https://example.org");
    if (options->edit && options->style)
        return camber_options_refuse(p, "--edit and --style: both name the style; give one of them");
    if (options->edit && options->theme >= 0)
        return camber_options_refuse(p, "--theme: applies only to the built-in styles; leave it out with --edit");
    if (options->edit && strcmp(options->edit, "-") == 0)
        return camber_options_refuse(p, "--edit -: changes to standard input cannot be seen; name a file");
    if (options->renderd && !options->cache_dir)
        return camber_options_refuse(
            p, "--renderd: needs a folder for its tiles; also give --cache-dir FOLDER, which is mod_tile's TileDir");
    if (options->edit)
        options->style = options->edit;
    /* A style's own sources are read once: at the zoom at which all their data has this width, or at their highest. */
    options->view.width = options->view.height = options->input_count ? 1024 : 30000;
    options->view.kind = CAMBER_VIEW_FIT;
    options->view.zoom = options->view.bearing_deg = options->view.pitch_deg = 0.0;
    return CAMBER_EXIT_DONE;
}
