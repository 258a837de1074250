// The unshadowed light of the environment that a pixel of card_see.glsl sends to the viewer.
#include "card_lobes.glsl"
#ifdef RICH
#include "card_table.glsl"

// Through the lobes of a table.
vec3 light_of_table(Seen s)
{
    TablePlace at = table_place(s.part, s.facets.viewer, s.surface.glossiness);
    vec3 light = vec3(0.0);
    for (int k = 0; k < int(s.part.table.z); k++) {
        TableLobe lobe = table_lobe(s.part, at, k);
        light += table_weight(lobe, s.surface.f0) * fetch_lobe(lobe_atlas, into_environment(s.facets.frame * lobe.local), lobe.log_exponent);
    }
    return light;
}

// ... and through those that stand for Ward's facets.
vec3 light_of_set(Seen s, int gloss)
{
    WardSet w = ward_set(s.part, gloss, widths_of(s.part, gloss, s.surface.widening, s.tangent.w), s.facets.viewer);
    FacetReflected r = reflected_of(s.part, s.surface, gloss);
    vec3 light_plain = vec3(0.0), light_away = vec3(0.0);
    float sum_plain = 0.0, sum_away = 0.0;
    for (float k = 0.0; k < w.set.count; k++) {
        WardLobe lobe = ward_lobe_of(w.facets, w.set, k);
        vec3 light = fetch_lobe(lobe_atlas, into_environment(s.facets.frame * ward_local(w, lobe)), log2(lobe.exponent));
        sum_plain += lobe.above * lobe.plain;
        sum_away += lobe.above * lobe.away;
        light_plain += lobe.plain * light;
        light_away += lobe.away * light;
    }
    return ward_scale(w, r, sum_plain, sum_away) * (r.plain * light_plain + r.away * light_away);
}

// ... through fibres.
vec3 exact_fibres(MaterialLayers m, vec3 viewer)
{
    float weights[FUZZ_POWERS];
    fuzz_lobes(m.roughness, dot(m.fuzz_axis, viewer), weights);
    vec2 place = octahedral_place(into_environment(m.fuzz_axis));
    vec3 light = vec3(0.0);
    for (int k = 0; k < FUZZ_POWERS; k++)
        light += weights[k] * fetch_map(lobe_atlas, 3 * k, place); // TL_FUZZ_INDEX
    return max(light, 0.0);
}
#endif

// ... through the gloss.
vec3 exact_gloss(Seen s)
{
    vec3 gloss = vec3(0.0);
#ifdef RICH
    if (s.is_faceted) {
        for (int k = 0; k <= int(s.part.flags.w) && s.facets.viewer.z > 0.0; k++)
            gloss += k == 0 && (s.part.flags.x & HAS_TABLE) != 0u ? light_of_table(s) : light_of_set(s, k);
        return gloss;
    }
#endif
    if ((s.part.flags.x & IS_GLOSSY) != 0u)
        gloss = s.reflectance * fetch_lobe(lobe_atlas, into_environment(s.mirror), log2(s.exponent));
    return gloss;
}
