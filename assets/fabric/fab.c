/* Raw measurements of the FAB tester, as u3m's physics_schema.json has them: for strips along the length (L),
 * the width (W) and the bias (B), paths of (distance in cm, force in gram-force); each test's first path
 * loads, the next unloads.
 *
 * Stretch (S2: 8 cm between the clamps): the slope of tension over strain between 2 and 10 gf/cm, about what
 * a garment's own weight puts into its cloth. Below, the strip is not yet straight.
 *
 * Shear, from the bias strip's stiffness E: a strip cut at 45 degrees has 4/E = 1/weft + 1/warp + 1/shear.
 *
 * Bending (D1 and U1: a strip between clamps 2 cm apart is pushed together, and buckles down, up): Euler's
 * load of a strip clamped at both ends, F = 4 pi^2 B b / L^2, which in the buckled strip grows by half of its
 * relative shortening [Timoshenko and Gere 1961, 2.7, to first order]. The mean over
 * both directions is free of the strip's own curl. */
#include "assets/fabric/fabric_internal.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

#define GRAM_FORCE_N   9.80665e-3
#define CM_M           1e-2
#define LOW_GF_PER_CM  2
#define HIGH_GF_PER_CM 10
#define THICKNESS_CM_M 1e-2

struct path {
    size_t count; /* of pairs */
    double *values;
};

struct fab_reader {
    tl_fabric_file *file;
    char *place;
    const char *prefix; /* of the fields' names */
    const cJSON *raw;
    tl_error *error;
};

static bool fail(const struct fab_reader *reader, const char *strip, const char *test, const char *expected)
{
    return tl_fail(reader->error, TL_INPUT, "%s: raw_data.%s.%s: expected %s", reader->place, strip, test,
                   expected);
}

/* The first path of a test; empty where the file lacks the test. */
static bool read_path(const struct fab_reader *reader, const char *strip, const char *test, const cJSON *part,
                      struct path *out)
{
    const cJSON *tree = cJSON_GetObjectItemCaseSensitive(part, "samplesTree"),
                *list = tree ? tree->child : NULL, *item;
    *out = (struct path){0};
    if (!part || cJSON_IsNull(part))
        return true;
    size_t count = cJSON_IsArray(list) ? (size_t)cJSON_GetArraySize(list) : 0, at = 0;
    if (!cJSON_IsArray(tree) || count < 2 || count % 2 != 0)
        return fail(reader, strip, test, "samplesTree, lists of pairs of distance and force");
    out->values = TL_NEW_ARRAY(double, count);
    cJSON_ArrayForEach(item, list)
    {
        if (!cJSON_IsNumber(item) || !isfinite(item->valuedouble)) {
            free(out->values);
            return fail(reader, strip, test, "numbers in samplesTree");
        }
        out->values[at++] = item->valuedouble;
    }
    out->count = count / 2;
    return true;
}

static bool read_width(const struct fab_reader *reader, const char *strip, const char *test,
                       const cJSON *part, double *width_cm)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(part, "width");
    if (!cJSON_IsNumber(value) || !(value->valuedouble > 0.1 && value->valuedouble < 100))
        return fail(reader, strip, test, "width, centimetres from 0.1 to 100");
    *width_cm = value->valuedouble;
    return true;
}

/* The distance at which a rising path first reaches a force; NaN: never. */
static double distance_at(const struct path *path, double force)
{
    const double *v = path->values;
    for (size_t i = 1; i < path->count; i++) {
        double before = v[2 * i - 1], after = v[2 * i + 1];
        if (before < force && after >= force)
            return v[2 * i - 2] + (v[2 * i] - v[2 * i - 2]) * (force - before) / (after - before);
    }
    return NAN;
}

/* N/m, of a strip; NaN when the path does not reach the tensions. */
static double stretch_of(const struct path *path, double width_cm)
{
    double low = distance_at(path, LOW_GF_PER_CM * width_cm),
           high = distance_at(path, HIGH_GF_PER_CM * width_cm);
    double strain = (high - low) / path->values[0];
    double tension = (HIGH_GF_PER_CM - LOW_GF_PER_CM) * GRAM_FORCE_N / CM_M;
    return strain > 0 ? tension / strain : NAN;
}

/* N m, of a strip of unit width, from one direction of buckling. */
static double bend_of(const struct path *path, double width_cm)
{
    const double *v = path->values, *last = v + 2 * (path->count - 1);
    double length = v[0] * CM_M, shortening = (v[0] - last[0]) / v[0];
    double force = fabs(last[1]) * GRAM_FORCE_N / (1 + shortening / 2);
    return shortening > 0.02 ? force * length * length / (4 * M_PI * M_PI * width_cm * CM_M) : NAN;
}

struct strip {
    double stretch, bend;
};

static bool measure(const struct fab_reader *reader, const char *strip, const char *test,
                    double (*of)(const struct path *path, double width_cm), double *out)
{
    const cJSON *part =
        cJSON_GetObjectItemCaseSensitive(cJSON_GetObjectItemCaseSensitive(reader->raw, strip), test);
    struct path path;
    double width_cm = 0;
    *out = NAN;
    if (!read_path(reader, strip, test, part, &path) || path.count == 0)
        return path.count == 0 && (!part || cJSON_IsNull(part));
    bool good = read_width(reader, strip, test, part, &width_cm);
    if (good && path.values[0] > 0)
        *out = of(&path, width_cm);
    free(path.values);
    return good;
}

static void list_test(const struct fab_reader *reader, const char *strip, const char *test, double value,
                      const char *unit, const char *use)
{
    char *name = tl_format("%sraw_data.%s.%s", reader->prefix, strip, test);
    if (!isnan(value))
        tl_fabric_add_field(reader->file, name, tl_format("%.4g %s", value, unit), true, tl_copy_string(use));
    else
        tl_fabric_add_field(
            reader->file, name, tl_copy_string("not measured"), false,
            tl_copy_string("not used: absent, or its first path is too short; the default is taken"));
    free(name);
}

static bool read_strip(const struct fab_reader *reader, const char *strip, const char *stretch_use,
                       const char *bend_use, struct strip *out)
{
    double down, up;
    if (!measure(reader, strip, "S2", stretch_of, &out->stretch) ||
        !measure(reader, strip, "D1", bend_of, &down) || !measure(reader, strip, "U1", bend_of, &up))
        return false;
    out->bend = (down + up) / 2;
    list_test(reader, strip, "S2", out->stretch, "N/m", stretch_use);
    if (bend_use) {
        list_test(reader, strip, "D1", down, "N m", bend_use);
        list_test(reader, strip, "U1", up, "N m", bend_use);
    }
    return true;
}

static void list_unused(const struct fab_reader *reader)
{
    static const struct {
        const char *name, *why;
    } rows[] = {{"L.S1, W.S1, B.S1", "not used: the long strips (S2) are measured more exactly"},
                {"L.D2, W.D2, B.D2", "not used: over 8 cm the strip's weight bends it, too"},
                {"B.D1, B.U1", "not used: stiffness on the bias follows from weft and warp"},
                {"paths that unload", "not used: cloth has no hysteresis here"}};
    for (size_t i = 0; i < TL_COUNT(rows); i++) {
        char *name = tl_format("%sraw_data.%s", reader->prefix, rows[i].name);
        tl_fabric_add_field(reader->file, name, tl_copy_string("measurements"), false,
                            tl_copy_string(rows[i].why));
        free(name);
    }
}

static bool read_weight(const struct fab_reader *reader)
{
    const cJSON *mass = cJSON_GetObjectItemCaseSensitive(reader->raw, "M");
    struct tl_fabric_physics *physics = &reader->file->physics;
    if (!mass || cJSON_IsNull(mass))
        return true;
    if (!cJSON_IsNumber(mass) || !(mass->valuedouble > 0.1 && mass->valuedouble < 1e5))
        return tl_fail(reader->error, TL_INPUT, "%s: raw_data.M: expected g/m^2, from 0.1 to 100000",
                       reader->place);
    char *name = tl_format("%sraw_data.M", reader->prefix);
    bool first = isnan(physics->weight_kg_m2);
    if (first)
        physics->weight_kg_m2 = 1e-3 * mass->valuedouble;
    tl_fabric_add_field(
        reader->file, name, tl_format("%.4g g/m^2", mass->valuedouble), first,
        tl_copy_string(first ? "fabric.areal_density" : "not used: the U3M file has its own weight"));
    free(name);
    return true;
}

static bool read_thickness(const struct fab_reader *reader)
{
    const cJSON *part = cJSON_GetObjectItemCaseSensitive(reader->raw, "T");
    struct tl_fabric_physics *physics = &reader->file->physics;
    struct path path;
    if (!read_path(reader, "T", "", part, &path))
        return false;
    double thickness_m = path.count ? path.values[0] * THICKNESS_CM_M : NAN;
    free(path.values);
    if (isnan(thickness_m))
        return true;
    char *name = tl_format("%sraw_data.T", reader->prefix);
    bool first = isnan(physics->thickness_m) && thickness_m > 0 && thickness_m < 0.1;
    if (first)
        physics->thickness_m = thickness_m;
    tl_fabric_add_field(
        reader->file, name, tl_format("%.3g mm", 1e3 * thickness_m), first,
        tl_copy_string(first ? "construction.thickness_mm" : "not used: the U3M file has its own thickness"));
    free(name);
    return true;
}

static bool read_raw(const struct fab_reader *reader)
{
    struct strip length = {0}, width = {0}, bias = {0};
    struct tl_fabric_physics *physics = &reader->file->physics;
    if (!read_weight(reader) || !read_thickness(reader) ||
        !read_strip(reader, "L", "fabric.stretch_warp", "fabric.bend_warp, the mean of D1 and U1", &length) ||
        !read_strip(reader, "W", "fabric.stretch_weft", "fabric.bend_weft, the mean of D1 and U1", &width) ||
        !read_strip(reader, "B", "fabric.shear, with L and W", NULL, &bias))
        return false;
    physics->stretch_warp = length.stretch;
    physics->stretch_weft = width.stretch;
    physics->bend_warp = length.bend;
    physics->bend_weft = width.bend;
    double shear = 1 / (4 / bias.stretch - 1 / length.stretch - 1 / width.stretch);
    physics->shear = shear > 0 ? shear : NAN;
    list_unused(reader);
    return true;
}

static void list_members(const struct fab_reader *reader, const cJSON *root)
{
    const cJSON *child;
    cJSON_ArrayForEach(child, root)
    {
        bool is_custom = child->string[0] == 'c' && cJSON_IsObject(child);
        char *name = tl_format("%s%.100s", reader->prefix, child->string);
        if (child != reader->raw)
            tl_fabric_add_field(reader->file, name,
                                cJSON_IsString(child) ? tl_format("%.80s", child->valuestring)
                                                      : tl_format("%d fields", cJSON_GetArraySize(child)),
                                false,
                                tl_copy_string(is_custom
                                                   ? "not used: other companies' own sections are not read"
                                                   : "not used: it measures nothing"));
        free(name);
    }
}

bool tl_fab_read(tl_fabric_file *file, const char *name, const char *prefix, tl_error *error)
{
    cJSON *root = tl_fabric_parse_json(&file->store, name, error);
    if (!root)
        return false;
    struct fab_reader reader = {.file = file,
                                .place = tl_store_place(&file->store, name),
                                .prefix = prefix,
                                .raw = cJSON_GetObjectItemCaseSensitive(root, "raw_data"),
                                .error = error};
    bool read =
        cJSON_IsObject(reader.raw)
            ? read_raw(&reader)
            : tl_fail(error, TL_INPUT,
                      "%s: holds no measurements of a fabric: expected an object \"raw_data\"", reader.place);
    if (read)
        list_members(&reader, root);
    free(reader.place);
    cJSON_Delete(root);
    return read;
}
