/* The verbs. Each returns an exit status; on failure a line has been printed. */
#ifndef CAMBER_CLI_VERBS_H
#define CAMBER_CLI_VERBS_H

#include "cli/session.h"

int camber_verb_render(camber_session *session);
int camber_verb_tessellate(camber_session *session);
int camber_verb_compare(camber_session *session);
int camber_verb_validate(camber_session *session);
int camber_verb_bench(camber_session *session);
int camber_verb_info(camber_session *session);
int camber_verb_style(camber_session *session);
int camber_verb_tiles(camber_session *session);
int camber_verb_tiles_draw(camber_session *session);
int camber_verb_serve(camber_session *session);
/* Runs info --warm. The session has a context, and no device yet. */
int camber_warm(camber_session *session);

#endif
