#include "render/brdf/brdf.h"

#include "render/brdf/facets.h"
#include "render/env/exponent.h"

typedef struct Cosines Cosines;
typedef struct Frame Frame;

#include "render/gpu/terms_begin.h"
#define power tl_cosine_power

#include "render/brdf/models_terms.glsl"

#undef power
#include "render/gpu/terms_end.h"

#include <math.h>

static float finite_or(float x, float otherwise)
{
    return isfinite(x) ? x : otherwise;
}

/* The squared Gaussian slope of a Blinn-Phong lobe. */
static float square_of(float exponent)
{
    return 2 / (4 * exponent + 2);
}

static float given_square(float width, float otherwise)
{
    return finite_or(width, 0) > 0 ? width * width : otherwise;
}

struct tl_brdf tl_brdf_of(const tl_material *material, vec3s f0, float glossiness)
{
    float own = square_of(tl_lobe_exponent(finite_or(material->glossiness, 0)));
    float wider = square_of(tl_lobe_exponent(finite_or(glossiness, 0))) - own;
    const float both[3] = {wider, wider, 0};
    return tl_brdf_bumped(material, f0, glossiness, 1, both);
}

/* The spreads are along u and v, the widths along the threads, which are turned towards v. */
static void widen(struct tl_brdf *brdf, float own, float by_glossiness, float handedness,
                  const float widening[3])
{
    struct tl_gloss *gloss = &brdf->gloss;
    FacetWidening wider = {by_glossiness, by_glossiness, 0};
    if (gloss->model == TL_REFLECT_WARD)
        wider =
            facet_widening(cosf(gloss->rotation), sinf(gloss->rotation), handedness,
                           finite_or(widening[0], 0), finite_or(widening[1], 0), finite_or(widening[2], 0));
    float weft = facet_square(given_square(gloss->width_weft, own), finite_or(wider.weft, 0));
    float warp = facet_square(given_square(gloss->width_warp, own), finite_or(wider.warp, 0));
    float product = facet_product(weft, warp, wider.product);
    const FacetAxes axes = facet_axes(weft, warp, product);
    gloss->width_weft = sqrtf(axes.square_x);
    gloss->width_warp = sqrtf(axes.square_y);
    brdf->turn = axes.sine;
}

struct tl_brdf_frame tl_brdf_own_frame(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame)
{
    if (brdf->turn == 0)
        return *frame;
    const vec3s t = frame->tangent, b = frame->bitangent;
    const float sine = brdf->turn, cosine = sqrtf(1 - sine * sine);
    return (struct tl_brdf_frame){frame->normal,
                                  glms_vec3_add(glms_vec3_scale(t, cosine), glms_vec3_scale(b, sine)),
                                  glms_vec3_sub(glms_vec3_scale(b, cosine), glms_vec3_scale(t, sine))};
}

struct tl_brdf tl_brdf_bumped(const tl_material *material, vec3s f0, float glossiness, float handedness,
                              const float widening[3])
{
    struct tl_brdf brdf = {
        .gloss = material->gloss, .f0 = f0, .exponent = tl_lobe_exponent(finite_or(glossiness, 0))};
    struct tl_gloss *gloss = &brdf.gloss;
    float own = square_of(tl_lobe_exponent(finite_or(material->glossiness, 0)));
    widen(&brdf, own, square_of(brdf.exponent) - own, handedness, widening);
    gloss->index = gloss->index > 0 ? finite_or(gloss->index, 1) : 1;
    gloss->extinction = fmaxf(finite_or(gloss->extinction, 0), 0);
    for (int c = 0; c < 3; c++)
        brdf.f0.raw[c] = fminf(fmaxf(finite_or(f0.raw[c], 0), 0), 1);
    return brdf;
}

/* A thread's lobe is as wide as its own widths state, and widened as the surface's lobe is. */
static struct tl_brdf thread_of(const tl_material *material, const struct tl_thread *thread, vec3s f0,
                                vec3s kd, float glossiness, float handedness, const float widening[3])
{
    struct tl_brdf brdf = {.gloss = {.model = TL_REFLECT_WARD,
                                     .ward = TL_WARD_BOUNDED,
                                     .width_weft = thread->width_weft,
                                     .width_warp = thread->width_warp,
                                     .rotation = material->gloss.rotation,
                                     .index = 1},
                           .f0 = f0,
                           .exponent = tl_lobe_exponent(finite_or(glossiness, 0)),
                           .is_inside = true,
                           .colour = glms_vec3_mul(thread->ratio, kd)};
    float own = square_of(tl_lobe_exponent(finite_or(material->glossiness, 0)));
    widen(&brdf, own, 0, handedness, widening);
    for (int c = 0; c < 3; c++)
        brdf.colour.raw[c] = fminf(fmaxf(finite_or(brdf.colour.raw[c], 0), 0), 1);
    return brdf;
}

struct tl_brdf_sum tl_brdf_sum_of(const tl_material *material, vec3s f0, vec3s kd, float glossiness,
                                  float handedness, const float widening[3])
{
    struct tl_brdf_sum sum = {.count = 1};
    sum.items[0] = tl_brdf_bumped(material, f0, glossiness, handedness, widening);
    for (int i = 0; i < material->thread_count; i++)
        sum.items[sum.count++] =
            thread_of(material, &material->threads[i], sum.items[0].f0, kd, glossiness, handedness, widening);
    return sum;
}

vec3s tl_brdf_sum_gloss(const struct tl_brdf_sum *sum, const struct tl_brdf_frame *frame, vec3s l, vec3s v)
{
    vec3s gloss = tl_brdf_gloss(&sum->items[0], frame, l, v);
    for (int i = 1; i < sum->count; i++)
        gloss = glms_vec3_add(gloss, tl_brdf_gloss(&sum->items[i], frame, l, v));
    return gloss;
}

float tl_brdf_facets(const struct tl_brdf *brdf, float tangent_squared)
{
    return facet_density(brdf->gloss.facets, brdf->gloss.width_weft, tangent_squared);
}

float tl_brdf_smith(const struct tl_brdf *brdf, float cos_a, float cos_b)
{
    return facet_masking(brdf->gloss.facets, TL_MASKING_SMITH, brdf->gloss.width_weft, cos_a, cos_b, 1, 1);
}

float tl_brdf_v_grooves(float cos_a, float cos_b, float cos_t, float cos_d)
{
    return facet_masking(0, TL_MASKING_V_GROOVES, 1, cos_a, cos_b, cos_t, cos_d);
}

float tl_brdf_masking(const struct tl_brdf *brdf, float cos_a, float cos_b, float cos_t, float cos_d)
{
    return facet_masking(brdf->gloss.facets, brdf->gloss.masking, brdf->gloss.width_weft, cos_a, cos_b, cos_t,
                         cos_d);
}

float tl_brdf_lobe_scale(const struct tl_brdf *brdf)
{
    return lobe_scale(brdf->gloss.model, brdf->exponent);
}

static float ward(const struct tl_gloss *gloss, Cosines c)
{
    const float u = gloss->width_weft, v = gloss->width_warp, steep = c.t * c.half_normal * c.half_normal;
    return ward_lobe(gloss->ward == TL_WARD_BOUNDED, c.half_plane.x / c.half_normal,
                     c.half_plane.y / c.half_normal, steep * steep, c.a, c.b, u * u, v * v, 0);
}

vec3s tl_brdf_fresnel(const struct tl_brdf *brdf, float cosine)
{
    const struct tl_gloss *gloss = &brdf->gloss;
    cosine = cosine > 0 ? fminf(cosine, 1) : 0; /* NaN: 0 */
    if (brdf->is_inside)
        return glms_vec3_mul(brdf->colour, glms_vec3_sub(glms_vec3_one(), schlick_colour(brdf->f0, cosine)));
    return fresnel_colour(gloss->fresnel, gloss->index, gloss->extinction, brdf->f0, cosine);
}

vec3s tl_brdf_gloss(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s l, vec3s v)
{
    const struct tl_gloss *gloss = &brdf->gloss;
    const struct tl_brdf_frame own = tl_brdf_own_frame(brdf, frame);
    const Cosines c = cosines_of((Frame){own.normal, own.tangent, own.bitangent}, l, v,
                                 direction_or(glms_vec3_add(l, v), l));
    if (!(c.a > 0 && c.b > 0 && c.half_normal > 0))
        return (vec3s){{0, 0, 0}};
    const float lobe = gloss->model == TL_REFLECT_WARD ? ward(gloss, c)
                                                       : lobe_of(gloss->model, gloss->facets, gloss->masking,
                                                                 c, brdf->exponent, gloss->width_weft);
    return glms_vec3_scale(tl_brdf_fresnel(brdf, fresnel_cosine(gloss->model, c)), finite_or(lobe, 0));
}
