/* --color, --fill and --width: how a built-in style draws what no rule of it takes. */
#ifndef CAMBER_CLI_PLAIN_H
#define CAMBER_CLI_PLAIN_H

#include "cli/input.h"

/* Whether one of the options is given. */
bool camber_plain_is_given(const camber_options *options);
/* Puts the options into the document of a style that ships. Returns an exit status, its line printed: usage where a
 * colour is none, or the style draws nothing plainly. */
int camber_plain_apply(camber_session *session, camber_style_input *style);

#endif
