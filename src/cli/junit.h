/* Verdicts as JUnit's XML, which CI systems read. */
#ifndef CAMBER_CLI_JUNIT_H
#define CAMBER_CLI_JUNIT_H

#include "cli/output.h"
#include "validate/results.h"

/* Writes to an open output and publishes it: a suite for each device and back end. Returns an exit status, its line
 * printed. */
int camber_junit_write(const camber_results *verdicts, camber_output *output);

#endif
