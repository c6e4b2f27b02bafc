/* The folder of --pictures, with pictures of validate's failures. */
#ifndef CAMBER_CLI_FAILURE_FOLDER_H
#define CAMBER_CLI_FAILURE_FOLDER_H

#include "cli/session.h"
#include "validate/validation.h"

typedef struct camber_failure_folder {
    camber_session *session;
    int exit_status; /* the error, already printed, if a picture could not be written */
} camber_failure_folder;

/* Checks before the work starts that the folder can be written to. Returns an exit status; on failure a line has been
 * printed. */
int camber_failure_folder_check(const camber_session *session);
/* The write_image function of a camber_validation_host; user is a camber_failure_folder. */
camber_status camber_failure_folder_write(void *user, const camber_failure_image *image, char **path);

#endif
