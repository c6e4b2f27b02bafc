/* Finds files that the command line uses twice: for reading and for writing, or as the output of two options. Files are
 * compared by device and inode, so that links are recognised. Parts of an input, such as the .dbf of a .shp, count as
 * inputs. */
#define _XOPEN_SOURCE 700

#include "cli/options_files.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* An existing file is identified by its device and inode, and a file that does not exist by its folder's device and
 * inode and its own name. */
typedef struct file {
    const char *path, *role;
    dev_t device;
    ino_t number;
    const char *name; /* NULL: the file exists */
} file;

enum { MOST_OUTPUTS = 5, LONGEST_PATH = 4096 };

/* ---- Identifying files ---- */

static bool take_info(file *it, const struct stat *info) {
    it->device = info->st_dev;
    it->number = info->st_ino;
    return true;
}

/* Only regular files count: a device or a pipe may be both read and written. */
static bool find_stream(file *it, int descriptor, const char *name) {
    struct stat info;
    it->path = name;
    return fstat(descriptor, &info) == 0 && S_ISREG(info.st_mode) && take_info(it, &info);
}

static bool find_existing(file *it) {
    struct stat info;
    return stat(it->path, &info) == 0 && S_ISREG(info.st_mode) && take_info(it, &info);
}

/* Finds the actual file of /vsigzip/FILE, /vsizip/FILE/member and the like. */
static bool find_archive(file *it) {
    char path[LONGEST_PATH];
    const char *rest = it->path, *slash;
    while (strncmp(rest, "/vsi", 4) == 0 && (slash = strchr(rest + 1, '/')) != NULL)
        rest = slash + 1;
    if (rest == it->path || strlen(rest) >= sizeof path)
        return false;
    memcpy(path, rest, strlen(rest) + 1);
    for (char *end = path + strlen(path); end && end > path; end = strrchr(path, '/')) {
        file outer = {.path = path};
        *end = 0;
        if (!find_existing(&outer))
            continue;
        it->device = outer.device;
        it->number = outer.number;
        return true;
    }
    return false;
}

static bool find_input(file *it) {
    return strcmp(it->path, "-") == 0 ? find_stream(it, STDIN_FILENO, "standard input")
                                      : find_existing(it) || find_archive(it);
}

static bool find_output(file *it) {
    char folder[LONGEST_PATH];
    struct stat info;
    if (strcmp(it->path, "-") == 0)
        return find_stream(it, STDOUT_FILENO, "standard output");
    if (stat(it->path, &info) == 0)
        return S_ISREG(info.st_mode) && take_info(it, &info);
    const char *slash = strrchr(it->path, '/');
    it->name = slash ? slash + 1 : it->path;
    if ((size_t)(it->name - it->path) + 2 > sizeof folder)
        return false;
    snprintf(folder, sizeof folder, "%.*s.", (int)(it->name - it->path), it->path);
    return stat(folder, &info) == 0 && take_info(it, &info);
}

static bool is_same(const file *a, const file *b) {
    return a->device == b->device && a->number == b->number && !a->name == !b->name &&
           (!a->name || strcmp(a->name, b->name) == 0);
}

/* ---- Listing files ---- */

typedef struct checked {
    const camber_options *options;
    file outputs[MOST_OUTPUTS];
    size_t output_count;
    char *message;
    size_t message_size;
} checked;

static bool tell(const checked *c, const char *path, const char *role, const char *output_role) {
    snprintf(c->message, c->message_size, "%s: is both %s and %s; name another %s", path, role, output_role,
             output_role);
    return true;
}

static bool add_output(checked *c, const char *path, const char *role) {
    file it = {.path = path, .role = role};
    if (!path || !find_output(&it))
        return false;
    for (size_t i = 0; i < c->output_count; i++)
        if (is_same(&c->outputs[i], &it))
            return tell(c, it.path, c->outputs[i].role, role);
    c->outputs[c->output_count++] = it;
    return false;
}

/* --pictures names a folder, whose files are called check-NUMBER.png. */
static bool is_picture(const checked *c, const file *input, const char *path) {
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *folder = c->options->pictures;
    char picture[LONGEST_PATH];
    if (!folder || strncmp(name, "check-", 6) != 0 ||
        snprintf(picture, sizeof picture, "%s/%s", folder, name) >= (int)sizeof picture)
        return false;
    file it = {.path = picture};
    return find_existing(&it) && is_same(&it, input);
}

static bool meets_output(const checked *c, const char *path, const char *role) {
    file it = {.path = path};
    if (!path || !find_input(&it))
        return false;
    for (size_t i = 0; i < c->output_count; i++)
        if (is_same(&c->outputs[i], &it))
            return tell(c, c->outputs[i].path, role, c->outputs[i].role);
    return is_picture(c, &it, path) && tell(c, path, role, "--pictures");
}

/* ---- Formats with several files ---- */

/* Extensions of formats that use several files with the same stem in one folder. Names may be in lower or upper
 * case. */
static const char *const families[][12] = {
    {".shp", ".shx", ".dbf", ".prj", ".cpg", ".qpj", ".qix", ".sbn", ".sbx", ".idm", ".ind"},
    {".tab", ".dat", ".map", ".id", ".ind"},
    {".mif", ".mid"},
    {".csv", ".csvt", ".prj"},
    {".gml", ".gfs", ".xsd"}};

enum { FAMILY_COUNT = sizeof families / sizeof *families, FAMILY_SIZE = sizeof *families / sizeof **families };

static bool belongs(const char *const *family, const char *ending) {
    for (size_t i = 0; i < FAMILY_SIZE && family[i]; i++)
        if (strcasecmp(ending, family[i]) == 0)
            return true;
    return false;
}

static bool member_meets_output(const checked *c, const char *path, size_t stem, const char *ending) {
    char part[LONGEST_PATH];
    snprintf(part, sizeof part, "%.*s%s", (int)stem, path, ending);
    if (meets_output(c, part, "a part of INPUT"))
        return true;
    for (char *letter = part + stem; *letter; letter++)
        *letter = (char)toupper((unsigned char)*letter);
    return meets_output(c, part, "a part of INPUT");
}

static bool part_meets_output(const checked *c, const char *path) {
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    if (!dot || (slash && dot < slash) || strlen(path) + 8 > LONGEST_PATH)
        return false;
    for (size_t i = 0; i < FAMILY_COUNT; i++)
        for (size_t k = 0; k < FAMILY_SIZE && families[i][k] && belongs(families[i], dot); k++)
            if (member_meets_output(c, path, (size_t)(dot - path), families[i][k]))
                return true;
    return false;
}

bool camber_options_clash(const camber_options *options, char *message, size_t message_size) {
    checked c = {.options = options, .message = message, .message_size = message_size};
    if (add_output(&c, options->output, "OUT") || add_output(&c, options->dump, "--dump") ||
        add_output(&c, options->plot, "--plot") || add_output(&c, options->junit, "--junit") ||
        (options->dry_run && add_output(&c, options->schedule, "--schedule")))
        return true;
    for (size_t i = 0; i < options->input_count; i++)
        if (meets_output(&c, options->inputs[i], "INPUT") || part_meets_output(&c, options->inputs[i]))
            return true;
    if (!options->dry_run && meets_output(&c, options->schedule, "--schedule"))
        return true;
    return meets_output(&c, options->style, "--style") || meets_output(&c, options->polylines, "--polylines");
}
