/* toile compare: measures how far two images differ. */
#include "app/batch/commands.h"
#include "app/cli/json.h"
#include "assets/image/exr.h"
#include "assets/image/image_file.h"
#include "config/base/file.h"
#include "config/base/memory.h"
#include "config/colour/srgb.h"
#include "render/inspect/aovs.h"
#include "render/metrics/compare.h"

#include <stdio.h>

/* Loads linear light: an EXR as it is; a PNG or JPEG decoded from sRGB, in [0, 1]. */
static bool load_linear(const char *path, tl_image *out, tl_error *error)
{
    if (!tl_file_check(path, error))
        return false;
    enum tl_exr_envmap envmap;
    if (tl_path_has_extension(path, "exr"))
        return tl_exr_load(path, out, &envmap, error);
    tl_image encoded;
    if (!tl_image_load(path, &encoded, error))
        return false;
    size_t texels = (size_t)encoded.width * (size_t)encoded.height;
    if (!tl_memory_request(path, texels * (size_t)encoded.channels * sizeof(float), error)) {
        tl_image_release(&encoded);
        return false;
    }
    *out = tl_image_create(encoded.width, encoded.height, encoded.channels, TL_IMAGE_F32);
    int channels = encoded.channels, colours = channels < 3 ? 1 : 3;
    for (size_t i = 0; i < texels; i++)
        for (int c = 0; c < channels; c++) {
            size_t at = i * (size_t)channels + (size_t)c;
            float value = (float)tl_image_bytes(&encoded)[at] / 255.0f;
            tl_image_floats(out)[at] = c < colours ? tl_srgb_to_linear(value) : value;
        }
    tl_image_release(&encoded);
    return true;
}

/* The garment's pixels: as --mask has them, else the layer that the reference carries. *out has no texels
 * when neither is there. */
static bool load_garment(const struct tl_arguments *arguments, tl_image *out, tl_error *error)
{
    const char *path = arguments->mask ? arguments->mask : arguments->positionals[1];
    enum tl_exr_envmap envmap;
    *out = (tl_image){0};
    if (!tl_file_check(path, error))
        return false;
    if (!tl_path_has_extension(path, "exr"))
        return !arguments->mask || tl_image_load_values(path, out, error);
    if (!tl_exr_load_channel(path, TL_AOV_GARMENT, out, error))
        return false;
    return out->texels || !arguments->mask || tl_exr_load(path, out, &envmap, error);
}

struct results {
    struct tl_comparison all;
    bool has_garment;
    struct tl_object_error garment;
};

static void print_comparison(const struct results *results, int width)
{
    const struct tl_comparison *result = &results->all;
    if (results->has_garment) {
        printf("garment pixels   %zu\n", results->garment.pixels);
        printf("garment FLIP     %.6g  (LDR, mean)\n", results->garment.flip_mean);
        printf("  its worst 5 %%  %.6g\n", results->garment.flip_worst);
    }
    printf("covered pixels   %zu\n", result->covered);
    printf("relative RMSE    %.6g\n", result->rel_rmse);
    printf("mean FLIP        %.6g  (%s, covered pixels)\n", result->flip_mean, result->hdr ? "HDR" : "LDR");
    printf("frame FLIP       %.6g\n", result->flip_frame);
    printf("largest          %.6g\n", result->max_abs);
    printf("worst pixel      %d, %d: %.3g %% of the square error\n", (int)result->worst % width,
           (int)result->worst / width, 100 * result->worst_share);
    if (result->hdr)
        printf("exposures        %.3g to %.3g stops\n", result->exposure_start, result->exposure_stop);
}

static void print_comparison_json(const struct results *results, int width)
{
    const struct tl_comparison *result = &results->all;
    cJSON *object = cJSON_CreateObject();
    if (results->has_garment) {
        tl_json_add_number(object, "garment_pixels", (double)results->garment.pixels);
        tl_json_add_number(object, "garment_flip_mean", results->garment.flip_mean);
        tl_json_add_number(object, "garment_flip_worst", results->garment.flip_worst);
    }
    cJSON_AddNumberToObject(object, "covered", (double)result->covered);
    cJSON_AddNumberToObject(object, "rel_rmse", result->rel_rmse);
    cJSON_AddNumberToObject(object, "flip_mean", result->flip_mean);
    cJSON_AddNumberToObject(object, "flip_frame", result->flip_frame);
    cJSON_AddNumberToObject(object, "max_abs", result->max_abs);
    int worst = (int)result->worst, worst_row = worst / width;
    cJSON_AddNumberToObject(object, "worst_x", worst % width);
    cJSON_AddNumberToObject(object, "worst_y", worst_row);
    cJSON_AddNumberToObject(object, "worst_share", result->worst_share);
    cJSON_AddBoolToObject(object, "hdr", result->hdr);
    tl_json_print(object);
}

bool tl_command_compare(const struct tl_arguments *arguments, tl_error *error)
{
    if (arguments->positional_count != 2)
        return tl_fail(error, TL_USAGE, "compare: expected two images: toile compare TESTED REFERENCE");
    tl_image tested = {0}, reference = {0}, garment = {0};
    struct results results;
    bool done = load_linear(arguments->positionals[0], &tested, error) &&
                load_linear(arguments->positionals[1], &reference, error) &&
                tl_image_compare(&tested, &reference, arguments->hdr, 0, &results.all, error) &&
                load_garment(arguments, &garment, error);
    results.has_garment = done && garment.texels;
    if (results.has_garment)
        done = tl_image_compare_object(&tested, &reference, &garment, 0, &results.garment, error);
    if (done && arguments->json)
        print_comparison_json(&results, tested.width);
    else if (done)
        print_comparison(&results, tested.width);
    tl_image_release(&tested);
    tl_image_release(&reference);
    tl_image_release(&garment);
    return done;
}
