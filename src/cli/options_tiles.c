/* Checks the options of `camber tiles`, for its actions on archives and for drawing. */
#include "cli/options_table.h"

#include "cli/options_files.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

const char *camber_options_tiles_action(const camber_options *options) {
    static const char *const actions[] = {"show", "verify", "merge"};
    for (size_t i = 0; options->input_count && i < sizeof actions / sizeof *actions; i++)
        if (strcmp(options->inputs[0], actions[i]) == 0)
            return actions[i];
    return NULL;
}

static int check_archive_name(const camber_option_reader *p) {
    const char *output = p->options->output;
    if (camber_path_ends_with(output, ".pmtiles") || camber_path_ends_with(output, ".mbtiles") ||
        camber_path_ends_with(output, "/"))
        return CAMBER_EXIT_DONE;
    char blame[64];
    camber_path_blame_extension(output, blame);
    return camber_options_refuse(p, "%s: %s; name it OUT.pmtiles, OUT.mbtiles, or OUT/ for a folder", output, blame);
}

/* ---- show, verify, merge ---- */

/* Returns the first given option that applies only to drawing; NULL if there is none. */
static const char *find_drawing(const camber_options *options) {
    static const char *const all[] = {"output", "force", "json", "quiet", "verbose", "help", "version"};
    for (size_t i = 0; i < camber_option_count; i++) {
        bool taken = !options->given[i];
        for (size_t k = 0; k < sizeof all / sizeof *all; k++)
            taken = taken || strcmp(camber_option_specs[i].name, all[k]) == 0;
        if (!taken)
            return camber_option_specs[i].name;
    }
    return NULL;
}

static int check_action(const camber_option_reader *p, const char *action) {
    const camber_options *options = p->options;
    const bool merges = strcmp(action, "merge") == 0;
    const char *drawing = find_drawing(options);
    if (drawing)
        return camber_options_refuse(p, "--%s: applies only to drawing tiles, and tiles %s draws none; leave it out",
                                     drawing, action);
    if (options->input_count == 1)
        return camber_options_refuse(p, "tiles %s: no archive; give one, as in city.pmtiles", action);
    if (!merges && options->input_count > 2)
        return camber_options_refuse(p, "%s: tiles %s takes one archive; leave out the others", options->inputs[2],
                                     action);
    if (!merges && (options->output || options->force))
        return camber_options_refuse(p, "tiles %s: writes nothing; leave out %s", action,
                                     options->output ? "-o" : "--force");
    if (!merges)
        return CAMBER_EXIT_DONE;
    if (options->json)
        return camber_options_refuse(p, "tiles merge: prints nothing; leave out --json");
    if (!options->output || !*options->output)
        return camber_options_refuse(p, "tiles merge: no output; give -o OUT.pmtiles");
    if (check_archive_name(p) != CAMBER_EXIT_DONE)
        return CAMBER_EXIT_USAGE;
    return camber_options_clash(options, p->message, p->message_size) ? CAMBER_EXIT_USAGE : CAMBER_EXIT_DONE;
}

/* ---- Drawing ---- */

static int check_zooms(const camber_option_reader *p) {
    camber_options *options = p->options;
    options->has_zooms = options->min_zoom != UINT32_MAX || options->max_zoom != UINT32_MAX;
    if (options->place_count && options->has_zooms && !options->renewed)
        return camber_options_refuse(p, "--tile: each tile includes its zoom; leave out --min-zoom and --max-zoom");
    if (options->min_zoom == UINT32_MAX)
        options->min_zoom = 0;
    if (options->max_zoom == UINT32_MAX)
        options->max_zoom = options->min_zoom > 14 ? options->min_zoom : 14;
    if (options->min_zoom > options->max_zoom)
        return camber_options_refuse(p, "--min-zoom %u: is greater than --max-zoom %u; swap them", options->min_zoom,
                                     options->max_zoom);
    return CAMBER_EXIT_DONE;
}

static int check_encoding(const camber_option_reader *p) {
    camber_options *options = p->options;
    if (options->format < 0)
        options->format = CAMBER_FORMAT_PNG;
    if (camber_format_is_vector(options->format))
        return camber_options_refuse(p, "--format: tiles are png, png8, webp or glb; give one of them");
    if (options->format == CAMBER_FORMAT_GLB && options->keep_empty)
        return camber_options_refuse(p, "--keep-empty: an empty mesh tile has no background to keep; leave it out");
#ifndef CAMBER_MESHOPT
    if (options->format == CAMBER_FORMAT_GLB)
        return camber_options_refuse(p, "--format glb: this build writes no mesh tiles (CAMBER_MESHOPT); build it with "
                                        "meshoptimizer, or choose png");
#endif
    if (!camber_encoding_is_built(camber_format_encoding(options->format)))
        return camber_options_refuse(
            p, "--format webp: this build writes no WebP (CAMBER_WEBP); build it with libwebp, or choose png");
    if (options->quality && options->format != CAMBER_FORMAT_WEBP)
        return camber_options_refuse(p, "--quality: applies only to WebP; leave it out, or give --format webp");
    const double tile_px = (options->tile_size == 1 ? 512 : 256) * options->view.ratio;
    if (tile_px < 63.5 || tile_px > 2048.4)
        return camber_options_refuse(p, "--ratio %g: gives tiles of %.0f px; choose one that gives 64 to 2048",
                                     options->view.ratio, tile_px);
    return CAMBER_EXIT_DONE;
}

/* Sets the view for which a style's own sources are read: once, at the highest zoom. Lower zooms are drawn from the
 * same lines. */
static void set_view(camber_options *options) {
    static const double WIDEST_PX = 30000.0;
    camber_view_desc *view = &options->view;
    const double zoom = options->max_zoom - (options->tile_size == 1 ? 0.0 : 1.0);
    const double degrees = view->east > view->west ? view->east - view->west : view->east - view->west + 360.0;
    const double side = fmin(degrees / 360.0 * 512.0 * exp2(zoom), WIDEST_PX / view->ratio);
    view->kind = options->has_bbox ? CAMBER_VIEW_BBOX : CAMBER_VIEW_FIT;
    view->width = view->height = options->has_bbox ? (uint32_t)fmax(side, 256.0) : 1024;
    view->zoom = view->bearing_deg = view->pitch_deg = 0.0;
}

/* A schedule is identified by the files that it was made from. */
static int check_schedule(const camber_option_reader *p) {
    const camber_options *options = p->options;
    if (!options->schedule)
        return CAMBER_EXIT_DONE;
    if (options->renewed)
        return camber_options_refuse(
            p, "--schedule and --renew: cannot be combined, because --renew looks up the lines itself; leave out one");
    if (options->shard && options->dry_run)
        return camber_options_refuse(p, "--schedule and --shard: a dry run makes the schedule of all shards; leave out "
                                        "--shard");
    if (!options->input_count)
        return camber_options_refuse(
            p, "--schedule: works only with INPUT files, not with a style's own sources; name an INPUT");
    for (size_t i = 0; i < options->input_count; i++)
        if (strcmp(options->inputs[i], "-") == 0 || strncmp(options->inputs[i], "/vsi", 4) == 0)
            return camber_options_refuse(p,
                                         "--schedule: %s is not a regular file, so later runs could not tell whether "
                                         "it has changed; copy it to one",
                                         options->inputs[i]);
    return CAMBER_EXIT_DONE;
}

static int check_run(const camber_option_reader *p) {
    const camber_options *options = p->options;
    if (options->label_record && (options->shard || options->schedule))
        return camber_options_refuse(p,
                                     "--label-record and --%s: cannot be combined, because a part of a run does not "
                                     "place the labels of all; leave out one",
                                     options->shard ? "shard" : "schedule");
    if (options->label_record && (options->no_labels || options->format == CAMBER_FORMAT_GLB))
        return camber_options_refuse(p, "--label-record: the tiles have no labels; leave it out");
    if (options->renewed && (options->shard || options->resume || options->force || options->dry_run))
        return camber_options_refuse(
            p,
            "--renew and --%s: cannot be combined, because --renew changes an existing archive in place; leave out one",
            options->shard    ? "shard"
            : options->resume ? "resume"
            : options->force  ? "force"
                              : "dry-run");
    if (options->shards && (!options->shard || strcmp(options->shard, "auto") != 0))
        return camber_options_refuse(p, "--shards %u: applies only to --shard auto; give --shard auto, or --shard K/%u",
                                     options->shards, options->shards);
    return CAMBER_EXIT_DONE;
}

/* Whether the first input is more likely a mistyped action of tiles: a bare word that is not a file. */
static bool is_mistyped(const camber_options *options) {
    const char *first = options->input_count ? options->inputs[0] : "";
    return *first && !strpbrk(first, "./:-") && access(first, F_OK) != 0;
}

int camber_options_check_tiles(camber_options *options, char *message, size_t message_size) {
    const camber_option_reader it = {options, message, message_size, NULL}, *p = &it;
    const char *action = camber_options_tiles_action(options);
    if (action)
        return check_action(p, action);
    if (!options->input_count && !options->style)
        return camber_options_refuse(
            p, "tiles: no input; give a file with lines, such as city.osm.pbf, or show FILE, verify FILE or "
               "merge PART... -o OUT");
    if (is_mistyped(options))
        return camber_options_refuse(p, "%s: no such file, and no such verb of tiles; it is one of show, verify, merge",
                                     options->inputs[0]);
    if (!options->output || !*options->output)
        return camber_options_refuse(p, "tiles: no output; give -o OUT.pmtiles");
    int status = check_archive_name(p);
    if (status == CAMBER_EXIT_DONE)
        status = check_zooms(p);
    if (status == CAMBER_EXIT_DONE)
        status = check_encoding(p);
    if (status == CAMBER_EXIT_DONE)
        status = check_run(p);
    if (status == CAMBER_EXIT_DONE)
        status = check_schedule(p);
    if (status == CAMBER_EXIT_DONE)
        set_view(options);
    return status;
}
