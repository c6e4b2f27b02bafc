/* --color, --fill and --width: how a built-in style draws features that none of its rules matches. */
#ifndef CAMBER_CLI_PLAIN_H
#define CAMBER_CLI_PLAIN_H

#include "cli/input.h"

/* Whether one of the options is given. */
bool camber_plain_is_given(const camber_options *options);
/* Writes the options into the document of a built-in style. Returns an exit status; on failure a line has been printed:
 * a usage error if a colour is invalid, or if the style has no plain layers. */
int camber_plain_apply(camber_session *session, camber_style_input *style);

#endif
