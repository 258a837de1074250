#include "app/library/toile.h"

#include "app/batch/frame/save_frame.h"
#include "app/scene/headless.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <locale.h>
#include <stdlib.h>
#include <string.h>

/* The codes and the message of the two errors are the same; the public one has no name of the inside. */
_Static_assert((int)TOILE_INTERRUPTED == (int)TL_INTERRUPTED,
               "codes of toile.h are those of config/base/error.h");
_Static_assert(sizeof((toile_error){0}.message) == sizeof((tl_error){0}.message), "messages have one size");

struct toile_scene {
    struct tl_headless headless;
};

static bool messages_wanted;

/* The state that holds during a call: numbers in files and options have a point whatever the caller's locale,
 * and the scene's GL context is current. */
struct call {
    locale_t plain, before;
    tl_gpu *gpu;
};

static struct call begin_call(void)
{
    tl_log_set_level(messages_wanted ? TL_LOG_INFO : TL_LOG_QUIET);
    struct call call = {.plain = newlocale(LC_ALL_MASK, "C", (locale_t)0)};
    call.before = uselocale(call.plain);
    return call;
}

static bool bind(struct call *call, tl_gpu *gpu, tl_error *error)
{
    call->gpu = tl_gpu_bind(gpu, error) ? gpu : NULL;
    return call->gpu != NULL;
}

/* Returns `done`, after copying the error of a call that failed. */
static bool end_call(const struct call *call, bool done, const tl_error *error, toile_error *out)
{
    if (call->gpu)
        tl_gpu_unbind(call->gpu);
    uselocale(call->before);
    freelocale(call->plain);
    if (out)
        *out = (toile_error){0};
    if (out && !done) {
        out->code = (int)error->code;
        memcpy(out->message, error->message, sizeof out->message);
    }
    return done;
}

const char *toile_version(void)
{
    return TOILE_VERSION;
}

void toile_set_messages(bool on)
{
    messages_wanted = on;
}

toile_scene *toile_load(const char *scene, const char *const *options, toile_error *error)
{
    tl_error inner = {0};
    struct call call = begin_call();
    size_t count = 0;
    while (options && options[count])
        count++;
    const struct tl_settings_source source = {
        .scene_file = scene, .assignments = options, .assignment_count = count};
    struct tl_settings settings;
    toile_scene *made = TL_NEW(toile_scene);
    bool done =
        tl_settings_load(&settings, &source, &inner) && tl_headless_open(&made->headless, &settings, &inner);
    if (done)
        call.gpu = made->headless.gpu;
    else
        free(made);
    return end_call(&call, done, &inner, error) ? made : NULL;
}

bool toile_settle(toile_scene *scene, toile_error *error)
{
    tl_error inner = {0};
    struct call call = begin_call();
    struct tl_settings draped = scene->headless.settings;
    draped.scene.drape = TL_DRAPE_SETTLE;
    bool done = !tl_session_is_undraped(scene->headless.session) ||
                tl_session_restart(scene->headless.session, &draped, &inner);
    if (done)
        scene->headless.settings = *tl_session_settings(scene->headless.session);
    return end_call(&call, done, &inner, error);
}

bool toile_step(toile_scene *scene, toile_error *error)
{
    tl_error inner = {0};
    struct call call = begin_call();
    bool done = tl_session_advance(scene->headless.session, &inner);
    return end_call(&call, done, &inner, error);
}

void toile_size(const toile_scene *scene, int *width, int *height)
{
    *width = scene->headless.settings.image.width;
    *height = scene->headless.settings.image.height;
}

static bool copy_image(const tl_image *image, float *rgba, size_t count, tl_error *error)
{
    size_t needed = (size_t)image->width * (size_t)image->height * 4;
    if (count != needed)
        return tl_fail(error, TL_USAGE, "toile_draw: room for %zu floats: the image has %d x %d x 4 = %zu",
                       count, image->width, image->height, needed);
    memcpy(rgba, tl_image_floats(image), needed * sizeof *rgba);
    return true;
}

bool toile_draw(toile_scene *scene, float *rgba, size_t count, toile_error *error)
{
    tl_error inner = {0};
    tl_image image = {0};
    struct call call = begin_call();
    bool done =
        bind(&call, scene->headless.gpu, &inner) && tl_headless_draw_still(&scene->headless, &inner) &&
        tl_renderer_read(scene->headless.renderer, &image, &inner) && copy_image(&image, rgba, count, &inner);
    tl_image_release(&image);
    return end_call(&call, done, &inner, error);
}

bool toile_save(toile_scene *scene, const char *path, toile_error *error)
{
    tl_error inner = {0};
    struct call call = begin_call();
    bool known = tl_path_has_extension(path, "exr") || tl_path_has_extension(path, "png");
    bool done =
        known
            ? bind(&call, scene->headless.gpu, &inner) && tl_headless_draw_still(&scene->headless, &inner) &&
                  tl_save_frame(&scene->headless, path, &inner)
            : tl_fail(&inner, TL_USAGE, "%s: unknown kind of image: end the name in .exr or .png", path);
    return end_call(&call, done, &inner, error);
}

void toile_destroy(toile_scene **scene)
{
    if (!*scene)
        return;
    tl_gpu *gpu = (*scene)->headless.gpu;
    tl_gpu_bind(gpu, NULL);
    tl_headless_release(&(*scene)->headless); /* leaves no context current */
    free(*scene);
    *scene = NULL;
}
