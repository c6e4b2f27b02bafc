/* Events for pages that show a style while it is edited: a stream of text/event-stream for each listener.
 *
 *     event: style
 *     data: {"revision": 3, "error": null}
 *
 * A new listener first gets the current state. Any thread may call these functions. */
#ifndef CAMBER_SERVE_EVENTS_H
#define CAMBER_SERVE_EVENTS_H

#include <microhttpd.h>

typedef struct camber_events camber_events;

/* Returns NULL if there is no memory. */
camber_events *camber_events_create(void);
/* Call it when there are no listeners any more. */
void camber_events_destroy(camber_events *events);
/* Announces that the style has been reloaded or, if error is not NULL, that reloading failed for this reason. */
void camber_events_tell(camber_events *events, const char *error);
/* Sends an empty line to each listener, to detect disconnected ones. */
void camber_events_beat(camber_events *events);
/* Ends all streams. A stream that is opened later ends at once. */
void camber_events_end(camber_events *events);
/* Returns the endless response for a connection; NULL if there is no memory, or there are too many listeners. */
struct MHD_Response *camber_events_listen(camber_events *events, struct MHD_Connection *connection);

#endif
