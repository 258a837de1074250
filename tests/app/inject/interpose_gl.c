/* GL and EGL calls that may run out of memory: each is counted, and the n-th does nothing, as GL allows, and
 * glGetError then reports GL_OUT_OF_MEMORY, or EGL's result says that it failed. The program calls through
 * libepoxy's variables, of which this library has its own. */
#include "tests/app/inject/interpose.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

static int is_out_of_memory;

static int is_refused(void)
{
    static long refused = -2;
    if (refused == -2)
        refused = inject_number("INJECT_GL");
    if (refused < 0 || ++inject_account.calls != refused)
        return 0;
    is_out_of_memory = 1;
    return 1;
}

/* The driver's function. epoxy's own variables are not asked: they look it up at their first call, and would
 * put it in the place of this library's. */
static void *find(const char *name)
{
    static __typeof__(epoxy_eglGetProcAddress) find_function;
    if (!find_function)
        find_function =
            (__typeof__(find_function))(size_t)dlsym(dlopen("libEGL.so.1", RTLD_NOW), "eglGetProcAddress");
    return (void *)(size_t)find_function(name);
}

/* Defines epoxy's variable as a pointer to a function that passes the call on, unless it is refused. */
#define REFUSABLE(name, type, result, parameters, arguments)                                                 \
    static type call_##name parameters                                                                       \
    {                                                                                                        \
        static __typeof__(epoxy_##name) real;                                                                \
        if (!real)                                                                                           \
            real = (__typeof__(real))(size_t)find(#name);                                                    \
        if (is_refused())                                                                                    \
            return result;                                                                                   \
        return real arguments;                                                                               \
    }                                                                                                        \
    __typeof__(epoxy_##name) epoxy_##name = call_##name

REFUSABLE(glTextureStorage2D, void, , (GLuint t, GLsizei l, GLenum f, GLsizei w, GLsizei h), (t, l, f, w, h));
REFUSABLE(glTextureStorage3D, void, , (GLuint t, GLsizei l, GLenum f, GLsizei w, GLsizei h, GLsizei d),
          (t, l, f, w, h, d));
REFUSABLE(glTextureSubImage2D, void, ,
          (GLuint t, GLint l, GLint x, GLint y, GLsizei w, GLsizei h, GLenum f, GLenum k, const void *p),
          (t, l, x, y, w, h, f, k, p));
REFUSABLE(glTextureSubImage3D, void, ,
          (GLuint t, GLint l, GLint x, GLint y, GLint z, GLsizei w, GLsizei h, GLsizei d, GLenum f, GLenum k,
           const void *p),
          (t, l, x, y, z, w, h, d, f, k, p));
REFUSABLE(glNamedBufferData, void, , (GLuint b, GLsizeiptr s, const void *p, GLenum u), (b, s, p, u));
REFUSABLE(glNamedBufferStorage, void, , (GLuint b, GLsizeiptr s, const void *p, GLbitfield f), (b, s, p, f));
REFUSABLE(glNamedBufferSubData, void, , (GLuint b, GLintptr o, GLsizeiptr s, const void *p), (b, o, s, p));
REFUSABLE(glGetTextureImage, void, , (GLuint t, GLint l, GLenum f, GLenum k, GLsizei s, void *p),
          (t, l, f, k, s, p));
REFUSABLE(glGetTextureSubImage, void, ,
          (GLuint t, GLint l, GLint x, GLint y, GLint z, GLsizei w, GLsizei h, GLsizei d, GLenum f, GLenum k,
           GLsizei s, void *p),
          (t, l, x, y, z, w, h, d, f, k, s, p));
REFUSABLE(glDrawArrays, void, , (GLenum m, GLint f, GLsizei c), (m, f, c));
REFUSABLE(glDrawElements, void, , (GLenum m, GLsizei c, GLenum k, const void *p), (m, c, k, p));
REFUSABLE(glCreateShader, GLuint, 0, (GLenum k), (k));
REFUSABLE(glCompileShader, void, , (GLuint s), (s));
REFUSABLE(glCreateProgram, GLuint, 0, (void), ());
REFUSABLE(glLinkProgram, void, , (GLuint p), (p));
REFUSABLE(eglInitialize, EGLBoolean, EGL_FALSE, (EGLDisplay d, EGLint *a, EGLint *b), (d, a, b));
REFUSABLE(eglCreateContext, EGLContext, EGL_NO_CONTEXT,
          (EGLDisplay d, EGLConfig c, EGLContext s, const EGLint *a), (d, c, s, a));
REFUSABLE(eglMakeCurrent, EGLBoolean, EGL_FALSE, (EGLDisplay d, EGLSurface w, EGLSurface r, EGLContext c),
          (d, w, r, c));

static GLenum get_error(void)
{
    static __typeof__(epoxy_glGetError) real;
    if (!real)
        real = (__typeof__(real))(size_t)find("glGetError");
    if (!is_out_of_memory)
        return real();
    is_out_of_memory = 0;
    return GL_OUT_OF_MEMORY;
}
__typeof__(epoxy_glGetError) epoxy_glGetError = get_error;
