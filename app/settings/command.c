#include "app/settings/command.h"

bool tl_settings_of_command(const struct tl_arguments *arguments, bool needs_garment, struct tl_settings *out,
                            tl_error *error)
{
    if (arguments->positional_count > 1)
        return tl_fail(error, TL_USAGE,
                       "%s: one scene at a time: name a YAML, .glb, .gltf, .obj or .json file, or none",
                       arguments->positionals[1]);
    const struct tl_settings_source source = {
        .scene_file = arguments->positional_count ? arguments->positionals[0] : NULL,
        .assignments = (const char *const *)arguments->assignments,
        .assignment_count = arguments->assignment_count,
    };
    if (!tl_settings_load(out, &source, error))
        return false;
    if (needs_garment && out->scene.is_undecided)
        tl_settings_wear(&out->scene);
    return true;
}
