#include "tests/render/bindings.h"

#include "config/base/hash.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#define PRINTED_MAX 5

static PFNGLDRAWARRAYSPROC draw_arrays;
static PFNGLDRAWELEMENTSPROC draw_elements;
static PFNGLDISPATCHCOMPUTEPROC dispatch;
static PFNGLDISPATCHCOMPUTEINDIRECTPROC dispatch_indirect;
static PFNGLCOMPILESHADERPROC compile_shader;
static size_t faults;

/* The binding that a sampler's type reads, 0: no sampler of this program's shaders. */
static GLenum binding_of(GLenum type, bool *compares)
{
    static const struct {
        GLenum type, binding;
        bool compares;
    } types[] = {
        {GL_SAMPLER_2D, GL_TEXTURE_BINDING_2D, false},
        {GL_SAMPLER_2D_ARRAY, GL_TEXTURE_BINDING_2D_ARRAY, false},
        {GL_SAMPLER_CUBE, GL_TEXTURE_BINDING_CUBE_MAP, false},
        {GL_SAMPLER_CUBE_MAP_ARRAY, GL_TEXTURE_BINDING_CUBE_MAP_ARRAY, false},
        {GL_UNSIGNED_INT_SAMPLER_2D, GL_TEXTURE_BINDING_2D, false},
        {GL_SAMPLER_2D_SHADOW, GL_TEXTURE_BINDING_2D, true},
        {GL_SAMPLER_2D_ARRAY_SHADOW, GL_TEXTURE_BINDING_2D_ARRAY, true},
    };
    for (size_t i = 0; i < TL_COUNT(types); i++)
        if (types[i].type == type) {
            *compares = types[i].compares;
            return types[i].binding;
        }
    return 0;
}

/* A program's samplers. To list them takes GL longer than to draw, so those of the last programs are kept;
 * one that has been deleted may have left its name to another. */
struct sampler {
    GLenum binding;
    bool compares;
    GLint unit;
    char name[64];
};
#define SAMPLERS_MAX 32
#define STORAGES_MAX 16
#define KEPT_MAX     64
struct listed {
    GLint program, uniform_count, count, storage_count;
    struct sampler samplers[SAMPLERS_MAX];
    GLint storages[STORAGES_MAX]; /* bindings of storage blocks */
};
static struct listed kept[KEPT_MAX];

static void list_storages(struct listed *listed)
{
    const GLuint program = (GLuint)listed->program;
    const GLenum asked = GL_BUFFER_BINDING;
    glGetProgramInterfaceiv(program, GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES, &listed->storage_count);
    listed->storage_count = listed->storage_count < STORAGES_MAX ? listed->storage_count : STORAGES_MAX;
    for (GLint i = 0; i < listed->storage_count; i++)
        glGetProgramResourceiv(program, GL_SHADER_STORAGE_BLOCK, (GLuint)i, 1, &asked, 1, NULL,
                               &listed->storages[i]);
}

static void list_samplers(struct listed *listed)
{
    const GLuint program = (GLuint)listed->program;
    listed->count = 0;
    for (GLint i = 0; i < listed->uniform_count && listed->count < SAMPLERS_MAX; i++) {
        struct sampler *sampler = &listed->samplers[listed->count];
        GLint size;
        GLenum type;
        glGetActiveUniform(program, (GLuint)i, sizeof sampler->name, NULL, &size, &type, sampler->name);
        sampler->binding = binding_of(type, &sampler->compares);
        if (!sampler->binding)
            continue;
        glGetUniformiv(program, glGetUniformLocation(program, sampler->name), &sampler->unit);
        listed->count++;
    }
}

static const struct listed *samplers_of(GLint program)
{
    struct listed *listed = &kept[program % KEPT_MAX];
    GLint uniform_count;
    glGetProgramiv((GLuint)program, GL_ACTIVE_UNIFORMS, &uniform_count);
    if (listed->program != program || listed->uniform_count != uniform_count) {
        listed->program = program;
        listed->uniform_count = uniform_count;
        list_samplers(listed);
        list_storages(listed);
    }
    return listed;
}

static void check_sampler(const struct sampler *sampler)
{
    GLint texture, mode = GL_NONE;
    glActiveTexture(GL_TEXTURE0 + (GLenum)sampler->unit);
    glGetIntegerv(sampler->binding, &texture);
    if (texture)
        glGetTextureParameteriv((GLuint)texture, GL_TEXTURE_COMPARE_MODE, &mode);
    if (sampler->compares ? mode == GL_COMPARE_REF_TO_TEXTURE : mode == GL_NONE)
        return;
    if (faults++ < PRINTED_MAX)
        print_error("bindings: sampler %s reads unit %d, texture %d, which %s\n", sampler->name,
                    sampler->unit, texture,
                    !texture            ? "is none"
                    : sampler->compares ? "does not compare depths"
                                        : "compares depths");
}

static void check_storage(GLint program, GLint binding)
{
    GLint buffer;
    glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, (GLuint)binding, &buffer);
    if (!buffer && faults++ < PRINTED_MAX)
        print_error("bindings: program %d reads storage buffer %d, which is none\n", program, binding);
}

static void check_draw(void)
{
    GLint program, active;
    glGetIntegerv(GL_CURRENT_PROGRAM, &program);
    if (!program)
        return;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    const struct listed *listed = samplers_of(program);
    for (GLint i = 0; i < listed->count; i++)
        check_sampler(&listed->samplers[i]);
    for (GLint i = 0; i < listed->storage_count; i++)
        check_storage(program, listed->storages[i]);
    glActiveTexture((GLenum)active);
}

static void watched_arrays(GLenum mode, GLint first, GLsizei count)
{
    check_draw();
    draw_arrays(mode, first, count);
}

static void watched_elements(GLenum mode, GLsizei count, GLenum type, const void *indices)
{
    check_draw();
    draw_elements(mode, count, type, indices);
}

static void watched_dispatch(GLuint x, GLuint y, GLuint z)
{
    check_draw();
    dispatch(x, y, z);
}

static void watched_dispatch_indirect(GLintptr offset)
{
    check_draw();
    dispatch_indirect(offset);
}

/* Writes the text of a shader to FOLDER/HASH.vert, .frag or .comp, as glslangValidator tells them. */
static void keep_shader(const char *folder, GLuint shader)
{
    GLint type, size;
    glGetShaderiv(shader, GL_SHADER_TYPE, &type);
    glGetShaderiv(shader, GL_SHADER_SOURCE_LENGTH, &size);
    char *text = tl_alloc((size_t)size + 1, 1);
    glGetShaderSource(shader, size, NULL, text);
    char *path =
        tl_format("%s/%016llx.%s", folder, (unsigned long long)tl_hash(TL_HASH_START, text, strlen(text)),
                  type == GL_VERTEX_SHADER    ? "vert"
                  : type == GL_COMPUTE_SHADER ? "comp"
                                              : "frag");
    FILE *file = fopen(path, "w");
    if (file) {
        fputs(text, file);
        fclose(file);
    }
    free(path);
    free(text);
}

/* Keeps shaders that this driver compiles: others may refuse them. Tests of refusals compile wrong ones. */
static void watched_compile(GLuint shader)
{
    const char *folder = getenv("TOILE_SHADERS_TO");
    GLint compiled = GL_FALSE;
    compile_shader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (folder && compiled)
        keep_shader(folder, shader);
}

void test_bindings_watch(void)
{
    if (draw_arrays)
        return;
    /* epoxy's own pointers are set to these at their first call, which would take the watch away. */
    draw_arrays = (PFNGLDRAWARRAYSPROC)eglGetProcAddress("glDrawArrays");
    draw_elements = (PFNGLDRAWELEMENTSPROC)eglGetProcAddress("glDrawElements");
    dispatch = (PFNGLDISPATCHCOMPUTEPROC)eglGetProcAddress("glDispatchCompute");
    dispatch_indirect = (PFNGLDISPATCHCOMPUTEINDIRECTPROC)eglGetProcAddress("glDispatchComputeIndirect");
    compile_shader = (PFNGLCOMPILESHADERPROC)eglGetProcAddress("glCompileShader");
    epoxy_glCompileShader = watched_compile;
    epoxy_glDispatchCompute = watched_dispatch;
    epoxy_glDispatchComputeIndirect = watched_dispatch_indirect;
    epoxy_glDrawArrays = watched_arrays;
    epoxy_glDrawElements = watched_elements;
}

size_t test_bindings_take_faults(void)
{
    const size_t taken = faults;
    faults = 0;
    return taken;
}
