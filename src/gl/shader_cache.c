/* Keeps linked shader programs in the user's cache folder, in the driver's own format. Mesa also caches the results of
 * its compiler, but reads the sources first; other drivers cache nothing. */
#include "gl/shader_cache.h"

#include <stdio.h>
#include <string.h>

/* A file begins with this head; the driver's bytes follow. */
typedef struct linked_head {
    /* covers the key, the format and the bytes, to detect files that are incomplete or of another program */
    uint64_t hash;
    GLenum format;
    uint32_t unused;
} linked_head;

uint64_t camber_shader_cache_key(const camber_surface *surface, const char *const *sources, size_t count) {
    const camber_surface_info *info = &surface->info;
    uint64_t key = camber_hash(CAMBER_HASH_START, info->renderer, strlen(info->renderer) + 1);
    key = camber_hash(key, info->version, strlen(info->version) + 1);
    for (size_t i = 0; i < count; i++)
        key = camber_hash(key, sources[i], strlen(sources[i]) + 1);
    return key;
}

static void file_name(uint64_t key, char name[64]) {
    snprintf(name, 64, "shaders-%016llx.bin", (unsigned long long)key);
}

static uint64_t hash_bytes(uint64_t key, GLenum format, const void *bytes, size_t size) {
    const uint64_t hash = camber_hash(camber_hash(CAMBER_HASH_START, &key, sizeof key), &format, sizeof format);
    return camber_hash(hash, bytes, size);
}

static bool keeps_programs(const camber_gl *gl) {
    GLint formats = 0;
    gl->GetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
    return formats > 0;
}

bool camber_shader_cache_load(camber_surface *surface, uint64_t key, GLuint program) {
    const camber_gl *gl = &surface->gl;
    char name[64], *bytes = NULL;
    size_t size = 0;
    GLint linked = 0;
    linked_head head;
    file_name(key, name);
    if (!keeps_programs(gl) || !camber_cache_load(surface->context, name, &bytes, &size))
        return false;
    if (size > sizeof head) {
        memcpy(&head, bytes, sizeof head);
        size -= sizeof head;
        if (head.hash == hash_bytes(key, head.format, bytes + sizeof head, size)) {
            gl->ProgramBinary(program, head.format, bytes + sizeof head, (GLsizei)size);
            gl->GetProgramiv(program, GL_LINK_STATUS, &linked);
            /* the bytes are of another version: the caller builds the program again */
            camber_surface_forget_errors(surface);
        }
    }
    camber_free(surface->context, bytes);
    return linked != 0;
}

void camber_shader_cache_save(camber_surface *surface, uint64_t key, GLuint program) {
    camber_context *context = surface->context;
    const camber_gl *gl = &surface->gl;
    GLint size = 0;
    GLsizei written = 0;
    linked_head head = {0};
    if (!keeps_programs(gl) || !camber_cache_is_on(context))
        return;
    gl->GetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &size);
    /* If there is no memory left, the file is not saved, which is not an error. */
    char *bytes = size > 0 ? camber_resize_quietly(context, NULL, sizeof head + (size_t)size) : NULL;
    if (bytes) {
        gl->GetProgramBinary(program, size, &written, &head.format, bytes + sizeof head);
        if (written > 0) {
            char name[64];
            head.hash = hash_bytes(key, head.format, bytes + sizeof head, (size_t)written);
            memcpy(bytes, &head, sizeof head);
            file_name(key, name);
            camber_cache_save(context, name, bytes, sizeof head + (size_t)written);
        }
    }
    camber_surface_forget_errors(surface);
    camber_free(context, bytes);
}
