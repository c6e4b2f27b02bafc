/* Determines the shard from the environment variables of systems that start many processes (called engines here).
 * Variables of job arrays take precedence over those of processes within a job, and MPI's over those of the scheduler
 * that started it. */
#include "cli/shard.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_SHARDS = 65535 };

/* Variables that number a process. */
typedef struct engine {
    const char *number, *first, *last, *step, *count; /* NULL: first is 0, step is 1, and the others are unknown */
} engine;

static const engine engines[] = {
    {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_MAX", "SLURM_ARRAY_TASK_STEP",
     "SLURM_ARRAY_TASK_COUNT"},
    {"OMPI_COMM_WORLD_RANK", NULL, NULL, NULL, "OMPI_COMM_WORLD_SIZE"},
    {"PMI_RANK", NULL, NULL, NULL, "PMI_SIZE"},
    {"SLURM_PROCID", NULL, NULL, NULL, "SLURM_NTASKS"},
    {"JOB_COMPLETION_INDEX", NULL, NULL, NULL, NULL},
    {"AWS_BATCH_JOB_ARRAY_INDEX", NULL, NULL, NULL, "AWS_BATCH_JOB_ARRAY_SIZE"},
};

/* Parses a whole number up to MOST_SHARDS, which must be followed by `end`. */
static bool parse(const char *text, char end, uint32_t *value, const char **rest) {
    const size_t digits = text ? strspn(text, "0123456789") : 0;
    if (digits < 1 || digits > 9 || text[digits] != end)
        return false;
    *value = (uint32_t)strtoul(text, NULL, 10);
    if (rest)
        *rest = text + digits + 1;
    return true;
}

/* A missing variable has the usual value; one that is not a number is an error. */
static bool read_variable(const char *name, uint32_t usual, uint32_t *value) {
    const char *text = name ? getenv(name) : NULL;
    *value = usual;
    return !text || !*text || parse(text, 0, value, NULL);
}

static int find_auto(const camber_options *options, camber_shard *shard, char *message, size_t message_size) {
    const engine *found = NULL;
    for (size_t i = 0; !found && i < sizeof engines / sizeof *engines; i++)
        if (getenv(engines[i].number))
            found = &engines[i];
    if (!found) {
        snprintf(message, message_size,
                 "--shard auto: no environment variable says which shard this is (SLURM_ARRAY_TASK_ID, SLURM_PROCID, "
                 "OMPI_COMM_WORLD_RANK, PMI_RANK, JOB_COMPLETION_INDEX, AWS_BATCH_JOB_ARRAY_INDEX); give --shard K/N");
        return CAMBER_EXIT_USAGE;
    }
    uint32_t number, first, last, step, count;
    if (!parse(getenv(found->number), 0, &number, NULL) || !read_variable(found->first, 0, &first) ||
        !read_variable(found->last, 0, &last) || !read_variable(found->step, 1, &step) ||
        !read_variable(found->count, 0, &count) || number < first) {
        snprintf(message, message_size,
                 "--shard auto: %s is \"%s\", which is not the number of a shard; give --shard K/N", found->number,
                 getenv(found->number));
        return CAMBER_EXIT_USAGE;
    }
    step = step ? step : 1;
    /* If an array has gaps, for example because it repeats only the jobs that failed, the shards cannot be
     * determined. */
    const bool gaps = last && count && (last < first || (last - first) / step + 1 != count);
    if (gaps || (options->shards && count && count != options->shards)) {
        snprintf(message, message_size,
                 "--shard auto: %s counts %u tasks%s, which are not all shards%s; give an array of all of them, or "
                 "name this task's shard: --shard K/N",
                 found->number, count, gaps ? " with gaps between them" : "", options->shards ? " of --shards" : "");
        return CAMBER_EXIT_USAGE;
    }
    number = (number - first) / step;
    count = options->shards ? options->shards : count;
    if (count == 0)
        snprintf(message, message_size,
                 "--shard auto: %s says which shard this is, but nothing says how many there are; give --shards N",
                 found->number);
    else if (number >= count || count > MOST_SHARDS)
        snprintf(message, message_size,
                 "--shard auto: %s is \"%s\", which would be shard %u of %u; give --shards the number of all shards",
                 found->number, getenv(found->number), number + 1, count);
    else {
        *shard = (camber_shard){number + 1, count};
        return CAMBER_EXIT_DONE;
    }
    return CAMBER_EXIT_USAGE;
}

int camber_shard_find(const camber_options *options, camber_shard *shard, char *message, size_t message_size) {
    const char *rest = NULL;
    *shard = (camber_shard){0};
    if (!options->shard)
        return CAMBER_EXIT_DONE;
    if (strcmp(options->shard, "auto") == 0)
        return find_auto(options, shard, message, message_size);
    if (parse(options->shard, '/', &shard->number, &rest) && parse(rest, 0, &shard->count, NULL) &&
        shard->number >= 1 && shard->number <= shard->count && shard->count <= MOST_SHARDS)
        return CAMBER_EXIT_DONE;
    snprintf(message, message_size, "--shard %s: not a shard; give K/N with K from 1 to N, as in 2/8, or auto",
             options->shard);
    return CAMBER_EXIT_USAGE;
}

bool camber_shard_name(const char *output, const camber_shard *shard, char *name, size_t size) {
    const char *slash = strrchr(output, '/'), *dot = strrchr(output, '.');
    size_t length = strlen(output);
    const bool folder = length && output[length - 1] == '/';
    if (folder)
        length--;
    else if (dot && (!slash || dot > slash))
        length = (size_t)(dot - output);
    return snprintf(name, size, "%.*s.%u-of-%u%s", (int)length, output, shard->number, shard->count, output + length) <
           (int)size;
}
