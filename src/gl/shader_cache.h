/* Linked shader programs in the user's cache folder. */
#ifndef CAMBER_GL_SHADER_CACHE_H
#define CAMBER_GL_SHADER_CACHE_H

#include "gl/surface.h"

/* Returns the key: a hash of the driver's name and version and of all sources. */
uint64_t camber_shader_cache_key(const camber_surface *surface, const char *const *sources, size_t count);
/* Fills a program. Returns false if the folder does not have it, or if the driver no longer accepts it. */
bool camber_shader_cache_load(camber_surface *surface, uint64_t key, GLuint program);
void camber_shader_cache_save(camber_surface *surface, uint64_t key, GLuint program);

#endif
