/* A session is what a verb runs on: the context, device, surface and renderer that the user's options ask for.
 *
 * It is no fixture (validate/fixture.h), which opens everything that a machine has: a session opens one of them, which
 * it chooses from the options and from whether GL is hardware; it says why, and opens on a thread beside reading. */
#ifndef CAMBER_CLI_SESSION_H
#define CAMBER_CLI_SESSION_H

#include "cli/output.h"
#include "cli/watch.h"

typedef enum camber_needs {
    CAMBER_NEEDS_CONTEXT,
    CAMBER_NEEDS_DEVICE,
    CAMBER_NEEDS_RENDERER,
} camber_needs;

/* The kernels that a picture will need, as far as is known before its lines are. */
typedef enum camber_outlook {
    CAMBER_OUTLOOK_PLAIN = 0, /* lines of one colour */
    CAMBER_OUTLOOK_RICH,      /* dashes and the like */
    CAMBER_OUTLOOK_OPEN,      /* the one or the other */
} camber_outlook;

/* A renderer that opens on a thread of its own while a file is read. It has its own context and report, since those
 * serve one thread at a time. */
typedef struct camber_opener camber_opener;

typedef struct camber_session {
    const camber_options *options;
    camber_report *report;
    camber_guard *guard;
    camber_budget *budget;
    /* A budget of which this session may hold what is left after those beside it, which hold beside_bytes. NULL: the
     * options say what it may. */
    camber_budget *whole;
    uint64_t beside_bytes;
    camber_watch watch; /* its give_up may be set before the session is used */
    camber_context *context;
    camber_surface *surface;
    camber_device *device;
    camber_renderer *renderer;
    camber_rasterizer draw; /* what the renderer draws with, and why: once one was asked for */
    char draw_reason[256];
    bool opens_beside;     /* camber_input_open starts a renderer, once it knows the style */
    camber_opener *opener; /* NULL: not started */
    /* Tells a set of features, before files are read, what of them is needed; done: they need not be read. NULL: the
     * verb and the view do. */
    camber_status (*read_for)(void *user, camber_features *features, bool *done);
    void *read_for_user;
    double start_ms;
} camber_session;

/* Starts opening a renderer beside what the caller does next, and makes ready what a picture of this outlook and pitch
 * needs; camber_session_need(CAMBER_NEEDS_RENDERER) waits for it and tells how it went. */
void camber_session_start(camber_session *session, camber_outlook outlook, double pitch_deg);
/* Whether that has begun, and camber_session_need has not waited for it. */
bool camber_session_is_opening(const camber_session *session);

/* Opens what is needed and not open yet. Returns an exit status, its line printed. */
int camber_session_need(camber_session *session, camber_needs needs);
/* The same where it is no failure that something is missing. There is a context, and no renderer opens beside. */
camber_status camber_session_open(camber_session *session, camber_needs needs);
void camber_session_close(camber_session *session);

/* The method that the options ask for, or the default. */
camber_method camber_session_method(const camber_session *session);

/* "device", "gl_renderer", "draw", "draw_reason", "sharing" of what is open. */
void camber_session_describe(const camber_session *session, json_t *object);

#endif
