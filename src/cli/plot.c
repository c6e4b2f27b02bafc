/* Draws the averages of a comparison as a bar chart: writes a script and runs gnuplot, which writes an SVG or PNG to
 * the output. Errors of gnuplot are reported in one line. */
#define _XOPEN_SOURCE 700 /* posix_spawn */

#include "cli/plot.h"

#include "base/whole_file.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* ---- A child process ---- */

typedef struct child {
    pid_t process;
    int input, errors; /* pipes to its standard input, from its standard error */
} child;

static bool open_pipe(int ends[2]) {
    return pipe(ends) == 0 && fcntl(ends[0], F_SETFD, FD_CLOEXEC) == 0 && fcntl(ends[1], F_SETFD, FD_CLOEXEC) == 0;
}

/* Starts gnuplot with the default handling of signals. Returns 0 or an errno. */
static int spawn(char *const *arguments, int output, child *made) {
    int input[2] = {-1, -1}, errors[2] = {-1, -1};
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    sigset_t none, ignored;
    sigemptyset(&none);
    sigemptyset(&ignored);
    sigaddset(&ignored, SIGPIPE);
    sigaddset(&ignored, SIGXFSZ);
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
    int cause = open_pipe(input) && open_pipe(errors) ? 0 : errno;
    if (cause == 0) {
        posix_spawn_file_actions_adddup2(&files, input[0], STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&files, errors[1], STDERR_FILENO);
        posix_spawnattr_setsigmask(&attributes, &none);
        posix_spawnattr_setsigdefault(&attributes, &ignored);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
        cause = posix_spawnp(&made->process, arguments[0], &files, &attributes, arguments, environ);
    }
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    const int unused[] = {input[0], errors[1], cause ? input[1] : -1, cause ? errors[0] : -1};
    for (int i = 0; i < 4; i++)
        if (unused[i] >= 0)
            close(unused[i]);
    made->input = input[1];
    made->errors = errors[0];
    return cause;
}

static void send(int descriptor, const char *text) {
    for (size_t left = strlen(text); left > 0;) {
        const ssize_t written = write(descriptor, text, left);
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            return; /* gnuplot has ended; its exit status says why */
        text += written;
        left -= (size_t)written;
    }
}

/* Sends the script to the child and waits for its end. The script fits into the pipe, so neither waits for the other.
 * line receives the first line that the child prints on standard error. Returns the child's exit status; -1 if a signal
 * ended it. */
static int finish(const child *made, const char *script, char *line, size_t line_size) {
    send(made->input, script);
    close(made->input);
    char block[512];
    size_t used = 0;
    for (ssize_t size; (size = read(made->errors, block, sizeof block)) != 0;) {
        if (size < 0 && errno != EINTR)
            break;
        for (ssize_t i = 0; i < size && used + 1 < line_size; i++)
            if (used > 0 || !strchr(" \t\r\n", block[i]))
                line[used++] = block[i];
    }
    line[used] = 0;
    line[strcspn(line, "\r\n")] = 0;
    close(made->errors);
    int status = 0;
    while (waitpid(made->process, &status, 0) < 0 && errno == EINTR)
        ;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int camber_plot_check(camber_report *report) {
    char program[] = "gnuplot", version[] = "--version", line[256] = "";
    char *const arguments[] = {program, version, NULL};
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    child made;
    const int cause = nowhere < 0 ? errno : spawn(arguments, nowhere, &made);
    const int status = cause ? -1 : finish(&made, "", line, sizeof line);
    if (nowhere >= 0)
        close(nowhere);
    if (cause)
        return camber_report_fail(report, CAMBER_EXIT_UNAVAILABLE, "gnuplot: %s, and --plot draws with it; %s",
                                  strerror(cause), camber_file_cure(cause, "apt install gnuplot-nox"));
    if (status != 0)
        return camber_report_fail(report, CAMBER_EXIT_UNAVAILABLE,
                                  "gnuplot: does not run (%s), and --plot draws with it; apt install gnuplot-nox",
                                  line[0] ? line : "it says nothing");
    return CAMBER_EXIT_DONE;
}

/* ---- The script ---- */

typedef struct panel {
    int metric;
    const char *title;
} panel;

enum { COLUMNS = 4, ROWS = 2 };
static const panel panels[COLUMNS * ROWS] = {
    {CAMBER_METRIC_VERTICES, "vertices"},
    {CAMBER_METRIC_BYTES, "bytes"},
    {CAMBER_METRIC_DRAW_CALLS_16_BIT, "draw calls, 16-bit indices"},
    {CAMBER_METRIC_FRAGMENTS, "fragments shaded"},
    {CAMBER_METRIC_REPEATED_PIXELS, "repeated pixels"},
    {CAMBER_METRIC_MEAN_ERROR, "mean error, of 255"},
    {CAMBER_METRIC_TESSELLATE_MS, "kernels, ms"},
    {CAMBER_METRIC_DRAW_MS, "drawing, ms"},
};

/* Grey, orange and blue: distinguishable in print and with colour blindness. */
static const char *const colors[CAMBER_METHODS] = {"0x98a1ad", "0xe69f00", "0x0072b2"};

/* Writes "1.23 M", "45.6 k" or "7.89": three digits, and no decimals for a small whole number. */
static void abbreviate(double value, char *text, size_t size) {
    const char *const units[] = {"", " k", " M", " G"};
    const bool whole = value < 999.5 && value == floor(value);
    int unit = 0;
    for (; value >= 999.5 && unit < 3; unit++)
        value /= 1000;
    const int decimals = whole || value >= 99.95 ? 0 : value >= 9.995 ? 1 : 2;
    snprintf(text, size, "%.*f%s", decimals, value, units[unit]);
}

static void put_panel(const camber_comparison *c, const panel *p, FILE *script) {
    double most = 0;
    int bars = 0;
    fputs("$bars << END\n", script);
    for (int i = 0; i < CAMBER_METHODS; i++) {
        const double metric = c->average.metrics[i][p->metric], value = isnan(metric) ? 0 : metric;
        char text[32] = "only in GL";
        if (!c->shown[i])
            continue;
        if (!isnan(metric))
            abbreviate(value, text, sizeof text);
        fprintf(script, "%d %.9g %s \"%s\" \"%s\"\n", -bars++, value, colors[i],
                camber_method_get_name(camber_methods_shown[i]), text);
        most = value > most ? value : most;
    }
    fprintf(script,
            "END\nset label 2 '%s' at graph 0,1.13 left font ',14'\nset xrange [0:%.9g]\nset yrange [%g:0.5]\n"
            "plot $bars using (0):1:(0):2:($1-0.36):($1+0.36):3:ytic(4) with boxxyerror fc rgb variable, "
            "$bars using 2:1:5 with labels left offset 0.5,0\n",
            p->title, most > 0 ? most * 1.4 : 1, 0.5 - bars);
}

static void put_script(const camber_comparison *c, bool svg, FILE *script) {
    if (svg)
        fputs("set terminal svg size 1120,360 dynamic noenhanced font 'Helvetica,Arial,sans-serif,14' "
              "background rgb 'white'\n",
              script);
    else /* without Cairo, gnuplot uses another terminal for PNG */
        fputs("if (strstrt(GPVAL_TERMINALS, 'pngcairo')) {\n"
              "set terminal pngcairo size 2240,720 noenhanced font 'sans,14' fontscale 1.7 background rgb 'white'\n"
              "} else {\nset terminal png size 2240,720 noenhanced font 'sans,24' background rgb 'white'\n}\n",
              script);
    fputs("set encoding utf8\nunset key\nset style fill solid noborder\nset border 2 lc rgb '#606060'\n"
          "unset xtics\nset ytics scale 0\n",
          script);
    fprintf(script, "set multiplot layout %d,%d margins 0.05,0.995,0.02,0.79 spacing 0.055,0.17\n", ROWS, COLUMNS);
    fprintf(script,
            "set label 1 'Fan, kite, strip: %s%zu %s, %u x %u px, lines %g px wide' at screen 0.008,0.95 left "
            "font ',16'\n",
            c->networks.count == 1 ? "" : "averages of ", c->networks.count,
            c->networks.count == 1 ? "network" : "networks", c->networks.width, c->networks.height,
            c->networks.width_px);
    for (int i = 0; i < COLUMNS * ROWS; i++) {
        put_panel(c, &panels[i], script);
        if (i == 0)
            fputs("unset label 1\n", script);
    }
    fputs("unset multiplot\n", script);
}

int camber_plot_write(const camber_comparison *comparison, camber_output *output) {
    camber_report *report = output->report;
    const size_t length = strlen(output->path);
    const bool svg = length > 4 && strcasecmp(output->path + length - 4, ".svg") == 0;
    char *text = NULL, line[256] = "";
    size_t size = 0;
    FILE *script = open_memstream(&text, &size);
    if (script)
        put_script(comparison, svg, script);
    if (!script || fclose(script) != 0) {
        free(text);
        return camber_report_status(report, CAMBER_ERROR_MEMORY);
    }
    char program[] = "gnuplot", plain[] = "-d", standard[] = "-";
    char *const arguments[] = {program, plain, standard, NULL};
    child made;
    const int cause = spawn(arguments, fileno(output->file), &made);
    const int status = cause ? -1 : finish(&made, text, line, sizeof line);
    free(text);
    if (cause || status != 0)
        return camber_report_fail(report, CAMBER_EXIT_UNAVAILABLE,
                                  "%s: gnuplot did not draw it (%s); install 5.0 or later", output->path,
                                  cause     ? strerror(cause)
                                  : line[0] ? line
                                            : "it says nothing");
    return CAMBER_EXIT_DONE;
}
