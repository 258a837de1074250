#include "app/fabric/card.h"

#include "app/cli/json.h"
#include "app/fabric/card_internal.h"
#include "app/fabric/fields.h"
#include "app/settings/imported.h"
#include "app/settings/layers.h"
#include "assets/image/image_file.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <cairo-pdf.h>

#include <stdlib.h>
#include <string.h>

#define POINTS_PER_MM (72 / 25.4)

/* ---- Contents ---- */

/* Comments at the head of a fabric's file, joined: they state what it is and who measured it. */
static char *head_of(const char *text)
{
    char *notes = tl_copy_string("");
    size_t length = 0;
    for (const char *line = text; line && *line == '#'; line = strchr(line, '\n'), line += line != NULL) {
        line += 1 + strspn(line + 1, " ");
        size_t size = strcspn(line, "\n");
        notes = tl_resize(notes, length + size + 2, 1);
        memcpy(notes + length, line, size);
        length += size;
        notes[length++] = ' ';
        notes[length] = '\0';
    }
    return notes;
}

static char *notes_of(const struct tl_fabric *fabric)
{
    tl_error unused;
    size_t size;
    char *data = NULL, *own = NULL;
    if (fabric->is_foreign)
        return tl_copy_string("");
    if (!tl_option_is_file_name(fabric->source)) {
        char *name = tl_format("%s.yaml", fabric->source);
        const struct tl_embedded *entry = tl_embedded_find(tl_embedded_fabrics, name);
        free(name);
        return head_of(entry ? entry->data : NULL);
    }
    own = tl_imported_own_file(fabric->source);
    bool read = tl_file_read(own ? own : fabric->source, &data, &size, &unused);
    char *notes = head_of(read ? data : NULL);
    free(own);
    free(data);
    return notes;
}

/* The disc of Cusick's test in this fabric; what the user sets comes last. */
static bool load_settings(const char *source, const struct tl_arguments *arguments, struct tl_settings *out,
                          tl_error *error)
{
    char *fabric = tl_format("scene.fabric=%s", source);
    const char *const own[] = {fabric,
                               "scene.colourways=own",
                               "cloth.edge_m=0.008",
                               "cloth.settle_s=20",
                               "fabric.damping=2", /* ends the swinging; the rest is the same */
                               "image.ground=false",
                               "image.background=grey"};
    const char **all = TL_NEW_ARRAY(const char *, TL_COUNT(own) + arguments->assignment_count);
    memcpy(all, own, sizeof own);
    for (size_t i = 0; i < arguments->assignment_count; i++)
        all[TL_COUNT(own) + i] = arguments->assignments[i];
    const struct tl_settings_source from = {.scene_file = "cusick",
                                            .assignments = all,
                                            .assignment_count = TL_COUNT(own) + arguments->assignment_count};
    bool loaded = tl_settings_load(out, &from, error);
    free(all);
    free(fabric);
    return loaded;
}

static void release(struct tl_card *card)
{
    tl_fabric_release(&card->fabric);
    tl_image_release(&card->shadow);
    tl_image_release(&card->swatch);
    tl_image_release(&card->close);
    tl_image_release(&card->ball);
    tl_image_release(&card->disc);
    free(card->notes);
    free(card->unused);
}

static bool make(struct tl_card *card, const char *source, const struct tl_arguments *arguments,
                 bool with_pictures, tl_error *error)
{
    if (!tl_fabric_open(source, &card->fabric, error))
        return false;
    card->notes = notes_of(&card->fabric);
    card->unused = tl_fabric_fields_unused(&card->fabric.file);
    return load_settings(source, arguments, &card->settings, error) &&
           tl_card_draw_views(card, with_pictures, error) && tl_card_fill_figures(card, error);
}

/* ---- JSON ---- */

static cJSON *json_of_colour(const struct tl_card_colour *colour)
{
    cJSON *object = cJSON_CreateObject(), *lab = cJSON_AddArrayToObject(object, "lab_d65"),
          *rgb = cJSON_AddArrayToObject(object, "linear_rgb");
    const double values[] = {colour->lab.l, colour->lab.a, colour->lab.b};
    for (int c = 0; c < 3; c++) {
        cJSON_AddItemToArray(lab, cJSON_CreateNumber(values[c]));
        cJSON_AddItemToArray(rgb, cJSON_CreateNumber((double)colour->rgb[c]));
    }
    cJSON_AddStringToObject(object, "hex", colour->hex.text);
    return object;
}

static cJSON *json_of(const struct tl_card *card)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "fabric", tl_fabric_name(&card->fabric));
    cJSON_AddStringToObject(object, "source", card->fabric.source);
    cJSON_AddStringToObject(object, "notes", card->notes);
    cJSON *figures = cJSON_AddArrayToObject(object, "figures");
    for (int i = 0; i < card->figure_count; i++) {
        cJSON *row = cJSON_CreateObject();
        cJSON_AddStringToObject(row, "name", card->figures[i].name);
        tl_json_add_number(row, "value", card->figures[i].value);
        cJSON_AddStringToObject(row, "unit", card->figures[i].unit);
        cJSON_AddStringToObject(row, "source", card->figures[i].source);
        cJSON_AddItemToArray(figures, row);
    }
    cJSON *drape = cJSON_AddObjectToObject(object, "drape");
    tl_json_add_number(drape, "coefficient_percent", 100 * card->drape);
    tl_json_add_number(drape, "folds", card->folds);
    cJSON_AddBoolToObject(drape, "at_rest", card->is_at_rest);
    if (card->has_colour) {
        cJSON *colour = cJSON_AddObjectToObject(object, "colour");
        cJSON_AddItemToObject(colour, "base", json_of_colour(&card->base));
        cJSON_AddItemToObject(colour, "measured", json_of_colour(&card->measured));
        tl_json_add_number(colour, "ciede2000", card->difference);
    }
    cJSON_AddItemToObject(object, "fields", tl_fabric_fields_json(&card->fabric.file));
    return object;
}

/* ---- Files ---- */

static bool write_json(const struct tl_card *card, const char *path, tl_error *error)
{
    struct tl_writer writer;
    if (!tl_writer_begin(&writer, path, error))
        return false;
    cJSON *object = json_of(card);
    char *text = cJSON_Print(object);
    fprintf(writer.stream, "%s\n", text ? text : "");
    cJSON_free(text);
    cJSON_Delete(object);
    return tl_writer_commit(&writer, error);
}

static cairo_status_t write_stream(void *closure, const unsigned char *data, unsigned size)
{
    return fwrite(data, 1, size, closure) == size ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

static bool write_pdf(const struct tl_card *card, const char *path, tl_error *error)
{
    struct tl_writer writer;
    if (!tl_writer_begin(&writer, path, error))
        return false;
    cairo_surface_t *surface = cairo_pdf_surface_create_for_stream(
        write_stream, writer.stream, TL_CARD_WIDTH_MM * POINTS_PER_MM, TL_CARD_HEIGHT_MM * POINTS_PER_MM);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, tl_fabric_name(&card->fabric));
    cairo_t *cairo = cairo_create(surface);
    cairo_scale(cairo, POINTS_PER_MM, POINTS_PER_MM);
    tl_card_draw_page(card, cairo);
    cairo_destroy(cairo);
    cairo_surface_finish(surface);
    cairo_surface_destroy(surface);
    return tl_writer_commit(&writer, error); /* the stream remembers a failure */
}

static bool write_png(const struct tl_card *card, const char *path, tl_error *error)
{
    const int width = TL_CARD_WIDTH_MM * TL_CARD_PER_MM, height = TL_CARD_HEIGHT_MM * TL_CARD_PER_MM;
    tl_image image = tl_image_create(width, height, 3, TL_IMAGE_U8);
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    cairo_t *cairo = cairo_create(surface);
    cairo_scale(cairo, TL_CARD_PER_MM, TL_CARD_PER_MM);
    tl_card_draw_page(card, cairo);
    cairo_destroy(cairo);
    cairo_surface_flush(surface);
    const unsigned char *data = cairo_image_surface_get_data(surface);
    int stride = cairo_image_surface_get_stride(surface);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            uint32_t texel;
            memcpy(&texel, data + (ptrdiff_t)y * stride + (ptrdiff_t)4 * x, sizeof texel);
            for (int c = 0; c < 3; c++)
                tl_image_bytes(&image)[3 * ((ptrdiff_t)y * width + x) + c] = (uint8_t)(texel >> (16 - 8 * c));
        }
    cairo_surface_destroy(surface);
    bool written = tl_image_save_png(path, &image, error);
    tl_image_release(&image);
    return written;
}

/* Checks the output before a minute of work is spent. */
static bool check_output(const char *path, tl_error *error)
{
    struct tl_writer writer;
    if (!tl_path_has_extension(path, "png") && !tl_path_has_extension(path, "pdf") &&
        !tl_path_has_extension(path, "json"))
        return tl_fail(error, TL_USAGE, "%s: unknown kind of card: end the name in .png, .pdf or .json",
                       path);
    if (!tl_writer_begin(&writer, path, error))
        return false;
    tl_writer_abandon(&writer);
    return true;
}

bool tl_fabric_card(const char *source, const struct tl_arguments *arguments, tl_error *error)
{
    const char *path = arguments->card;
    if (!check_output(path, error))
        return false;
    struct tl_card *card = TL_NEW(struct tl_card);
    bool is_json = tl_path_has_extension(path, "json");
    bool done = make(card, source, arguments, !is_json, error);
    if (done)
        done = is_json                              ? write_json(card, path, error)
               : tl_path_has_extension(path, "pdf") ? write_pdf(card, path, error)
                                                    : write_png(card, path, error);
    if (done)
        tl_info("%s: %.0f g/m\u00b2, drape coefficient %.0f %%", path,
                1e3 * card->settings.fabric.areal_density, 100 * card->drape);
    release(card);
    free(card);
    return done;
}
