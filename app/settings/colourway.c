#include "app/settings/colourway.h"

#include "app/settings/layers.h"
#include "config/base/hash.h"
#include "config/base/intern.h"
#include "config/base/memory.h"
#include "config/embedded.h"

#include <assert.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* The fields of a swatch that are not rows of material and weave. */
struct draft {
    const char *fabric;
    struct tl_swatch swatch;
};

enum { FABRIC, PRINT, OWN_ROWS, ROWS_MAX = 64, NAME_BYTES_MAX = 63 };

/* The rows of a swatch: its own, material's, weave's, all within a struct draft. */
struct swatch_rows {
    struct tl_option rows[ROWS_MAX];
    struct tl_option_table table;
};

static void add_rows(struct swatch_rows *to, const struct tl_option_table *from, size_t offset)
{
    assert(to->table.row_count + from->row_count <= ROWS_MAX); /* tl_swatch.given has a bit for each */
    for (size_t i = 0; i < from->row_count; i++) {
        to->rows[to->table.row_count] = from->rows[i];
        to->rows[to->table.row_count++].offset += offset;
    }
}

static void make_rows(struct swatch_rows *out)
{
    const struct tl_option own[OWN_ROWS] = {
        [FABRIC] =
            TL_OPTION_NAME_OR_PATH(struct draft, fabric, TL_AFFECTS_NOTHING, tl_embedded_fabrics_names, ""),
        [PRINT] = TL_OPTION_BOOL(struct draft, swatch.print, TL_AFFECTS_NOTHING, ""),
    };
    *out = (struct swatch_rows){.table = {.name = "swatch", .row_count = OWN_ROWS}};
    memcpy(out->rows, own, sizeof own);
    out->rows[PRINT].name = "print";
    add_rows(out, &tl_material_options, offsetof(struct draft, swatch.params));
    add_rows(out, &tl_weave_options, offsetof(struct draft, swatch.weave));
    out->table.rows = out->rows;
}

/* ---- Reading ---- */

static bool fail(const struct tl_record_place *place, const char *what, tl_error *error)
{
    return tl_fail(error, TL_USAGE, "%s:%zu: colourways.%s%s%s: %s", place->file, place->line, place->record,
                   place->part ? "." : "", place->part ? place->part : "", what);
}

static bool begin_record(struct tl_colourways_reader *reader, const struct tl_record_place *place,
                         tl_error *error)
{
    struct tl_colourways *out = reader->out;
    if (strlen(place->record) > NAME_BYTES_MAX || place->record[0] == '\0')
        return fail(place, "a colourway's name has 1 to 63 bytes", error);
    for (size_t i = 0; i < out->name_count; i++)
        if (strcmp(out->names[i], place->record) == 0)
            return fail(place, "is given twice: remove one", error);
    if (out->name_count == TL_COLOURWAYS_MAX)
        return fail(place, "is one more than the 64 that a file can have: remove some", error);
    out->names[out->name_count++] = tl_intern(place->record);
    reader->is_chosen = strcmp(place->record, reader->chosen) == 0;
    out->is_known = out->is_known || reader->is_chosen;
    return true;
}

static bool begin_part(struct tl_colourways_reader *reader, const struct tl_record_place *place,
                       tl_error *error)
{
    struct tl_colourways *out = reader->out;
    if (strlen(place->part) > NAME_BYTES_MAX)
        return fail(place, "a material's name has at most 63 bytes", error);
    reader->swatch =
        (struct tl_swatch){.line = (int)place->line, .print = true, .material = tl_intern(place->part)};
    if (!reader->is_chosen)
        return true;
    for (size_t i = 0; i < out->swatch_count; i++)
        if (strcmp(out->swatches[i].material, place->part) == 0)
            return fail(place, "is given twice: remove one", error);
    if (out->swatch_count == TL_SWATCHES_MAX)
        return fail(place, "is one more than the 16 materials that a colourway can have: use `all`", error);
    out->swatches[out->swatch_count++] = reader->swatch;
    return true;
}

/* The fabric's rows, but for those that the swatch has given. */
static bool take_fabric(struct tl_swatch *swatch, const char *name, tl_error *error)
{
    struct tl_swatch fresh = *swatch;
    if (!tl_option_layer_read_appearance(name, &fresh.params, &fresh.weave, error))
        return false;
    tl_swatch_apply(swatch, &fresh.params, &fresh.weave);
    *swatch = fresh;
    swatch->has_fabric = true;
    return true;
}

static bool take_option(struct tl_colourways_reader *reader, const struct tl_record_place *place,
                        const char *text, tl_error *error)
{
    struct swatch_rows known;
    make_rows(&known);
    struct draft draft = {.swatch = reader->swatch};
    const struct tl_binding binding = {&known.table, &draft};
    char *key = tl_format("swatch.%s", place->key);
    char *where = tl_format("%s:%zu: colourways.%s.%s", place->file, place->line, place->record, place->part);
    bool good = tl_options_set(&binding, 1, key, text, where, place->file, error);
    for (size_t i = 0; good && i < known.table.row_count; i++) {
        if (strcmp(known.rows[i].name, place->key) != 0)
            continue;
        if (draft.swatch.given >> i & 1)
            good = tl_fail(error, TL_USAGE, "%s.%s: is given twice: remove one", where, place->key);
        draft.swatch.given |= (uint64_t)1 << i;
    }
    tl_error why;
    if (good && tl_text_is_given(draft.fabric) && !take_fabric(&draft.swatch, draft.fabric, &why))
        good = tl_fail(error, why.code, "%s.fabric: %s", where, why.message);
    free(where);
    free(key);
    if (!good)
        return false;
    reader->swatch = draft.swatch;
    if (reader->is_chosen)
        reader->out->swatches[reader->out->swatch_count - 1] = draft.swatch;
    return true;
}

static bool take(void *context, const struct tl_record_place *place, const char *text, tl_error *error)
{
    if (!place->part)
        return begin_record(context, place, error);
    if (!place->key)
        return begin_part(context, place, error);
    return take_option(context, place, text, error);
}

void tl_colourways_begin(struct tl_colourways_reader *reader, const char *chosen, struct tl_colourways *out)
{
    *reader = (struct tl_colourways_reader){.chosen = chosen, .out = out};
    memset(out, 0, sizeof *out);
}

struct tl_record_section tl_colourways_section(struct tl_colourways_reader *reader)
{
    return (struct tl_record_section){"colourways", take, reader};
}

/* ---- Use ---- */

void tl_swatch_apply(const struct tl_swatch *swatch, struct tl_material_params *params,
                     struct tl_weave_params *weave)
{
    if (swatch->has_fabric) {
        *params = swatch->params;
        *weave = swatch->weave;
        return;
    }
    const struct tl_option_table *tables[] = {&tl_material_options, &tl_weave_options};
    const void *from[] = {&swatch->params, &swatch->weave};
    void *to[] = {params, weave};
    uint64_t given = swatch->given >> OWN_ROWS;
    for (size_t t = 0; t < TL_COUNT(tables); t++)
        for (size_t i = 0; i < tables[t]->row_count; i++, given >>= 1)
            if (given & 1)
                tl_options_copy(&tables[t]->rows[i], from[t], to[t]);
}

bool tl_swatch_is_dyed(const struct tl_swatch *swatch)
{
    for (size_t i = 0; i < tl_material_options.row_count; i++)
        if (tl_material_options.rows[i].offset == offsetof(struct tl_material_params, diffuse))
            return swatch->given >> (OWN_ROWS + i) & 1;
    return false;
}

bool tl_swatch_is_woven(const struct tl_swatch *swatch)
{
    return swatch->given >> (OWN_ROWS + tl_material_options.row_count) != 0;
}

/* ---- Keeping ---- */

const struct tl_colourways tl_colourways_none = {0};

static bool is_same_swatch(const struct tl_swatch *a, const struct tl_swatch *b)
{
    return a->material == b->material && a->line == b->line && a->has_fabric == b->has_fabric &&
           a->print == b->print && a->given == b->given &&
           tl_options_equal(&tl_material_options, &a->params, &b->params) &&
           tl_options_equal(&tl_weave_options, &a->weave, &b->weave);
}

static bool is_same(const struct tl_colourways *a, const struct tl_colourways *b)
{
    if (a->name_count != b->name_count || a->is_known != b->is_known || a->swatch_count != b->swatch_count)
        return false;
    for (size_t i = 0; i < a->name_count; i++)
        if (a->names[i] != b->names[i])
            return false;
    for (size_t i = 0; i < a->swatch_count; i++)
        if (!is_same_swatch(&a->swatches[i], &b->swatches[i]))
            return false;
    return true;
}

struct kept {
    struct kept *next;
    struct tl_colourways table;
};

const struct tl_colourways *tl_colourways_keep(const struct tl_colourways *made)
{
    static pthread_mutex_t guard = PTHREAD_MUTEX_INITIALIZER;
    static struct kept *all;
    if (is_same(made, &tl_colourways_none))
        return &tl_colourways_none;
    pthread_mutex_lock(&guard);
    struct kept *kept = all;
    while (kept && !is_same(&kept->table, made))
        kept = kept->next;
    if (!kept) {
        kept = TL_NEW(struct kept);
        *kept = (struct kept){all, *made};
        all = kept;
    }
    pthread_mutex_unlock(&guard);
    return &kept->table;
}

uint64_t tl_colourways_hash(const struct tl_colourways *colourways, uint64_t hash)
{
    for (size_t i = 0; i < colourways->swatch_count; i++) {
        struct tl_swatch swatch = colourways->swatches[i]; /* bindings can be written through */
        const struct tl_binding bindings[] = {{&tl_material_options, &swatch.params},
                                              {&tl_weave_options, &swatch.weave}};
        const char *material = colourways->swatches[i].material;
        const uint64_t own[] = {swatch.has_fabric, swatch.print, swatch.given};
        hash = tl_hash(hash, material, strlen(material) + 1);
        hash = tl_hash(hash, own, sizeof own);
        hash = tl_options_hash(bindings, TL_COUNT(bindings), (struct tl_option_filter){.any_of = UINT64_MAX},
                               hash);
    }
    return hash;
}
