/* Which part of a run this process draws. */
#ifndef CAMBER_CLI_SHARD_H
#define CAMBER_CLI_SHARD_H

#include "cli/options.h"

typedef struct camber_shard {
    uint32_t number, count; /* from 1; 0: the whole */
} camber_shard;

/* Finds the part by --shard; auto: by the environment. Returns CAMBER_EXIT_DONE, or CAMBER_EXIT_USAGE with one line in
 * message. */
int camber_shard_find(const camber_options *options, camber_shard *shard, char *message, size_t message_size);
/* Writes the name of a part: city.pmtiles is city.2-of-8.pmtiles, and city/ is city.2-of-8/. false: too long. */
bool camber_shard_name(const char *output, const camber_shard *shard, char *name, size_t size);

#endif
