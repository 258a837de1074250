#include "app/lab/gallery/photographs.h"

#include "app/fabric/swatch.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define SIDE     128
#define WIDTH_MM 32.0f /* two repeats of the weave: what is measured tiles */

static const int counts[TL_PHOTOGRAPHS_RIGS] = {4, 6, 8, 12};

/* Around the swatch, by turns low and high. */
static struct tl_swatch_rig rig_of(int count)
{
    struct tl_swatch_rig rig = {.width_mm = WIDTH_MM, .count = (size_t)count};
    for (int k = 0; k < count; k++)
        rig.lamps[k] = (struct tl_swatch_lamp){.azimuth_deg = 360.0f * (float)k / (float)count + 10,
                                               .elevation_deg = k % 2 ? 60 : 40,
                                               .intensity = 1};
    return rig;
}

/* The exact weave on the flat disc, from a height from which it fills the picture. */
static bool settings_of(const struct tl_experiment_picture *picture, const struct tl_swatch_lamp *lamp,
                        struct tl_settings *out, tl_error *error)
{
    static const struct tl_technique bare = {0};
    const struct tl_experiment_picture plain = {.experiment = picture->experiment, .technique = &bare};
    char *yaw = tl_format("lamp.yaw_deg=%g", (double)lamp->azimuth_deg + 90),
         *pitch = tl_format("lamp.pitch_deg=%g", (double)lamp->elevation_deg);
    const char *const own[] = {yaw,
                               pitch,
                               "lamp.irradiance=[3.14159, 3.14159, 3.14159]",
                               "scene.garment=disc",
                               "cloth.settle_s=0",
                               "camera.target=[0, 0, 0]",
                               "camera.yaw_deg=0",
                               "camera.pitch_deg=90",
                               "camera.distance_m=1.8333",
                               "camera.fov_deg=1"};
    bool made = tl_picture_settings(&plain, TL_PICTURE_SOLID, SIDE, true, out, error) &&
                tl_settings_assign(out, own, TL_COUNT(own), error);
    free(yaw);
    free(pitch);
    return made;
}

/* The three channels of a picture of four or more. */
static tl_image rgb_of(const tl_image *from)
{
    tl_image out = tl_image_create(from->width, from->height, 3, TL_IMAGE_F32);
    for (size_t i = 0; i < (size_t)from->width * (size_t)from->height; i++)
        for (size_t c = 0; c < 3; c++)
            tl_image_floats(&out)[3 * i + c] = tl_image_floats(from)[(size_t)from->channels * i + c];
    return out;
}

/* World axes are those of the picture: x to the right, y away from the viewer's feet is -z, z up is y. */
static struct tl_photographs_error compare(const struct tl_swatch_maps *swatch, const tl_image *normals,
                                           const tl_image *albedo)
{
    const size_t count = (size_t)SIDE * SIDE;
    struct tl_photographs_error found = {0};
    double squares = 0, sum = 0;
    for (size_t i = 0; i < count; i++) {
        const float *n = tl_image_floats(normals) + 3 * i, *own = tl_image_floats(&swatch->normal) + 3 * i;
        const double cosine = (double)(n[0] * own[0] - n[2] * own[1] + n[1] * own[2]);
        found.normal_deg += acos(fmin(cosine, 1)) * 180 / M_PI / (double)count;
        for (size_t c = 0; c < 3; c++) {
            const double due = (double)tl_image_floats(albedo)[3 * i + c];
            squares += pow((double)tl_image_floats(&swatch->albedo)[3 * i + c] - due, 2);
            sum += due * due;
        }
    }
    found.albedo = sqrt(squares / sum);
    return found;
}

static bool save(const struct tl_experiment_picture *picture, const struct tl_swatch_rig *rig,
                 const struct tl_swatch_maps *swatch, tl_error *error)
{
    bool saved = true;
    for (int object = 0; saved && object < TL_PICTURE_OBJECTS; object++) {
        char name[32];
        snprintf(name, sizeof name, "photographs-%02zu", rig->count);
        char *folder = tl_picture_file(picture, (enum tl_picture_object)object, name);
        saved = tl_folder_make(folder, error) && tl_fabric_swatch_save(folder, rig, swatch, error);
        free(folder);
    }
    return saved;
}

static bool measure(struct tl_shots *shots, const struct tl_experiment_picture *picture, int count,
                    struct tl_photographs_error *out, tl_error *error)
{
    const struct tl_swatch_rig rig = rig_of(count);
    tl_image pictures[TL_SWATCH_LAMPS_MAX] = {0};
    struct tl_swatch_maps swatch = {0};
    struct tl_aovs layers = {0};
    bool done = true;
    for (int k = 0; done && k < count; k++) {
        struct tl_settings settings;
        tl_image light = {0};
        tl_aovs_release(&layers);
        done = settings_of(picture, &rig.lamps[k], &settings, error) &&
               tl_shots_layers(shots, &settings, &light, &layers, error);
        if (done)
            pictures[k] = rgb_of(&light);
        tl_image_release(&light);
    }
    done = done && tl_swatch_solve(&rig, pictures, &swatch, error);
    if (done) {
        *out = compare(&swatch, tl_shots_layer(&layers, "N.x"), tl_shots_layer(&layers, "albedo.R"));
        out->lamps = count;
        done = save(picture, &rig, &swatch, error);
        tl_swatch_release(&swatch);
    }
    for (int k = 0; k < count; k++)
        tl_image_release(&pictures[k]);
    tl_aovs_release(&layers);
    return done;
}

bool tl_photographs_make(struct tl_shots *shots, const struct tl_experiment_picture *picture,
                         struct tl_photographs_error out[TL_PHOTOGRAPHS_RIGS], tl_error *error)
{
    bool made = true;
    for (int i = 0; made && i < TL_PHOTOGRAPHS_RIGS; i++)
        made = measure(shots, picture, counts[i], &out[i], error);
    return made;
}
