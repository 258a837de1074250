#include "assets/image/exr.h"
#include "config/file.h"

#include <openexr.h>

#include <string.h>

/* A file being written: the library's context and what it complained about. */
struct output {
    exr_context_t file;
    const struct tl_exr_layer *layers;
    size_t layer_count;
    const char *comments; /* NULL: none */
    char complaint[256];
};

static void note_complaint(exr_const_context_t file, exr_result_t code, const char *message)
{
    void *user = NULL;
    (void)code;
    if (file && exr_get_user_data(file, &user) == EXR_ERR_SUCCESS && user)
        snprintf(((struct output *)user)->complaint, sizeof((struct output *)user)->complaint, "%s", message);
}

static bool add_channels(struct output *output, int part)
{
    for (size_t l = 0; l < output->layer_count; l++)
        for (int c = 0; c < output->layers[l].image->channels; c++)
            if (exr_add_channel(output->file, part, output->layers[l].channel_names[c], EXR_PIXEL_FLOAT,
                                EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1) != EXR_ERR_SUCCESS)
                return false;
    return true;
}

static bool add_comments(struct output *output, int part)
{
    return !output->comments ||
           exr_attr_set_string(output->file, part, "comments", output->comments) == EXR_ERR_SUCCESS;
}

/* Points one of the encoder's channels at row `y` of the layer that has it. */
static void aim_channel(const struct output *output, exr_coding_channel_info_t *channel, int y)
{
    for (size_t l = 0; l < output->layer_count; l++) {
        const tl_image *image = output->layers[l].image;
        size_t channels = (size_t)image->channels, width = (size_t)image->width;
        for (size_t c = 0; c < channels; c++)
            if (strcmp(output->layers[l].channel_names[c], channel->channel_name) == 0) {
                const float *first = tl_image_floats(image) + (size_t)y * width * channels + c;
                channel->encode_from_ptr = (const uint8_t *)first;
                channel->user_data_type = EXR_PIXEL_FLOAT;
                channel->user_bytes_per_element = sizeof(float);
                channel->user_pixel_stride = (int32_t)(channels * sizeof(float));
                channel->user_line_stride = (int32_t)(width * channels * sizeof(float));
            }
    }
}

static bool write_chunk(struct output *output, int part, int y)
{
    exr_chunk_info_t chunk;
    if (exr_write_scanline_chunk_info(output->file, part, y, &chunk) != EXR_ERR_SUCCESS)
        return false;
    exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
    bool written = exr_encoding_initialize(output->file, part, &chunk, &encoder) == EXR_ERR_SUCCESS;
    if (written) {
        for (int c = 0; c < encoder.channel_count; c++)
            aim_channel(output, &encoder.channels[c], y);
        written = exr_encoding_choose_default_routines(output->file, part, &encoder) == EXR_ERR_SUCCESS &&
                  exr_encoding_run(output->file, part, &encoder) == EXR_ERR_SUCCESS;
    }
    exr_encoding_destroy(output->file, &encoder);
    return written;
}

static bool write_file(struct output *output, const char *path)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = note_complaint;
    setup.user_data = output;
    if (exr_start_write(&output->file, path, EXR_WRITE_FILE_DIRECTLY, &setup) != EXR_ERR_SUCCESS)
        return false;
    const tl_image *image = output->layers[0].image;
    int part = 0;
    int32_t lines = 0;
    bool written = exr_add_part(output->file, NULL, EXR_STORAGE_SCANLINE, &part) == EXR_ERR_SUCCESS &&
                   exr_initialize_required_attr_simple(output->file, part, image->width, image->height,
                                                       EXR_COMPRESSION_ZIP) == EXR_ERR_SUCCESS &&
                   add_channels(output, part) && add_comments(output, part) &&
                   exr_write_header(output->file) == EXR_ERR_SUCCESS &&
                   exr_get_scanlines_per_chunk(output->file, part, &lines) == EXR_ERR_SUCCESS && lines > 0;
    for (int y = 0; written && y < image->height; y += lines)
        written = write_chunk(output, part, y);
    return exr_finish(&output->file) == EXR_ERR_SUCCESS && written;
}

bool tl_exr_save(const char *path, const struct tl_exr_layer *layers, size_t layer_count, tl_error *error)
{
    return tl_exr_save_commented(path, layers, layer_count, NULL, error);
}

bool tl_exr_save_commented(const char *path, const struct tl_exr_layer *layers, size_t layer_count,
                           const char *comments, tl_error *error)
{
    struct tl_writer writer;
    if (!tl_writer_begin(&writer, path, error))
        return false;
    tl_writer_close_stream(&writer);
    struct output output = {.layers = layers, .layer_count = layer_count, .comments = comments};
    if (write_file(&output, writer.temporary))
        return tl_writer_commit(&writer, error);
    tl_writer_abandon(&writer);
    return tl_fail(error, TL_OUTPUT,
                   "%s: could not be written whole%s%s: free some space or choose another place", path,
                   output.complaint[0] ? ": " : "", output.complaint);
}
