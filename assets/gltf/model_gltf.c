/* A glTF document as a tl_model: its nodes' primitives in one mesh, in the rest pose. */
#include "assets/gltf/gltf_model.h"
#include "assets/gltf/model_internal.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NO_SLOT UINT32_MAX

/* The model under construction. */
struct gltf_builder {
    const gltf_document *document;
    tl_model *model;
    tl_rig *rig;
    vec3s *normals;       /* [vertex_count] before any transform; zero where the file has none */
    uint32_t *skin_slots; /* [skin_count] first slot of each skin, or NO_SLOT */
    /* The vertices added last: primitives of one mesh often share one set. */
    const struct gltf_primitive *last_primitive;
    const struct gltf_primitive **sources; /* [part_count] the primitive of each part */
    struct morph_reading morphs;
    int last_node;
    size_t last_base, last_count;
    size_t vertex_capacity, index_capacity, part_capacity, slot_capacity;
    bool has_pins, has_colours;
};

/* ---- Slots: a node and a bind matrix; vertices are bound to them ---- */

static uint32_t add_slot(struct gltf_builder *builder, int node, mat4s bind)
{
    tl_rig *rig = builder->rig;
    if (rig->slot_count == builder->slot_capacity) {
        builder->slot_capacity = 2 * builder->slot_capacity + 64;
        rig->slots = tl_resize(rig->slots, builder->slot_capacity, sizeof *rig->slots);
    }
    rig->slots[rig->slot_count] = (struct rig_slot){node, bind};
    return (uint32_t)rig->slot_count++;
}

/* Adds the slots of a skin once, one for each joint, however many nodes use it. */
static bool add_skin(struct gltf_builder *builder, int index, tl_error *error)
{
    const gltf_document *document = builder->document;
    if ((size_t)index >= document->skin_count)
        return tl_fail(error, TL_INPUT, "%s: skin %d does not exist: export the file again", document->path,
                       index);
    if (builder->skin_slots[index] != NO_SLOT)
        return true;
    const struct gltf_skin *skin = &document->skins[index];
    float *binds = NULL;
    size_t bind_count = 0;
    if (skin->inverse_binds >= 0 &&
        !gltf_read_floats(document, skin->inverse_binds, "inverse bind matrices", 16,
                          document->node_count + skin->joint_count, false, &binds, &bind_count, error))
        return false;
    builder->skin_slots[index] = (uint32_t)builder->rig->slot_count;
    bool good = skin->inverse_binds < 0 || bind_count >= skin->joint_count;
    for (size_t i = 0; good && i < skin->joint_count; i++) {
        mat4s bind = glms_mat4_identity();
        if (binds)
            memcpy(&bind, binds + 16 * i, sizeof bind);
        good = skin->joints[i] >= 0 && (size_t)skin->joints[i] < document->node_count;
        if (good)
            add_slot(builder, skin->joints[i], bind);
    }
    free(binds);
    if (!good)
        tl_fail(error, TL_INPUT,
                "%s: skin %d has joints or matrices that do not exist: export the file again", document->path,
                index);
    return good;
}

/* ---- Primitives ---- */

static void note_ignored(struct gltf_builder *builder, const struct gltf_primitive *primitive)
{
    if (primitive->attributes[GLTF_COLOUR] >= 0)
        model_ignore(builder->model, "vertex colours");
    if (primitive->has_second_uvs)
        model_ignore(builder->model, "TEXCOORD_1 and beyond");
    if (primitive->has_second_joints)
        model_ignore(builder->model, "more than four joints a vertex");
}

static struct rig_influence influence_of(const struct gltf_vertices *primitive, size_t vertex,
                                         uint32_t first_slot)
{
    const float *weights = primitive->weights + 4 * vertex;
    float sum = 0;
    for (int i = 0; i < 4; i++)
        sum += fmaxf(weights[i], 0);
    struct rig_influence influence = {.slots = {first_slot}, .weights = {1}};
    for (int i = 0; sum > 0 && i < 4; i++) {
        influence.weights[i] = fmaxf(weights[i], 0) / sum;
        influence.slots[i] =
            influence.weights[i] > 0 ? first_slot + primitive->joints[4 * vertex + (size_t)i] : first_slot;
    }
    return influence;
}

/* Asks for the vertices and indices so far and those to be added. Many nodes may show one mesh. */
static bool request_memory(const struct gltf_builder *builder, size_t vertices, size_t indices,
                           tl_error *error)
{
    const tl_mesh *mesh = &builder->model->mesh;
    const uint64_t capacity = 2; /* arrays that grow have twice the size at most */
    uint64_t vertex_bytes =
        sizeof *mesh->uvs + 4 * sizeof(vec3s) + sizeof(float) + sizeof(struct rig_influence);
    uint64_t all_vertices = mesh->vertex_count + vertices, all_indices = mesh->index_count + indices;
    if (all_vertices > TL_LIMIT_MESH_VERTICES || all_indices > TL_LIMIT_MESH_INDICES)
        return tl_fail(error, TL_INPUT, "%s: has more than %zu vertices or %zu triangles: simplify it",
                       builder->document->path, TL_LIMIT_MESH_VERTICES, TL_LIMIT_MESH_INDICES / 3);
    return tl_memory_request_for_file(
        builder->document->path, builder->document->file_bytes,
        capacity * (all_vertices * vertex_bytes + all_indices * sizeof *mesh->indices), error);
}

static void reserve(struct gltf_builder *builder, size_t vertices, size_t indices)
{
    tl_mesh *mesh = &builder->model->mesh;
    tl_rig *rig = builder->rig;
    if (mesh->vertex_count + vertices > builder->vertex_capacity) {
        size_t capacity = builder->vertex_capacity = 2 * (mesh->vertex_count + vertices);
        mesh->uvs = tl_resize(mesh->uvs, capacity, sizeof *mesh->uvs);
        builder->model->pins = tl_resize(builder->model->pins, capacity, sizeof(float));
        builder->model->colours = tl_resize(builder->model->colours, capacity, sizeof(vec3s));
        builder->normals = tl_resize(builder->normals, capacity, sizeof *builder->normals);
        rig->local = tl_resize(rig->local, capacity, sizeof *rig->local);
        rig->influences = tl_resize(rig->influences, capacity, sizeof *rig->influences);
    }
    if (mesh->index_count + indices > builder->index_capacity) {
        builder->index_capacity = 2 * (mesh->index_count + indices);
        mesh->indices = tl_resize(mesh->indices, builder->index_capacity, sizeof *mesh->indices);
    }
    if (mesh->part_count == builder->part_capacity) {
        builder->part_capacity = 2 * builder->part_capacity + 8;
        mesh->parts = tl_resize(mesh->parts, builder->part_capacity, sizeof *mesh->parts);
        builder->sources = tl_resize(builder->sources, builder->part_capacity, sizeof(void *));
    }
}

static void append_vertices(struct gltf_builder *builder, const struct gltf_vertices *from,
                            uint32_t first_slot)
{
    tl_model *model = builder->model;
    tl_mesh *mesh = &model->mesh;
    size_t base = mesh->vertex_count;
    builder->has_pins |= from->pins != NULL;
    builder->has_colours |= from->colours != NULL;
    for (size_t i = 0; i < from->vertex_count; i++) {
        const float *colour = from->colours ? from->colours + i * (size_t)from->colour_components : NULL;
        model->pins[base + i] = from->pins ? from->pins[i] : 0;
        model->colours[base + i] = colour ? (vec3s){{colour[0], colour[1], colour[2]}} : (vec3s){{1, 1, 1}};
        memcpy(&builder->rig->local[base + i], from->positions + 3 * i, sizeof(vec3s));
        builder->normals[base + i] = (vec3s){{0, 0, 0}};
        if (from->normals)
            memcpy(&builder->normals[base + i], from->normals + 3 * i, sizeof(vec3s));
        mesh->uvs[base + i] = from->uvs ? (vec2s){{from->uvs[2 * i], from->uvs[2 * i + 1]}} : (vec2s){{0, 0}};
        builder->rig->influences[base + i] =
            from->weights ? influence_of(from, i, first_slot)
                          : (struct rig_influence){.slots = {first_slot}, .weights = {1}};
    }
    mesh->vertex_count += from->vertex_count;
    builder->rig->vertex_count = mesh->vertex_count;
}

static void append_part(struct gltf_builder *builder, const struct gltf_vertices *from,
                        const struct gltf_primitive *source)
{
    tl_mesh *mesh = &builder->model->mesh;
    for (size_t i = 0; i < from->index_count; i++)
        mesh->indices[mesh->index_count + i] = from->indices[i] + (uint32_t)builder->last_base;
    size_t default_material = builder->model->material_count - 1;
    bool known = source->material >= 0 && (size_t)source->material < default_material;
    builder->sources[mesh->part_count] = source;
    mesh->parts[mesh->part_count++] =
        (struct tl_mesh_part){.first_index = (uint32_t)mesh->index_count,
                              .index_count = (uint32_t)from->index_count,
                              .material = known ? source->material : (int)default_material};
    mesh->index_count += from->index_count;
}

/* Whether two primitives have the same vertices, morph targets included. */
static bool has_same_vertices(const gltf_document *document, const struct gltf_primitive *a,
                              const struct gltf_primitive *b)
{
    const struct gltf_target *targets = document->targets;
    if (a->target_count != b->target_count || memcmp(a->attributes, b->attributes, sizeof a->attributes) != 0)
        return false;
    for (size_t i = 0; i < a->target_count; i++)
        if (memcmp(&targets[a->first_target + i], &targets[b->first_target + i], sizeof *targets) != 0)
            return false;
    return true;
}

/* Appends the triangles of `from` at a node; skin: that of the node, or NULL. */
static bool append_primitive(struct gltf_builder *builder, const struct gltf_primitive *from, int node,
                             const struct gltf_skin *skin, struct gltf_vertices *primitive, tl_error *error)
{
    const gltf_document *document = builder->document;
    tl_mesh *mesh = &builder->model->mesh;
    bool shared = builder->last_primitive && builder->last_node == node &&
                  has_same_vertices(document, builder->last_primitive, from);
    if (shared)
        primitive->vertex_count = builder->last_count;
    else if (!gltf_primitive_read_vertices(document, from, skin ? skin->joint_count : 0, primitive, error))
        return false;
    if (!gltf_primitive_read_indices(document, from, primitive, error))
        return false;
    size_t added = shared ? 0 : primitive->vertex_count;
    if (!request_memory(builder, added, primitive->index_count, error))
        return false;
    if (primitive->index_count == 0)
        return true;
    reserve(builder, added, primitive->index_count);
    if (!shared) {
        builder->last_primitive = from;
        builder->last_node = node;
        builder->last_base = mesh->vertex_count;
        builder->last_count = primitive->vertex_count;
        append_vertices(builder, primitive,
                        primitive->weights ? builder->skin_slots[document->nodes[node].skin]
                                           : add_slot(builder, node, glms_mat4_identity()));
        if (!rig_read_morphs(document, from, node, builder->last_base, builder->last_count, &builder->morphs,
                             builder->rig, builder->normals, error))
            return false;
    }
    append_part(builder, primitive, from);
    return true;
}

static bool add_primitive(struct gltf_builder *builder, const struct gltf_primitive *from, int node,
                          const struct gltf_skin *skin, tl_error *error)
{
    if (from->mode < GLTF_MODE_TRIANGLES || from->mode > GLTF_MODE_FAN) {
        model_ignore(builder->model, "points and lines");
        return true;
    }
    if (from->attributes[GLTF_POSITION] < 0) {
        model_ignore(builder->model, "primitives without positions");
        return true;
    }
    note_ignored(builder, from);
    struct gltf_vertices primitive = {0};
    bool good = append_primitive(builder, from, node, skin, &primitive, error);
    gltf_vertices_release(&primitive);
    return good;
}

static bool add_node(struct gltf_builder *builder, int index, tl_error *error)
{
    const gltf_document *document = builder->document;
    const struct gltf_node *node = &document->nodes[index];
    if (node->mesh < 0)
        return true;
    if ((size_t)node->mesh >= document->mesh_count)
        return tl_fail(error, TL_INPUT, "%s: mesh %d does not exist: export the file again", document->path,
                       node->mesh);
    if (node->skin >= 0 && !add_skin(builder, node->skin, error))
        return false;
    const struct gltf_skin *skin = node->skin >= 0 ? &document->skins[node->skin] : NULL;
    const struct gltf_mesh *mesh = &document->meshes[node->mesh];
    for (size_t i = 0; i < mesh->primitive_count; i++)
        if (!add_primitive(builder, &document->primitives[mesh->first_primitive + i], index, skin, error))
            return false;
    return true;
}

/* Adds the nodes below the scene's roots, parents first: a node is shown when it is a root or its parent is.
 */
static bool add_scene(struct gltf_builder *builder, tl_error *error)
{
    const gltf_document *document = builder->document;
    const tl_rig *rig = builder->rig;
    bool *shown = TL_NEW_ARRAY(bool, rig->node_count);
    bool good = true;
    for (size_t i = 0; good && i < document->root_count; i++) {
        good = document->roots[i] >= 0 && (size_t)document->roots[i] < rig->node_count;
        if (good)
            shown[document->roots[i]] = true;
        else
            tl_fail(error, TL_INPUT, "%s: root node %d does not exist: export the file again", document->path,
                    document->roots[i]);
    }
    for (size_t i = 0; good && i < rig->node_count; i++) {
        int node = rig->order[i], parent = rig->nodes[node].parent;
        shown[node] = shown[node] || !document->has_scene || (parent >= 0 && shown[parent]);
        good = !shown[node] || add_node(builder, node, error);
    }
    free(shown);
    return good;
}

/* ---- The rest pose ---- */

/* Transforms a normal by the cofactor matrix, given by its columns: right for any linear map, also scaled or
 * mirrored, and it needs no inverse. */
static vec3s turn_normal(const mat4s *m, vec3s n)
{
    vec3s x = {{m->m00, m->m01, m->m02}}, y = {{m->m10, m->m11, m->m12}}, z = {{m->m20, m->m21, m->m22}};
    vec3s turned = glms_vec3_scale(glms_vec3_cross(y, z), n.x);
    turned = glms_vec3_muladds(glms_vec3_cross(z, x), n.y, turned);
    turned = glms_vec3_muladds(glms_vec3_cross(x, y), n.z, turned);
    if (glms_vec3_dot(glms_vec3_cross(x, y), z) < 0)
        turned = glms_vec3_negate(turned);
    return turned;
}

static void place_normals(const struct gltf_builder *builder, const mat4s *world)
{
    tl_mesh *mesh = &builder->model->mesh;
    const tl_rig *rig = builder->rig;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        vec3s sum = {{0, 0, 0}};
        for (int k = 0; k < 4; k++) {
            const struct rig_slot *slot = &rig->slots[rig->influences[i].slots[k]];
            if (rig->influences[i].weights[k] <= 0)
                continue;
            mat4s matrix = glms_mat4_mul(world[slot->node], slot->bind);
            /* A false positive: reserve() allocated normals for every vertex that is counted. */
            // NOLINTNEXTLINE(clang-analyzer-core.NullDereference)
            sum = glms_vec3_muladds(turn_normal(&matrix, builder->normals[i]), rig->influences[i].weights[k],
                                    sum);
        }
        float length = glms_vec3_norm(sum);
        mesh->normals[i] = length > 0 && isfinite(length) ? glms_vec3_divs(sum, length) : (vec3s){{0, 0, 0}};
    }
}

/* A mirrored node (negative determinant) turns its triangles inside out: swap two corners of each [glTF 2.0,
 * 3.7.4]. */
static void repair_winding(const struct gltf_builder *builder, const mat4s *world)
{
    tl_mesh *mesh = &builder->model->mesh;
    for (size_t p = 0; p < mesh->part_count; p++) {
        uint32_t *indices = &mesh->indices[mesh->parts[p].first_index];
        const struct rig_slot *slot = &builder->rig->slots[builder->rig->influences[indices[0]].slots[0]];
        mat4s matrix = glms_mat4_mul(world[slot->node], slot->bind);
        if (glms_mat4_det(matrix) >= 0)
            continue;
        for (uint32_t i = 0; i + 2 < mesh->parts[p].index_count; i += 3) {
            uint32_t swap = indices[i + 1];
            indices[i + 1] = indices[i + 2];
            indices[i + 2] = swap;
        }
    }
}

static bool finish(struct gltf_builder *builder, enum tl_units wanted, tl_error *error)
{
    tl_mesh *mesh = &builder->model->mesh;
    if (mesh->index_count == 0)
        return tl_fail(error, TL_INPUT, "%s: holds no mesh with triangles: choose another file",
                       builder->document->path);
    mesh->positions = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    mesh->normals = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    struct rig_pose rest = rig_pose_at(builder->rig, -1, 0);
    rig_place(builder->rig, &rest, mesh->positions);
    bool good = model_take_units(builder->document->path, wanted, true, builder->model, error);
    if (good) {
        repair_winding(builder, rest.world);
        place_normals(builder, rest.world);
        model_smooth_normals(mesh);
        tl_mesh_measure_uvs(mesh);
    }
    rig_pose_release(&rest);
    return good;
}

/* ---- The whole ---- */

static void note_extensions(const gltf_document *document, tl_model *model)
{
    static const char *const known[] = {"KHR_materials_variants",
                                        "KHR_texture_transform",
                                        "KHR_mesh_quantization",
                                        "KHR_materials_anisotropy",
                                        "KHR_materials_clearcoat",
                                        "KHR_materials_ior",
                                        "KHR_materials_sheen",
                                        "KHR_materials_specular",
                                        "KHR_materials_transmission",
                                        "KHR_materials_diffuse_transmission",
                                        "KHR_materials_emissive_strength",
                                        "KHR_draco_mesh_compression",
                                        "EXT_meshopt_compression",
                                        "KHR_meshopt_compression"};
    for (size_t i = 0; i < document->used_count; i++) {
        bool has_effect = false;
        for (size_t k = 0; k < TL_COUNT(known); k++)
            has_effect |= strcmp(document->used[i], known[k]) == 0;
        if (!has_effect)
            model_ignore(model, "%s", document->used[i]);
    }
    if (document->has_cameras)
        model_ignore(model, "cameras");
    if (document->has_lights)
        model_ignore(model, "KHR_lights_punctual");
}

static void name_clips(const gltf_document *document, tl_model *model)
{
    model->clip_count = model->rig->clip_count;
    model->clips = TL_NEW_ARRAY(struct tl_clip, model->clip_count);
    for (size_t i = 0; i < model->clip_count; i++) {
        const char *name = document->animations[i].name;
        if (name && name[0])
            snprintf(model->clips[i].name, sizeof model->clips[i].name, "%s", name);
        else
            snprintf(model->clips[i].name, sizeof model->clips[i].name, "clip %zu", i);
        model->clips[i].duration_s = model->rig->clips[i].duration_s;
    }
}

static void drop_unused(const struct gltf_builder *builder)
{
    if (!builder->has_pins) {
        free(builder->model->pins);
        builder->model->pins = NULL;
    }
    if (!builder->has_colours) {
        free(builder->model->colours);
        builder->model->colours = NULL;
    }
}

bool gltf_load_model(const char *path, enum tl_units wanted, tl_model *out, tl_error *error)
{
    gltf_document document;
    if (!gltf_open(path, &document, error))
        return false;
    out->rig = TL_NEW(tl_rig);
    struct gltf_builder builder = {.document = &document,
                                   .model = out,
                                   .rig = out->rig,
                                   .skin_slots = TL_NEW_ARRAY(uint32_t, document.skin_count)};
    for (size_t i = 0; i < document.skin_count; i++)
        builder.skin_slots[i] = NO_SLOT;
    note_extensions(&document, out);
    bool loaded = rig_read(&document, out->rig, error) && model_read_materials(&document, out, error);
    if (loaded) {
        loaded = add_scene(&builder, error) && finish(&builder, wanted, error) &&
                 model_read_variants(&document, builder.sources, out, error);
    }
    if (loaded)
        name_clips(&document, out);
    if (loaded && out->clip_count == 0)
        rig_destroy(&out->rig);
    drop_unused(&builder);
    free(builder.normals);
    free((void *)builder.sources);
    free(builder.skin_slots);
    gltf_close(&document);
    return loaded;
}
