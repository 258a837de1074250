#include "render/local/local.h"

#include "config/base/hash.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/brdf/material_lobes.h"
#include "render/env/exponent.h"
#include "render/gpu/shaders.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Uniform locations of lamp.glsl, gloss.glsl and local.frag, in addition to those of surface.glsl. */
enum {
    VIEW_PROJECTION = 64,
    EYE,
    LAMP,
    LAMP_IRRADIANCE,
    CONSTANT_LAMP,
    CONSTANT_EYE,
    GLOSS_WIDTHS,
    GLOSS_OPTICS,
    LAMP_VIEW = 73,
    LAMP_BIAS,
    LAMP_LAYER,
    LAMP_GROUND,
    LAMP_LAYERS,
    TABLE_SCALES = 83,
    EMISSION = 84,
    EMISSION_ROWS = 85,
    LAMP_FUZZ = 87,
    THREAD_WIDTHS = 88, /* two of each */
    THREAD_RATIOS = 90,
    LAMP_FUZZ_FOLLOW = 93,
    MATT_LAW = 102,
    TABLE_AXES = 94, /* four */
    MEASURED_DIFFUSE = 98,
    CHART,
    LIT_SCALE,
    TEXEL_SIDE,
    OBJECT_TURN = 103,
    FIRST_CORNER,
    TABLE_AMBIENT,
    LAMP_AMBIENT
};
enum {
    TRIANGLE_UNIT = 16,
    POINT_UNIT,
    SHADOW_UNIT,
    CUBE_UNIT,
    TABLE_UNIT,
    POWER_UNIT = 23,
    PRODUCT_UNIT,
    EMISSION_UNIT,
    TABLE_3_UNIT,
    LIT_UNIT,
    LIT_COVER_UNIT
};

/* The work of one draw call: everything, or its part of several passes. */
struct pass {
    int first, last;    /* tables to multiply; none when last < first */
    const char *define; /* or NULL */
    float texel_side;   /* of TEXELS: 1 for the front, -1 for the back */
};

/* A part of a surface, a lamp, and the resources of shading. */
struct lit_part {
    size_t surface, part, lamp;
    const tl_material *material;
    enum tl_lamp_shadow shadow;
    const struct tl_gloss_tables *tables; /* NULL: the formula */
    const tl_texture *power;              /* of POWER_TABLE */
    const struct tl_lit_chart *chart;     /* NULL: no texture over UVs */
    const struct tl_object_map *normals;  /* NULL: not from a map in object space */
    float lit_scale;                      /* the largest gloss of its texels, if that is known */
};

void tl_local_reload(struct tl_local *local)
{
    for (size_t i = 0; i < local->program_count; i++) {
        tl_program_destroy(&local->programs[i]->program);
        free(local->programs[i]);
    }
    free(local->programs);
    local->programs = NULL;
    local->program_count = 0;
}

void tl_local_release(struct tl_local *local)
{
    tl_local_reload(local);
    tl_lamp_shadows_release(&local->shadows);
    tl_table_textures_release(&local->tables);
    tl_target_destroy(&local->product);
    tl_lit_texture_release(&local->lit);
    tl_object_maps_release(&local->normals);
    *local = (struct tl_local){0};
}

size_t tl_local_bytes(const struct tl_local *local)
{
    return tl_table_textures_bytes(&local->tables) + tl_target_bytes(&local->product) +
           tl_lit_texture_bytes(&local->lit) + tl_object_maps_bytes(&local->normals);
}

static void define(char defines[TL_LOCAL_DEFINES_SIZE], const char *name)
{
    size_t length = strlen(defines);
    snprintf(defines + length, TL_LOCAL_DEFINES_SIZE - length, "#define %s\n", name);
}

/* Defines the origin of the vectors and their normalisation. */
static void define_vectors(const struct tl_shading_params *params, char defines[TL_LOCAL_DEFINES_SIZE])
{
    static const char *const ways[] = {
        [TL_NORMALISE_NONE] = "NORMALISE_NONE",        [TL_NORMALISE_CUBE8] = "NORMALISE_CUBE",
        [TL_NORMALISE_CUBE16] = "NORMALISE_CUBE",      [TL_NORMALISE_NEWTON] = "NORMALISE_SERIES 1",
        [TL_NORMALISE_TAYLOR2] = "NORMALISE_SERIES 2", [TL_NORMALISE_TAYLOR3] = "NORMALISE_SERIES 3",
        [TL_NORMALISE_SLERP] = "NORMALISE_SLERP",      [TL_NORMALISE_NEWTON8] = "NORMALISE_NEWTON8",
        [TL_NORMALISE_EXACT] = "NORMALISE_EXACT"};
    bool is_fast = params->frequency == TL_FREQUENCY_FAST_PHONG;
    int way = is_fast ? TL_NORMALISE_NONE : params->normalisation;
    bool is_slerp = way == TL_NORMALISE_SLERP;
    bool is_tangent = params->space == TL_SPACE_TANGENT && !is_slerp;
    define(defines, ways[way]);
    if (params->coordinates == TL_COORDINATES_MATRIX)
        define(defines, "MATRIX");
    else if (is_tangent || (way != TL_NORMALISE_EXACT && !is_slerp))
        define(defines, is_tangent ? "VECTORS\n#define TANGENT_SPACE" : "VECTORS");
}

static void define_tables(const struct tl_gloss_tables *tables, const struct pass *pass,
                          char defines[TL_LOCAL_DEFINES_SIZE])
{
    size_t length = strlen(defines);
    snprintf(defines + length, TL_LOCAL_DEFINES_SIZE - length,
             "#define TABLES %d\n#define FIRST_TABLE %d\n#define LAST_TABLE %d\n", tables ? tables->count : 0,
             pass->first, pass->last);
    for (int i = 0; tables && i < tables->count; i++) {
        const struct tl_gloss_table *table = &tables->tables[i];
        length = strlen(defines);
        snprintf(defines + length, TL_LOCAL_DEFINES_SIZE - length,
                 "#define TABLE%d_X %d\n#define TABLE%d_Y %d\n#define TABLE%d_ANGLES %s\n", i, table->x, i,
                 table->y, i, table->angles ? "true" : "false");
    }
    if (tables && tables->times_cos_a)
        define(defines, "TIMES_COS_A");
    if (tables && tables->measured)
        define(defines, "MEASURED");
    if (tables && tables->folded)
        define(defines, "FOLDED");
}

static void define_all(const struct tl_local_request *request, const struct lit_part *part,
                       const struct pass *pass, char defines[TL_LOCAL_DEFINES_SIZE])
{
    const struct tl_shading_params *params = request->params;
    const struct tl_gloss *gloss = &part->material->gloss;
    snprintf(
        defines, TL_LOCAL_DEFINES_SIZE,
        "#define MODEL %d\n#define FACETS %d\n#define MASKING %d\n#define WARD_FORM %d\n#define FRESNEL %d\n",
        gloss->model, gloss->facets, gloss->masking, gloss->ward, gloss->fresnel);
    define_tables(part->tables, pass, defines);
    if (params->frequency == TL_FREQUENCY_GOURAUD)
        define(defines, params->coordinates == TL_COORDINATES_MATRIX ? "GOURAUD\n#define MATRIX" : "GOURAUD");
    else if (params->coordinates == TL_COORDINATES_VERTEX)
        define(defines, "COSINES");
    else
        define_vectors(params, defines);
    if (params->ambient > 0)
        define(defines, "AMBIENT");
    if (params->self_shadow == TL_SELF_SHADOW_STEP)
        define(defines, "STEP");
    if (!part->tables && params->power != TL_POWER_POW)
        define(defines, params->power == TL_POWER_FIXED8 ? "POWER_FIXED8" : "POWER_TABLE");
    if (part->shadow == TL_LAMP_SHADOW_RAYS)
        define(defines, "SHADOW_RAYS");
    else if (part->shadow == TL_LAMP_SHADOW_MAP)
        define(defines, "SHADOW_MAP");
    if (part->material->coat > 0)
        define(defines, "COAT");
    if (tl_material_has_fuzz(part->material))
        define(defines, "FUZZ");
    if (part->material->thread_count > 0 && !part->material->measured)
        define(defines, part->material->thread_count > 1 ? "THREADS 2" : "THREADS 1");
    if (part->normals)
        define(defines, "OBJECT_SPACE");
    if (pass->define)
        define(defines, pass->define);
    size_t length = strlen(defines);
    const struct tl_detail_params *detail = request->detail ? request->detail : tl_detail_options.defaults;
    tl_detail_defines(detail, defines + length, TL_LOCAL_DEFINES_SIZE - length);
}

/* The program with these defines, compiled at the first call. */
static const tl_program *find_program(struct tl_local *local, tl_gpu *gpu, const char *defines,
                                      tl_error *error)
{
    for (size_t i = 0; i < local->program_count; i++)
        if (strcmp(local->programs[i]->defines, defines) == 0)
            return &local->programs[i]->program;
    struct tl_local_program *made = TL_NEW(struct tl_local_program);
    snprintf(made->defines, sizeof made->defines, "%s", defines);
    if (!tl_program_create_variant(gpu, tl_embedded_shaders, "local.vert", "local.frag", made->defines,
                                   &made->program, error)) {
        free(made);
        return NULL;
    }
    local->programs = tl_resize(local->programs, local->program_count + 1, sizeof(struct tl_local_program *));
    local->programs[local->program_count++] = made;
    return &made->program;
}

static void set_view(const struct tl_view *view)
{
    glUniformMatrix4fv(VIEW_PROJECTION, 1, GL_FALSE, view->view_projection.raw[0]);
    glUniform3fv(EYE, 1, view->eye.raw);
    glUniformMatrix3fv(TL_UNIFORM_INTO_EYE_SPACE, 1, GL_FALSE, tl_view_turn(view).raw[0]);
}

static vec3s constant_eye(const struct tl_local_request *request)
{
    return glms_vec3_negate(glms_vec3_normalize(request->view->forward));
}

static vec3s constant_lamp(const struct tl_local_request *request, size_t index)
{
    return tl_lamp_at(&request->lamps[index], request->casters.centre, constant_eye(request)).direction;
}

static void set_lamp(const struct tl_local *local, const struct tl_local_request *request, size_t index)
{
    const struct tl_lamp *lamp = &request->lamps[index];
    const struct tl_view *view = request->view;
    const struct tl_ground *ground = request->ground;
    bool is_point = lamp->kind == TL_LAMP_POINT;
    vec3s place = is_point ? lamp->position : glms_vec3_normalize(lamp->direction);
    vec3s constant_l = constant_lamp(request, index), constant_v = constant_eye(request);
    bool stops = ground && !(is_point && lamp->position.y >= ground->centre.y);
    set_view(view);
    glUniform4f(LAMP, place.x, place.y, place.z, is_point ? 1 : 0);
    glUniform3fv(LAMP_IRRADIANCE, 1, lamp->irradiance.raw);
    glUniform3fv(CONSTANT_LAMP, 1, constant_l.raw);
    glUniform3fv(CONSTANT_EYE, 1, constant_v.raw);
    glUniformMatrix4fv(LAMP_VIEW, 1, GL_FALSE, local->shadows.views[index].raw[0]);
    glUniform1f(LAMP_BIAS, request->depth_bias_m);
    glUniform1f(LAMP_AMBIENT, request->params->ambient);
    glUniform1i(LAMP_LAYER, (GLint)index);
    glUniform4f(LAMP_GROUND, stops ? ground->centre.x : 0, stops ? ground->centre.y : 0,
                stops ? ground->centre.z : 0, stops ? ground->radius : 0);
}

static void set_gloss(const tl_material *material)
{
    const struct tl_brdf brdf = tl_brdf_of(material, material->specular, material->glossiness);
    const struct tl_gloss *gloss = &brdf.gloss;
    glUniform4f(GLOSS_WIDTHS, gloss->width_weft, gloss->width_warp, cosf(gloss->rotation),
                sinf(gloss->rotation));
    glUniform4fv(MATT_LAW, 1, tl_material_law(material).raw);
    glUniform3f(LAMP_LAYERS, material->coat, tl_lobe_exponent(material->coat_glossiness),
                1 - material->openness);
    glUniform2f(GLOSS_OPTICS, gloss->index, gloss->extinction);
    if (material->measured)
        glUniform3fv(MEASURED_DIFFUSE, 1, material->measured->diffuse.raw);
    for (int i = 0; i < material->thread_count && !material->measured; i++) {
        const struct tl_thread *thread = &material->threads[i];
        glUniform2f(THREAD_WIDTHS + i, thread->width_weft, thread->width_warp);
        glUniform3fv(THREAD_RATIOS + i, 1, thread->ratio.raw);
    }
    if (tl_material_has_fuzz(material)) {
        const struct tl_fuzz *fuzz = &material->fuzz;
        glUniform4f(LAMP_FUZZ, fuzz->colour.x, fuzz->colour.y, fuzz->colour.z, fuzz->roughness);
        glUniform1f(LAMP_FUZZ_FOLLOW, fuzz->follow);
    }
}

static void bind_shadow(const struct tl_lamp_shadows *shadows, enum tl_lamp_shadow kind)
{
    if (kind == TL_LAMP_SHADOW_RAYS)
        glBindTextureUnit(SHADOW_UNIT, shadows->visibility.id);
    else if (kind == TL_LAMP_SHADOW_MAP)
        glBindTextureUnit(SHADOW_UNIT, shadows->depths.id);
}

static void set_tables(const struct lit_part *part, const struct tl_shading_params *params)
{
    static const GLuint units[] = {TABLE_UNIT, TABLE_UNIT + 1, TABLE_UNIT + 2, TABLE_3_UNIT};
    float axes[TL_GLOSS_TABLES_MAX][4] = {{0}}, scales[TL_GLOSS_TABLES_MAX] = {1, 1, 1, 1};
    for (int i = 0; part->tables && i < part->tables->count; i++) {
        const struct tl_gloss_table *table = &part->tables->tables[i];
        memcpy(axes[i], table->axes, sizeof axes[i]);
        scales[i] = table->scale;
        glBindTextureUnit(units[i], table->texture.id);
    }
    glUniform4fv(TABLE_AXES, TL_GLOSS_TABLES_MAX, axes[0]);
    glUniform4fv(TABLE_SCALES, 1, scales);
    const vec3s even = tl_table_ambient(part->material, params);
    glUniform3fv(TABLE_AMBIENT, 1, even.raw);
    if (part->power)
        glBindTextureUnit(POWER_UNIT, part->power->id);
}

/* UVs to places in the texture, which covers their box. */
static void set_chart(const struct lit_part *part)
{
    const struct tl_lit_chart *chart = part->chart;
    vec2s factor = {{1 / chart->extent.x, 1 / chart->extent.y}};
    glUniform4f(CHART, -chart->low.x * factor.x, -chart->low.y * factor.y, factor.x, factor.y);
    glUniform1f(LIT_SCALE, part->lit_scale);
}

static void set_normals(const struct tl_object_map *normals, const tl_surface *surface)
{
    const mat3s turn = tl_object_map_turn(normals, surface);
    glUniformMatrix3fv(OBJECT_TURN, 1, GL_FALSE, turn.raw[0]);
    glBindTextureUnit(LIT_UNIT, normals->texture.light.id);
}

static bool draw_pass(struct tl_local *local, tl_gpu *gpu, const struct tl_local_request *request,
                      const struct lit_part *part, const struct pass *pass, tl_error *error)
{
    char defines[TL_LOCAL_DEFINES_SIZE];
    define_all(request, part, pass, defines);
    const tl_program *program = find_program(local, gpu, defines, error);
    if (!program)
        return false;
    glUseProgram(program->id);
    set_lamp(local, request, part->lamp);
    set_gloss(part->material);
    set_tables(part, request->params);
    if (part->chart) {
        set_chart(part);
        glUniform1f(TEXEL_SIDE, pass->texel_side);
    }
    if (part->normals)
        set_normals(part->normals, request->drawn[part->surface]);
    if (request->params->normalisation == TL_NORMALISE_SLERP)
        glUniform1ui(FIRST_CORNER, tl_surfaces_bind_corners(request->surfaces, part->surface, part->part));
    tl_surfaces_draw_part(request->surfaces, part->surface, part->part);
    return true;
}

static void draw_into_light(const struct tl_local_request *request)
{
    glBindFramebuffer(GL_FRAMEBUFFER, request->light->id);
    glViewport(0, 0, request->light->width, request->light->height);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE); /* coverage is kept, because light has none */
}

static void prepare_product(struct tl_local *local, tl_gpu *gpu, const struct tl_local_request *request)
{
    const unsigned format = request->params->pass_target == TL_PASS_TARGET_FIXED8 ? GL_RGBA8 : GL_RGBA32F;
    tl_target_fit(&local->product, gpu, &request->gbuffer->target, &format, 1);
    local->product_used = true;
    glBindTextureUnit(PRODUCT_UNIT, local->product.colours[0].id);
}

/* Multiplies the tables by blending, a few in each pass. A last pass adds the product and the diffuse light
 * [Heidrich and Seidel 1999, 3.1]. */
static bool draw_passes(struct tl_local *local, tl_gpu *gpu, const struct tl_local_request *request,
                        const struct lit_part *part, tl_error *error)
{
    int count = part->tables->count, each = request->params->max_textures_per_pass;
    bool fine = true;
    prepare_product(local, gpu, request);
    glBindFramebuffer(GL_FRAMEBUFFER, local->product.id);
    for (int first = 0; fine && first < count; first += each) {
        int last = first + each < count ? first + each - 1 : count - 1;
        const struct pass multiply = {first, last, "PASS_PRODUCT", 0};
        glBlendFunc(first == 0 ? GL_ONE : GL_DST_COLOR, GL_ZERO);
        fine = draw_pass(local, gpu, request, part, &multiply, error);
    }
    draw_into_light(request);
    const struct pass add = {0, -1, "PASS_LAST", 0};
    return fine && draw_pass(local, gpu, request, part, &add, error);
}

static bool has_bumps(const tl_material *material)
{
    return material->normal_map.image || material->height_map.image || material->weave;
}

/* Whether a part has a texture over its UVs. */
static bool has_chart(const struct tl_local_request *request, const tl_material *material)
{
    const struct tl_shading_params *params = request->params;
    return params->space >= TL_SPACE_TEXTURE && params->frequency != TL_FREQUENCY_GOURAUD &&
           params->coordinates != TL_COORDINATES_VERTEX && request->drawn && has_bumps(material);
}

/* The cosine of Fresnel's term where that is one for all of a part, else 0, where the term is largest. */
static float fresnel_cosine(const struct tl_local_request *request, const struct lit_part *part)
{
    int model = part->material->gloss.model;
    if (request->params->coordinates != TL_COORDINATES_MATRIX || model == TL_REFLECT_PHONG ||
        model == TL_REFLECT_BANKS)
        return 0;
    vec3s l = constant_lamp(request, part->lamp);
    return glms_vec3_dot(l, glms_vec3_normalize(glms_vec3_add(l, constant_eye(request))));
}

/* A bound of the gloss, by which it is divided for targets up to 1: that of its tables, or of a power; 1 of
 * facets, which have none. */
static float largest_gloss(const struct lit_part *part, const struct tl_brdf *brdf, float cosine)
{
    float scale = 1;
    for (int i = 0; part->tables && i < part->tables->count; i++)
        scale *= part->tables->tables[i].scale;
    if (part->tables || brdf->gloss.model == TL_REFLECT_TORRANCE_SPARROW ||
        brdf->gloss.model == TL_REFLECT_WARD)
        return scale;
    vec3s f = tl_brdf_fresnel(brdf, cosine);
    return fmaxf(tl_brdf_lobe_scale(brdf) * fmaxf(f.x, fmaxf(f.y, f.z)), 1e-6f);
}

/* Lights the texels of the front and of the back, and maps the texture to the part. */
static bool draw_as_texture(struct tl_local *local, tl_gpu *gpu, const struct tl_local_request *request,
                            const struct lit_part *part, tl_error *error)
{
    const struct tl_shading_params *params = request->params;
    bool fine = true;
    for (int back = 0; fine && back < 2; back++) {
        tl_lit_texture_begin(&local->lit, gpu, params->pass_target, params->texture_size, 2, back);
        const struct pass texels = {0, part->tables ? part->tables->count - 1 : -1, "TEXELS", back ? -1 : 1};
        fine = draw_pass(local, gpu, request, part, &texels, error);
    }
    tl_lit_texture_end(&local->lit);
    local->lit_used = true;
    draw_into_light(request);
    glBindTextureUnit(LIT_UNIT, local->lit.light.id);
    glBindTextureUnit(LIT_COVER_UNIT, local->lit.cover.id);
    const struct pass mapped = {0, -1, "LIT", 0};
    return fine && draw_pass(local, gpu, request, part, &mapped, error);
}

/* Finds the normals of a part in object space, and draws them where the map is new. */
static bool find_normals(struct tl_local *local, tl_gpu *gpu, const struct tl_local_request *request,
                         struct lit_part *part, tl_error *error)
{
    const struct tl_shading_params *params = request->params;
    const tl_surface *surface = request->drawn[part->surface];
    const struct tl_detail_params *detail = request->detail ? request->detail : tl_detail_options.defaults;
    const struct tl_binding binding = {&tl_detail_options, (void *)detail};
    const struct tl_object_map key = {
        .surface = part->surface,
        .part = part->part,
        .revision = surface->topology_revision,
        .side = params->texture_size,
        .target = params->pass_target,
        .detail = tl_options_hash(&binding, 1, (struct tl_option_filter){.any_of = ~0ull}, TL_HASH_START)};
    bool is_new;
    struct tl_object_map *normals = tl_object_maps_find(&local->normals, surface, &key, &is_new);
    bool fine = true;
    if (is_new) {
        const struct pass texels = {0, -1, "TEXELS\n#define NORMALS", 1};
        tl_lit_texture_begin(&normals->texture, gpu, params->pass_target, params->texture_size, 1, 0);
        fine = draw_pass(local, gpu, request, part, &texels, error);
        tl_lit_texture_end(&normals->texture);
        draw_into_light(request);
    }
    part->normals = normals;
    local->lit_used = true; /* its charts */
    return fine;
}

/* Reports the first material whose light no single table can hold. */
static void report_refusal(struct tl_local *local, const tl_material *material)
{
    const char *refusal = material->measured ? "measured reflectance" : tl_table_terms_refusal(material);
    if (refusal && !local->has_reported)
        tl_warn("shading.table_terms: \"%s\" has %s, and a table holds one even colour: its table, and those "
                "of others like it, hold gloss alone",
                material->name, refusal);
    local->has_reported |= refusal != NULL;
}

static bool draw_part(struct tl_local *local, tl_gpu *gpu, const struct tl_local_request *request,
                      struct lit_part *part, tl_error *error)
{
    const struct tl_shading_params *params = request->params;
    const tl_material *material = part->material;
    const struct tl_brdf brdf = tl_brdf_of(material, material->specular, material->glossiness);
    if (params->reflectance == TL_REFLECTANCE_TABLE && params->table_terms == TL_TERMS_ALL)
        report_refusal(local, material);
    if (material->measured)
        part->tables = tl_table_textures_measured(&local->tables, gpu, material->measured);
    else if (params->reflectance != TL_REFLECTANCE_DIRECT)
        part->tables = tl_table_textures_gloss(&local->tables, gpu, material, params);
    else if (params->power == TL_POWER_TABLE)
        part->power = tl_table_textures_power(
            &local->tables, gpu,
            material->gloss.model == TL_REFLECT_BLINN_PHONG ? 4 * brdf.exponent : brdf.exponent);
    if (has_chart(request, material))
        part->chart = tl_lit_texture_chart(&local->lit, request->drawn[part->surface], part->surface,
                                           part->part, params->texture_size);
    if (part->chart && params->space == TL_SPACE_OBJECT && !find_normals(local, gpu, request, part, error))
        return false;
    if (part->chart && params->space == TL_SPACE_TEXTURE) {
        part->lit_scale = largest_gloss(part, &brdf, fresnel_cosine(request, part));
        return draw_as_texture(local, gpu, request, part, error);
    }
    if (part->tables && part->tables->count > params->max_textures_per_pass &&
        params->frequency != TL_FREQUENCY_GOURAUD)
        return draw_passes(local, gpu, request, part, error);
    const struct pass all = {0, part->tables ? part->tables->count - 1 : -1, NULL, 0};
    return draw_pass(local, gpu, request, part, &all, error);
}

static void bind_cube(struct tl_local *local, tl_gpu *gpu, const struct tl_shading_params *params)
{
    if (params->normalisation == TL_NORMALISE_CUBE8 || params->normalisation == TL_NORMALISE_CUBE16)
        glBindTextureUnit(CUBE_UNIT, tl_table_textures_cube(&local->tables, gpu, params->normalisation)->id);
}

static bool draw_lamp(struct tl_local *local, tl_gpu *gpu, const struct tl_local_request *request,
                      size_t index, tl_error *error)
{
    enum tl_lamp_shadow shadow = local->shadows.kinds[index];
    bool fine = true;
    bind_shadow(&local->shadows, shadow);
    for (size_t s = 0; fine && s < request->surface_count; s++)
        for (size_t p = 0; fine && p < tl_surfaces_part_count(request->surfaces, s); p++) {
            struct lit_part part = {.surface = s,
                                    .part = p,
                                    .lamp = index,
                                    .material = tl_surfaces_part_material(request->surfaces, s, p),
                                    .shadow = shadow};
            fine = draw_part(local, gpu, request, &part, error);
        }
    return fine;
}

/* Adds the light that a part sends out itself. */
static bool draw_emission(struct tl_local *local, tl_gpu *gpu, const struct tl_local_request *request,
                          size_t surface, size_t index, tl_error *error)
{
    const tl_material *material = tl_surfaces_part_material(request->surfaces, surface, index);
    if (!tl_material_emits(material))
        return true;
    struct tl_local_request plain = *request;
    plain.params =
        tl_shading_options.defaults; /* vectors of a lamp, which are not read, have no variants then */
    bool mapped = tl_surfaces_bind_emission(request->surfaces, surface, index, EMISSION_UNIT);
    const struct lit_part part = {.surface = surface, .part = index, .material = material};
    const struct pass pass = {0, -1, mapped ? "EMISSION\n#define EMISSION_MAP" : "EMISSION", 0};
    char defines[TL_LOCAL_DEFINES_SIZE];
    float rows[6];
    define_all(&plain, &part, &pass, defines);
    const tl_program *program = find_program(local, gpu, defines, error);
    if (!program)
        return false;
    glUseProgram(program->id);
    set_view(request->view);
    set_gloss(material);
    tl_uv_transform_rows(&material->emission_map.transform, rows);
    glUniform3fv(EMISSION, 1, material->emission.raw);
    if (mapped)
        glUniform3fv(EMISSION_ROWS, 2, rows);
    tl_surfaces_draw_part(request->surfaces, surface, index);
    return true;
}

bool tl_local_draw(struct tl_local *local, tl_gpu *gpu, const struct tl_local_request *request,
                   tl_error *error)
{
    tl_table_textures_begin(&local->tables);
    local->product_used = local->lit_used = false;
    tl_object_maps_keep(&local->normals, request->drawn, request->drawn ? request->surface_count : 0);
    draw_into_light(request);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    glBlendColor(0, 0, 0, request->weight);
    bind_cube(local, gpu, request->params);
    glBindTextureUnit(TRIANGLE_UNIT, request->gbuffer->target.colours[TL_GBUFFER_TRIANGLE].id);
    glBindTextureUnit(POINT_UNIT, request->gbuffer->target.colours[TL_GBUFFER_POINT].id);
    bool fine = true;
    for (size_t i = 0; fine && i < request->lamp_count; i++)
        fine = draw_lamp(local, gpu, request, i, error);
    for (size_t s = 0; fine && s < request->surface_count; s++)
        for (size_t p = 0; fine && p < tl_surfaces_part_count(request->surfaces, s); p++)
            fine = draw_emission(local, gpu, request, s, p, error);
    tl_table_textures_end(&local->tables);
    if (!local->product_used)
        tl_target_destroy(&local->product);
    if (!local->lit_used)
        tl_lit_texture_release(&local->lit);
    tl_gpu_reset_state(gpu);
    return fine;
}
