/* Checks the options of print, and decides how large the sheet is.
 *
 * A picture is on a sheet if --paper is given, or if it is PDF or SVG. */
#include "cli/options_table.h"

#ifdef CAMBER_MAP
#include "camber_print.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A margin of this part of the sheet's shorter side, unless --margin is given. */
static const double MARGIN_SHARE = 0.04;
static const double MM_PER_INCH = 25.4, USUAL_DPI = 300.0;

/* Parses WIDTHxHEIGHTmm. */
static bool parse_sheet(const char *text, double mm[2]) {
    char sides[2][16], *rest;
    int end = 0;
    if (sscanf(text, "%15[0-9.]%*1[xX]%15[0-9.]%n", sides[0], sides[1], &end) < 2)
        return false;
    for (size_t i = 0; i < 2; i++) {
        mm[i] = strtod(sides[i], &rest);
        if (*rest || !(mm[i] >= 10.0 && mm[i] <= 20000.0))
            return false;
    }
    return !text[end] || strcmp(text + end, "mm") == 0;
}

static bool is_given(const camber_options *options, const char *name) {
    for (size_t i = 0; i < camber_option_count; i++)
        if (strcmp(camber_option_specs[i].name, name) == 0)
            return options->given[i];
    return false;
}

/* Returns the first given option that needs a sheet. */
static const char *find_sheet_option(const camber_options *options) {
    static const char *const all[] = {"landscape", "margin", "title", "subtitle", "scale-bar", "north-arrow", "grid"};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (is_given(options, all[i]))
            return all[i];
    return NULL;
}

static int check_sheet(const camber_option_reader *p, double mm[2]) {
    const camber_options *options = p->options;
    const bool sized = is_given(options, "size");
    if (options->paper && sized)
        return camber_options_refuse(p, "--paper and --size: both set the size; give one of them");
    if (options->paper && !camber_paper_find(options->paper, mm, mm + 1) && !parse_sheet(options->paper, mm))
        return camber_options_refuse(
            p,
            "--paper %s: not a size of paper; give A0 to A6, B0 to B6, Letter, Legal, Tabloid, "
            "or millimetres, as in 600x900mm",
            options->paper);
    if (!options->paper && !sized)
        (void)camber_paper_find("A4", mm, mm + 1);
    if (sized) {
        mm[0] = options->view.width * MM_PER_INCH / CAMBER_CSS_PX_PER_INCH;
        mm[1] = options->view.height * MM_PER_INCH / CAMBER_CSS_PX_PER_INCH;
        if (!(fmin(mm[0], mm[1]) >= 10.0))
            return camber_options_refuse(p, "--size %ux%u: as a page these are %.1f x %.1f mm, and 10 mm are the least",
                                         options->view.width, options->view.height, mm[0], mm[1]);
    }
    if (options->landscape && mm[0] < mm[1]) {
        const double width = mm[0];
        mm[0] = mm[1];
        mm[1] = width;
    }
    return CAMBER_EXIT_DONE;
}

/* Sets the picture's size as the page will lay it out, without its margin: the page is not made yet. */
static int set_size(const camber_option_reader *p, const double mm[2]) {
    camber_options *options = p->options;
    camber_view_desc *view = &options->view;
    const double width = round(mm[0] / MM_PER_INCH * options->dpi), height = round(mm[1] / MM_PER_INCH * options->dpi);
    if (!(width >= 1.0 && height >= 1.0 && width <= 65535.0 && height <= 65535.0 && width * height <= 2147483648.0))
        return camber_options_refuse(p,
                                     "--dpi %g: on %g x %g mm these are %.0f x %.0f px; each side may have 1 to 65535, "
                                     "and the picture 2^31 in all",
                                     options->dpi, mm[0], mm[1], width, height);
    if (!is_given(options, "ratio"))
        view->ratio = options->dpi / CAMBER_CSS_PX_PER_INCH;
    view->width = (uint32_t)fmax(floor(width / view->ratio), 1.0);
    view->height = (uint32_t)fmax(floor(height / view->ratio), 1.0);
    options->paper_width_mm = mm[0];
    options->paper_height_mm = mm[1];
    return CAMBER_EXIT_DONE;
}

int camber_options_check_page(camber_options *options, char *message, size_t message_size) {
    const camber_option_reader it = {options, message, message_size, "render"}, *p = &it;
    const bool on_sheet = options->paper || camber_format_is_vector(options->format);
    const char *needs = find_sheet_option(options);
    if (options->fit >= 0 && options->view.kind == CAMBER_VIEW_CENTER)
        return camber_options_refuse(p, "--fit: --center and --zoom already say what is shown; leave it out");
    options->view.cover = options->fit == 1;
    if (!on_sheet && needs)
        return camber_options_refuse(p, "--%s: needs a sheet; give --paper A4, or name the output OUT.pdf", needs);
    if (!on_sheet)
        return CAMBER_EXIT_DONE;
    if (!camber_page_is_built())
        return camber_options_refuse(
            p, "%s%s: this build cannot print (CAMBER_CAIRO); build it with Cairo, or draw a PNG without --paper",
            options->paper ? "--paper " : "", options->paper ? options->paper : options->output);
    double mm[2] = {0.0, 0.0};
    int status = check_sheet(p, mm);
    if (status != CAMBER_EXIT_DONE)
        return status;
    const bool sized = !options->paper && is_given(options, "size");
    if (isnan(options->margin_mm))
        options->margin_mm = sized && !options->title && !options->subtitle ? 0.0 : MARGIN_SHARE * fmin(mm[0], mm[1]);
    if (isnan(options->dpi))
        options->dpi = USUAL_DPI;
    if (options->margin_mm * 2.0 >= fmin(mm[0], mm[1]))
        return camber_options_refuse(p, "--margin %g: leaves nothing of %g x %g mm; choose a smaller one",
                                     options->margin_mm, mm[0], mm[1]);
    if (options->fit < 0)
        options->view.cover = options->view.kind == CAMBER_VIEW_FIT;
    return set_size(p, mm);
}

#else

int camber_options_check_page(camber_options *options, char *message, size_t message_size) {
    (void)options;
    (void)message;
    (void)message_size;
    return CAMBER_EXIT_DONE;
}

#endif
