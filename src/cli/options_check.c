/* Checks the options together, after each has been parsed: which ones exclude each other, which ones need another, and
 * that no file is both read and written. The first rule that is broken produces one line: the option, the reason and
 * the cure. */
#include "cli/input.h"
#include "cli/options.h"
#include "cli/options_files.h"
#include "cli/options_table.h"

#include <math.h>
#include <string.h>

static bool ships(const char *style) {
#ifdef CAMBER_MAP
    return camber_input_ships(style);
#else
    return style == NULL;
#endif
}

static const struct {
    const char *name, *extension;
} formats[] = {[CAMBER_FORMAT_PNG] = {"png", ".png"},    [CAMBER_FORMAT_PNG8] = {"png8", ".png"},
               [CAMBER_FORMAT_WEBP] = {"webp", ".webp"}, [CAMBER_FORMAT_GLB] = {"glb", ".glb"},
               [CAMBER_FORMAT_PDF] = {"pdf", ".pdf"},    [CAMBER_FORMAT_SVG] = {"svg", ".svg"}};

enum { FORMAT_COUNT = sizeof formats / sizeof *formats };

/* Checks the picture that will be written. Its format is known. */
static int check_picture(const camber_option_reader *p) {
    const camber_options *options = p->options;
    const camber_encoding encoding = camber_format_encoding(options->format);
    const uint32_t longest = camber_encoding_get_longest_side(encoding);
    const double width = floor(options->view.width * options->view.ratio + 0.5);
    const double height = floor(options->view.height * options->view.ratio + 0.5);
    const char *name = formats[options->format].name;
    if (camber_format_is_vector(options->format))
        return options->quality
                   ? camber_options_refuse(p, "--quality: applies only to WebP, but %s is %s; leave it out",
                                           options->output, name)
                   : CAMBER_EXIT_DONE;
    if (!camber_encoding_is_built(encoding))
        return camber_options_refuse(
            p, "%s: this build writes no WebP (CAMBER_WEBP); build it with libwebp, or name it OUT.png",
            options->output);
    if (options->quality && options->format != CAMBER_FORMAT_WEBP)
        return camber_options_refuse(
            p, "--quality: applies only to WebP, but %s is %s; leave it out, or name the output OUT.webp",
            options->output, name);
    if (width > longest || height > longest)
        return camber_options_refuse(
            p, "%s: %.0f x %.0f px, but each side of a WebP is at most %u; draw a smaller picture, or a PNG",
            options->output, width, height, longest);
    if (options->format != CAMBER_FORMAT_PNG && width * height > CAMBER_PIXELS_MOST)
        return camber_options_refuse(
            p, "%s: %.0f x %.0f px, but a picture of the format %s has at most %d pixels; draw a smaller one, or a PNG",
            options->output, width, height, name, CAMBER_PIXELS_MOST);
    return CAMBER_EXIT_DONE;
}

/* Determines the format from the extension if --format is not given. If both are given, they must agree. */
static int check_format(const camber_option_reader *p, bool out) {
    camber_options *options = p->options;
    const bool glb = options->verb == CAMBER_VERB_TESSELLATE, renders = options->verb == CAMBER_VERB_RENDER;
    const char *pictures = options->verb == CAMBER_VERB_BENCH ? "png, png8 and webp" : "png, png8, webp, pdf and svg";
    int named = -1; /* the format of the extension */
    for (int i = FORMAT_COUNT - 1; i >= 0; i--)
        if (!out && camber_path_ends_with(options->output, formats[i].extension))
            named = i;
    const int format = options->format >= 0 ? options->format
                       : named >= 0         ? named
                       : out && glb         ? CAMBER_FORMAT_GLB
                       : out                ? CAMBER_FORMAT_PNG
                                            : -1;
    if (format < 0) {
        char blame[64];
        camber_path_blame_extension(options->output, blame);
        return camber_options_refuse(p, "%s: %s; camber %s writes %s: name it OUT.%s, or give --format",
                                     options->output, blame, p->verb, glb ? "glb" : pictures, glb ? "glb" : "png");
    }
    const bool wrong = (format == CAMBER_FORMAT_GLB) != glb || (named >= 0 && (named == CAMBER_FORMAT_GLB) != glb);
    if (wrong)
        return camber_options_refuse(p, "%s: %s writes %s; use camber %s to write %s", options->output, p->verb,
                                     glb ? "glb" : pictures, glb ? "render" : "tessellate", glb ? pictures : "glb");
    if (named >= 0 && strcmp(formats[named].extension, formats[format].extension) != 0)
        return camber_options_refuse(
            p, "%s: its extension means %s, but --format is %s; name it OUT%s, or leave out --format", options->output,
            formats[named].name, formats[format].name, formats[format].extension);
    options->format = format;
    if (camber_format_is_vector(format) && !renders)
        return camber_options_refuse(p, "%s: camber %s writes %s; use camber render to write %s", options->output,
                                     p->verb, pictures, formats[format].name);
    if (renders && camber_options_check_page(options, p->message, p->message_size) != CAMBER_EXIT_DONE)
        return CAMBER_EXIT_USAGE;
    return glb ? CAMBER_EXIT_DONE : check_picture(p);
}

static int check_output(const camber_option_reader *p) {
    const camber_options *options = p->options;
    if (!options->output && options->verb != CAMBER_VERB_BENCH)
        return camber_options_refuse(p, "%s: no output; give -o OUT.%s", p->verb,
                                     options->verb == CAMBER_VERB_TESSELLATE ? "glb" : "png");
    if (!options->output)
        return CAMBER_EXIT_DONE;
    const bool out = strcmp(options->output, "-") == 0;
    if (out && options->json)
        return camber_options_refuse(p, "--json and -o -: both write to standard output; give only one of them");
    if (options->dump && strcmp(options->dump, "-") == 0 && out)
        return camber_options_refuse(p, "--dump - and -o -: both write to standard output; give only one of them");
    return check_format(p, out);
}

static int check_view(const camber_option_reader *p) {
    camber_options *options = p->options;
    camber_view_desc *view = &options->view;
    if (options->has_bbox && (options->has_center || !isnan(options->zoom)))
        return camber_options_refuse(
            p, "--bbox and --center or --zoom: cannot be combined; give the box, or the centre and zoom");
    /* if the style's own sources are drawn, the style supplies the missing one */
    const bool own = options->style && options->input_count == 0;
    if (!own && options->has_center != !isnan(options->zoom))
        return camber_options_refuse(
            p, "--%s: does not make a view by itself; give --center LON,LAT and --zoom Z together",
            options->has_center ? "center" : "zoom");
    const bool tilts = options->verb == CAMBER_VERB_RENDER || options->verb == CAMBER_VERB_BENCH;
    if (options->pitch_deg > 0 && !tilts)
        return camber_options_refuse(
            p, "--pitch %g: camber %s works in the plane of the map, without a pitch; leave it out", options->pitch_deg,
            p->verb);
    view->kind = options->has_bbox ? CAMBER_VIEW_BBOX : options->has_center ? CAMBER_VIEW_CENTER : CAMBER_VIEW_FIT;
    view->zoom = isnan(options->zoom) ? 0 : options->zoom;
    view->bearing_deg = isnan(options->bearing_deg) ? 0 : options->bearing_deg;
    view->pitch_deg = isnan(options->pitch_deg) ? 0 : options->pitch_deg;
    if (view->width == 0)
        view->width = view->height = options->polylines ? 2048 : 1024;
    return CAMBER_EXIT_DONE;
}

/* A sheet has set the view's size before this. */
static int check_px(const camber_option_reader *p) {
    const camber_view_desc *view = &p->options->view;
    const double width = floor(view->width * view->ratio + 0.5);
    const double height = floor(view->height * view->ratio + 0.5);
    if (width < 1 || height < 1 || width > 65535 || height > 65535 || width * height > 2147483648.0)
        return camber_options_refuse(p,
                                     "%ux%u at ratio %g: out of range; times --ratio, each side must be 1 to 65535 px, "
                                     "and the picture at most 2^31",
                                     view->width, view->height, view->ratio);
    return CAMBER_EXIT_DONE;
}

static int check_inputs(const camber_option_reader *p) {
    const camber_options *options = p->options;
    const char *verb = p->verb;
#ifndef CAMBER_MAP
    if (options->input_count)
        return camber_options_refuse(p, "%s: this build reads no maps (CAMBER_MAP=OFF); give --polylines FILE",
                                     options->inputs[0]);
#endif
    if (options->verb == CAMBER_VERB_INFO && options->input_count)
        return camber_options_refuse(p, "%s: info takes no input; leave it out", options->inputs[0]);
    if (options->polylines && options->input_count)
        return camber_options_refuse(p, "--polylines and %s: both are inputs; give one of them", options->inputs[0]);
    if (options->polylines &&
        (options->style || options->theme >= 0 || options->layer || options->where || options->has_bbox ||
         options->has_center || !isnan(options->bearing_deg) || !isnan(options->pitch_deg)))
        return camber_options_refuse(
            p, "--polylines: the file is in pixels and has no style, layer or view; leave out the options for those");
    if (options->where_count > 1 && options->verb != CAMBER_VERB_COMPARE)
        return camber_options_refuse(p, "--where: given %zu times; camber %s takes one, so join them with AND or OR",
                                     options->where_count, verb);
    if (options->width_px > 0 && !options->polylines && options->verb != CAMBER_VERB_COMPARE)
        return camber_options_refuse(p, "--width-px: applies only to --polylines; the style sets the widths of a map");
    if (options->style && options->theme >= 0 && !ships(options->style))
        return camber_options_refuse(p, "--theme: applies only to the built-in styles; leave it out with --style %s",
                                     options->style);
    if (options->style && options->input_count == 0 && (options->layer || options->where))
        return camber_options_refuse(p,
                                     "--%s: applies only to INPUT, but this run draws the style's own sources; use the "
                                     "filters of its layers instead",
                                     options->layer ? "layer" : "where");
    size_t streams = options->polylines && strcmp(options->polylines, "-") == 0;
    for (size_t i = 0; i < options->input_count; i++)
        streams += strcmp(options->inputs[i], "-") == 0;
    streams += options->style && strcmp(options->style, "-") == 0;
    if (streams > 1)
        return camber_options_refuse(p, "-: standard input can be read only once; name a file for the other one");
    const bool takes_both = options->verb == CAMBER_VERB_COMPARE || options->verb == CAMBER_VERB_BENCH;
    const bool needs = options->verb != CAMBER_VERB_INFO && options->verb != CAMBER_VERB_VALIDATE;
    if (needs && !options->input_count && !options->polylines && !options->style)
        return camber_options_refuse(p, "%s: no input; give %s", verb,
                                     takes_both ? "a file with lines or --polylines FILE"
                                                : "a file with lines, such as city.osm.pbf");
    return CAMBER_EXIT_DONE;
}

/* Checks style SUBCOMMAND FILE. */
static int check_style(const camber_option_reader *p) {
    const camber_options *options = p->options;
    if (options->input_count == 0 ||
        (strcmp(options->inputs[0], "check") != 0 && strcmp(options->inputs[0], "eval") != 0))
        return camber_options_refuse(p, "style: %s%s; write camber style check FILE or camber style eval FILE",
                                     options->input_count ? "no such action: " : "no action",
                                     options->input_count ? options->inputs[0] : "");
    if (options->input_count == 1)
        return camber_options_refuse(p, "style %s: no file; give one, or - for standard input", options->inputs[0]);
    if (options->input_count > 2)
        return camber_options_refuse(p, "%s: style %s takes one file; leave out the others", options->inputs[2],
                                     options->inputs[0]);
    return CAMBER_EXIT_DONE;
}

/* With --draw cl no GL library is loaded, so an option that selects a part of GL would have no effect. */
static int check_draw(const camber_option_reader *p) {
    const camber_options *options = p->options;
    const bool named = options->backend != CAMBER_BACKEND_AUTO;
    if (options->draw != CAMBER_RASTERIZER_OPENCL || (!named && options->sharing == CAMBER_SHARING_AUTO))
        return CAMBER_EXIT_DONE;
    return camber_options_refuse(p,
                                 "--draw cl and --%s: cannot be combined, because OpenCL kernels draw without GL; "
                                 "leave out --%s, or give --draw gl",
                                 named ? "backend" : "sharing", named ? "backend" : "sharing");
}

static int check_plot(const camber_option_reader *p) {
    const char *plot = p->options->plot;
    char blame[64];
    if (!plot || camber_path_ends_with(plot, ".svg") || camber_path_ends_with(plot, ".png"))
        return CAMBER_EXIT_DONE;
    camber_path_blame_extension(plot, blame);
    return camber_options_refuse(p, "--plot %s: %s; name it OUT.svg or OUT.png", plot, blame);
}

int camber_options_check(camber_options *options, const char *verb, char *message, size_t message_size) {
    const camber_option_reader it = {options, message, message_size, verb}, *p = &it;
    const bool writes = options->verb == CAMBER_VERB_RENDER || options->verb == CAMBER_VERB_TESSELLATE ||
                        options->verb == CAMBER_VERB_BENCH;
    if (options->verb == CAMBER_VERB_NONE)
        return camber_options_refuse(p, "no verb given; `camber --help` lists them");
    if (options->verb == CAMBER_VERB_STYLE)
        return check_style(p);
    int status = CAMBER_EXIT_DONE;
    if (options->verb == CAMBER_VERB_TILES) {
        status = camber_options_check_tiles(options, message, message_size);
        if (status != CAMBER_EXIT_DONE || camber_options_tiles_action(options))
            return status;
    }
    if (options->verb == CAMBER_VERB_SERVE) {
        status = camber_options_check_serve(options, message, message_size);
        if (status != CAMBER_EXIT_DONE)
            return status;
    }
    status = check_inputs(p);
    if (status == CAMBER_EXIT_DONE && options->verb != CAMBER_VERB_TILES && options->verb != CAMBER_VERB_SERVE)
        status = check_view(p);
    if (status == CAMBER_EXIT_DONE)
        status = check_draw(p);
    if (status == CAMBER_EXIT_DONE && writes)
        status = check_output(p);
    if (status == CAMBER_EXIT_DONE && options->verb != CAMBER_VERB_TILES && options->verb != CAMBER_VERB_SERVE)
        status = check_px(p);
    if (status == CAMBER_EXIT_DONE)
        status = check_plot(p);
    if (status == CAMBER_EXIT_DONE && options->junit && strcmp(options->junit, "-") == 0)
        return camber_options_refuse(p, "--junit -: the report already goes to standard output; name a file");
    if (status == CAMBER_EXIT_DONE && options->dump && strcmp(options->dump, "-") == 0 && options->json)
        return camber_options_refuse(p, "--json and --dump -: both write to standard output; give only one of them");
    if (status == CAMBER_EXIT_DONE && camber_options_clash(options, message, message_size))
        return CAMBER_EXIT_USAGE;
    return status;
}
