#include "assets/base/model_build.h"
#include "assets/obj/polygon.h"
#include "assets/obj/wavefront_internal.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define LIMIT_PARTS 1024 /* each is one draw call */

struct obj_builder {
    const struct wave_object *object;
    tl_mesh *mesh;
    uint32_t *points;             /* [vertex_count] the file's vertex of each render vertex */
    struct wave_corner *vertices; /* [vertex_count] what each was made from */
    uint32_t *corner_vertices;    /* [corner_count] render vertex of each corner */
};

static uint32_t hash_corner(const struct wave_corner *corner)
{
    uint32_t hash = corner->position * 0x9e3779b1u;
    hash = (hash ^ hash >> 15 ^ corner->uv) * 0x85ebca77u;
    hash = (hash ^ hash >> 13 ^ corner->normal) * 0xc2b2ae3du;
    return hash ^ hash >> 16;
}

static bool is_same(const struct wave_corner *a, const struct wave_corner *b)
{
    return a->position == b->position && a->uv == b->uv && a->normal == b->normal;
}

/* Corners of equal position, texture coordinate and normal share a render vertex; these are numbered in the
 * order of their first corner. */
static void share_corners(struct obj_builder *builder)
{
    const struct wave_object *object = builder->object;
    size_t slots = 16, count = 0;
    while (slots < 2 * object->corner_count)
        slots *= 2;
    uint32_t *table = TL_NEW_ARRAY(uint32_t, slots); /* vertex + 1; 0: empty */
    builder->vertices = tl_alloc(object->corner_count, sizeof *builder->vertices);
    builder->corner_vertices = TL_NEW_ARRAY(uint32_t, object->corner_count);
    for (size_t i = 0; i < object->corner_count; i++) {
        const struct wave_corner *corner = &object->corners[i];
        size_t slot = hash_corner(corner) & (slots - 1);
        while (table[slot] && !is_same(&builder->vertices[table[slot] - 1], corner))
            slot = (slot + 1) & (slots - 1);
        if (!table[slot]) {
            builder->vertices[count++] = *corner;
            table[slot] = (uint32_t)count;
        }
        builder->corner_vertices[i] = table[slot] - 1;
    }
    free(table);
    builder->mesh->vertex_count = count;
}

static void fill_vertices(struct obj_builder *builder)
{
    const struct wave_object *object = builder->object;
    tl_mesh *mesh = builder->mesh;
    size_t count = mesh->vertex_count;
    mesh->positions = TL_NEW_ARRAY(vec3s, count);
    mesh->normals = TL_NEW_ARRAY(vec3s, count);
    mesh->uvs = TL_NEW_ARRAY(vec2s, count);
    builder->points = TL_NEW_ARRAY(uint32_t, count);
    for (size_t i = 0; i < count; i++) {
        const struct wave_corner *from = &builder->vertices[i];
        builder->points[i] = from->position;
        mesh->positions[i] = object->positions[from->position];
        if (from->normal != WAVE_NONE)
            mesh->normals[i] = glms_vec3_normalize(object->normals[from->normal]); /* zero stays zero */
        if (from->uv != WAVE_NONE)
            mesh->uvs[i] = (vec2s){{object->uvs[from->uv].x, 1 - object->uvs[from->uv].y}};
    }
}

/* Divides the faces into parts: one for each run of faces of one group and material; if these are too many,
 * one for each material. Returns the part of each face, and the parts' materials. */
static uint32_t *divide(const struct wave_object *object, uint32_t **part_materials, size_t *part_count)
{
    uint32_t *part_of = TL_NEW_ARRAY(uint32_t, object->face_count);
    const struct wave_face *faces = object->faces;
    *part_materials = NULL;
    *part_count = 0;
    for (size_t i = 0; i < object->face_count; i++) {
        bool same =
            i > 0 && faces[i].group == faces[i - 1].group && faces[i].material == faces[i - 1].material;
        if (!same) {
            if (*part_count == LIMIT_PARTS)
                break;
            *part_materials = tl_resize(*part_materials, *part_count + 1, sizeof(uint32_t));
            (*part_materials)[(*part_count)++] = faces[i].material;
        }
        part_of[i] = (uint32_t)*part_count - 1;
        if (i + 1 == object->face_count)
            return part_of;
    }
    *part_count = object->material_count;
    *part_materials = tl_resize(*part_materials, *part_count, sizeof(uint32_t));
    for (size_t i = 0; i < *part_count; i++)
        (*part_materials)[i] = (uint32_t)i;
    for (size_t i = 0; i < object->face_count; i++)
        part_of[i] = faces[i].material;
    return part_of;
}

/* Cuts one face into triangles at `out`; returns where they end. */
static uint32_t *cut_face(const struct obj_builder *builder, uint32_t first, size_t count, uint32_t *out)
{
    const uint32_t *vertices = &builder->corner_vertices[first];
    if (count == 3) {
        memcpy(out, vertices, 3 * sizeof *out);
        return out + 3;
    }
    vec3s *corners = TL_NEW_ARRAY(vec3s, count);
    uint32_t *scratch = TL_NEW_ARRAY(uint32_t, count);
    for (size_t i = 0; i < count; i++)
        corners[i] = builder->mesh->positions[vertices[i]];
    tl_polygon_cut(corners, count, out, scratch);
    size_t index_count = 3 * (count - 2);
    for (size_t i = 0; i < index_count; i++)
        out[i] = vertices[out[i]];
    free(scratch);
    free(corners);
    return out + index_count;
}

static size_t corners_of(const struct wave_object *object, size_t face, uint32_t *first)
{
    *first = face > 0 ? object->faces[face - 1].corner_end : 0;
    return object->faces[face].corner_end - *first;
}

/* Triangulates the faces in the order of their parts, within a part in that of the file. */
static void fill_parts(struct obj_builder *builder)
{
    const struct wave_object *object = builder->object;
    tl_mesh *mesh = builder->mesh;
    uint32_t *materials, first;
    uint32_t *part_of = divide(object, &materials, &mesh->part_count);
    mesh->parts = TL_NEW_ARRAY(struct tl_mesh_part, mesh->part_count);
    for (size_t i = 0; i < object->face_count; i++)
        mesh->parts[part_of[i]].index_count += (uint32_t)(3 * (corners_of(object, i, &first) - 2));
    for (size_t i = 0; i < mesh->part_count; i++) {
        mesh->parts[i].first_index = (uint32_t)mesh->index_count;
        mesh->parts[i].material = (int)materials[i];
        mesh->index_count += mesh->parts[i].index_count;
    }
    mesh->indices = TL_NEW_ARRAY(uint32_t, mesh->index_count);
    uint32_t **ends = tl_alloc(mesh->part_count, sizeof *ends);
    for (size_t i = 0; i < mesh->part_count; i++)
        ends[i] = mesh->indices + mesh->parts[i].first_index;
    for (size_t i = 0; i < object->face_count; i++) {
        size_t count = corners_of(object, i, &first);
        ends[part_of[i]] = cut_face(builder, first, count, ends[part_of[i]]);
    }
    free(ends);
    free(materials);
    free(part_of);
}

bool wave_load_model(const char *path, enum tl_units wanted, tl_model *out, tl_error *error)
{
    struct wave_object object;
    if (!wave_read(path, &object, error))
        return false;
    if (object.face_count == 0) {
        wave_release(&object);
        return tl_fail(error, TL_INPUT, "%s: holds no mesh with triangles: choose another file", path);
    }
    struct obj_builder builder = {.object = &object, .mesh = &out->mesh};
    share_corners(&builder);
    fill_vertices(&builder);
    fill_parts(&builder);
    for (size_t i = 0; i < object.ignored_count; i++)
        model_ignore(out, "%s", object.ignored[i]);
    wave_read_materials(path, &object, out);
    out->points = builder.points;
    out->point_count = object.position_count;
    out->stitch_count = object.stitch_count;
    out->stitches = object.stitches;
    object.stitches = NULL;
    free(builder.vertices);
    free(builder.corner_vertices);
    wave_release(&object);
    if (!model_take_units(path, wanted, false, out, error))
        return false;
    model_smooth_normals(&out->mesh);
    tl_mesh_measure_uvs(&out->mesh);
    return true;
}
