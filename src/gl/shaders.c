/* Shader programs, each built when it is first used. */
#include "draw/renderer.h"

#include "base/embedded.h"

#include <stdio.h>

enum { LOG_SIZE = 2048 };

/* A step that failed: GL's own error tells more than the step's log, where there is one. */
static camber_status fail_step(camber_renderer *renderer, const char *step, const char *log) {
    const camber_status status = camber_renderer_check(renderer, "shaders");
    if (status != CAMBER_OK)
        return status;
    return camber_fail(renderer->share.device->context, CAMBER_ERROR_DEVICE, "%s on %s; update its driver: %s", step,
                       renderer->share.surface->info.renderer, log[0] ? log : "it does not say why");
}

static camber_status compile(camber_renderer *renderer, GLenum kind, const char *head, const char *source,
                             GLuint *made) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const GLchar *version = renderer->share.surface->es_3_2
                                ? "#version 320 es\n"
                                : "#version 310 es\n#extension GL_EXT_texture_buffer : require\n";
    const GLchar *parts[] = {version, head, camber_edge_glsl, "#line 1\n", source};
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
    return fail_step(renderer, "a shader does not compile", log);
}

static camber_status link(camber_renderer *renderer, GLuint program, const GLuint parts[2]) {
    const camber_gl *gl = &renderer->share.surface->gl;
    GLint linked = 0;
    for (int i = 0; i < 2; i++)
        gl->AttachShader(program, parts[i]);
    gl->LinkProgram(program);
    gl->GetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked)
        return CAMBER_OK;
    char log[LOG_SIZE] = "";
    gl->GetProgramInfoLog(program, LOG_SIZE, NULL, log);
    return fail_step(renderer, "shaders do not link", log);
}

/* From the sources. */
static camber_status make(camber_renderer *renderer, const char *head, const char *vertex, const char *fragment,
                          GLuint program) {
    const camber_gl *gl = &renderer->share.surface->gl;
    GLuint parts[2] = {0, 0};
    camber_status status = compile(renderer, GL_VERTEX_SHADER, head, vertex, parts);
    if (status == CAMBER_OK)
        status = compile(renderer, GL_FRAGMENT_SHADER, head, fragment, parts + 1);
    if (status == CAMBER_OK)
        status = link(renderer, program, parts);
    for (int i = 0; i < 2; i++)
        gl->DeleteShader(parts[i]); /* 0 is none */
    return status;
}

static camber_status build(camber_renderer *renderer, const char *head, const char *vertex, const char *fragment,
                           camber_shader *shader) {
    const camber_gl *gl = &renderer->share.surface->gl;
    const char *const sources[] = {head, camber_edge_glsl, vertex, fragment};
    const uint64_t key = camber_linked_key(renderer, sources, sizeof sources / sizeof *sources);
    const double begin = camber_now_ms();
    const GLuint program = gl->CreateProgram();
    const bool cached = camber_linked_load(renderer, key, program);
    if (!cached) {
        gl->ProgramParameteri(program, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
        const camber_status status = make(renderer, head, vertex, fragment, program);
        if (status != CAMBER_OK) {
            gl->DeleteProgram(program);
            return status;
        }
        camber_linked_save(renderer, key, program);
    }
    camber_log(renderer->share.device->context, CAMBER_LOG_INFO, "shaders: %s in %.0f ms",
               cached ? "from the cache" : "built", camber_now_ms() - begin);
    *shader = (camber_shader){program,
                              0,
                              gl->GetUniformLocation(program, "u_origin"),
                              gl->GetUniformLocation(program, "u_corner"),
                              gl->GetUniformLocation(program, "u_scale"),
                              gl->GetUniformLocation(program, "u_color"),
                              gl->GetUniformLocation(program, "u_table"),
                              gl->GetUniformLocation(program, "u_table_rows"),
                              gl->GetUniformLocation(program, "u_stride"),
                              gl->GetUniformLocation(program, "u_tail"),
                              gl->GetUniformLocation(program, "u_eye"),
                              gl->GetUniformLocation(program, "u_place"),
                              gl->GetUniformLocation(program, "u_mean"),
                              gl->GetUniformLocation(program, "u_first"),
                              gl->GetUniformLocation(program, "u_axis_x"),
                              gl->GetUniformLocation(program, "u_axis_y")};
    return CAMBER_OK;
}

camber_status camber_renderer_stroke_shader(camber_renderer *renderer, unsigned variant, const camber_shader **shader) {
    const camber_gl *gl = &renderer->share.surface->gl;
    camber_shader *wanted = renderer->strokes;
    while (wanted < renderer->strokes + CAMBER_STROKES_MAX && wanted->program && wanted->variant != variant)
        wanted++;
    if (wanted == renderer->strokes + CAMBER_STROKES_MAX) { /* the oldest goes */
        wanted = renderer->strokes + renderer->strokes_built % CAMBER_STROKES_MAX;
        gl->DeleteProgram(wanted->program);
        wanted->program = 0;
    }
    if (!wanted->program) {
        char head[512];
        snprintf(
            head, sizeof head,
            "#define LINEAR %d\n#define SHARP_JOINS %d\n#define FLAT_CAPS %d\n#define COUNT %d\n"
            "#define UNION %d\n#define METHOD %u\n#define THIN %d\n#define TIPS %d\n#define GAP %d\n#define BLUR %d\n"
            "#define DASH %d\n#define TRIM %d\n#define RAMP %d\n#define MASK %d\n#define PATTERN %d\n"
            "#define PITCHED %d\n#define TEXELS_A_ROW %d\n",
            (variant & CAMBER_VARIANT_LINEAR) != 0, (variant & CAMBER_VARIANT_SHARP_JOINS) != 0,
            (variant & CAMBER_VARIANT_FLAT_CAPS) != 0, (variant & CAMBER_VARIANT_COUNT) != 0,
            (variant & CAMBER_VARIANT_UNION) != 0, variant / CAMBER_VARIANT_METHOD,
            (variant & CAMBER_VARIANT_THIN) != 0, (variant & CAMBER_VARIANT_TIPS) != 0,
            (variant & CAMBER_VARIANT_GAP) != 0, (variant & CAMBER_VARIANT_BLUR) != 0,
            (variant & CAMBER_VARIANT_DASH) != 0, (variant & CAMBER_VARIANT_TRIM) != 0,
            (variant & CAMBER_VARIANT_RAMP) != 0, (variant & CAMBER_VARIANT_MASK) != 0,
            (variant & CAMBER_VARIANT_PATTERN) != 0, (variant & CAMBER_VARIANT_PITCHED) != 0, (int)CAMBER_TEXELS_A_ROW);
        const camber_status status = build(renderer, head, camber_stroke_vert, camber_stroke_frag, wanted);
        if (status != CAMBER_OK)
            return status;
        wanted->variant = variant;
        renderer->strokes_built++;
    }
    *shader = wanted;
    return CAMBER_OK;
}

camber_status camber_renderer_flatten_shader(camber_renderer *renderer, camber_flatten_kind kind,
                                             const camber_shader **shader) {
    static const char *const heads[CAMBER_FLATTEN_KINDS] = {
        "#define COVERAGE 0\n#define UNION 0\n#define MASKED 0\n#define FILL 0\n#define IMAGES 0\n",
        "#define COVERAGE 1\n#define UNION 0\n#define MASKED 0\n#define FILL 0\n#define IMAGES 0\n",
        "#define COVERAGE 0\n#define UNION 1\n#define MASKED 0\n#define FILL 0\n#define IMAGES 0\n",
        "#define COVERAGE 0\n#define UNION 0\n#define MASKED 1\n#define FILL 0\n#define IMAGES 0\n",
        "#define COVERAGE 0\n#define UNION 0\n#define MASKED 0\n#define FILL 1\n#define IMAGES 0\n",
        "#define COVERAGE 0\n#define UNION 0\n#define MASKED 0\n#define FILL 1\n#define IMAGES 1\n",
        "#define COVERAGE 0\n#define UNION 0\n#define MASKED 0\n#define FILL 0\n#define IMAGES 0\n#define FLIPPED\n"};
    camber_shader *wanted = renderer->flatten + kind;
    if (!wanted->program) {
        const camber_status status = build(renderer, heads[kind], camber_flatten_vert, camber_flatten_frag, wanted);
        if (status != CAMBER_OK)
            return status;
    }
    *shader = wanted;
    return CAMBER_OK;
}

camber_status camber_renderer_count_shader(camber_renderer *renderer, camber_method method,
                                           const camber_shader **shader) {
    camber_shader *wanted = renderer->counts + method;
    if (!wanted->program) {
        char head[256];
        snprintf(head, sizeof head,
                 "#define METHOD %d\n#define TIPS 0\n#define SHARP_JOINS 0\n#define GAP 0\n#define BLUR 0\n"
                 "#define DASH 0\n#define TRIM 0\n#define RAMP 0\n#define PATTERN 0\n#define PITCHED 0\n"
                 "#define TEXELS_A_ROW %d\n",
                 (int)method, (int)CAMBER_TEXELS_A_ROW);
        const camber_status status = build(renderer, head, camber_stroke_vert, camber_count_frag, wanted);
        if (status != CAMBER_OK)
            return status;
    }
    *shader = wanted;
    return CAMBER_OK;
}
