/* Which shard of a run this process draws. */
#ifndef CAMBER_CLI_SHARD_H
#define CAMBER_CLI_SHARD_H

#include "cli/options.h"

typedef struct camber_shard {
    uint32_t number, count; /* counted from 1; 0: the whole run */
} camber_shard;

/* Determines the shard from --shard, or from the environment if it is auto. Returns CAMBER_EXIT_DONE, or
 * CAMBER_EXIT_USAGE with a one-line message. */
int camber_shard_find(const camber_options *options, camber_shard *shard, char *message, size_t message_size);
/* Writes the name of a shard's output: city.pmtiles becomes city.2-of-8.pmtiles, and city/ becomes city.2-of-8/.
 * Returns false if it is too long. */
bool camber_shard_name(const char *output, const camber_shard *shard, char *name, size_t size);

#endif
