/* A session holds what a verb runs on: the context, device, surface and renderer that the user's options select.
 *
 * Unlike a fixture (validate/fixture.h), which opens everything that a machine has, a session opens one of each. It
 * chooses by the options and by whether GL runs on hardware, records why, and can open them on a second thread while
 * files are read. */
#ifndef CAMBER_CLI_SESSION_H
#define CAMBER_CLI_SESSION_H

#include "cli/output.h"
#include "cli/watch.h"

typedef enum camber_needs {
    CAMBER_NEEDS_CONTEXT,
    CAMBER_NEEDS_DEVICE,
    CAMBER_NEEDS_RENDERER,
} camber_needs;

/* The kernels that a picture will need, as far as they can be predicted before its lines are known. */
typedef enum camber_outlook {
    CAMBER_OUTLOOK_PLAIN = 0, /* lines of one colour */
    CAMBER_OUTLOOK_RICH,      /* dashes, images or other paints that need the rich variant */
    CAMBER_OUTLOOK_OPEN,      /* either of the two */
} camber_outlook;

/* A renderer that is opened on its own thread while a file is read. It has its own context and report, because each of
 * these serves one thread at a time. */
typedef struct camber_opener camber_opener;

typedef struct camber_session {
    const camber_options *options;
    camber_report *report;
    camber_guard *guard;
    camber_budget *budget;
    /* A budget that is shared with others, which hold beside_bytes of it; this session may hold the rest. NULL: the
     * options set the limit. */
    camber_budget *whole;
    uint64_t beside_bytes;
    camber_watch watch; /* its give_up may be set before the session is used */
    camber_context *context;
    camber_surface *surface;
    camber_device *device;
    camber_renderer *renderer;
    camber_rasterizer draw; /* the chosen rasterizer, and why; valid once one has been needed */
    char draw_reason[256];
    bool opens_beside;     /* camber_input_open starts opening a renderer as soon as it knows the style */
    camber_opener *opener; /* NULL: not started */
    /* Called before files are read: says which parts of the features are needed. It sets done if the files need not be
     * read at all. NULL: the verb and the view decide. */
    camber_status (*read_for)(void *user, camber_features *features, bool *done);
    void *read_for_user;
    double start_ms;
} camber_session;

/* Starts opening a renderer on a second thread, and prepares what a picture with this outlook and pitch needs.
 * camber_session_need(CAMBER_NEEDS_RENDERER) waits for it and reports failures. */
void camber_session_start(camber_session *session, camber_outlook outlook, double pitch_deg);
/* Whether camber_session_start has been called, and camber_session_need has not waited for the renderer yet. */
bool camber_session_is_opening(const camber_session *session);

/* Opens what is needed and not open yet. Returns an exit status; on failure a line has been printed. */
int camber_session_need(camber_session *session, camber_needs needs);
/* Does the same for callers for whom a missing device or GL is not an error. The session must have a context, and no
 * renderer may be opening. */
camber_status camber_session_open(camber_session *session, camber_needs needs);
void camber_session_close(camber_session *session);

/* Returns the method that the options select, or the default. */
camber_method camber_session_method(const camber_session *session);

/* Returns the milliseconds since the tool started. */
static inline double camber_session_elapsed_ms(const camber_session *session) {
    return camber_now_ms() - session->start_ms;
}

/* With --verbose: says how much memory was in use, and what limits it. */
void camber_session_say_memory(const camber_session *session);

/* Adds "device", "gl_renderer", "draw", "draw_reason" and "sharing", as far as these parts are open. */
void camber_session_describe(const camber_session *session, json_t *object);

#endif
