/* Runs a target on files and on the files of folders, in the order of their names: what libFuzzer's main does with
 * -runs=0, for any compiler. */
#include "fuzz.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

static bool replay_file(const char *path) {
    FILE *file = fopen(path, "rb");
    struct stat about;
    if (!file || fstat(fileno(file), &about) != 0)
        return false;
    const size_t size = (size_t)about.st_size;
    /* No byte more, so that a sanitizer sees a read past the end. */
    uint8_t *bytes = malloc(size ? size : 1);
    REQUIRE(bytes);
    const bool whole = fread(bytes, 1, size, file) == size;
    fclose(file);
    printf("%s\n", path);
    fflush(stdout);
    if (whole)
        LLVMFuzzerTestOneInput(bytes, size);
    free(bytes);
    return whole;
}

static bool replay(const char *path, size_t *count) {
    struct dirent **entries = NULL;
    const int entry_count = scandir(path, &entries, NULL, alphasort);
    if (entry_count < 0) {
        ++*count;
        return replay_file(path);
    }
    bool whole = true;
    for (int i = 0; i < entry_count; i++) {
        char inner[4096];
        snprintf(inner, sizeof inner, "%s/%s", path, entries[i]->d_name);
        if (entries[i]->d_name[0] != '.') {
            whole = replay_file(inner) && whole;
            ++*count;
        }
        free(entries[i]);
    }
    free(entries);
    return whole;
}

int main(int argument_count, char **arguments) {
    size_t count = 0;
    LLVMFuzzerInitialize(&argument_count, &arguments);
    for (int i = 1; i < argument_count; i++) {
        if (!replay(arguments[i], &count)) {
            fprintf(stderr, "%s cannot be read\n", arguments[i]);
            return 1;
        }
    }
    printf("%zu inputs\n", count);
    return count ? 0 : 1;
}
