/* Builds shader programs from the sources that are embedded in the library, or loads them from the cache folder.
 *
 * A variant of the stroke shader is the same source after different #defines. A surface keeps the latest
 * CAMBER_STROKE_SHADERS_MAX of them, one flatten shader per kind and one count shader per method. */
#include "gl/shaders.h"

#include "base/embedded.h"
#include "gl/shader_cache.h"

#include <stdio.h>

enum { LOG_SIZE = 2048 };

/* Reports a step that failed. If GL reports an error of its own, that says more than the step's log. */
static camber_status fail_step(camber_surface *surface, const char *step, const char *log) {
    const camber_status status = camber_surface_check(surface, "shaders");
    if (status != CAMBER_OK)
        return status;
    return camber_fail(surface->context, CAMBER_ERROR_DEVICE, "%s on %s; update its driver: %s", step,
                       surface->info.renderer, log[0] ? log : "it does not say why");
}

static camber_status compile(camber_surface *surface, GLenum kind, const char *head, const char *source, GLuint *made) {
    const camber_gl *gl = &surface->gl;
    const GLchar *version =
        surface->es_3_2 ? "#version 320 es\n" : "#version 310 es\n#extension GL_EXT_texture_buffer : require\n";
    const GLchar *parts[] = {version, "#define CAMBER_GLSL 1\n", head, source};
    const GLuint shader = gl->CreateShader(kind);
    GLint built = 0;
    gl->ShaderSource(shader, sizeof parts / sizeof *parts, parts, NULL);
    gl->CompileShader(shader);
    gl->GetShaderiv(shader, GL_COMPILE_STATUS, &built);
    *made = shader;
    if (built)
        return CAMBER_OK;
    char log[LOG_SIZE] = "";
    gl->GetShaderInfoLog(shader, LOG_SIZE, NULL, log);
    return fail_step(surface, "a shader does not compile", log);
}

static camber_status link(camber_surface *surface, GLuint program, const GLuint parts[2]) {
    const camber_gl *gl = &surface->gl;
    GLint linked = 0;
    for (int i = 0; i < 2; i++)
        gl->AttachShader(program, parts[i]);
    gl->LinkProgram(program);
    gl->GetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked)
        return CAMBER_OK;
    char log[LOG_SIZE] = "";
    gl->GetProgramInfoLog(program, LOG_SIZE, NULL, log);
    return fail_step(surface, "shaders do not link", log);
}

static camber_status build_from_sources(camber_surface *surface, const char *head, const char *vertex,
                                        const char *fragment, GLuint program) {
    const camber_gl *gl = &surface->gl;
    GLuint parts[2] = {0, 0};
    camber_status status = compile(surface, GL_VERTEX_SHADER, head, vertex, parts);
    if (status == CAMBER_OK)
        status = compile(surface, GL_FRAGMENT_SHADER, head, fragment, parts + 1);
    if (status == CAMBER_OK)
        status = link(surface, program, parts);
    for (int i = 0; i < 2; i++)
        gl->DeleteShader(parts[i]); /* 0 is none */
    return status;
}

/* Fills shader from the cache or from the sources. head: the #defines. */
static camber_status build(camber_surface *surface, const char *head, const char *vertex, const char *fragment,
                           camber_shader *shader) {
    const camber_gl *gl = &surface->gl;
    const char *const sources[] = {head, vertex, fragment};
    const uint64_t key = camber_shader_cache_key(surface, sources, sizeof sources / sizeof *sources);
    const double begin = camber_now_ms();
    const GLuint program = gl->CreateProgram();
    const bool cached = camber_shader_cache_load(surface, key, program);
    if (!cached) {
        gl->ProgramParameteri(program, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
        const camber_status status = build_from_sources(surface, head, vertex, fragment, program);
        if (status != CAMBER_OK) {
            gl->DeleteProgram(program);
            return status;
        }
        camber_shader_cache_save(surface, key, program);
    }
    camber_log(surface->context, CAMBER_LOG_INFO, "shaders: %s in %.0f ms", cached ? "from the cache" : "built",
               camber_now_ms() - begin);
    *shader = (camber_shader){program,
                              0,
                              gl->GetUniformLocation(program, "u_origin"),
                              gl->GetUniformLocation(program, "u_corner"),
                              gl->GetUniformLocation(program, "u_scale"),
                              gl->GetUniformLocation(program, "u_color"),
                              gl->GetUniformLocation(program, "u_table"),
                              gl->GetUniformLocation(program, "u_table_rows"),
                              gl->GetUniformLocation(program, "u_stride"),
                              gl->GetUniformLocation(program, "u_side_table"),
                              gl->GetUniformLocation(program, "u_eye"),
                              gl->GetUniformLocation(program, "u_image_rect"),
                              gl->GetUniformLocation(program, "u_mean"),
                              gl->GetUniformLocation(program, "u_first"),
                              gl->GetUniformLocation(program, "u_axis_x"),
                              gl->GetUniformLocation(program, "u_axis_y")};
    return CAMBER_OK;
}

camber_status camber_shaders_stroke(camber_shaders *shaders, unsigned variant, const camber_shader **shader) {
    const camber_gl *gl = &shaders->surface->gl;
    camber_shader *wanted = shaders->strokes;
    while (wanted < shaders->strokes + CAMBER_STROKE_SHADERS_MAX && wanted->program && wanted->variant != variant)
        wanted++;
    if (wanted == shaders->strokes + CAMBER_STROKE_SHADERS_MAX) { /* the oldest is replaced */
        wanted = shaders->strokes + shaders->strokes_built % CAMBER_STROKE_SHADERS_MAX;
        gl->DeleteProgram(wanted->program);
        wanted->program = 0;
    }
    if (!wanted->program) {
        char head[512];
        snprintf(
            head, sizeof head,
            "#define LINEAR %d\n#define SHARP_JOINS %d\n#define FLAT_ENDS %d\n#define COUNT %d\n"
            "#define UNION %d\n#define METHOD %u\n#define THIN %d\n#define TIPS %d\n#define GAP %d\n#define BLUR %d\n"
            "#define DASH %d\n#define TRIM %d\n#define RAMP %d\n#define MASK %d\n#define PATTERN %d\n"
            "#define PITCHED %d\n#define TEXELS_A_ROW %d\n",
            (variant & CAMBER_VARIANT_LINEAR) != 0, (variant & CAMBER_VARIANT_SHARP_JOINS) != 0,
            (variant & CAMBER_VARIANT_FLAT_ENDS) != 0, (variant & CAMBER_VARIANT_COUNT) != 0,
            (variant & CAMBER_VARIANT_UNION) != 0, variant / CAMBER_VARIANT_METHOD,
            (variant & CAMBER_VARIANT_THIN) != 0, (variant & CAMBER_VARIANT_TIPS) != 0,
            (variant & CAMBER_VARIANT_GAP) != 0, (variant & CAMBER_VARIANT_BLUR) != 0,
            (variant & CAMBER_VARIANT_DASH) != 0, (variant & CAMBER_VARIANT_TRIM) != 0,
            (variant & CAMBER_VARIANT_RAMP) != 0, (variant & CAMBER_VARIANT_MASK) != 0,
            (variant & CAMBER_VARIANT_PATTERN) != 0, (variant & CAMBER_VARIANT_PITCHED) != 0, (int)CAMBER_ROW_TEXELS);
        const camber_status status = build(shaders->surface, head, camber_stroke_vert, camber_stroke_frag, wanted);
        if (status != CAMBER_OK)
            return status;
        wanted->variant = variant;
        shaders->strokes_built++;
    }
    *shader = wanted;
    return CAMBER_OK;
}

camber_status camber_shaders_flatten(camber_shaders *shaders, camber_flatten_kind kind, const camber_shader **shader) {
    static const char *const heads[CAMBER_FLATTEN_KINDS] = {
        "#define COVERAGE 0\n#define UNION 0\n#define MASKED 0\n#define FILL 0\n",
        "#define COVERAGE 1\n#define UNION 0\n#define MASKED 0\n#define FILL 0\n",
        "#define COVERAGE 0\n#define UNION 1\n#define MASKED 0\n#define FILL 0\n",
        "#define COVERAGE 0\n#define UNION 0\n#define MASKED 1\n#define FILL 0\n",
        "#define COVERAGE 0\n#define UNION 0\n#define MASKED 0\n#define FILL 1\n",
        "",
        "#define COVERAGE 0\n#define UNION 0\n#define MASKED 0\n#define FILL 0\n#define FLIPPED\n"};
    camber_shader *wanted = shaders->flatten + kind;
    if (!wanted->program) {
        const char *const fragment = kind == CAMBER_FLATTEN_IMAGES ? camber_images_frag : camber_flatten_frag;
        const camber_status status = build(shaders->surface, heads[kind], camber_flatten_vert, fragment, wanted);
        if (status != CAMBER_OK)
            return status;
    }
    *shader = wanted;
    return CAMBER_OK;
}

camber_status camber_shaders_count(camber_shaders *shaders, camber_method method, const camber_shader **shader) {
    camber_shader *wanted = shaders->counts + method;
    if (!wanted->program) {
        char head[256];
        snprintf(head, sizeof head,
                 "#define METHOD %d\n#define LINEAR 0\n#define TIPS 0\n#define SHARP_JOINS 0\n#define GAP 0\n#define "
                 "BLUR 0\n"
                 "#define DASH 0\n#define TRIM 0\n#define RAMP 0\n#define PATTERN 0\n#define PITCHED 0\n"
                 "#define TEXELS_A_ROW %d\n",
                 (int)method, (int)CAMBER_ROW_TEXELS);
        const camber_status status = build(shaders->surface, head, camber_stroke_vert, camber_count_frag, wanted);
        if (status != CAMBER_OK)
            return status;
    }
    *shader = wanted;
    return CAMBER_OK;
}

void camber_shaders_release(camber_shaders *shaders) {
    const camber_gl *gl = &shaders->surface->gl;
    for (size_t i = 0; i < CAMBER_STROKE_SHADERS_MAX; i++)
        gl->DeleteProgram(shaders->strokes[i].program);
    for (size_t i = 0; i < CAMBER_FLATTEN_KINDS; i++)
        gl->DeleteProgram(shaders->flatten[i].program);
    for (size_t i = 0; i < CAMBER_METHODS; i++)
        gl->DeleteProgram(shaders->counts[i].program);
}
