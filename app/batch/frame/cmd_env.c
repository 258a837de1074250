/* toile env: converts an environment map to another layout, or captures what the middle of a scene sees. */
#include "app/batch/commands.h"
#include "app/scene/headless.h"
#include "app/scene/moving_light.h"
#include "assets/environment/studio.h"
#include "assets/image/exr.h"
#include "config/base/file.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "config/options.h"
#include "render/env/convert.h"

#include <string.h>

/* Comments in the written files, for users of other programs. */
static const char *const descriptions[TL_LAYOUT_COUNT] = {
    [TL_LAYOUT_CUBE] =
        TL_EXR_ENVMAP_COMMENT "cube: faces +X -X +Y -Y +Z -Z from the top, each oriented as OpenGL "
                              "has it; +Y is up",
    [TL_LAYOUT_SPHERE] =
        TL_EXR_ENVMAP_COMMENT "sphere: a mirror ball seen along -Z, +Y is up; the centre shows +Z",
    [TL_LAYOUT_PARABOLOID] = TL_EXR_ENVMAP_COMMENT "dual paraboloid: left disc d.xy / (1 + d.z), "
                                                   "right disc (-d.x, d.y) / (1 - d.z); +Y is up",
    [TL_LAYOUT_LATLONG] =
        TL_EXR_ENVMAP_COMMENT "latlong: u = 0.5 + atan2(x, -z) / 2pi, v = acos(y) / pi; +Y is up",
    [TL_LAYOUT_OCTAHEDRAL] =
        TL_EXR_ENVMAP_COMMENT "octahedral: |x| + |y| + |z| = 1 unfolded about +Y, +X right, +Z "
                              "down; -Y in the corners",
};

static bool find_layout(const char *flag, const char *name, enum tl_layout *layout, tl_error *error)
{
    for (int i = 0; i < TL_LAYOUT_COUNT; i++)
        if (strcmp(tl_layout_names[i], name) == 0) {
            *layout = (enum tl_layout)i;
            return true;
        }
    return tl_fail(error, TL_USAGE, "%s: \"%s\": expected cube, sphere, paraboloid, latlong or octahedral",
                   flag, name);
}

static bool check_arguments(const struct tl_arguments *arguments, tl_error *error)
{
    if (!arguments->capture && arguments->positional_count != 1)
        return tl_fail(error, TL_USAGE,
                       "env: expected one environment map: toile env IN -o OUT.exr --layout cube");
    if (!arguments->capture && arguments->assignment_count > 0)
        return tl_fail(error, TL_USAGE,
                       "%s: a map that is converted has no scene: leave it out, or capture one: --capture",
                       arguments->assignments[0]);
    if (arguments->capture && arguments->from)
        return tl_fail(error, TL_USAGE, "--from: a captured scene comes as a cube: leave it out");
    if (!arguments->output || !tl_path_has_extension(arguments->output, "exr"))
        return tl_fail(error, TL_USAGE, "%s: unknown kind of file: add -o FILE.exr",
                       arguments->output ? arguments->output : "env: no output");
    if (!arguments->layout)
        return tl_fail(error, TL_USAGE,
                       "env: into which layout? add --layout cube, sphere, paraboloid, latlong or "
                       "octahedral");
    return true;
}

/* Guesses the layout of a file that states none from its shape. Paraboloids have the shape of lat-long maps
 * and octahedral maps that of spheres: for both the user has to name the layout. */
static enum tl_layout guess_layout(const tl_environment *environment)
{
    if (environment->layout != TL_ENV_LATLONG)
        return tl_environment_layout(environment);
    return environment->image.width == environment->image.height ? TL_LAYOUT_SPHERE : TL_LAYOUT_LATLONG;
}

static bool find_source(const struct tl_arguments *arguments, const tl_environment *environment,
                        struct tl_sphere_map *from, tl_error *error)
{
    const char *path = arguments->positionals[0];
    *from = (struct tl_sphere_map){guess_layout(environment), environment->image.width,
                                   environment->image.height};
    if (!arguments->from) {
        tl_info("%s: %d x %d texels, taken for %s: name another with --from", path, from->width, from->height,
                tl_layout_names[from->layout]);
        return true;
    }
    if (!find_layout("--from", arguments->from, &from->layout, error))
        return false;
    int64_t width, height;
    tl_layout_extent(from->layout, tl_layout_size(from), &width, &height);
    if (from->layout != TL_LAYOUT_LATLONG && (width != from->width || height != from->height))
        return tl_fail(
            error, TL_INPUT,
            "%s: %d x %d texels cannot be %s, which has %d x %d for each of size: leave --from out", path,
            from->width, from->height, tl_layout_names[from->layout], (int)(width / tl_layout_size(from)),
            (int)(height / tl_layout_size(from)));
    return true;
}

static bool find_target(const struct tl_arguments *arguments, const struct tl_sphere_map *from,
                        enum tl_layout layout, struct tl_sphere_map *to, tl_error *error)
{
    int64_t width, height;
    int size = arguments->map_size ? arguments->map_size : tl_convert_size(from, layout);
    tl_layout_extent(layout, size, &width, &height);
    if (!tl_image_size_check(arguments->output, width, height, error))
        return false;
    *to = (struct tl_sphere_map){layout, (int)width, (int)height};
    return true;
}

static bool save(const struct tl_arguments *arguments, const tl_image *image, enum tl_layout layout,
                 tl_error *error)
{
    static const char *const names[] = {"R", "G", "B"};
    const struct tl_exr_layer layer = {names, image};
    return tl_exr_save_commented(arguments->output, &layer, 1, descriptions[layout], error);
}

static bool convert(const struct tl_arguments *arguments, enum tl_layout layout, const tl_image *source,
                    const struct tl_sphere_map *from, tl_error *error)
{
    struct tl_sphere_map to;
    if (!find_target(arguments, from, layout, &to, error) ||
        !tl_memory_request(arguments->output, tl_convert_bytes(from, &to), error))
        return false;
    double worst;
    tl_image image = tl_image_convert(source, from, &to, &worst);
    if (!image.texels)
        return tl_fail(error, TL_INTERRUPTED, "env: stopped: %s was not written", arguments->output);
    bool saved = save(arguments, &image, layout, error);
    tl_image_release(&image);
    if (saved)
        tl_info("%s: %s, %d x %d texels, the power of any light kept within %.1g", arguments->output,
                tl_layout_names[layout], to.width, to.height, worst);
    return saved;
}

static bool convert_file(const struct tl_arguments *arguments, enum tl_layout layout, tl_error *error)
{
    tl_environment environment;
    struct tl_sphere_map from;
    if (!tl_environment_find(arguments->positionals[0], &environment) &&
        !tl_environment_load(arguments->positionals[0], &environment, error))
        return false;
    tl_environment_warn_of_cleaning(&environment);
    bool done = find_source(arguments, &environment, &from, error) &&
                convert(arguments, layout, &environment.image, &from, error);
    tl_environment_release(&environment);
    return done;
}

/* The captured cube has about the resolution of the result. */
static int capture_size(const struct tl_arguments *arguments, enum tl_layout layout,
                        const struct tl_maps_params *maps)
{
    if (!arguments->map_size)
        return maps->size;
    int64_t width, height;
    tl_layout_extent(layout, arguments->map_size, &width, &height);
    const struct tl_sphere_map map = {layout, (int)width, (int)height};
    int wanted = tl_convert_size(&map, TL_LAYOUT_CUBE), size = TL_MAPS_SIZE_MIN;
    while (size < wanted && size < TL_MAPS_SIZE_MAX)
        size *= 2;
    return size;
}

static bool capture(struct tl_headless *headless, const struct tl_arguments *arguments, enum tl_layout layout,
                    tl_image *out, tl_error *error)
{
    headless->settings.light.method = TL_METHOD_MAPS;
    headless->settings.maps.capture_every = 1;
    headless->settings.maps.size = capture_size(arguments, layout, &headless->settings.maps);
    for (int frame = 0; frame < arguments->first_frame; frame++)
        if (tl_interrupted())
            return tl_fail(error, TL_INTERRUPTED, "env: stopped at frame %d", frame);
        else if (!tl_session_advance(headless->session, error))
            return false;
    return tl_headless_draw_still(headless, error) &&
           tl_renderer_read_capture(headless->renderer, out, error);
}

static bool convert_capture(const struct tl_arguments *arguments, enum tl_layout layout, tl_error *error)
{
    struct tl_headless headless;
    tl_image cube = {0};
    struct tl_sphere_map from = {TL_LAYOUT_CUBE, TL_MAPS_SIZE_MIN, 6 * TL_MAPS_SIZE_MIN}, to;
    if (!find_target(arguments, &from, layout, &to, error) || /* checked before the cloth is settled */
        !tl_headless_create(&headless, arguments, error))
        return false;
    bool done = capture(&headless, arguments, layout, &cube, error);
    from.width = cube.width;
    from.height = cube.height;
    done = done && convert(arguments, layout, &cube, &from, error);
    tl_image_release(&cube);
    tl_headless_release(&headless);
    return done;
}

bool tl_command_env(const struct tl_arguments *arguments, tl_error *error)
{
    enum tl_layout layout = TL_LAYOUT_LATLONG;
    if (!check_arguments(arguments, error) || !find_layout("--layout", arguments->layout, &layout, error))
        return false;
    return arguments->capture ? convert_capture(arguments, layout, error)
                              : convert_file(arguments, layout, error);
}
