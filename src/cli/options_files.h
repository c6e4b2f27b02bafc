/* No file that the command line names may be read and written, or written twice. */
#ifndef CAMBER_CLI_OPTIONS_FILES_H
#define CAMBER_CLI_OPTIONS_FILES_H

#include "cli/options.h"

/* Whether there is one, with one line in message: by what names lead to, so that links do not hide it. */
bool camber_options_clash(const camber_options *options, char *message, size_t message_size);

#endif
