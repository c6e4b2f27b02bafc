/* Textures that GL draws into: the picture, the layers that are flattened before they reach it, and counts. */
#include "draw/renderer.h"

camber_status camber_gl_check(camber_renderer *renderer, const char *what) {
    return camber_surface_check(renderer->share.surface, what);
}

#include <stdio.h>

static void release(const camber_gl *gl, camber_target *target) {
    gl->DeleteFramebuffers(1, &target->framebuffer);
    gl->DeleteTextures(1, &target->texture);
    gl->DeleteTextures(1, &target->alphas);
    gl->DeleteRenderbuffers(1, &target->stencil);
    *target = (camber_target){0};
}

/* Checks whether GL accepts the bound target. */
static camber_status check_target(camber_renderer *renderer, GLsizei width, GLsizei height) {
    const GLenum complete = renderer->share.surface->gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
    char what[64];
    snprintf(what, sizeof what, "a target of %d x %d px", (int)width, (int)height);
    const camber_status status = camber_gl_check(renderer, what);
    if (status == CAMBER_OK && complete != GL_FRAMEBUFFER_COMPLETE)
        return camber_fail(renderer->share.device->context, CAMBER_ERROR_DEVICE,
                           "%s: not complete (0x%x) on %s; draw smaller areas, or update its driver", what, complete,
                           renderer->share.surface->info.renderer);
    return status;
}

/* Adds a stencil buffer. Not every driver accepts a stencil without depth, so it has depth too, which is not needed.
 */
static void add_stencil(const camber_gl *gl, camber_target *target, GLsizei width, GLsizei height) {
    gl->GenRenderbuffers(1, &target->stencil);
    gl->BindRenderbuffer(GL_RENDERBUFFER, target->stencil);
    gl->RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, width, height);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, target->stencil);
}

static GLenum format_of(const camber_renderer *renderer, int which) {
    if (which != CAMBER_TARGET_COVERAGE)
        return GL_RGBA8;
    return renderer->share.surface->half_float_targets ? GL_RGBA16F : GL_R8;
}

static GLuint make_texture(const camber_gl *gl, GLenum format, GLsizei width, GLsizei height) {
    GLuint texture;
    gl->GenTextures(1, &texture);
    gl->BindTexture(GL_TEXTURE_2D, texture);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

static void add_alphas(const camber_gl *gl, camber_target *target, GLsizei width, GLsizei height) {
    static const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    target->alphas = make_texture(gl, GL_R8, width, height);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, target->alphas, 0);
    gl->DrawBuffers(2, both);
}

static camber_status resize(camber_renderer *renderer, int which, GLsizei width, GLsizei height) {
    const camber_gl *gl = &renderer->share.surface->gl;
    camber_target *target = renderer->gl.targets + which;
    if (target->width == width && target->height == height)
        return CAMBER_OK;
    release(gl, target);
    target->texture = make_texture(gl, format_of(renderer, which), width, height);
    gl->GenFramebuffers(1, &target->framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target->texture, 0);
    if (which == CAMBER_TARGET_COUNTS)
        add_stencil(gl, target, width, height);
    if (which == CAMBER_TARGET_MASKED)
        add_alphas(gl, target, width, height);
    const camber_status status = check_target(renderer, width, height);
    if (status != CAMBER_OK) {
        release(gl, target);
        return status;
    }
    target->width = width;
    target->height = height;
    return CAMBER_OK;
}

GLsizei camber_target_guard(const camber_renderer *renderer, int axis, GLsizei side) {
    const GLsizei room = (renderer->share.surface->largest_viewport[axis] - side) / 2;
    return room < 0 ? 0 : room < side ? room : side;
}

camber_status camber_target_bind(camber_renderer *renderer, int which, GLsizei width, GLsizei height) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const camber_status status = resize(renderer, which, width, height);
    if (status != CAMBER_OK)
        return status;
    gl->BindFramebuffer(GL_FRAMEBUFFER, renderer->gl.targets[which].framebuffer);
    const GLsizei guard_x = camber_target_guard(renderer, 0, width), guard_y = camber_target_guard(renderer, 1, height);
    gl->Viewport(-guard_x, -guard_y, width + 2 * guard_x, height + 2 * guard_y);
    gl->Scissor(0, 0, width, height);
    gl->Enable(GL_SCISSOR_TEST);
    return CAMBER_OK;
}

void camber_targets_release(camber_renderer *renderer) {
    for (int i = 0; i < CAMBER_TARGETS; i++)
        release(&renderer->share.surface->gl, renderer->gl.targets + i);
}

/* The texture is the caller's, so only the framebuffer is deleted. */
void camber_target_take_back(camber_renderer *renderer) {
    renderer->gl.targets[CAMBER_TARGET_GIVEN].texture = 0;
    release(&renderer->share.surface->gl, renderer->gl.targets + CAMBER_TARGET_GIVEN);
}

camber_status camber_target_give(camber_renderer *renderer, GLuint texture, GLsizei width, GLsizei height) {
    const camber_gl *gl = &renderer->share.surface->gl;
    camber_target *target = renderer->gl.targets + CAMBER_TARGET_GIVEN;
    target->texture = texture;
    gl->GenFramebuffers(1, &target->framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    const camber_status status = check_target(renderer, width, height);
    if (status != CAMBER_OK) {
        camber_target_take_back(renderer);
        return status;
    }
    target->width = width;
    target->height = height;
    return CAMBER_OK;
}
