/* One named channel of a written EXR file, through OpenEXR's own decoder. */
#ifndef TOILE_TESTS_EXR_CHANNEL_H
#define TOILE_TESTS_EXR_CHANNEL_H

#include "config/base/memory.h"
#include "tests/testing.h"

#include <openexr.h>

#include <stdbool.h>
#include <string.h>

/* [height][width], rows downwards; NULL when the file has no channel of that name. Free it. */
static inline float *exr_read_channel(const char *path, const char *name, int *width, int *height)
{
    exr_context_t file = NULL;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_attr_box2i_t window;
    int32_t lines = 0;
    assert_int_equal(exr_start_read(&file, path, &setup), EXR_ERR_SUCCESS);
    assert_int_equal(exr_get_data_window(file, 0, &window), EXR_ERR_SUCCESS);
    assert_int_equal(exr_get_scanlines_per_chunk(file, 0, &lines), EXR_ERR_SUCCESS);
    *width = window.max.x - window.min.x + 1;
    *height = window.max.y - window.min.y + 1;
    float *values = TL_NEW_ARRAY(float, (size_t)*width *(size_t)*height);
    bool found = false;
    for (int y = 0; y < *height; y += lines) {
        exr_chunk_info_t chunk;
        exr_decode_pipeline_t decoder = EXR_DECODE_PIPELINE_INITIALIZER;
        assert_int_equal(exr_read_scanline_chunk_info(file, 0, y, &chunk), EXR_ERR_SUCCESS);
        assert_int_equal(exr_decoding_initialize(file, 0, &chunk, &decoder), EXR_ERR_SUCCESS);
        for (int c = 0; c < decoder.channel_count; c++) {
            exr_coding_channel_info_t *channel = &decoder.channels[c];
            if (strcmp(channel->channel_name, name) != 0)
                continue;
            found = true;
            channel->decode_to_ptr = (uint8_t *)(values + (size_t)y * (size_t)*width);
            channel->user_bytes_per_element = sizeof(float);
            channel->user_pixel_stride = sizeof(float);
            channel->user_line_stride = *width * (int32_t)sizeof(float);
            channel->user_data_type = EXR_PIXEL_FLOAT;
        }
        assert_int_equal(exr_decoding_choose_default_routines(file, 0, &decoder), EXR_ERR_SUCCESS);
        assert_int_equal(exr_decoding_run(file, 0, &decoder), EXR_ERR_SUCCESS);
        assert_int_equal(exr_decoding_destroy(file, &decoder), EXR_ERR_SUCCESS);
    }
    assert_int_equal(exr_finish(&file), EXR_ERR_SUCCESS);
    if (found)
        return values;
    free(values);
    return NULL;
}

#endif
