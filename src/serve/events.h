/* Events for pages that show a style while it is edited: a stream of text/event-stream to each who listens.
 *
 *     event: style
 *     data: {"revision": 3, "error": null}
 *
 * Whoever begins to listen is told how things are. Any thread may call. */
#ifndef CAMBER_SERVE_EVENTS_H
#define CAMBER_SERVE_EVENTS_H

#include <microhttpd.h>

typedef struct camber_events camber_events;

/* NULL: no memory. */
camber_events *camber_events_create(void);
/* Nobody listens any more. */
void camber_events_destroy(camber_events *events);
/* The style was read anew; or it could not be, for this error. */
void camber_events_tell(camber_events *events, const char *error);
/* Sends a line that says nothing, by which a listener that has gone is found. */
void camber_events_beat(camber_events *events);
/* Ends all streams, and those that begin. */
void camber_events_end(camber_events *events);
/* The endless answer for a connection; NULL: no memory, or too many listen. */
struct MHD_Response *camber_events_listen(camber_events *events, struct MHD_Connection *connection);

#endif
