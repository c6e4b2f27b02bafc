/* Checks the options together, once each has a value by itself: which exclude each other, which need another, and that
 * no file is read and written. The first rule that is broken becomes one line: the option, the reason and the cure. */
#include "cli/input.h"
#include "cli/options.h"
#include "cli/options_files.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>
#include <strings.h>

/* The options to check, and where the message goes. */
typedef struct checked {
    camber_options *options;
    const char *verb; /* its name */
    char *message;
    size_t message_size;
} checked;

static int usage(const checked *p, const char *format, ...) {
    va_list list;
    va_start(list, format);
    vsnprintf(p->message, p->message_size, format, list);
    va_end(list);
    return CAMBER_EXIT_USAGE;
}

static bool has_extension(const char *path, const char *extension) {
    const size_t length = strlen(path);
    const size_t tail = strlen(extension);
    return length > tail && strcasecmp(path + length - tail, extension) == 0;
}

static bool ships(const char *style) {
#ifdef CAMBER_MAP
    return camber_input_ships(style);
#else
    return style == NULL;
#endif
}

static int check_output(const checked *p) {
    camber_options *options = p->options;
    const bool glb = options->verb == CAMBER_VERB_TESSELLATE;
    const char *format = glb ? "glb" : "png";
    if (!options->output && options->verb != CAMBER_VERB_BENCH)
        return usage(p, "%s: no output; give -o OUT.%s", p->verb, format);
    if (!options->output)
        return CAMBER_EXIT_DONE;
    const bool out = strcmp(options->output, "-") == 0;
    if (out && options->json)
        return usage(p, "--json and -o -: both want standard output; give one of them");
    if (options->dump && strcmp(options->dump, "-") == 0 && out)
        return usage(p, "--dump - and -o -: both want standard output; give one of them");
    const bool png_name = has_extension(options->output, ".png");
    const bool glb_name = has_extension(options->output, ".glb");
    if (options->format < 0 && !out && !png_name && !glb_name)
        return usage(p, "%s: its extension tells no format; name it OUT.%s, or give --format %s", options->output,
                     format, format);
    if ((glb ? png_name : glb_name) || (options->format >= 0 && options->format != glb))
        return usage(p, "%s: %s writes %s; camber %s writes %s", options->output, p->verb, format,
                     glb ? "render" : "tessellate", glb ? "png" : "glb");
    return CAMBER_EXIT_DONE;
}

static int check_view(const checked *p) {
    camber_options *options = p->options;
    camber_view_desc *view = &options->view;
    if (options->has_bbox && (options->has_center || !isnan(options->zoom)))
        return usage(p, "--bbox and --center or --zoom: they exclude each other; give the box or the centre");
    /* A style that is drawn from its own sources gives the missing one. */
    const bool own = options->style && options->input_count == 0;
    if (!own && options->has_center != !isnan(options->zoom))
        return usage(p, "--%s alone: give --center LON,LAT and --zoom Z together",
                     options->has_center ? "center" : "zoom");
    const bool tilts = options->verb == CAMBER_VERB_RENDER || options->verb == CAMBER_VERB_BENCH;
    if (options->pitch_deg > 0 && !tilts)
        return usage(p, "--pitch %g: camber %s works on the map's plane, which has no pitch; leave it out",
                     options->pitch_deg, p->verb);
    view->kind = options->has_bbox ? CAMBER_VIEW_BBOX : options->has_center ? CAMBER_VIEW_CENTER : CAMBER_VIEW_FIT;
    view->zoom = isnan(options->zoom) ? 0 : options->zoom;
    view->bearing_deg = isnan(options->bearing_deg) ? 0 : options->bearing_deg;
    view->pitch_deg = isnan(options->pitch_deg) ? 0 : options->pitch_deg;
    if (view->width == 0)
        view->width = view->height = options->polylines ? 2048 : 1024;
    const double width = floor(view->width * view->ratio + 0.5);
    const double height = floor(view->height * view->ratio + 0.5);
    if (width < 1 || height < 1 || width > 65535 || height > 65535 || width * height > 2147483648.0)
        return usage(p, "%ux%u at ratio %g: out of range; after --ratio a side is 1 to 65535 px, all 2^31 at most",
                     view->width, view->height, view->ratio);
    return CAMBER_EXIT_DONE;
}

static int check_inputs(const checked *p) {
    const camber_options *options = p->options;
    const char *verb = p->verb;
#ifndef CAMBER_MAP
    if (options->input_count)
        return usage(p, "%s: this build reads no maps (CAMBER_MAP=OFF); give --polylines FILE", options->inputs[0]);
#endif
    if (options->verb == CAMBER_VERB_INFO && options->input_count)
        return usage(p, "%s: info takes no input; leave it out", options->inputs[0]);
    if (options->polylines && options->input_count)
        return usage(p, "--polylines and %s: both are inputs; give one of them", options->inputs[0]);
    if (options->polylines &&
        (options->style || options->theme >= 0 || options->layer || options->where || options->has_bbox ||
         options->has_center || !isnan(options->bearing_deg) || !isnan(options->pitch_deg)))
        return usage(p, "--polylines: is in pixels already and has no style, layer or view; leave those out");
    if (options->where_count > 1 && options->verb != CAMBER_VERB_COMPARE)
        return usage(p, "--where: given %zu times; camber %s takes one, so join them with AND or OR",
                     options->where_count, verb);
    if (options->width_px > 0 && !options->polylines && options->verb != CAMBER_VERB_COMPARE)
        return usage(p, "--width-px: is for --polylines; a map's widths are its style's");
    if (options->style && options->theme >= 0 && !ships(options->style))
        return usage(p, "--theme: is for the styles that ship with camber; leave it out with --style %s",
                     options->style);
    if (options->style && options->input_count == 0 && (options->layer || options->where))
        return usage(p, "--%s: is for INPUT, and the style's own sources are drawn; let its layers name what they draw",
                     options->layer ? "layer" : "where");
    size_t streams = options->polylines && strcmp(options->polylines, "-") == 0;
    for (size_t i = 0; i < options->input_count; i++)
        streams += strcmp(options->inputs[i], "-") == 0;
    streams += options->style && strcmp(options->style, "-") == 0;
    if (streams > 1)
        return usage(p, "-: standard input can be read once; name the other file");
    const bool takes_both = options->verb == CAMBER_VERB_COMPARE || options->verb == CAMBER_VERB_BENCH;
    const bool needs = options->verb != CAMBER_VERB_INFO && options->verb != CAMBER_VERB_VALIDATE;
    if (needs && !options->input_count && !options->polylines && !options->style)
        return usage(p, "%s: no input; give %s", verb,
                     takes_both ? "a file with lines or --polylines FILE" : "a file with lines, such as city.osm.pbf");
    return CAMBER_EXIT_DONE;
}

/* style SUBCOMMAND FILE. */
static int check_style(const checked *p) {
    const camber_options *options = p->options;
    if (options->input_count == 0 ||
        (strcmp(options->inputs[0], "check") != 0 && strcmp(options->inputs[0], "eval") != 0))
        return usage(p, "style: %s%swhat to do with a file; write camber style check FILE or camber style eval FILE",
                     options->input_count ? options->inputs[0] : "", options->input_count ? ": not " : "say ");
    if (options->input_count == 1)
        return usage(p, "style %s: no file; give one, or - for standard input", options->inputs[0]);
    if (options->input_count > 2)
        return usage(p, "%s: style %s takes one file; leave out the others", options->inputs[2], options->inputs[0]);
    return CAMBER_EXIT_DONE;
}

/* With --draw cl no GL is loaded, so an option that names a part of GL would have no effect. */
static int check_draw(const checked *p) {
    const camber_options *options = p->options;
    const bool named = options->backend != CAMBER_BACKEND_AUTO;
    if (options->draw != CAMBER_RASTERIZER_OPENCL || (!named && options->sharing == CAMBER_SHARING_AUTO))
        return CAMBER_EXIT_DONE;
    return usage(p, "--draw cl and --%s: OpenCL kernels draw without any GL; leave out --%s, or give --draw gl",
                 named ? "backend" : "sharing", named ? "backend" : "sharing");
}

static int check_plot(const checked *p) {
    const char *plot = p->options->plot;
    if (plot && !has_extension(plot, ".svg") && !has_extension(plot, ".png"))
        return usage(p, "--plot %s: its extension tells no format; name it OUT.svg or OUT.png", plot);
    return CAMBER_EXIT_DONE;
}

int camber_options_check(camber_options *options, const char *verb, char *message, size_t message_size) {
    const checked it = {options, verb, message, message_size}, *p = &it;
    const bool writes = options->verb == CAMBER_VERB_RENDER || options->verb == CAMBER_VERB_TESSELLATE ||
                        options->verb == CAMBER_VERB_BENCH;
    if (options->verb == CAMBER_VERB_NONE)
        return usage(p, "no verb given; `camber --help` lists them");
    if (options->verb == CAMBER_VERB_STYLE)
        return check_style(p);
    int status = check_inputs(p);
    if (status == CAMBER_EXIT_DONE)
        status = check_view(p);
    if (status == CAMBER_EXIT_DONE)
        status = check_draw(p);
    if (status == CAMBER_EXIT_DONE && writes)
        status = check_output(p);
    if (status == CAMBER_EXIT_DONE)
        status = check_plot(p);
    if (status == CAMBER_EXIT_DONE && options->junit && strcmp(options->junit, "-") == 0)
        return usage(p, "--junit -: standard output is the report's; name a file");
    if (status == CAMBER_EXIT_DONE && options->dump && strcmp(options->dump, "-") == 0 && options->json)
        return usage(p, "--json and --dump -: both want standard output; give one of them");
    if (status == CAMBER_EXIT_DONE && camber_options_clash(options, message, message_size))
        return CAMBER_EXIT_USAGE;
    return status;
}
