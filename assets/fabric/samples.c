#include "assets/fabric/samples.h"

#include "config/base/file.h"
#include "config/base/memory.h"
#include "config/base/text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum column {
    THETA_L,
    PHI_L,
    THETA_V,
    PHI_V,
    L_X,
    L_Y,
    L_Z,
    V_X,
    V_Y,
    V_Z,
    RED,
    GREEN,
    BLUE,
    VALUE,
    COLUMNS
};
static const char *const column_names[COLUMNS] = {
    "theta_l", "phi_l", "theta_v", "phi_v", "l_x", "l_y", "l_z", "v_x", "v_y", "v_z", "r", "g", "b", "value"};
#define WORDS_MAX    64
#define UNIT_ERROR   0.02f /* of a vector's length */
#define BRIGHTEST    1e6f  /* 1/sr: what is larger is a mirror, which no table holds */
#define UNDER_GROUND 1e-3f /* how far below the surface a direction may lie by rounding */

struct samples_reader {
    struct tl_text text;
    int words;           /* columns of the file */
    int places[COLUMNS]; /* of a column among them; -1: it has none */
    bool has_angles, is_grey;
    struct tl_reflectance_samples *out;
    tl_error *error;
};

static bool fail_here(const struct samples_reader *reader, const char *what)
{
    return tl_fail(reader->error, TL_INPUT, "%s: line %zu: %s", reader->text.path, reader->text.line, what);
}

/* ---- The first line ---- */

static bool has(const struct samples_reader *reader, enum column first, enum column last)
{
    for (int c = (int)first; c <= (int)last; c++)
        if (reader->places[c] < 0)
            return false;
    return true;
}

static bool name_columns(struct samples_reader *reader)
{
    for (int c = 0; c < COLUMNS; c++)
        reader->places[c] = -1;
    if (!tl_text_next(&reader->text))
        return tl_fail(reader->error, TL_INPUT, "%s: has no line that names its columns", reader->text.path);
    for (char *word; (word = tl_text_word(&reader->text)) != NULL; reader->words++) {
        if (reader->words == WORDS_MAX)
            return fail_here(reader, "has more than 64 columns: remove those that are not needed");
        for (int c = 0; c < COLUMNS; c++) {
            if (strcmp(word, column_names[c]) != 0)
                continue;
            if (reader->places[c] >= 0)
                return fail_here(reader, "names a column twice: remove one");
            reader->places[c] = reader->words;
        }
    }
    reader->has_angles = has(reader, THETA_L, PHI_V);
    reader->is_grey = !has(reader, RED, BLUE);
    if (!reader->has_angles && !has(reader, L_X, V_Z))
        return fail_here(reader,
                         "does not name the columns of directions: expected theta_l phi_l theta_v phi_v in "
                         "degrees, or l_x l_y l_z v_x v_y v_z");
    if (reader->is_grey && !has(reader, VALUE, VALUE))
        return fail_here(reader, "does not name the columns of reflectance: expected r g b, or value");
    return true;
}

/* ---- The samples ---- */

static vec3s from_angles(float theta_deg, float phi_deg)
{
    double theta = (double)theta_deg * M_PI / 180, phi = (double)phi_deg * M_PI / 180;
    return (vec3s){{(float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)), (float)cos(theta)}};
}

static bool read_direction(const struct samples_reader *reader, const float *words, bool is_viewer,
                           vec3s *out)
{
    const int *places = reader->places;
    int angle = is_viewer ? THETA_V : THETA_L, axis = is_viewer ? V_X : L_X;
    *out = reader->has_angles
               ? from_angles(words[places[angle]], words[places[angle + 1]])
               : (vec3s){{words[places[axis]], words[places[axis + 1]], words[places[axis + 2]]}};
    float length = glms_vec3_norm(*out);
    if (!(fabsf(length - 1) < UNIT_ERROR))
        return fail_here(reader, is_viewer ? "v is no unit vector: divide it by its length"
                                           : "l is no unit vector: divide it by its length");
    *out = glms_vec3_scale(*out, 1 / length);
    if (out->z < -UNDER_GROUND)
        return fail_here(reader, is_viewer ? "the viewer is below the surface: remove the line"
                                           : "the light is below the surface: remove the line");
    out->z = fmaxf(out->z, 0);
    return true;
}

static bool read_sample(const struct samples_reader *reader, const float *words,
                        struct tl_reflectance_sample *out)
{
    for (int c = 0; c < 3; c++) {
        out->value.raw[c] = words[reader->places[reader->is_grey ? VALUE : RED + c]];
        if (out->value.raw[c] < 0)
            return fail_here(reader, "reflectance is negative: remove the line, or set it to 0");
        if (out->value.raw[c] > BRIGHTEST)
            return fail_here(reader, "reflectance is more than 1000000 per sr: remove the line");
    }
    return read_direction(reader, words, false, &out->l) && read_direction(reader, words, true, &out->v);
}

static bool read_samples(struct samples_reader *reader)
{
    struct tl_reflectance_samples *out = reader->out;
    float words[WORDS_MAX], brightest = 0;
    size_t room = 0;
    while (tl_text_next(&reader->text)) {
        struct tl_reflectance_sample sample;
        if (out->count == TL_REFLECTANCE_SAMPLES_MAX)
            return fail_here(reader,
                             "is one more than the 1000000 samples that can be read: keep every n-th");
        if (!tl_text_numbers(&reader->text, "sample", reader->words, words, reader->error))
            return false;
        if (tl_text_word(&reader->text))
            return fail_here(reader, "has more numbers than the first line names columns");
        if (!read_sample(reader, words, &sample))
            return false;
        if (out->count == room) {
            room = room ? 2 * room : 1024;
            out->items = tl_resize(out->items, room, sizeof *out->items);
        }
        out->items[out->count++] = sample;
        brightest = fmaxf(brightest, glms_vec3_max(sample.value));
    }
    if (out->count < TL_REFLECTANCE_SAMPLES_MIN)
        return tl_fail(reader->error, TL_INPUT, "%s: has %zu samples: at least 32 are needed",
                       reader->text.path, out->count);
    return brightest > 0 || tl_fail(reader->error, TL_INPUT, "%s: reflects no light: all of its values are 0",
                                    reader->text.path);
}

bool tl_reflectance_samples_load(const char *path, struct tl_reflectance_samples *out, tl_error *error)
{
    struct samples_reader reader = {.out = out, .error = error};
    *out = (struct tl_reflectance_samples){0};
    if (tl_file_size(path) > TL_REFLECTANCE_FILE_BYTES)
        return tl_fail(error, TL_INPUT, "%s: has more than 256 MB: keep every n-th sample", path);
    bool good = tl_text_open(path, &reader.text, error);
    for (char *c = reader.text.data; good && c < reader.text.end; c++)
        if (*c == ',' || *c == ';')
            *c = ' ';
    good = good && name_columns(&reader) && read_samples(&reader);
    tl_text_close(&reader.text);
    if (!good)
        tl_reflectance_samples_release(out);
    return good;
}

void tl_reflectance_samples_release(struct tl_reflectance_samples *samples)
{
    free(samples->items);
    *samples = (struct tl_reflectance_samples){0};
}
