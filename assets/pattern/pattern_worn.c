#include "assets/pattern/pattern_worn.h"

#include "assets/pattern/pattern_cut.h"
#include "assets/pattern/pattern_place.h"
#include "config/base/log.h"
#include "config/options.h"

/* Panels are raised only where the waist is known. */
static void place(tl_pattern *pattern, const struct tl_pattern_wearer *wearer)
{
    struct tl_pattern_measures measures = {0};
    bool known = tl_option_is_file_name(wearer->name) && tl_pattern_measures(wearer->name, &measures);
    if (!wearer->mesh)
        return;
    struct tl_pattern_levels levels = tl_pattern_levels(&measures, wearer->mesh);
    tl_pattern_hold(pattern, &levels);
    if (levels.waist > 0 && tl_pattern_raise(pattern, &levels))
        tl_info("%s: hung at the waist of %s, %.3f m high by %s", pattern->name, wearer->name, levels.waist,
                known ? "the measures beside it" : "its girths");
}

bool tl_pattern_worn(const char *path, const struct tl_pattern_wearer *wearer, float edge_m, tl_garment *out,
                     tl_error *error)
{
    tl_pattern pattern;
    *out = (tl_garment){0};
    if (!tl_pattern_load(path, &pattern, error))
        return false;
    place(&pattern, wearer);
    bool good = tl_pattern_cut(&pattern, edge_m, out, error);
    tl_pattern_release(&pattern);
    return good;
}
