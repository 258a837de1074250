#include "tests/fuzz/readers.h"

#include "app/audit/audit.h"
#include "app/scene/path.h"
#include "app/settings/settings.h"
#include "assets/environment/environment.h"
#include "assets/fabric/samples.h"
#include "assets/image/exr.h"
#include "assets/image/image_file.h"
#include "assets/model.h"
#include "assets/motion/point_cache.h"
#include "assets/pattern/pattern_cut.h"
#include "assets/sewing/stitches.h"
#include "assets/swatch/swatch.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/brdf/tables/measured.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Ends the process where a promise is broken. */
static void require(bool holds, const char *promise)
{
    if (holds)
        return;
    fprintf(stderr, "broken: %s\n", promise);
    abort();
}

/* Checks what each refusal is: one line of a stated kind. */
static bool refused(const tl_error *error)
{
    require(error->code == TL_INPUT || error->code == TL_USAGE, "a refusal is of the input or of the usage");
    require(error->message[0] && !strchr(error->message, '\n'), "a refusal is one line");
    return false;
}

/* ---- Models ---- */

/* Crossings of a mesh whose triangles lie in one heap take seconds. */
#define AUDITED_TRIANGLES 2000

static void check_model(const tl_model *model)
{
    const tl_mesh *mesh = &model->mesh;
    require(mesh->index_count > 0 && mesh->index_count % 3 == 0, "a model has triangles");
    for (size_t i = 0; i < mesh->index_count; i++)
        require(mesh->indices[i] < mesh->vertex_count, "an index is that of a vertex");
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        require(isfinite(glms_vec3_norm(mesh->positions[i])), "a position is finite");
        require(isfinite(glms_vec3_norm(mesh->normals[i])), "a normal is finite");
    }
    for (size_t i = 0; model->points && i < mesh->vertex_count; i++)
        require(model->points[i] < model->point_count, "a vertex is one of the file's points");
}

static void use_model(tl_model *model)
{
    tl_audit audit = {0};
    vec3s *posed = TL_NEW_ARRAY(vec3s, model->mesh.vertex_count);
    for (size_t clip = 0; clip < model->clip_count; clip++)
        tl_model_pose(model, (int)clip, 0.7, posed);
    free(posed);
    tl_garment garment = {.model = *model};
    tl_stitches_sew(&garment);
    if (garment.model.mesh.index_count <= (size_t)3 * AUDITED_TRIANGLES)
        tl_audit_garment(&audit, &garment);
    tl_audit_release(&audit);
    *model = garment.model;
    garment.model = (tl_model){0};
    tl_garment_release(&garment);
}

static bool read_model(const char *path)
{
    tl_model model;
    tl_error error = {0};
    if (!tl_model_load(path, &model, &error))
        return refused(&error);
    check_model(&model);
    use_model(&model);
    tl_model_release(&model);
    return true;
}

static bool read_pattern(const char *path)
{
    const float edge_m = 0.1f;
    tl_pattern pattern;
    tl_garment garment;
    tl_error error = {0};
    if (!tl_pattern_load(path, &pattern, &error))
        return refused(&error);
    bool is_cut = tl_pattern_cut(&pattern, edge_m, &garment, &error);
    tl_pattern_release(&pattern);
    if (!is_cut)
        return refused(&error);
    tl_garment_release(&garment);
    return true;
}

static bool read_motion(const char *path)
{
    tl_error error = {0};
    tl_point_cache *cache = tl_point_cache_open(path, 1, &error);
    if (!cache)
        return refused(&error);
    const struct tl_point_cache_facts *facts = tl_point_cache_facts(cache);
    vec3s *points = TL_NEW_ARRAY(vec3s, facts->point_count);
    for (int half = 0; half <= 2; half++)
        if (!tl_point_cache_read(cache, half * 0.5 * (double)(facts->sample_count - 1), points, &error))
            refused(&error);
    free(points);
    tl_point_cache_destroy(&cache);
    return true;
}

/* ---- Pictures ---- */

static bool read_environment(const char *path)
{
    tl_environment environment;
    tl_image channel;
    tl_error error = {0};
    if (tl_path_has_extension(path, "exr") && tl_exr_load_channel(path, "R", &channel, &error))
        tl_image_release(&channel);
    if (!tl_environment_load(path, &environment, &error))
        return refused(&error);
    const tl_image *image = &environment.image;
    for (size_t i = 0; i < 3 * (size_t)image->width * (size_t)image->height; i++)
        require(isfinite(tl_image_floats(image)[i]), "radiance is finite");
    tl_environment_release(&environment);
    return true;
}

static bool read_picture(const char *path)
{
    tl_image image;
    tl_error error = {0};
    if (tl_image_load_values(path, &image, &error))
        tl_image_release(&image);
    if (!tl_image_load(path, &image, &error))
        return refused(&error);
    tl_image_release(&image);
    return true;
}

static bool read_samples(const char *path)
{
    struct tl_reflectance_samples samples;
    tl_error error = {0};
    if (!tl_reflectance_samples_load(path, &samples, &error))
        return refused(&error);
    require(samples.count >= TL_REFLECTANCE_SAMPLES_MIN, "there are samples enough");
    struct tl_measured measured = tl_measured_make(&samples);
    for (size_t i = 0; i < samples.count; i++) {
        const struct tl_reflectance_sample *sample = &samples.items[i];
        const struct tl_brdf_frame frame = {{{0, 0, 1}}, {{1, 0, 0}}, {{0, 1, 0}}};
        require(sample->l.z >= 0 && sample->v.z >= 0, "a direction is above the surface");
        require(isfinite(glms_vec3_norm(tl_measured_reflected(&measured, &frame, sample->l, sample->v))),
                "tables give finite light");
    }
    tl_measured_release(&measured);
    tl_reflectance_samples_release(&samples);
    return true;
}

/* ---- Settings and fabrics ---- */

static bool read_scene(const char *path)
{
    struct tl_settings settings;
    tl_error error = {0};
    return tl_settings_load(&settings, &(struct tl_settings_source){.scene_file = path}, &error) ||
           refused(&error);
}

static const struct tl_settings *built_in(void)
{
    static struct tl_settings settings;
    static bool is_loaded;
    if (!is_loaded)
        is_loaded = tl_settings_load(&settings, &(struct tl_settings_source){0}, NULL);
    require(is_loaded, "the built-in scene is sound");
    return &settings;
}

/* Of toile's own form, and of other programs. */
static bool read_fabric(const char *path)
{
    struct tl_settings settings = *built_in();
    tl_fabric_file fabric;
    tl_audit audit = {0};
    tl_error error = {0};
    if (tl_fabric_file_is(path) && tl_fabric_file_open(path, &fabric, &error)) {
        tl_audit_fabric(&audit, &fabric);
        tl_audit_release(&audit);
        tl_fabric_file_release(&fabric);
    }
    return tl_settings_apply_fabric(&settings, path, &error) || refused(&error);
}

static bool read_path(const char *path)
{
    struct tl_path keys;
    tl_error error = {0};
    if (!tl_path_load(path, built_in(), &keys, &error))
        return refused(&error);
    struct tl_path_key key = tl_path_at(&keys, tl_path_length_s(&keys) / 3);
    require(isfinite(key.camera.yaw_deg), "a camera between two keys is finite");
    tl_path_release(&keys);
    return true;
}

static bool read_lights(const char *path)
{
    tl_error error = {0};
    struct tl_swatch_rig rig;
    if (!tl_swatch_rig_load(path, &rig, &error))
        return refused(&error);
    require(rig.count >= TL_SWATCH_LAMPS_MIN && rig.count <= TL_SWATCH_LAMPS_MAX, "there are lamps enough");
    require(rig.width_mm > 0, "the swatch has a width");
    return true;
}

const struct fuzz_reader fuzz_readers[] = {
    {"gltf", "gltf", read_model},      {"glb", "glb", read_model},       {"obj", "obj", read_model},
    {"ply", "ply", read_model},        {"stl", "stl", read_model},       {"off", "off", read_model},
    {"pattern", "json", read_pattern}, {"pc2", "pc2", read_motion},      {"mdd", "mdd", read_motion},
    {"exr", "exr", read_environment},  {"hdr", "hdr", read_environment}, {"picture", "png", read_picture},
    {"samples", "csv", read_samples},  {"scene", "yaml", read_scene},    {"fabric", "yaml", read_fabric},
    {"path", "yaml", read_path},       {"u3m", "u3m", read_fabric},      {"u3ma", "u3ma", read_fabric},
    {"fab", "json", read_fabric},      {"lights", "yaml", read_lights},  {NULL, NULL, NULL},
};

const struct fuzz_reader *fuzz_reader_named(const char *name)
{
    for (const struct fuzz_reader *reader = fuzz_readers; reader->name; reader++)
        if (strcmp(reader->name, name) == 0)
            return reader;
    return NULL;
}

/* ---- The scratch folder ---- */

static char folder[] = "/tmp/toile_fuzz_XXXXXX";

static void write_bytes(const char *name, const void *bytes, size_t size)
{
    FILE *stream = fopen(name, "wb");
    require(stream && fwrite(bytes, 1, size, stream) == size && fclose(stream) == 0,
            "the scratch folder can be written");
}

void fuzz_begin(void)
{
    static const uint8_t texel[] = {128, 64, 32};
    tl_image image = tl_image_create(1, 1, 3, TL_IMAGE_U8);
    memcpy(image.texels, texel, sizeof texel);
    tl_log_set_level(TL_LOG_QUIET);
    require(mkdtemp(folder) && chdir(folder) == 0, "a scratch folder can be made");
    require(tl_image_save_png("dot.png", &image, NULL), "the scratch folder can be written");
    tl_image_release(&image);
}

bool fuzz_read(const struct fuzz_reader *reader, const void *bytes, size_t size)
{
    char name[32];
    snprintf(name, sizeof name, "input.%s", reader->extension);
    write_bytes(name, bytes, size);
    if (reader->read == read_model)
        write_bytes("input.mtl", bytes, size);
    return reader->read(name);
}

void fuzz_end(void)
{
    unlink("dot.png");
    unlink("input.mtl");
    for (const struct fuzz_reader *reader = fuzz_readers; reader->name; reader++) {
        char name[32];
        snprintf(name, sizeof name, "input.%s", reader->extension);
        unlink(name);
    }
    require(chdir("/") == 0 && rmdir(folder) == 0, "the scratch folder can be removed");
}
