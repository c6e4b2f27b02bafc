/* Runs `camber compare`: runs the comparison and prints its networks, metrics and averages, as a table or JSON. On
 * request the averages become a plot. */
#include "cli/plot.h"
#include "cli/verbs.h"

#include <math.h>
#include <string.h>

#define NAME_COLUMNS 28

/* ---- JSON ---- */

static json_t *number_json(double value, int decimals) {
    if (isnan(value))
        return json_null();
    return decimals == 0 && value == floor(value) ? json_integer((json_int_t)value) : json_real(value);
}

static json_t *metrics_json(const double *metrics) {
    json_t *object = json_object();
    for (int i = 0; i < CAMBER_METRIC_COUNT; i++) {
        const bool ms = i == CAMBER_METRIC_TESSELLATE_MS || i == CAMBER_METRIC_DRAW_MS;
        json_object_set_new(object, camber_metrics[i].key,
                            ms ? camber_json_ms(metrics[i]) : number_json(metrics[i], camber_metrics[i].decimals));
    }
    return object;
}

static json_t *row_json(const camber_comparison *c, const camber_comparison_row *row) {
    json_t *object = json_object(), *turns = json_object(), *methods = json_object();
    for (int i = 0; i < CAMBER_FIGURE_COUNT; i++) {
        const bool turn = i >= CAMBER_FIGURE_TURNS && i < CAMBER_FIGURE_TIGHT_JOINS;
        json_object_set_new(turn ? turns : object, camber_figures[i].key, number_json(row->figures[i], 0));
    }
    for (int i = 0; i < CAMBER_METHODS; i++)
        if (c->shown[i])
            json_object_set_new(methods, camber_method_get_name(camber_methods_shown[i]),
                                metrics_json(row->metrics[i]));
    json_object_set_new(object, "joins_by_turn_deg", turns);
    json_object_set_new(object, "methods", methods);
    return object;
}

/* Adds the position of the pixel with each method's maximum error. */
static void put_places(const camber_comparison *c, const camber_comparison_row *row, json_t *methods) {
    for (int i = 0; i < CAMBER_METHODS; i++) {
        const json_int_t at = (json_int_t)row->max_at[i], width = (json_int_t)c->networks.width;
        if (c->shown[i])
            json_object_set_new(json_object_get(methods, camber_method_get_name(camber_methods_shown[i])),
                                "max_error_at", json_pack("[I, I]", at % width, at / width));
    }
}

static json_t *ratios_json(const camber_comparison *c) {
    json_t *object = json_object();
    for (int i = 0; i < CAMBER_METHODS; i++) {
        json_t *ratios = json_object();
        for (int k = 0; k < CAMBER_METRIC_COUNT; k++) {
            const double ratio = camber_comparison_ratio(c, i, k);
            json_object_set_new(ratios, camber_metrics[k].key, isnan(ratio) ? json_null() : json_real(ratio));
        }
        json_object_set_new(object, camber_method_get_name(camber_methods_shown[i]), ratios);
    }
    return object;
}

static int print_json(const camber_comparison *c) {
    const camber_options *options = c->session->options;
    json_t *object =
        json_pack("{s:I, s:I, s:f, s:s, s:f, s:I}", "width", (json_int_t)c->networks.width, "height",
                  (json_int_t)c->networks.height, "line_width_px", c->networks.width_px, "coverage",
                  options->coverage == CAMBER_COVERAGE_EXACT ? "exact" : "linear", "fan_tolerance_px",
                  options->fan_tolerance_px > 0 ? options->fan_tolerance_px : 0.25, "runs", (json_int_t)options->runs);
    json_t *networks = json_array();
    if (!object || !networks)
        return camber_report_json(c->session->report, NULL);
    if (c->networks.features) {
        json_object_set_new(object, "longitude", json_real(c->networks.info.longitude));
        json_object_set_new(object, "latitude", json_real(c->networks.info.latitude));
        json_object_set_new(object, "zoom", json_real(c->networks.info.zoom));
    }
    camber_session_describe(c->session, object);
    for (size_t i = 0; i < c->networks.count; i++) {
        json_t *row = row_json(c, &c->rows[i]);
        put_places(c, &c->rows[i], json_object_get(row, "methods"));
        json_object_set_new(row, "name", camber_json_text(c->rows[i].name));
        json_array_append_new(networks, row);
    }
    json_object_set_new(object, "networks", networks);
    json_object_set_new(object, "average", row_json(c, &c->average));
    if (options->method < 0)
        json_object_set_new(object, "ratio_to_kite", ratios_json(c));
    json_object_set_new(object, "peak_rss_bytes", camber_json_count(camber_peak_rss_bytes()));
    return camber_report_json(c->session->report, object);
}

/* ---- A table ---- */

/* Prints a number right-aligned, with commas between thousands. */
static void put_number(double value, int decimals, int width) {
    printf("%*s", width, isnan(value) ? "-" : camber_figure_number(value, decimals).text);
}

/* The average of a count is printed with decimals if it is small. */
static int decimals_of(const camber_metric_info *info, double value) {
    return info->decimals == 0 && value != floor(value) && value < 1000 ? 1 : info->decimals;
}

static void put_name(const char *name, int width) {
    if ((int)strlen(name) > width)
        printf("%.*s...", width - 3, name);
    else
        printf("%-*s", width, name);
}

static int name_width(const camber_comparison *c) {
    size_t width = strlen(c->average.name);
    for (size_t i = 0; i < c->networks.count; i++)
        width = strlen(c->rows[i].name) > width ? strlen(c->rows[i].name) : width;
    return width < NAME_COLUMNS ? (int)width : NAME_COLUMNS;
}

/* Returns row i: a network, or, after the last of several networks, their average. */
static const camber_comparison_row *row_at(const camber_comparison *c, size_t i) {
    return i < c->networks.count ? &c->rows[i] : &c->average;
}

static size_t row_count(const camber_comparison *c) {
    return c->networks.count + (c->networks.count > 1);
}

static void print_figures(const camber_comparison *c, int width) {
    printf("\n%-*s", width, "network");
    for (int i = 0; i < CAMBER_FIGURE_COUNT; i++)
        printf("%*s", camber_figures[i].width, camber_figures[i].head);
    putchar('\n');
    for (size_t i = 0; i < row_count(c); i++) {
        const camber_comparison_row *row = row_at(c, i);
        put_name(row->name, width);
        for (int k = 0; k < CAMBER_FIGURE_COUNT; k++)
            put_number(row->figures[k], decimals_of(&camber_figures[k], row->figures[k]), camber_figures[k].width);
        putchar('\n');
    }
    puts("0-30 and so on: joins that turn by that many degrees; tight: the inner side has no room; split: past 127 "
         "degrees");
}

/* Prints metrics first to end - 1: one row for each network and method, then the ratios. */
static void print_metrics(const camber_comparison *c, int width, int first, int end) {
    printf("\n%-*s  %-7s", width, "network", "method");
    for (int k = first; k < end; k++)
        printf("%*s", camber_metrics[k].width, camber_metrics[k].head);
    putchar('\n');
    for (size_t i = 0; i < row_count(c); i++)
        for (int method = 0; method < CAMBER_METHODS; method++) {
            if (!c->shown[method])
                continue;
            const double *metrics = row_at(c, i)->metrics[method];
            put_name(row_at(c, i)->name, width);
            printf("  %-7s", camber_method_get_name(camber_methods_shown[method]));
            for (int k = first; k < end; k++)
                put_number(metrics[k], decimals_of(&camber_metrics[k], metrics[k]), camber_metrics[k].width);
            putchar('\n');
        }
    for (int method = 0; method < CAMBER_METHODS && c->session->options->method < 0; method++) {
        printf("%-*s  %-7s", width, method ? "" : "to one of kite's",
               camber_method_get_name(camber_methods_shown[method]));
        for (int k = first; k < end; k++)
            put_number(camber_comparison_ratio(c, method, k), 2, camber_metrics[k].width);
        putchar('\n');
    }
}

static int print_text(const camber_comparison *c) {
    const camber_compared_networks *networks = &c->networks;
    const camber_device_info device = camber_device_get_info(c->session->device);
    int width = name_width(c);
    width = width < 16 ? 16 : width;
    const bool in_gl = c->session->draw == CAMBER_RASTERIZER_GL;
    printf("%s; %s\n", device.name, in_gl ? camber_surface_get_info(c->session->surface).renderer : "drawn in OpenCL");
    printf("%u x %u px", networks->width, networks->height);
    if (networks->features)
        printf(" at zoom %.2f", networks->info.zoom);
    printf(", lines %g px wide, round joins, butt caps; runs: %u\n", networks->width_px, c->session->options->runs);
    print_figures(c, width);
    print_metrics(c, width, 0, CAMBER_METRIC_OF_PIXELS);
    puts("16-bit: batches of 65,535 vertices; times: medians, tess. is the kernels; error: mean absolute difference "
         "from 256\n"
         "samples a pixel, in 255ths, over the pixels that lines or picture touch; max: the largest");
    if (!in_gl) {
        puts("kernels draw the segments of every mesh in the same way, without its triangles: draw calls, fragments "
             "and\nrepeated pixels exist only in GL (--draw gl)");
        return camber_report_flush(c->session->report);
    }
    print_metrics(c, width, CAMBER_METRIC_OF_PIXELS, CAMBER_METRIC_COUNT);
    puts("fragments: shaded; drawn: pixels, once a polyline; repeated: more than once within a polyline; at plain, "
         "tight, split\n"
         "joins: by the two segments that meet, once a join; elsewhere: by no join, where a line comes back to itself");
    return camber_report_flush(c->session->report);
}

/* ---- The verb ---- */

int camber_verb_compare(camber_session *session) {
    const camber_options *options = session->options;
    camber_comparison c = {.session = session};
    camber_output plot = {0};
    int status = CAMBER_EXIT_DONE;
    if (options->plot)
        status = camber_output_open(&plot, session->report, session->guard, options->plot, options->force);
    if (status == CAMBER_EXIT_DONE && options->plot)
        status = camber_plot_check(session->report);
    if (status == CAMBER_EXIT_DONE)
        status = camber_comparison_run(&c, session);
    if (status == CAMBER_EXIT_DONE && options->plot)
        status = camber_plot_write(&c, &plot);
    if (status == CAMBER_EXIT_DONE && options->plot)
        status = camber_output_publish(&plot);
    if (status == CAMBER_EXIT_DONE)
        status = options->json ? print_json(&c) : print_text(&c);
    if (status == CAMBER_EXIT_DONE)
        camber_report_done(session->report, "compare", 0, camber_session_elapsed_ms(session),
                           "%s network%s of %u x %u px%s%s", camber_figure_count(c.networks.count).text,
                           camber_plural(c.networks.count), c.networks.width, c.networks.height,
                           options->plot ? ", plot in " : "", options->plot ? options->plot : "");
    camber_comparison_close(&c);
    camber_output_discard(&plot);
    return status;
}
