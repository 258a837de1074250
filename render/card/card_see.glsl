// A pixel, its material, and the gloss that it sends to the viewer for light from a direction. RICH: of a class with maps, seams, facets or fuzz.
#include "card_pixel.glsl"
#include "card_material.glsl"
#include "layers_terms.glsl"
#ifdef RICH
#include "card_construction.glsl"
#include "card_maps.glsl"
layout(std430, binding = CARD_TANGENTS) restrict readonly buffer Tangents
{
    vec4 tangents[];
};
#endif

struct Seen {
    Place p;
    Part part;
    Surface surface;
    Facets facets;
    vec4 tangent;
    vec3 viewer, mirror, reflectance, emitted;
    float side, cover, exponent;
    bool is_faceted;
};

Seen see_place(Place p, uint part_number)
{
    Seen s;
    s.p = p;
    s.part = parts[part_number];
    s.side = s.p.back ? -1.0 : 1.0;
    s.viewer = -s.p.ray;
    vec3 point = point_of(s.p);
    s.cover = (s.part.flags.x & FADES) != 0u ? ground_opacity(disc, point.x, point.z) : 1.0;
    s.tangent = vec4(0.0, 0.0, 0.0, 1.0);
#ifdef RICH
    s.tangent = s.p.weights.x * tangents[s.p.corners.x] + s.p.weights.y * tangents[s.p.corners.y] + s.p.weights.z * tangents[s.p.corners.z];
    Uv uv = uv_of(s.p, s.part.turn.z);
    ConstructionLook sewn = construction_none();
    if ((s.part.flags.x & IS_SEWN) != 0u) {
        uint t = s.p.triangle - s.part.flags.y;
        construction_sizes = s.part.sizes;
        construction_rows = s.part.rows;
        sewn = construction_near(border_firsts[t], border_firsts[t + 1u], uv.at, uv.across, uv.up);
    }
    s.surface = surface_of(s.part, smooth_of(s.p), s.tangent, s.viewer, s.side, texels_of(s.part, uv, sewn));
    s.emitted = s.part.emission.rgb;
    if ((s.part.flags.z & 1u << MAP_EMISSION) != 0u)
        s.emitted *= read_map(s.part, MAP_EMISSION, emission_map, uv).rgb;
#else
    s.surface = surface_of(s.part, smooth_of(s.p), s.tangent, s.viewer, s.side, mean_texels(s.part));
#endif
    s.mirror = s.reflectance = vec3(0.0);
    s.exponent = 1.0;
    s.facets = Facets(mat3(0.0), vec3(0.0));
    s.is_faceted = (s.part.flags.x & IS_FACETED) != 0u;
    if (s.is_faceted) {
        s.facets = facets_of(s.part, s.surface.shown, s.tangent, s.side, s.viewer);
    } else if ((s.part.flags.x & IS_GLOSSY) != 0u) {
        s.mirror = mirror_direction(s.surface.shown, s.viewer);
        s.exponent = lobe_exponent(s.surface.glossiness);
        s.reflectance = schlick_colour(s.surface.f0, dot(s.surface.shown, s.viewer));
    }
    return s;
}

Seen see(uint id, uint part_number, ivec2 pixel)
{
    return see_place(place_of(id, pixel), part_number);
}

MaterialLayers layers_over(Seen s)
{
    return material_layers(s.part.law, s.part.optics.z, s.part.optics.w, s.part.fuzz.rgb, s.part.fuzz.a, s.part.fuzz_more.x,
                           s.side * s.surface.smooth_normal, s.surface.shown, s.facets.frame[0], s.viewer);
}

#ifdef RICH
// f_r cos of other models than Ward's, for light from a disc (tl_brdf_gloss_under_disc).
vec3 model_under(Seen s, vec3 d, float radius)
{
    mat3 f = s.facets.frame;
    Cosines c = cosines_of(Frame(f[2], f[0], f[1]), d, s.viewer, direction_or(d + s.viewer, d));
    if (!(c.a > 0.0 && c.b > 0.0 && c.half_normal > 0.0))
        return vec3(0.0);
    int model = int(s.part.table_first.w & 15u);
    float wider = detail_facet_square(1.0 - s.surface.glossiness) - detail_facet_square(1.0 - s.part.diffuse.a);
    float width = sqrt(facet_square(s.part.ward[0].x, wider) + radius * radius / 8.0);
    float exponent = lobe_broadened_exponent(lobe_exponent(s.surface.glossiness), radius * 0.707106781);
    return fresnel_colour(fresnel_kind(s.part, 0), s.part.optics.x, s.part.optics.y, s.surface.f0, fresnel_cosine(model, c)) *
           lobe_of(model, int(s.part.table_first.y), int(s.part.table_first.z), c, exponent, width);
}

// ... of Ward's.
vec3 facets_under(Seen s, int gloss, vec3 d, float radius)
{
    vec3 widths = widths_of(s.part, gloss, s.surface.widening, s.tangent.w), sum = d + s.viewer, h = sum * s.facets.frame;
    float square = dot(sum, sum), cosine = min(0.5 * sqrt(square), 1.0);
    FacetReflected r = reflected_of(s.part, s.surface, gloss);
    float value = ward_under_disc(is_bounded(s.part, gloss), h.x, h.y, h.z, square, dot(s.facets.frame[2], d),
                                  s.facets.viewer.z, widths.x, widths.y, widths.z, radius);
    return value * fresnel_by_index(fresnel_kind(s.part, gloss), s.part.optics.x, s.part.optics.y, cosine) *
           (r.plain + r.away * schlick_share(cosine));
}
#endif

// f_r cos of the gloss, for light from a disc.
vec3 gloss_under(Seen s, vec3 d, float radius)
{
    vec3 gloss = vec3(0.0);
#ifdef RICH
    if (s.is_faceted) {
        for (int k = 0; k <= int(s.part.flags.w); k++)
            gloss += k == 0 && (s.part.flags.x & HAS_TABLE) != 0u ? model_under(s, d, radius) : facets_under(s, k, d, radius);
        return gloss;
    }
#endif
    if ((s.part.flags.x & IS_GLOSSY) != 0u) {
        float e = lobe_broadened_exponent(s.exponent, radius * 0.707106781);
        gloss = s.reflectance * lobe_cosine(e, dot(d, s.mirror));
    }
    return gloss;
}
