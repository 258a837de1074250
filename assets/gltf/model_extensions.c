/* glTF's material extensions as the nearest appearance that a tl_material can represent, with a note on each
 * difference. */
#include "assets/gltf/model_internal.h"

#include <math.h>

static float unit(float value)
{
    return value > 0 ? fminf(value, 1) : 0; /* NaN: 0 */
}

/* F0 from the index of refraction, scaled by the specular factor and colour [KHR_materials_specular,
 * KHR_materials_ior]. An index of 0 means infinity there. */
vec3s model_dielectric_f0(const struct material_build *build)
{
    const struct gltf_extensions *from = &build->from->extensions;
    float ior = from->ior == 0 || from->ior >= 1 ? from->ior : 1.5f, root = (ior - 1) / (ior + 1);
    float f0 = root * root * unit(from->specular);
    f0 *= model_map_mean(build, &from->specular_map, "a", "KHR_materials_specular: its strength").a;
    if (from->specular < 1)
        model_approximate_extension(
            build, "KHR_materials_specular: weakens reflection at normal incidence; at grazing "
                   "angles it stays full");
    if (build->metallic <= 0.5f)
        model_colour_map(build, &from->specular_colour_map, &build->to->specular_map);
    vec3s out;
    for (int c = 0; c < 3; c++)
        out.raw[c] = unit(f0 * fmaxf(from->specular_colour[c], 0));
    if (ior > 1)
        build->to->gloss.index = ior;
    return out;
}

/* Fitted by least squares over views up to 70 degrees: there Ward's lobe falls with the cosine of the view,
 * GGX does not (tests/assets/gltf/test_model_extensions.c). */
float model_ward_factor(float width_weft, float width_warp)
{
    return 1.14f + 0.17f * sqrtf(width_weft * width_warp);
}

/* GGX of widths mix(alpha, 1, strength^2) along the direction and alpha across, as a Ward lobe of the same
 * widths. Wide slopes along a direction stretch the highlight along it; the grooves that make them run
 * across. The fit is best with a factor a little
 * above 1 (model_ward_factor). */
static void apply_anisotropy(const struct material_build *build)
{
    const struct gltf_extensions *from = &build->from->extensions;
    float strength = unit(from->anisotropy_strength);
    if (strength <= 0)
        return;
    struct tl_gloss *gloss = &build->to->gloss;
    gloss->rotation = isfinite(from->anisotropy_rotation) ? from->anisotropy_rotation : 0;
    if (from->anisotropy_map.used) {
        struct model_mean mean = model_map_mean(build, &from->anisotropy_map, "rgb",
                                                "KHR_materials_anisotropy: its direction or strength");
        strength *= mean.b;
        if (mean.r < 1 || mean.g < 1) /* all ones: the map could not be read */
            gloss->rotation += atan2f(2 * mean.g - 1, 2 * mean.r - 1);
    }
    float alpha = fmaxf(build->roughness * build->roughness, 1e-3f);
    gloss->model = TL_REFLECT_WARD;
    gloss->width_weft = alpha + (1 - alpha) * strength * strength;
    gloss->width_warp = alpha;
    float brighter = model_ward_factor(gloss->width_weft, gloss->width_warp);
    for (int c = 0; c < 3; c++)
        build->to->specular.raw[c] = fminf(build->to->specular.raw[c] * brighter, 1);
    model_approximate_extension(
        build, "KHR_materials_anisotropy: shown by Ward's elliptical lobe of the same widths "
               "instead of GGX: shorter tails, brighter at normal incidence, darker at grazing views");
    if (build->roughness_varies)
        model_approximate_extension(
            build, "KHR_materials_anisotropy: roughness varies over a texture: its mean is used");
}

/* Fuzz whose albedo is nearest to that of the "Charlie" sheen [Estevez and Kulla 2017],
 *
 *     D = (2 + 1/a) sin^(1/a) / 2 pi,   V = 1 / (4 (l + v - l v)),   a = roughness^2,
 *
 * with l and v the cosines of light and view: for each tenth of its roughness, by least squares over the
 * views. From 0.3 on the two differ by 3 to 8 %. A smaller roughness is a narrower rim than fuzz can have: it
 * becomes the narrowest fuzz. Amounts over 1.43 would send back more light than arrives
 * (tests/assets/gltf/test_model_extensions.c). */
static const struct model_fuzz fuzz_of_tenths[] = {
    {0.48f, 0.4f},   {1.06f, 0.4f},   {1.43f, 0.4f},   {1.43f, 0.41f},  {1.233f, 0.5f}, {1.067f, 0.575f},
    {0.953f, 0.64f}, {0.865f, 0.70f}, {0.803f, 0.75f}, {0.762f, 0.79f}, {0.722f, 0.83f}};
#define TENTHS    ((int)(sizeof fuzz_of_tenths / sizeof *fuzz_of_tenths) - 1)
#define NARROWEST 2 /* the last of those that share the smallest roughness of fuzz */

struct model_fuzz model_fuzz_of_sheen(float roughness)
{
    float at = TENTHS * unit(roughness);
    int below = at < TENTHS ? (int)at : TENTHS - 1;
    const struct model_fuzz *a = &fuzz_of_tenths[below], *b = a + 1;
    float share = at - (float)below;
    return (struct model_fuzz){a->amount + share * (b->amount - a->amount),
                               a->roughness + share * (b->roughness - a->roughness)};
}

float model_sheen_of_fuzz(float roughness)
{
    int i = NARROWEST;
    while (i < TENTHS - 1 && fuzz_of_tenths[i + 1].roughness < roughness)
        i++;
    float from = fuzz_of_tenths[i].roughness, step = fuzz_of_tenths[i + 1].roughness - from;
    return ((float)i + unit((roughness - from) / step)) / TENTHS;
}

/* Sheen lies over the other layers and leaves them the light that it does not send back, as fuzz does. */
static void apply_sheen(const struct material_build *build)
{
    const struct gltf_extensions *from = &build->from->extensions;
    float maximum = 0;
    for (int c = 0; c < 3; c++)
        maximum = fmaxf(maximum, unit(from->sheen_colour[c]));
    if (maximum <= 0)
        return;
    struct model_mean tint =
        model_map_mean(build, &from->sheen_colour_map, "colour", "KHR_materials_sheen: its colour");
    struct model_mean rough =
        model_map_mean(build, &from->sheen_roughness_map, "a", "KHR_materials_sheen: its roughness");
    struct model_fuzz fuzz = model_fuzz_of_sheen(unit(from->sheen_roughness) * rough.a);
    const float tints[] = {tint.r, tint.g, tint.b};
    for (int c = 0; c < 3; c++)
        build->to->fuzz.colour.raw[c] = fuzz.amount * unit(from->sheen_colour[c]) * tints[c];
    build->to->fuzz.roughness = fuzz.roughness;
    model_approximate_extension(
        build, "KHR_materials_sheen: shown as fuzz of nearly the same albedo; under a roughness of 0.3 its "
               "rim is broader");
}

/* Mean base colour, which filters transmitted light. */
static vec3s base_mean(const struct material_build *build)
{
    struct model_mean map =
        model_map_mean(build, &build->from->base_colour_map, "colour", "colour of transmitted light");
    return (vec3s){{build->base[0] * map.r, build->base[1] * map.g, build->base[2] * map.b}};
}

/* A smooth thin sheet transmits light straight, as holes do; a rough one scatters it. A tl_material's colours
 * are those of the surface between its holes, so they are divided by the share that is left. */
static void apply_transmission(const struct material_build *build)
{
    const struct gltf_extensions *from = &build->from->extensions;
    tl_material *to = build->to;
    float share = unit(from->transmission) * (1 - build->metallic);
    if (share <= 0)
        return;
    share *= model_map_mean(build, &from->transmission_map, "r", "KHR_materials_transmission: its share").r;
    vec3s base = base_mean(build);
    float clear = share * (1 - build->roughness) * (base.x + base.y + base.z) / 3,
          kept = fmaxf(1 - clear, 0.01f);
    to->openness = 1 - kept;
    for (int c = 0; c < 3; c++) {
        to->diffuse.raw[c] = unit(to->diffuse.raw[c] * (1 - share) / kept);
        to->specular.raw[c] = unit(to->specular.raw[c] / kept);
        to->transmission.raw[c] = unit(base.raw[c] * share * build->roughness / kept);
    }
    model_approximate_extension(
        build, "KHR_materials_transmission: smooth parts let light straight through, neither "
               "tinted nor bent; rough parts scatter it evenly");
}

/* A tl_material has the same term [KHR_materials_diffuse_transmission]. */
static void apply_diffuse_transmission(const struct material_build *build)
{
    const struct gltf_extensions *from = &build->from->extensions;
    float share = unit(from->diffuse_transmission);
    if (share <= 0)
        return;
    share *= model_map_mean(build, &from->diffuse_transmission_map, "a",
                            "KHR_materials_diffuse_transmission: its share")
                 .a;
    struct model_mean tint = model_map_mean(build, &from->diffuse_transmission_colour_map, "colour",
                                            "KHR_materials_diffuse_transmission: its colour");
    const float tints[] = {tint.r, tint.g, tint.b};
    for (int c = 0; c < 3; c++) {
        float colour = unit(from->diffuse_transmission_colour[c]) * tints[c];
        build->to->transmission.raw[c] =
            unit(build->to->transmission.raw[c] + share * colour * (1 - build->metallic));
        build->to->diffuse.raw[c] *= 1 - share;
    }
}

static void apply_clearcoat(const struct material_build *build)
{
    const struct gltf_extensions *from = &build->from->extensions;
    float share = unit(from->clearcoat);
    if (share <= 0)
        return;
    share *= model_map_mean(build, &from->clearcoat_map, "r", "KHR_materials_clearcoat: its share").r;
    float roughness = unit(from->clearcoat_roughness);
    if (roughness > 0)
        roughness *= model_map_mean(build, &from->clearcoat_roughness_map, "g",
                                    "KHR_materials_clearcoat: its roughness")
                         .g;
    build->to->coat = share;
    build->to->coat_glossiness = tl_glossiness_from_roughness(roughness);
    if (from->clearcoat_normal_map.used)
        model_approximate_extension(build,
                                    "KHR_materials_clearcoat: the coat follows the surface's own normals");
}

void model_apply_extensions(const struct material_build *build)
{
    apply_anisotropy(build);
    apply_sheen(build);
    apply_transmission(build);
    apply_diffuse_transmission(build);
    apply_clearcoat(build);
}
