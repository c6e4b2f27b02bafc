/* What drivers are to find in the environment. */
#ifndef CAMBER_CLI_ENVIRONMENT_H
#define CAMBER_CLI_ENVIRONMENT_H

#include "cli/options.h"

/* Sets what the user has not set, and what --threads asks for; before any thread starts. false: out of memory. */
bool camber_environment_set(const camber_options *options);

#endif
