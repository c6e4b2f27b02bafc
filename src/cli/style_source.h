/* The file that a style names as the source of its lines. */
#ifndef CAMBER_CLI_STYLE_SOURCE_H
#define CAMBER_CLI_STYLE_SOURCE_H

#include "cli/report.h"

/* For a style without INPUT. *path is freed with free, and is NULL where no line layer has a source. A path in the
 * style is relative to the folder of style_path. Returns an exit status, its line printed: more than one source,
 * or one that is no file, is a usage error. */
int camber_style_source(camber_report *report, const char *style_path, const char *bytes, size_t size_bytes,
                        char **path);

#endif
