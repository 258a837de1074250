#include "assets/base/model.h"

#include "assets/base/rig.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

size_t tl_model_point_count(const tl_model *model)
{
    return model->points ? model->point_count : model->mesh.vertex_count;
}

void tl_model_points(const tl_model *model, const vec3s *positions, vec3s *points)
{
    float metres = (float)tl_units_metres(model->units.units);
    for (size_t i = 0; i < tl_model_point_count(model); i++)
        points[i] = glms_vec3_divs(positions[0], metres);
    for (size_t i = 0; i < model->mesh.vertex_count; i++)
        points[model->points ? model->points[i] : i] = glms_vec3_divs(positions[i], metres);
}

bool tl_model_is_painted(const tl_model *model, size_t vertex, int channel)
{
    const float *colour = model->colours[vertex].raw;
    return colour[channel] > 0.5f && colour[(channel + 1) % 3] < 0.5f && colour[(channel + 2) % 3] < 0.5f;
}

const struct tl_variant *tl_model_find_variant(const tl_model *model, const char *name)
{
    for (size_t i = 0; i < model->variant_count; i++)
        if (strcmp(model->variants[i].name, name) == 0)
            return &model->variants[i];
    return NULL;
}

void tl_model_pose(const tl_model *model, int clip, double time_s, vec3s *positions)
{
    if (!model->rig || clip < 0) {
        memcpy(positions, model->mesh.positions, model->mesh.vertex_count * sizeof *positions);
        return;
    }
    struct rig_pose pose = rig_pose_at(model->rig, clip, time_s);
    rig_place(model->rig, &pose, positions);
    float metres = (float)tl_units_metres(model->units.units);
    for (size_t i = 0; i < model->mesh.vertex_count; i++)
        positions[i] = glms_vec3_scale(positions[i], metres);
    rig_pose_release(&pose);
}

int tl_model_find_clip(const tl_model *model, const char *name)
{
    if (name[0] == '\0')
        return model->clip_count ? 0 : -1;
    for (size_t i = 0; i < model->clip_count; i++)
        if (strcmp(model->clips[i].name, name) == 0)
            return (int)i;
    return -1;
}

void tl_model_release(tl_model *model)
{
    for (size_t i = 0; i < model->variant_count; i++)
        free(model->variants[i].materials);
    free(model->variants);
    tl_mesh_release(&model->mesh);
    rig_destroy(&model->rig);
    for (size_t i = 0; i < model->image_count; i++)
        tl_image_release(&model->images[i]);
    for (size_t i = 0; i < model->ignored_count; i++)
        free(model->ignored[i]);
    free(model->ignored);
    for (size_t i = 0; i < model->approximated_count; i++)
        free(model->approximated[i]);
    free(model->approximated);
    for (size_t i = 0; i < model->unread_count; i++) {
        free(model->unread[i].file);
        free(model->unread[i].reason);
    }
    free(model->unread);
    for (size_t i = 0; i < model->defect_count; i++)
        free(model->defects[i]);
    free(model->defects);
    free(model->extensions);
    free(model->images);
    free(model->materials);
    free(model->clips);
    free(model->points);
    free(model->stitches);
    free(model->pins);
    free(model->colours);
    free(model->name);
    *model = (tl_model){0};
}
