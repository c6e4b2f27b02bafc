/* Rejects options, and words the messages. */
#include "cli/options_table.h"
#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

int camber_options_refuse(const camber_option_reader *reader, const char *format, ...) {
    va_list list;
    va_start(list, format);
    vsnprintf(reader->message, reader->message_size, format, list);
    va_end(list);
    return CAMBER_EXIT_USAGE;
}

bool camber_path_ends_with(const char *path, const char *end) {
    const size_t length = strlen(path), tail = strlen(end);
    return length > tail && strcasecmp(path + length - tail, end) == 0;
}

void camber_path_blame_extension(const char *path, char blame[64]) {
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    snprintf(blame, 64, dot && dot > name && dot[1] ? "unknown extension %.32s" : "no extension", dot ? dot : "");
}
