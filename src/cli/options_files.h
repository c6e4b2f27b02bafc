/* No file that the command line names may be read and written, or written twice. */
#ifndef CAMBER_CLI_OPTIONS_FILES_H
#define CAMBER_CLI_OPTIONS_FILES_H

#include "cli/options.h"

/* Whether there is such a file; message then has one line. Files are compared by identity, so that links do not hide
 * it. */
bool camber_options_clash(const camber_options *options, char *message, size_t message_size);

#endif
