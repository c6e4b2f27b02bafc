/* Reads the file from start to end, and looks only at the names of elements. */
#include "gdal/xml_order.h"

#include "base/open_file.h"

#include <stdio.h>

enum { MOST_NAME = 9 };

/* Returns the kind of the element with this name; kinds are numbered in the order in which they should come. 0: another
 * element. */
static int kind_of(const char *name) {
    static const char *const names[] = {"node", "way", "relation"};
    for (int i = 0; i < 3; i++) {
        const size_t length = strlen(names[i]);
        if (strncmp(name, names[i], length) == 0 && name[length] && strchr(" \t\r\n/>", name[length]))
            return i + 1;
    }
    return 0;
}

/* Skips a comment, after its "<!--" was read. */
static void skip_comment(FILE *file) {
    int dashes = 0;
    for (int c; (c = getc_unlocked(file)) != EOF && !(c == '>' && dashes >= 2);)
        dashes = c == '-' ? dashes + 1 : 0;
}

static bool find_disorder(FILE *file) {
    bool is_osm = false, is_xml = false;
    int last = 0;
    for (int c; (c = getc_unlocked(file)) != EOF;) {
        char name[MOST_NAME + 1] = "";
        int length = 0;
        if (c != '<' && !is_xml &&
            (c == 0 || !strchr(" \t\r\n\xef\xbb\xbf", c))) /* the last three are the byte order mark of UTF-8 */
            return false;
        if (c != '<')
            continue;
        is_xml = true;
        while (length < MOST_NAME && (c = getc_unlocked(file)) != EOF) {
            name[length++] = (char)c;
            if (c == '<' || c == '>' || strncmp(name, "!--", 3) == 0)
                break;
        }
        if (c == '<')
            ungetc(c, file);
        if (strncmp(name, "!--", 3) == 0)
            skip_comment(file);
        is_osm = is_osm || strncmp(name, "osm ", 4) == 0 || strncmp(name, "osm>", 4) == 0;
        if (!is_osm && name[0] != '?' && name[0] != '!')
            return false;
        const int kind = kind_of(name);
        if (kind && kind < last)
            return true;
        last = kind ? kind : last;
    }
    return false;
}

bool camber_osm_xml_is_unordered(const char *path) {
    struct stat about;
    const int descriptor = camber_open_file(path, &about);
    FILE *file = descriptor >= 0 && S_ISREG(about.st_mode) ? fdopen(descriptor, "rb") : NULL;
    if (!file) {
        if (descriptor >= 0)
            close(descriptor);
        return false;
    }
    const bool unordered = find_disorder(file);
    fclose(file);
    return unordered;
}
