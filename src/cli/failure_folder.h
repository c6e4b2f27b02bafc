/* The folder of --pictures: pictures of what validate found wrong. */
#ifndef CAMBER_CLI_FAILURE_FOLDER_H
#define CAMBER_CLI_FAILURE_FOLDER_H

#include "cli/session.h"
#include "validate/validation.h"

typedef struct camber_failure_folder {
    camber_session *session;
    int exit_status; /* of a picture that could not be written, whose line is printed */
} camber_failure_folder;

/* Whether the folder can be written to: known before the work. Returns an exit status, its line printed. */
int camber_failure_folder_check(const camber_session *session);
/* A camber_validation_host's write_image: user is a camber_failure_folder. */
camber_status camber_failure_folder_write(void *user, const camber_failure_image *image, char **path);

#endif
