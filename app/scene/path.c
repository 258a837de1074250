#include "app/scene/path.h"

#include "app/scene/camera.h"
#include "config/base/file.h"
#include "config/base/memory.h"
#include "config/yaml.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The rows of a key; ranges are those of the options camera.* and scene.environment_yaw_deg. */
#define KEY_ROW(field, path, kind, low, high, u)                                                             \
    {                                                                                                        \
        .name = #field, .type = (kind), .offset = offsetof(struct tl_path_key, path),                        \
        .affects = TL_AFFECTS_NOTHING, .minimum = (low), .maximum = (high), .unit = (u), .help = ""          \
    }
static const struct tl_option key_rows[] = {
    KEY_ROW(time_s, time_s, TL_DOUBLE, 0, 86400, "s"),
    KEY_ROW(yaw_deg, camera.yaw_deg, TL_FLOAT, -3600, 3600, "degrees"),
    KEY_ROW(pitch_deg, camera.pitch_deg, TL_FLOAT, -90, 90, "degrees"),
    KEY_ROW(distance_m, camera.distance_m, TL_FLOAT, 0, 10000, "m"),
    KEY_ROW(target, camera.target, TL_VECTOR, -10000, 10000, "m"),
    KEY_ROW(fov_deg, camera.fov_deg, TL_FLOAT, 1, 150, "degrees"),
    KEY_ROW(environment_yaw_deg, environment_yaw_deg, TL_FLOAT, -3600, 3600, "degrees"),
};
static const struct tl_option_table key_table =
    TL_OPTION_TABLE("key", "of a camera path", key_rows, struct tl_path_key, 0);

void tl_path_add(struct tl_path *path, const struct tl_path_key *key)
{
    path->keys = tl_resize(path->keys, path->count + 1, sizeof *path->keys);
    path->keys[path->count++] = *key;
}

void tl_path_release(struct tl_path *path)
{
    free(path->keys);
    *path = (struct tl_path){0};
}

bool tl_path_same_key(const struct tl_path_key *a, const struct tl_path_key *b)
{
    return tl_options_equal(&key_table, a, b);
}

double tl_path_length_s(const struct tl_path *path)
{
    return path->keys[path->count - 1].time_s;
}

static struct tl_path_key key_of(const struct tl_settings *scene)
{
    return (struct tl_path_key){.camera = scene->camera,
                                .environment_yaw_deg = scene->scene.environment_yaw_deg};
}

/* -- reading -- */

struct path_reader {
    struct tl_yaml yaml;
    struct tl_path *path;
    struct tl_path_key key; /* being read; what it leaves out stays */
};

static bool fail_here(const struct path_reader *reader, const char *what)
{
    return tl_yaml_fail(&reader->yaml, tl_yaml_line(&reader->yaml), what);
}

/* The current event is a field's name; its value follows. */
static bool read_field(struct path_reader *reader, bool given[TL_COUNT(key_rows)])
{
    struct tl_yaml *yaml = &reader->yaml;
    size_t line = tl_yaml_line(yaml);
    if (yaml->event.type != YAML_SCALAR_EVENT)
        return fail_here(reader, "a list or table stands where a field's name was expected");
    const struct tl_binding binding = {&key_table, &reader->key};
    const struct tl_option *row = key_rows;
    const struct tl_option *end = key_rows + TL_COUNT(key_rows);
    while (row < end && strcmp(row->name, tl_yaml_text(yaml)) != 0)
        row++;
    char *key = tl_format("key.%s", tl_yaml_text(yaml));
    char *where = tl_format("%s:%zu", yaml->name, line);
    char *text = tl_yaml_next(yaml) ? tl_yaml_value(yaml, true, key) : NULL;
    bool set = text && tl_options_set(&binding, 1, key, text, where, NULL, yaml->error);
    if (set && given[row - key_rows])
        set = tl_fail(yaml->error, TL_USAGE, "%s: %s: is given twice in one key: remove one", where, key);
    if (set)
        given[row - key_rows] = true;
    free(text);
    free(where);
    free(key);
    return set;
}

static bool check_key(const struct path_reader *reader, size_t line)
{
    const struct tl_path *path = reader->path;
    const struct tl_path_key *key = &reader->key, *before = path->keys ? &path->keys[path->count - 1] : NULL;
    if (before && !(key->time_s > before->time_s))
        return tl_fail(reader->yaml.error, TL_USAGE,
                       "%s:%zu: key.time_s: %g s is not after the key before it, %g s: keys stand in order "
                       "of time",
                       reader->yaml.name, line, key->time_s, before->time_s);
    if (before && (key->camera.distance_m > 0) != (before->camera.distance_m > 0))
        return tl_yaml_fail(&reader->yaml, line,
                            "key.distance_m: 0 frames the scene, and nothing lies between that and a "
                            "distance: give all keys metres, or none");
    return true;
}

/* The current event begins a key. */
static bool read_key(struct path_reader *reader)
{
    bool given[TL_COUNT(key_rows)] = {false};
    size_t line = tl_yaml_line(&reader->yaml);
    if (reader->yaml.event.type != YAML_MAPPING_START_EVENT)
        return fail_here(reader, "keys: expected a key, as in `- {time_s: 2, yaw_deg: 90}`");
    while (tl_yaml_next(&reader->yaml)) {
        if (reader->yaml.event.type == YAML_MAPPING_END_EVENT) {
            bool good = check_key(reader, line);
            if (good)
                tl_path_add(reader->path, &reader->key);
            return good;
        }
        if (!read_field(reader, given))
            return false;
    }
    return false;
}

static bool read_keys(struct path_reader *reader)
{
    if (!tl_yaml_next(&reader->yaml))
        return false;
    if (reader->yaml.event.type != YAML_SEQUENCE_START_EVENT)
        return fail_here(reader, "keys: expected a list of keys, as in `- {time_s: 2, yaw_deg: 90}`");
    while (tl_yaml_next(&reader->yaml)) {
        if (reader->yaml.event.type == YAML_SEQUENCE_END_EVENT)
            return true;
        if (!read_key(reader))
            return false;
    }
    return false;
}

static bool read_root(void *context)
{
    struct path_reader *reader = context;
    if (reader->yaml.event.type != YAML_MAPPING_START_EVENT)
        return fail_here(reader, "expected `keys:` and a list of keys: this is no camera path");
    for (bool read = false; tl_yaml_next(&reader->yaml); read = true) {
        if (reader->yaml.event.type == YAML_MAPPING_END_EVENT)
            return true;
        bool named =
            reader->yaml.event.type == YAML_SCALAR_EVENT && strcmp(tl_yaml_text(&reader->yaml), "keys") == 0;
        if (!named || read)
            return fail_here(reader, "expected `keys:`, once, and nothing beside it: this is no camera path");
        if (!read_keys(reader))
            return false;
    }
    return false;
}

/* Gives keys without a target of their own the scene's target. */
static void aim_keys(struct tl_path *path, const struct tl_camera_params *scene)
{
    for (size_t i = 0; i < path->count; i++) {
        struct tl_camera_params *camera = &path->keys[i].camera;
        if (!tl_camera_is_placed(camera))
            memcpy(camera->target, scene->target, sizeof camera->target);
    }
}

bool tl_path_load(const char *file, const struct tl_settings *scene, struct tl_path *out, tl_error *error)
{
    struct tl_path path = {0};
    struct path_reader reader = {.path = &path, .key = key_of(scene)};
    char *data = NULL;
    size_t size = 0;
    if (!tl_file_read_small(file, TL_LIMIT_YAML_BYTES, &data, &size, error))
        return false;
    bool begun = tl_yaml_begin(&reader.yaml, file, data, size, error);
    bool read = begun && tl_yaml_read(&reader.yaml, read_root, &reader);
    if (begun)
        tl_yaml_end(&reader.yaml);
    free(data);
    aim_keys(&path, &scene->camera);
    if (read && path.count == 0)
        read = tl_fail(error, TL_USAGE, "%s: holds no key: add `keys:` and at least one below it", file);
    if (read)
        *out = path;
    else
        tl_path_release(&path);
    return read;
}

/* -- writing -- */

bool tl_path_save(const char *file, const struct tl_path *path, tl_error *error)
{
    struct tl_writer writer;
    if (!tl_writer_begin(&writer, file, error))
        return false;
    fputs("# A camera path, flown by `toile fly --path`. Seconds, metres, degrees.\nkeys:\n", writer.stream);
    for (size_t i = 0; i < path->count; i++) {
        struct tl_path_key key = path->keys[i];
        const struct tl_binding binding = {&key_table, &key};
        for (size_t r = 0; r < TL_COUNT(key_rows); r++) {
            char *text = tl_options_get_text(&binding, &key_rows[r]);
            fprintf(writer.stream, "%s%s: %s", r ? ", " : "  - {", key_rows[r].name, text);
            free(text);
        }
        fputs("}\n", writer.stream);
    }
    return tl_writer_commit(&writer, error);
}

/* -- flying -- */

#define NUMBERS 8 /* of a key, but for its time */

static void numbers_of(const struct tl_path_key *key, double numbers[NUMBERS])
{
    const struct tl_camera_params *camera = &key->camera;
    const float all[NUMBERS] = {camera->yaw_deg,   camera->pitch_deg,       camera->distance_m,
                                camera->target[0], camera->target[1],       camera->target[2],
                                camera->fov_deg,   key->environment_yaw_deg};
    for (int i = 0; i < NUMBERS; i++)
        numbers[i] = (double)all[i];
}

static struct tl_path_key key_from(double time_s, const double numbers[NUMBERS])
{
    float all[NUMBERS];
    for (int i = 0; i < NUMBERS; i++)
        all[i] = (float)numbers[i];
    return (struct tl_path_key){.time_s = time_s,
                                .camera = {.yaw_deg = all[0],
                                           .pitch_deg = all[1],
                                           .distance_m = all[2],
                                           .target = {all[3], all[4], all[5]},
                                           .fov_deg = all[6]},
                                .environment_yaw_deg = all[7]};
}

/* Slopes at key `i`, a weighted harmonic mean of those on its two sides [Fritsch and Butland 1984, eq. 5]: at
 * most three times the lesser, which is enough for the cubics on both sides to be monotone [Fritsch and
 * Carlson 1980]. 0 where the two differ in sign, and at the ends, where the path rests. */
static void slopes_at(const struct tl_path *path, size_t i, double slopes[NUMBERS])
{
    memset(slopes, 0, NUMBERS * sizeof *slopes);
    if (i == 0 || i + 1 == path->count)
        return;
    const struct tl_path_key *keys = path->keys;
    double before[NUMBERS], here[NUMBERS], after[NUMBERS];
    numbers_of(&keys[i - 1], before);
    numbers_of(&keys[i], here);
    numbers_of(&keys[i + 1], after);
    double left_s = keys[i].time_s - keys[i - 1].time_s, right_s = keys[i + 1].time_s - keys[i].time_s;
    for (int n = 0; n < NUMBERS; n++) {
        double left = (here[n] - before[n]) / left_s, right = (after[n] - here[n]) / right_s;
        if (left * right > 0)
            slopes[n] =
                3 * (left_s + right_s) / ((2 * right_s + left_s) / left + (right_s + 2 * left_s) / right);
    }
}

struct tl_path_key tl_path_at(const struct tl_path *path, double time_s)
{
    const struct tl_path_key *keys = path->keys;
    size_t next = 0;
    while (next < path->count && keys[next].time_s <= time_s)
        next++;
    if (next == 0 || next == path->count) {
        struct tl_path_key rest = keys[next ? next - 1 : 0];
        rest.time_s = time_s;
        return rest;
    }
    double from[NUMBERS], to[NUMBERS], leaving[NUMBERS], arriving[NUMBERS], at[NUMBERS];
    numbers_of(&keys[next - 1], from);
    numbers_of(&keys[next], to);
    slopes_at(path, next - 1, leaving);
    slopes_at(path, next, arriving);
    double span_s = keys[next].time_s - keys[next - 1].time_s;
    double u = (time_s - keys[next - 1].time_s) / span_s;
    double rise = u * u * (3 - 2 * u), out = u * (1 - u) * (1 - u), in = u * u * (u - 1);
    for (int n = 0; n < NUMBERS; n++) /* Hermite's form */
        at[n] = from[n] + rise * (to[n] - from[n]) + span_s * (out * leaving[n] + in * arriving[n]);
    return key_from(time_s, at);
}

struct tl_path tl_path_built_in(const struct tl_settings *scene)
{
    /* Seconds; turns of the eye and of the environment; tilt; part of the distance. */
    static const struct {
        double time_s;
        float eye_deg, environment_deg, pitch_deg, nearness;
    } stations[] = {
        {0, 0, 0, 0, 1},          /* one turn ... */
        {8, 360, 0, 0, 1},        /* ... */
        {10.5, 390, 0, 4, 0.45f}, /* a look close up ... */
        {13, 420, 0, 12, 0.45f},  /* ... along the cloth */
        {15, 405, 90, 0, 1},      /* back, and the light turns */
        {TL_PATH_BUILT_IN_S, 360, 360, 0, 1},
    };
    struct tl_path path = {0};
    for (size_t i = 0; i < TL_COUNT(stations); i++) {
        struct tl_path_key key = key_of(scene);
        key.time_s = stations[i].time_s;
        key.camera.yaw_deg += stations[i].eye_deg;
        key.camera.pitch_deg = fminf(key.camera.pitch_deg + stations[i].pitch_deg, 89);
        key.camera.distance_m *= stations[i].nearness;
        key.environment_yaw_deg += stations[i].environment_deg;
        tl_path_add(&path, &key);
    }
    return path;
}
