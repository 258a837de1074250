#include "app/batch/frame/save_frame.h"

#include "app/report/legend.h"
#include "assets/image/exr.h"
#include "assets/image/image_file.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "render/inspect/aovs.h"
#include "render/inspect/inspect.h"

static void draw_legend(const struct tl_headless *headless, tl_image *image)
{
    struct tl_legend legend;
    tl_renderer_legend(headless->renderer, &legend);
    if (!tl_legend_draw(&legend, image))
        tl_info("%s: the picture is too small for its legend", legend.title);
}

/* Saves the image, and as further layers the AOVs that were asked for. */
static bool save_layers(const struct tl_headless *headless, const char *path, const tl_image *image,
                        tl_error *error)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    struct tl_exr_layer written[1 + TL_AOVS_MAX] = {{.channel_names = names, .image = image}};
    struct tl_aovs aovs = {0};
    if (headless->aovs && !tl_renderer_read_aovs(headless->renderer, &aovs, error))
        return false;
    for (int i = 0; i < aovs.count; i++)
        written[1 + i] =
            (struct tl_exr_layer){.channel_names = aovs.items[i].channels, .image = &aovs.items[i].image};
    bool saved = tl_exr_save(path, written, 1 + (size_t)aovs.count, error);
    tl_aovs_release(&aovs);
    return saved;
}

bool tl_save_frame(struct tl_headless *headless, const char *path, tl_error *error)
{
    tl_image image = {0};
    bool saved;
    if (tl_path_has_extension(path, "exr")) {
        saved =
            tl_renderer_read(headless->renderer, &image, error) && save_layers(headless, path, &image, error);
    } else {
        saved = tl_renderer_show_image(headless->renderer, &image, error);
        if (saved && headless->settings.image.legend)
            draw_legend(headless, &image);
        saved = saved && tl_image_save_png(path, &image, error);
    }
    tl_image_release(&image);
    return saved;
}
