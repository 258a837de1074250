/* The list of findings, and the table of their codes. */
#include "app/audit/audit_internal.h"
#include "config/base/memory.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

const struct tl_audit_kind tl_audit_kinds[TL_AUDIT_CODES] = {
    [TL_AUDIT_FILE_MISSING] = {"file-missing", true,
                               "a file that this one names is not there, or lies outside its folder",
                               "deliver it, below the folder of this file"},
    [TL_AUDIT_FILE_UNREADABLE] = {"file-unreadable", true, "a file that this one names holds nothing usable",
                                  "export it again"},
    [TL_AUDIT_UNITS_UNFIT] = {"units-unfit", true,
                              "the size fits no unit of length, or is absurd in the format's metres",
                              "export it in the unit that the format prescribes, or agree on --units"},
    [TL_AUDIT_UNITS_GUESSED] = {"units-guessed", false,
                                "the file states no unit of length: it was guessed from the size",
                                "deliver glTF, which is in metres, or agree on --units"},
    [TL_AUDIT_UP_GUESSED] = {"up-guessed", false,
                             "the file states no upward axis: its shape stands along Z, and is turned "
                             "upright, or is deeper than high, and is left",
                             "export it with Y up, or agree on --up"},
    [TL_AUDIT_SEAM_OPEN] = {"seam-open", true,
                            "two borders lie along one another within a millimetre, but nothing joins them",
                            "weld or sew them: borders of a seam need the same vertices"},
    [TL_AUDIT_TRIANGLE_FLIPPED] = {"triangle-flipped", true,
                                   "triangles face the other way than the rest of their piece",
                                   "turn them over"},
    [TL_AUDIT_TRIANGLE_DEGENERATE] =
        {"triangle-degenerate", true,
         "a triangle has no area: two corners are at one place, or all on a line",
         "remove it, and weld its corners"},
    [TL_AUDIT_TRIANGLE_REPEATED] = {"triangle-repeated", false,
                                    "a triangle has the corners of another one: it is no cloth of its own",
                                    "remove it, or give the second layer vertices at a distance"},
    [TL_AUDIT_EDGE_CROWDED] = {"edge-crowded", false,
                               "more than two triangles share an edge: the cloth does not bend there",
                               "part the layers that are welded into one another"},
    [TL_AUDIT_SURFACE_ONE_SIDED] = {"surface-one-sided", false,
                                    "a piece is joined so that it has no outside, like a Moebius strip",
                                    "join one of its seams the other way round"},
    [TL_AUDIT_CROSSING] = {"crossing", false, "triangles pass through one another",
                           "move the layers apart, or drape them again"},
    [TL_AUDIT_UV_FLIPPED] = {"uv-flipped", false,
                             "triangles lie turned over in a chart that is the flat pattern",
                             "unfold the chart, or set cloth.rest=mesh"},
    [TL_AUDIT_TEXTURE_UNSCALED] = {"texture-unscaled", true, "pictures lie on the cloth at no stated size",
                                   "give the cloth UVs, or state the size of the fabric's pictures in mm"},
    [TL_AUDIT_PATTERN_UNCUT] = {"pattern-uncut", true, "the sewing pattern's panels cannot be cut",
                                "correct the panel that is named"},
};

vec3s audit_corner(const tl_mesh *mesh, size_t triangle, size_t k)
{
    return mesh->positions[mesh->indices[3 * triangle + k]];
}

/* The part that a triangle belongs to. */
static size_t part_of(const tl_mesh *mesh, size_t triangle)
{
    size_t part = 0;
    while (part + 1 < mesh->part_count &&
           3 * triangle >= mesh->parts[part].first_index + mesh->parts[part].index_count)
        part++;
    return part;
}

static struct tl_audit_place place_of(const tl_model *model, int64_t triangle)
{
    const tl_mesh *mesh = &model->mesh;
    if (triangle < 0)
        return (struct tl_audit_place){.part = TL_AUDIT_NOWHERE};
    size_t part = part_of(mesh, (size_t)triangle);
    struct tl_audit_place place = {
        .part = (int64_t)part,
        .name = tl_copy_string(model->materials[mesh->parts[part].material].name),
        .triangle = triangle - mesh->parts[part].first_index / 3,
    };
    for (size_t k = 0; k < 3; k++) {
        uint32_t vertex = mesh->indices[3 * triangle + (int64_t)k];
        place.points[k] = model->points ? model->points[vertex] : vertex;
        for (int axis = 0; axis < 3; axis++)
            place.position_mm[axis] += 1e3 * (double)mesh->positions[vertex].raw[axis] / 3;
    }
    return place;
}

/* Takes the message and the place's strings. */
static void add(tl_audit *audit, enum tl_audit_code code, struct tl_audit_place place, char *message)
{
    if (audit->counts[code]++ >= TL_AUDIT_LISTED) {
        free(place.name);
        free(place.file);
        free(message);
        return;
    }
    audit->findings = tl_resize(audit->findings, audit->finding_count + 1, sizeof *audit->findings);
    audit->findings[audit->finding_count++] = (struct tl_audit_finding){code, place, message};
}

void audit_add(tl_audit *audit, enum tl_audit_code code, const tl_model *model, int64_t triangle,
               const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    add(audit, code, place_of(model, triangle), tl_copy_string(text));
}

void tl_audit_add_file(tl_audit *audit, enum tl_audit_code code, const char *file, const char *message)
{
    struct tl_audit_place place = {.part = TL_AUDIT_NOWHERE, .file = file ? tl_copy_string(file) : NULL};
    add(audit, code, place, tl_copy_string(message));
}

size_t tl_audit_count(const tl_audit *audit, bool errors)
{
    size_t count = 0;
    for (int code = 0; code < TL_AUDIT_CODES; code++)
        count += tl_audit_kinds[code].is_error == errors ? audit->counts[code] : 0;
    return count;
}

static void print_place(const struct tl_audit_place *place, FILE *out)
{
    if (place->file)
        fprintf(out, "%s: ", place->file);
    if (place->part != TL_AUDIT_NOWHERE)
        fprintf(out, "part %" PRId64 " (%s), triangle %" PRId64 ", at %.1f %.1f %.1f mm: ", place->part,
                place->name, place->triangle, place->position_mm[0], place->position_mm[1],
                place->position_mm[2]);
}

void tl_audit_print(const tl_audit *audit, FILE *out)
{
    fprintf(out, "findings             %zu errors, %zu warnings\n", tl_audit_count(audit, true),
            tl_audit_count(audit, false));
    for (size_t i = 0; i < audit->finding_count; i++) {
        const struct tl_audit_finding *finding = &audit->findings[i];
        const struct tl_audit_kind *kind = &tl_audit_kinds[finding->code];
        fprintf(out, "  %-7s %-19s ", kind->is_error ? "error" : "warning", kind->code);
        print_place(&finding->place, out);
        fprintf(out, "%s: %s\n", finding->message, kind->remedy);
    }
    for (int code = 0; code < TL_AUDIT_CODES; code++)
        if (audit->counts[code] > TL_AUDIT_LISTED)
            fprintf(out, "  %-27s and %zu more\n", tl_audit_kinds[code].code,
                    audit->counts[code] - TL_AUDIT_LISTED);
}

void tl_audit_release(tl_audit *audit)
{
    for (size_t i = 0; i < audit->finding_count; i++) {
        free(audit->findings[i].place.name);
        free(audit->findings[i].place.file);
        free(audit->findings[i].message);
    }
    free(audit->findings);
    *audit = (tl_audit){0};
}
