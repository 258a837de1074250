#include "render/gpu/context.h"

#include "config/base/log.h"
#include "config/base/memory.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GL_VERSION_NEEDED 45

/* Whether a message is of a fault. Drivers send hints about speed and notes as well, some of them as severe.
 */
static bool is_fault(GLenum type)
{
    return type == GL_DEBUG_TYPE_ERROR || type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR ||
           type == GL_DEBUG_TYPE_DEPRECATED_BEHAVIOR || type == GL_DEBUG_TYPE_PORTABILITY;
}

static void on_message(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                       const GLchar *message, const void *user)
{
    (void)source, (void)length;
    if (is_fault(type)) {
        /* The pointer comes back const only because GL declares it so. */
        ((tl_gpu *)user)->message_count++;
        tl_warn("GL message %u: %s", id, message);
    } else if (severity != GL_DEBUG_SEVERITY_NOTIFICATION) {
        tl_debug("GL hint %u: %s", id, message);
    }
}

/* Initialises everything that does not depend on the origin of the context. */
static bool take_over(tl_gpu *gpu, tl_error *error)
{
    if (epoxy_gl_version() < GL_VERSION_NEEDED || !epoxy_is_desktop_gl())
        return tl_fail(error, TL_DEVICE, "OpenGL: version %d.%d was found: 4.5 is needed, update the driver",
                       epoxy_gl_version() / 10, epoxy_gl_version() % 10);
    snprintf(gpu->name, sizeof gpu->name, "%s, OpenGL %s", (const char *)glGetString(GL_RENDERER),
             (const char *)glGetString(GL_VERSION));
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(on_message, gpu);
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &gpu->texture_side_max);
    glGetIntegerv(GL_SUBPIXEL_BITS, &gpu->subpixel_bits);
    gpu->compute = tl_compute_limits_query();
    glCreateVertexArrays(1, &gpu->empty_vertices);
    return true;
}

static bool create_context(tl_gpu *gpu, EGLDisplay display, tl_error *error)
{
    static const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                        4,
                                        EGL_CONTEXT_MINOR_VERSION,
                                        5,
                                        EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                        EGL_CONTEXT_OPENGL_DEBUG,
                                        EGL_TRUE,
                                        EGL_NONE};
    gpu->display = display;
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL))
        return tl_fail(error, TL_DEVICE,
                       "EGL: the device does not open: install its driver; libegl-mesa0 has one in software");
    if (eglBindAPI(EGL_OPENGL_API))
        gpu->context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    return (gpu->context != EGL_NO_CONTEXT &&
            eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, gpu->context)) ||
           tl_fail(error, TL_DEVICE, "EGL: no OpenGL 4.5 core context (EGL error 0x%x): update the driver",
                   (unsigned)eglGetError());
}

static tl_gpu *create_on(EGLDisplay display, tl_error *error)
{
    tl_gpu *gpu = TL_NEW(tl_gpu);
    gpu->context = EGL_NO_CONTEXT;
    if (!create_context(gpu, display, error) || !take_over(gpu, error))
        tl_gpu_destroy(&gpu);
    return gpu;
}

/* ---- Devices ---- */

static int chosen_device;

static bool find_egl(tl_error *error)
{
    return dlopen("libEGL.so.1", RTLD_LAZY) || /* libepoxy would abort */
           tl_fail(error, TL_DEVICE, "EGL: %s: install libegl1", dlerror());
}

static int list_devices(EGLDeviceEXT devices[TL_GPU_DEVICES_MAX])
{
    EGLint count = 0;
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
        (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") ||
         epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_base")))
        eglQueryDevicesEXT(TL_GPU_DEVICES_MAX, devices, &count);
    return count;
}

static EGLDisplay display_of(EGLDeviceEXT device)
{
    return eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, NULL);
}

int tl_gpu_devices(struct tl_gpu_device out[TL_GPU_DEVICES_MAX], tl_error *error)
{
    EGLDeviceEXT devices[TL_GPU_DEVICES_MAX];
    if (!find_egl(error))
        return -1;
    const int count = list_devices(devices);
    for (int i = 0; i < count; i++) {
        tl_error refusal = {0};
        tl_gpu *gpu = create_on(display_of(devices[i]), &refusal);
        out[i].opens = gpu != NULL;
        snprintf(out[i].name, sizeof out[i].name, "%.255s", gpu ? gpu->name : refusal.message);
        tl_gpu_destroy(&gpu);
    }
    return count;
}

void tl_gpu_choose(int device)
{
    chosen_device = device;
}

tl_gpu *tl_gpu_create_headless(tl_error *error)
{
    EGLDeviceEXT devices[TL_GPU_DEVICES_MAX];
    tl_gpu *gpu = NULL;
    if (!find_egl(error))
        return NULL;
    const int count = list_devices(devices);
    if (chosen_device > count)
        tl_fail(error, TL_USAGE, "--device: there is no device %d: `toile info devices` lists %d",
                chosen_device, count);
    else if (chosen_device > 0)
        gpu = create_on(display_of(devices[chosen_device - 1]), error);
    else if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        gpu = create_on(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL),
                        error);
    else if (count == 0)
        tl_fail(error, TL_DEVICE,
                "EGL: there is neither a surfaceless platform here nor a device: install Mesa's driver "
                "(libegl-mesa0)");
    for (int i = 0; !gpu && chosen_device == 0 && i < count; i++)
        gpu = create_on(display_of(devices[i]), error);
    return gpu;
}

tl_gpu *tl_gpu_create_current(tl_error *error)
{
    tl_gpu *gpu = TL_NEW(tl_gpu);
    gpu->display = EGL_NO_DISPLAY;
    if (!take_over(gpu, error))
        tl_gpu_destroy(&gpu);
    return gpu;
}

void tl_gpu_destroy(tl_gpu **gpu)
{
    if (!*gpu)
        return;
    if ((*gpu)->empty_vertices) {
        glDeleteVertexArrays(1, &(*gpu)->empty_vertices);
        glDebugMessageCallback(NULL, NULL); /* an adopted context outlives its tl_gpu */
    }
    if ((*gpu)->display != EGL_NO_DISPLAY) {
        eglMakeCurrent((*gpu)->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if ((*gpu)->context != EGL_NO_CONTEXT)
            eglDestroyContext((*gpu)->display, (*gpu)->context);
        /* The display itself is one for the whole process and stays open: another tl_gpu may be using it. */
    }
    free(*gpu);
    *gpu = NULL;
}

bool tl_gpu_bind(tl_gpu *gpu, tl_error *error)
{
    if (gpu->display == EGL_NO_DISPLAY ||
        eglMakeCurrent(gpu->display, EGL_NO_SURFACE, EGL_NO_SURFACE, gpu->context))
        return true;
    return tl_fail(
        error, TL_DEVICE,
        "EGL: the context cannot be used on this thread (EGL error 0x%x): is it in use on another?",
        (unsigned)eglGetError());
}

void tl_gpu_unbind(tl_gpu *gpu)
{
    if (gpu->display != EGL_NO_DISPLAY)
        eglMakeCurrent(gpu->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

const char *tl_gpu_name(const tl_gpu *gpu)
{
    return gpu->name;
}

bool tl_gpu_is_software(const tl_gpu *gpu)
{
    return strstr(gpu->name, "llvmpipe") != NULL;
}

size_t tl_gpu_message_count(const tl_gpu *gpu)
{
    return gpu->message_count;
}

size_t tl_gpu_bytes(const tl_gpu *gpu)
{
    return gpu->bytes;
}

bool tl_gpu_check(const tl_gpu *gpu, tl_error *error)
{
    const int flags_max = 8; /* GL may keep several; a lost context would report without end */
    bool is_exhausted = false;
    GLenum code = GL_NO_ERROR;
    for (int i = 0; i < flags_max && (code = glGetError()) != GL_NO_ERROR; i++)
        is_exhausted |= code == GL_OUT_OF_MEMORY;
    return !is_exhausted || tl_fail(error, TL_DEVICE,
                                    "OpenGL: out of memory, with %zu MiB of textures and buffers: close "
                                    "other programs, or make the image, "
                                    "light.regions or light.pem_size smaller",
                                    gpu->bytes >> 20);
}

int tl_gpu_texture_side_max(const tl_gpu *gpu)
{
    return gpu->texture_side_max;
}

int tl_gpu_subpixel_bits(const tl_gpu *gpu)
{
    return gpu->subpixel_bits;
}

void tl_gpu_reset_state(const tl_gpu *gpu)
{
    const GLenum off[] = {GL_BLEND,        GL_CULL_FACE,           GL_DEPTH_CLAMP,
                          GL_DEPTH_TEST,   GL_POLYGON_OFFSET_FILL, GL_SCISSOR_TEST,
                          GL_STENCIL_TEST, GL_FRAMEBUFFER_SRGB};
    for (size_t i = 0; i < TL_COUNT(off); i++)
        glDisable(off[i]);
    glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glBlendFunc(GL_ONE, GL_ZERO);
    glBlendEquation(GL_FUNC_ADD);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_PACK_ROW_LENGTH, 0);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    /* A sampler object of the window's panel would override the textures' own parameters. */
    for (GLuint unit = 0; unit < 8; unit++)
        glBindSampler(unit, 0);
    glBindVertexArray(gpu->empty_vertices);
}

void tl_gpu_draw_fullscreen(const tl_gpu *gpu)
{
    glBindVertexArray(gpu->empty_vertices);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}
