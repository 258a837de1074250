#include "render/gpu/context.h"

#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define FILES_MAX 40 /* of one shader, includes counted */

/* Line l of file f is called f x LINES_MAX + l: GLSL numbers files as well as lines, but Mesa gives file 0
 * for many places in another one. */
#define LINES_MAX 10000

/* One shader's text with its includes in place. */
struct shader_source {
    const struct tl_embedded *shaders;
    const char *defines; /* or NULL */
    const char *files[FILES_MAX];
    int file_count;
    char *text; /* grows */
    size_t size;
};

static void append(struct shader_source *source, const char *text, size_t size)
{
    source->text = tl_resize(source->text, source->size + size + 1, 1);
    memcpy(source->text + source->size, text, size);
    source->size += size;
    source->text[source->size] = '\0';
}

static void append_line_directive(struct shader_source *source, int line, int file)
{
    char directive[64];
    int length = snprintf(directive, sizeof directive, "#line %d\n", file * LINES_MAX + line);
    append(source, directive, (size_t)length);
}

/* Returns the file's path in TOILE_SHADER_DIR, which is laid out as the folder render/, as a new string; NULL
 * when it is not there. */
static char *path_on_disk(const struct tl_embedded *file)
{
    const char *folder = getenv("TOILE_SHADER_DIR");
    if (!folder)
        return NULL;
    const char *tail = file->source + strlen(file->source);
    for (int slashes = 0; tail > file->source && slashes < 2; tail--)
        slashes += tail[-1] == '/';
    char *path = tl_format("%s/%s", folder, *tail == '/' ? tail + 1 : tail);
    if (tl_file_exists(path))
        return path;
    free(path);
    return NULL;
}

/* The file's text as a new string: from disk, or else as embedded. */
static char *read_text(const struct tl_embedded *file, tl_error *error)
{
    char *path = path_on_disk(file);
    if (!path)
        return tl_copy_string(file->data);
    char *text = NULL;
    size_t size;
    if (!tl_file_read(path, &text, &size, error))
        text = NULL;
    free(path);
    return text;
}

/* If `line` begins with #include "name", the embedded file of that name, else NULL. */
static const struct tl_embedded *included_file(const struct shader_source *source, const char *line,
                                               bool *is_include, char name[64])
{
    *is_include = sscanf(line, "#include \"%63[^\"\n]\"", name) == 1;
    return *is_include ? tl_embedded_find(source->shaders, name) : NULL;
}

static bool expand(struct shader_source *source, const struct tl_embedded *file, tl_error *error)
{
    for (int i = 0; i < source->file_count; i++)
        if (source->files[i] == file->name)
            return true; /* each file once, as if it had an include guard */
    if (source->file_count == FILES_MAX)
        return tl_fail(error, TL_INPUT, "%s: more than %d files are included: merge some", file->name,
                       FILES_MAX);
    int number = source->file_count++;
    source->files[number] = file->name;
    char *text = read_text(file, error);
    if (!text)
        return false;
    if (number > 0) /* the first file begins with #version, which nothing may precede */
        append_line_directive(source, 1, number);
    bool fine = true;
    int line = 1;
    for (const char *start = text; fine && *start; line++) {
        size_t length = strcspn(start, "\n");
        bool is_include;
        char name[64];
        const struct tl_embedded *include = included_file(source, start, &is_include, name);
        if (is_include && !include) {
            fine = tl_fail(error, TL_INPUT, "%s:%d: no shader file is called %s: check the name", file->name,
                           line, name);
        } else if (include) {
            fine = expand(source, include, error);
            append_line_directive(source, line + 1, number);
        } else {
            append(source, start, length);
            append(source, "\n", 1);
            if (number == 0 && line == 1 && source->defines) { /* after #version */
                append(source, source->defines, strlen(source->defines));
                append_line_directive(source, 2, 0);
            }
        }
        start += length + (start[length] == '\n');
    }
    free(text);
    return fine;
}

/* The compiler's first message, with the name of the file that it is about: "light.frag:12(7): error: ...".
 * Mesa writes "0:LINE(COLUMN): ...", others "0(LINE) : ...". */
static bool fail_with_log(const struct shader_source *source, const char *log, tl_error *error)
{
    int line = 0, consumed = 0, length = (int)strcspn(log, "\n");
    if (length == 0)
        return tl_fail(error, TL_DEVICE,
                       "%s: the driver does not compile it and gives no reason: update the driver",
                       source->files[0]);
    if ((sscanf(log, "%*u:%d%n", &line, &consumed) == 1 || sscanf(log, "%*u(%d)%n", &line, &consumed) == 1) &&
        line >= 0 && line / LINES_MAX < source->file_count)
        return tl_fail(error, TL_INPUT, "%s:%d%.*s", source->files[line / LINES_MAX], line % LINES_MAX,
                       length - consumed, log + consumed);
    return tl_fail(error, TL_INPUT, "%s: %.*s", source->files[0], length, log);
}

static GLuint compile(GLenum kind, const tl_program *program, const char *name, tl_error *error)
{
    const struct tl_embedded *file = tl_embedded_find(program->shaders, name);
    struct shader_source source = {.shaders = program->shaders, .defines = program->defines};
    GLuint shader = 0;
    if (!file) {
        tl_fail(error, TL_INPUT, "%s: no shader file has this name: add it to toile_embed", name);
        return 0;
    }
    if (!expand(&source, file, error))
        goto done;
    shader = glCreateShader(kind);
    glShaderSource(shader, 1, (const GLchar *const *)&source.text, NULL);
    glCompileShader(shader);
    GLint compiled = GL_FALSE; /* stays where there is no shader */
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (!compiled) {
        char log[512] = "";
        glGetShaderInfoLog(shader, sizeof log, NULL, log);
        fail_with_log(&source, log, error);
        glDeleteShader(shader);
        shader = 0;
    }
done:
    free(source.text);
    return shader;
}

/* Attaches the program's files. Returns false if one does not compile. */
static bool attach(GLuint id, const tl_program *program, tl_error *error)
{
    const struct {
        GLenum kind;
        const char *file;
    } stages[] = {
        {GL_VERTEX_SHADER, program->vertex},
        {GL_FRAGMENT_SHADER, program->fragment},
        {GL_COMPUTE_SHADER, program->compute},
    };
    for (size_t i = 0; i < TL_COUNT(stages); i++) {
        if (!stages[i].file)
            continue;
        GLuint shader = compile(stages[i].kind, program, stages[i].file, error);
        if (!shader)
            return false;
        glAttachShader(id, shader);
        glDeleteShader(shader); /* it goes with the program */
    }
    return true;
}

static GLuint build(const tl_program *program, tl_error *error)
{
    GLuint id = glCreateProgram();
    GLint linked = GL_FALSE;
    if (attach(id, program, error)) {
        glLinkProgram(id);
        glGetProgramiv(id, GL_LINK_STATUS, &linked);
        if (!linked) {
            char log[512] = "";
            glGetProgramInfoLog(id, sizeof log, NULL, log);
            const char *reason =
                log[0] ? log : "the driver does not link them and gives no reason: update the driver";
            tl_fail(error, TL_INPUT, "%s%s%s: %.*s", program->vertex ? program->vertex : "",
                    program->vertex ? " + " : "", program->name, (int)strcspn(reason, "\n"), reason);
        }
    }
    if (!linked)
        glDeleteProgram(id);
    return linked ? id : 0;
}

bool tl_program_create(tl_gpu *gpu, const struct tl_embedded *shaders, const char *vertex,
                       const char *fragment, tl_program *out, tl_error *error)
{
    return tl_program_create_variant(gpu, shaders, vertex, fragment, NULL, out, error);
}

bool tl_program_create_variant(tl_gpu *gpu, const struct tl_embedded *shaders, const char *vertex,
                               const char *fragment, const char *defines, tl_program *out, tl_error *error)
{
    (void)gpu; /* current on this thread */
    *out = (tl_program){.shaders = shaders, .vertex = vertex, .fragment = fragment, .defines = defines};
    snprintf(out->name, sizeof out->name, "%s", fragment);
    out->id = build(out, error);
    return out->id != 0;
}

bool tl_program_create_compute(tl_gpu *gpu, const struct tl_embedded *shaders, const char *compute,
                               const char *defines, tl_program *out, tl_error *error)
{
    (void)gpu; /* current on this thread */
    *out = (tl_program){.shaders = shaders, .compute = compute, .defines = defines};
    snprintf(out->name, sizeof out->name, "%s", compute);
    out->id = build(out, error);
    return out->id != 0;
}

bool tl_program_reload(tl_program *program, tl_error *error)
{
    GLuint id = build(program, error);
    if (!id)
        return false;
    glDeleteProgram(program->id);
    program->id = id;
    return true;
}

/* A program in use would go only when another is used, and who restores it then, as ImGui does, fails. */
void tl_program_destroy(tl_program *program)
{
    GLint used = 0;
    if (program->id) {
        glGetIntegerv(GL_CURRENT_PROGRAM, &used);
        if ((GLuint)used == program->id)
            glUseProgram(0);
        glDeleteProgram(program->id);
    }
    *program = (tl_program){0};
}

uint64_t tl_shaders_stamp(const struct tl_embedded *shaders)
{
    uint64_t stamp = 0;
    for (const struct tl_embedded *file = shaders; file->name; file++) {
        char *path = path_on_disk(file);
        struct stat status;
        if (path && stat(path, &status) == 0)
            stamp = stamp * 1000003 + (uint64_t)status.st_mtim.tv_sec * 1000000000u +
                    (uint64_t)status.st_mtim.tv_nsec;
        free(path);
    }
    return stamp;
}
