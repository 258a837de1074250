#include "render/light/light.h"

#include "config/base/memory.h"
#include "render/gpu/shaders.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>

/* Uniform locations of chain.frag and regions.frag, and what they include. */
enum {
    REGION_RANGE = 0,
    EYE,
    ENVIRONMENT_TURN,
    PEM_SCALE,
    LOBE,
    ALREADY_THERE,
    MAP_LIMITS,
    GROUND_DISC,
    PARABOLOID_DENSITY,
    SUM_COUNT
};
enum { COUNTS = 0, COMPOSITION = 5, LAST_EXPONENT = 8, LOBE_PLACES };
/* Texture units; the G-buffer's layers without the triangles come first. */
enum { LEVELS_UNIT = 5, PEMS_UNIT, MAPS_UNIT, LOBES_UNIT, SUN_MAPS_UNIT, SUMS_UNIT };
/* The programs of chains that are paraboloid maps, or that look sums of lobes up. */
enum { PARABOLOIDS = TL_LIGHT_SOURCES, LOBE_SUMS, PARABOLOID_SUMS };
/* Values of the uniform in regions.frag. */
enum composition { SUM, DIFFERENCE, RATIO, OCCLUSION, OCCLUSION_COLOUR, UNSHADOWED };

/* exact.glsl: log2 of the largest exponent that the table of levels distinguishes. */
#define EXPONENT_LOG_RANGE 15.0f
#define EXPONENT_STEPS     512

/* std430: struct Region in region.glsl. */
struct region_light {
    vec4s map_rows[3];
    vec4s direction;
    vec4s centre; /* w: sine of the half-angle over which the light is spread */
    vec4s power;  /* w: spread, rad */
};

enum tl_light_source tl_light_source(const struct tl_light_params *params)
{
    bool chain = params->prefilter == TL_PREFILTER_CHAIN, ratio = params->composition == TL_COMPOSE_RATIO;
    switch (params->method) {
    case TL_METHOD_LIGHTS:
    case TL_METHOD_AO:
    case TL_METHOD_AO_COLOUR:
        return TL_LIGHT_LOBES;
    case TL_METHOD_UNSHADOWED:
        return chain && params->composition == TL_COMPOSE_SUM && !params->sun ? TL_LIGHT_CHAIN
                                                                              : TL_LIGHT_EXACT;
    default:
        return !chain ? TL_LIGHT_SLICES : ratio ? TL_LIGHT_LOBES : TL_LIGHT_CHAIN;
    }
}

/* Chains stand alone, unless a pass of regions.frag goes before them. */
static bool begins_exact(const struct tl_light_params *params)
{
    return params->composition == TL_COMPOSE_DIFFERENCE || params->sun;
}

bool tl_light_needs_exact(const struct tl_light_params *params)
{
    return tl_light_source(params) != TL_LIGHT_CHAIN || begins_exact(params);
}

bool tl_light_sums_lobes(const struct tl_light_params *params)
{
    return (params->method == TL_METHOD_PEM || params->method == TL_METHOD_UNSHADOWED) &&
           params->visibility != TL_VISIBILITY_RAYS && params->lobe == TL_LOBE_DUAL &&
           !tl_light_needs_exact(params);
}

bool tl_light_is_composed(const struct tl_light_params *params)
{
    return params->visibility == TL_VISIBILITY_RAYS && params->method != TL_METHOD_MAPS &&
           params->method != TL_METHOD_REFERENCE;
}

static enum composition composition_of(const struct tl_light_params *params)
{
    switch (params->method) {
    case TL_METHOD_LIGHTS:
        return SUM;
    case TL_METHOD_AO:
        return OCCLUSION;
    case TL_METHOD_AO_COLOUR:
        return OCCLUSION_COLOUR;
    case TL_METHOD_UNSHADOWED:
        return UNSHADOWED;
    default:
        return (enum composition)params->composition;
    }
}

bool tl_lighting_create(struct tl_lighting *lighting, tl_gpu *gpu, tl_error *error)
{
    (void)error;
    float levels[EXPONENT_STEPS];
    for (int i = 0; i < EXPONENT_STEPS; i++) {
        struct tl_exponent_blend blend =
            tl_exponent_blend(exp2f(EXPONENT_LOG_RANGE * (float)i / (EXPONENT_STEPS - 1)));
        levels[i] = (float)blend.index + blend.weight;
    }
    lighting->exponent_levels = tl_texture_create(gpu, GL_TEXTURE_2D, GL_R32F, EXPONENT_STEPS, 1, 1, 1);
    glTextureSubImage2D(lighting->exponent_levels.id, 0, 0, 0, EXPONENT_STEPS, 1, GL_RED, GL_FLOAT, levels);
    lighting->no_depths = tl_depth_array_create(gpu, 1, 1);
    glCreateBuffers(1, &lighting->regions_buffer);
    glNamedBufferStorage(lighting->regions_buffer,
                         (TL_REGIONS_MAX + TL_SUNS_MAX) * sizeof(struct region_light), NULL,
                         GL_DYNAMIC_STORAGE_BIT);
    return true;
}

void tl_lighting_release(struct tl_lighting *lighting)
{
    for (int source = 0; source < TL_LIGHT_PROGRAMS; source++)
        for (int kind = 0; kind < TL_LIGHT_MAP_KINDS; kind++)
            tl_program_destroy(&lighting->programs[source][kind]);
    tl_texture_destroy(&lighting->exponent_levels);
    tl_texture_destroy(&lighting->no_depths);
    tl_texture_destroy(&lighting->exact.lobes);
    if (lighting->regions_buffer)
        glDeleteBuffers(1, &lighting->regions_buffer);
    lighting->regions_buffer = 0;
}

bool tl_lighting_reload(struct tl_lighting *lighting, tl_error *error)
{
    bool fine = true;
    for (int source = 0; source < TL_LIGHT_PROGRAMS; source++)
        for (int kind = 0; kind < TL_LIGHT_MAP_KINDS; kind++)
            if (lighting->programs[source][kind].id)
                fine = fine && tl_program_reload(&lighting->programs[source][kind], error);
    return fine;
}

/* The program of a source, or PARABOLOIDS, under a kind of maps (RAYS: none). */
static const tl_program *program_of(struct tl_lighting *lighting, tl_gpu *gpu, int source,
                                    enum tl_visibility kind, tl_error *error)
{
    static const char *const defines[TL_LIGHT_PROGRAMS][TL_LIGHT_MAP_KINDS] = {
        [TL_LIGHT_CHAIN] = {"#define VSM\n", "#define DEPTH\n", NULL},
        [TL_LIGHT_SLICES] = {"#define SLICES\n#define VSM\n", "#define SLICES\n#define DEPTH\n",
                             "#define SLICES\n"},
        [TL_LIGHT_LOBES] = {"#define VSM\n", "#define DEPTH\n", NULL},
        [TL_LIGHT_EXACT] = {"#define EXACT\n", "#define EXACT\n", "#define EXACT\n"},
        [PARABOLOIDS] = {"#define PARABOLOIDS\n#define VSM\n", "#define PARABOLOIDS\n#define DEPTH\n",
                         "#define PARABOLOIDS\n"},
        [LOBE_SUMS] = {"#define LOBE_SUMS\n#define VSM\n", "#define LOBE_SUMS\n#define DEPTH\n",
                       "#define LOBE_SUMS\n"},
        [PARABOLOID_SUMS] = {"#define LOBE_SUMS\n#define PARABOLOIDS\n#define VSM\n",
                             "#define LOBE_SUMS\n#define PARABOLOIDS\n#define DEPTH\n",
                             "#define LOBE_SUMS\n#define PARABOLOIDS\n"},
    };
    bool chain = source == TL_LIGHT_CHAIN || source >= PARABOLOIDS;
    tl_program *program = &lighting->programs[source][kind];
    if (!program->id && !tl_program_create_variant(gpu, tl_embedded_shaders, "fullscreen.vert",
                                                   chain ? "chain.frag" : "regions.frag",
                                                   defines[source][kind], program, error))
        return NULL;
    return program;
}

void tl_lobe_levels_upload(tl_texture *levels, tl_gpu *gpu, const struct tl_lobe_table *table)
{
    if (!levels->id)
        *levels = tl_texture_create(gpu, GL_TEXTURE_2D, GL_R32F, TL_LOBE_STEPS, 1, 1, 1);
    glTextureSubImage2D(levels->id, 0, 0, 0, TL_LOBE_STEPS, 1, GL_RED, GL_FLOAT, table->level);
}

static void send_lobes(struct tl_exact_maps *maps, tl_gpu *gpu, const struct tl_lobes *lobes)
{
    int width = 0, height = 0;
    for (int i = 0; i <= TL_EXPONENT_COUNT; i++) {
        int side = lobes->made & 1u << i ? lobes->maps[i].side : 0;
        maps->places[i][0] = (float)height;
        maps->places[i][1] = (float)side;
        width = side > 0 && side + 2 > width ? side + 2 : width;
        height += side > 0 ? side + 2 : 0;
    }
    if (maps->lobes.width != width || maps->lobes.height != height) {
        tl_texture_destroy(&maps->lobes);
        maps->lobes = tl_texture_create(gpu, GL_TEXTURE_2D, GL_RGBA32F, width, height, 1, 1);
    }
    for (int i = 0; i <= TL_EXPONENT_COUNT; i++) {
        int side = (int)maps->places[i][1];
        if (side > 0)
            glTextureSubImage2D(maps->lobes.id, 0, 0, (int)maps->places[i][0], side + 2, side + 2, GL_RGBA,
                                GL_FLOAT, lobes->maps[i].texels);
    }
}

/* Sends the lobes of the request, unless they are there. */
static void follow_lobes(struct tl_exact_maps *maps, tl_gpu *gpu, const struct tl_light_request *request)
{
    if (maps->sent == request->exact->made && maps->revision == request->exact_revision)
        return;
    send_lobes(maps, gpu, request->exact);
    maps->sent = request->exact->made;
    maps->revision = request->exact_revision;
}

static vec4s vec4_of(vec3s v, float w)
{
    return (vec4s){{v.x, v.y, v.z, w}};
}

/* The view of a depth map with the bias taken off the depth of what is looked up. */
static void copy_view(const struct tl_region_view *view, float bias_m, struct region_light *out)
{
    for (int row = 0; row < 3; row++)
        out->map_rows[row] = view->map_rows[row];
    const vec4s *depth = &view->map_rows[2];
    out->map_rows[2].w -= bias_m * glms_vec3_norm((vec3s){{depth->x, depth->y, depth->z}});
    out->direction = view->direction;
}

static struct region_light light_of_region(const struct tl_light_request *request, int i)
{
    const struct tl_region *region = &request->regions->items[i];
    int method = request->params->method;
    bool is_white = method == TL_METHOD_AO;
    float spread = method == TL_METHOD_LIGHTS ? 0 : region->spread;
    /* A disc whose mean square angle is spread^2 has the radius sqrt(2) spread. */
    float sine = sinf(fminf(sqrtf(2) * spread, GLM_PI_2f));
    vec3s white = {{region->solid_angle, region->solid_angle, region->solid_angle}};
    return (struct region_light){
        .centre = vec4_of(tl_turn_direction(region->direction, request->environment_yaw), sine),
        .power = vec4_of(is_white ? white : region->power, spread)};
}

static struct region_light light_of_sun(const struct tl_light_request *request, int i)
{
    const struct tl_sun *sun = &request->suns->items[i];
    return (struct region_light){
        .centre = vec4_of(tl_turn_direction(sun->direction, request->environment_yaw), sinf(sun->radius)),
        .power = vec4_of(sun->power, sun->radius / sqrtf(2))};
}

/* Regions, then suns. */
static void upload_regions(const struct tl_lighting *lighting, const struct tl_light_request *request)
{
    const struct tl_light_params *params = request->params;
    bool shadowed = params->method != TL_METHOD_UNSHADOWED;
    /* A variance map's bias is a uniform: there it is the paper's, in units of the casters' sphere. */
    float sun_bias_m = tl_casters_scale(&request->casters) * params->depth_bias_m;
    float bias_m = params->visibility == TL_VISIBILITY_DEPTH ? sun_bias_m : 0;
    int regions = request->regions->count, suns = request->suns->count;
    struct region_light *lights = TL_NEW_ARRAY(struct region_light, (size_t)(regions + suns));
    for (int i = 0; i < regions; i++) {
        lights[i] = light_of_region(request, i);
        if (shadowed)
            copy_view(&tl_shadow_maps_views(request->maps)[i], bias_m, &lights[i]);
        lights[i].direction.w = request->round > 0 ? 1 : 0;
    }
    for (int i = 0; i < suns; i++) {
        lights[regions + i] = light_of_sun(request, i);
        if (shadowed)
            copy_view(&tl_shadow_maps_sun_views(request->maps)[i], sun_bias_m, &lights[regions + i]);
    }
    glNamedBufferSubData(lighting->regions_buffer, 0, (GLsizeiptr)((size_t)(regions + suns) * sizeof *lights),
                         lights);
    free(lights);
}

static void use_program(const tl_program *program, const struct tl_light_request *request)
{
    const struct tl_light_params *params = request->params;
    const struct tl_ground *ground = request->ground;
    /* One unit of depth of a variance map, in the metres of the options. */
    float unit_m = 2 * request->casters.radius / tl_casters_scale(&request->casters);
    glUseProgram(program->id);
    glUniform3fv(EYE, 1, request->eye.raw);
    glUniform2f(ENVIRONMENT_TURN, cosf(request->environment_yaw), sinf(request->environment_yaw));
    glUniform1i(LOBE, params->lobe);
    glUniform3f(MAP_LIMITS, params->depth_bias_m / unit_m, params->min_variance / (unit_m * unit_m),
                params->bleed_reduction);
    if (ground)
        glUniform4f(GROUND_DISC, ground->centre.x, ground->centre.y, ground->centre.z, ground->radius);
    else
        glUniform4f(GROUND_DISC, 0, 0, 0, 0);
}

/* The passes of one image add up; images are averaged over the rounds: each new one counts 1 / (round + 1),
 * what is in the target the rest. */
static void draw_pass(tl_gpu *gpu, bool is_first)
{
    glBlendFunc(GL_CONSTANT_ALPHA, is_first ? GL_ONE_MINUS_CONSTANT_ALPHA : GL_ONE);
    tl_gpu_draw_fullscreen(gpu);
}

static bool draw_regions(struct tl_lighting *lighting, tl_gpu *gpu, const struct tl_light_request *request,
                         enum tl_light_source source, tl_error *error)
{
    const struct tl_light_params *params = request->params;
    bool shadowed = params->method != TL_METHOD_UNSHADOWED;
    const tl_program *program =
        program_of(lighting, gpu, source, (enum tl_visibility)params->visibility, error);
    if (!program)
        return false;
    follow_lobes(&lighting->exact, gpu, request);
    use_program(program, request);
    glUniform2i(COUNTS, request->regions->count, request->suns->count);
    glUniform1i(COMPOSITION, (int)composition_of(params));
    glUniform1i(LAST_EXPONENT, TL_EXPONENT_COUNT);
    glUniform2fv(LOBE_PLACES, TL_EXPONENT_COUNT + 1, lighting->exact.places[0]);
    glBindTextureUnit(LEVELS_UNIT, lighting->exponent_levels.id);
    glBindTextureUnit(LOBES_UNIT, lighting->exact.lobes.id);
    if (source == TL_LIGHT_SLICES)
        tl_slice_maps_bind(request->slices);
    const unsigned sun_maps = shadowed ? tl_shadow_maps_sun_texture(request->maps) : 0;
    if (shadowed)
        glBindTextureUnit(MAPS_UNIT, tl_shadow_maps_texture(request->maps, 0));
    glBindTextureUnit(SUN_MAPS_UNIT, sun_maps ? sun_maps : lighting->no_depths.id);
    draw_pass(gpu, true);
    return true;
}

static bool draw_chains(struct tl_lighting *lighting, tl_gpu *gpu, const struct tl_light_request *request,
                        tl_error *error)
{
    const struct tl_light_params *params = request->params;
    const struct tl_pems *pems = request->pems;
    bool shadowed = params->method != TL_METHOD_UNSHADOWED, exact_first = begins_exact(params);
    const int source = request->sums ? (pems->paraboloids ? PARABOLOID_SUMS : LOBE_SUMS)
                                     : (pems->paraboloids ? PARABOLOIDS : TL_LIGHT_CHAIN);
    const tl_program *program = program_of(
        lighting, gpu, source, shadowed ? (enum tl_visibility)params->visibility : TL_VISIBILITY_RAYS, error);
    if (!program || (exact_first && !draw_regions(lighting, gpu, request, TL_LIGHT_EXACT, error)))
        return false;
    use_program(program, request);
    glUniform1f(PEM_SCALE, pems->scale);
    if (pems->paraboloids)
        glUniform2i(PARABOLOID_DENSITY, tl_paraboloid_density(pems->size, 0),
                    pems->paraboloids[0].level_count);
    if (request->sums) {
        glUniform1i(SUM_COUNT, request->sums->count);
        glBindTextureUnit(SUMS_UNIT, request->sums->lobes.id);
    }
    glUniform1f(ALREADY_THERE, params->composition == TL_COMPOSE_DIFFERENCE ? 1 : 0);
    glBindTextureUnit(LEVELS_UNIT, request->lobe_levels->id);
    for (int pass = 0; pass < pems->array_count; pass++) {
        int first = pass * pems->per_array, left = pems->count - first;
        glUniform2i(REGION_RANGE, first, left < pems->per_array ? left : pems->per_array);
        tl_pems_bind(pems, pass, PEMS_UNIT);
        if (shadowed)
            glBindTextureUnit(MAPS_UNIT, tl_shadow_maps_texture(request->maps, pass));
        draw_pass(gpu, pass == 0 && !exact_first);
    }
    return true;
}

bool tl_lighting_draw(struct tl_lighting *lighting, tl_gpu *gpu, const struct tl_light_request *request,
                      struct tl_light_buffer *out, tl_error *error)
{
    enum tl_light_source source = tl_light_source(request->params);
    tl_light_buffer_begin(out, gpu, &request->gbuffer->target, request->round == 0);
    upload_regions(lighting, request);
    glEnable(GL_BLEND);
    glBlendColor(0, 0, 0, 1 / (float)(request->round + 1));
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, lighting->regions_buffer);
    bool fine = source == TL_LIGHT_CHAIN ? draw_chains(lighting, gpu, request, error)
                                         : draw_regions(lighting, gpu, request, source, error);
    tl_gpu_reset_state(gpu);
    return fine;
}
