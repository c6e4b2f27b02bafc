/* A file on the command line must not be both read and written, or written twice. */
#ifndef CAMBER_CLI_OPTIONS_FILES_H
#define CAMBER_CLI_OPTIONS_FILES_H

#include "cli/options.h"

/* Returns whether there is such a file, and writes a one-line message if so. Files are compared by identity, so that
 * links are recognised. */
bool camber_options_clash(const camber_options *options, char *message, size_t message_size);

#endif
