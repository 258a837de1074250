#version 450 core
// The ratio of seen to exact light at the listed probes: thirty-two of them, whose regions eight threads share
// (render/light/compose.c: ratio_of_sample).
#include "card_frame.glsl"
#include "card_geometry.glsl"
#include "card_lobes.glsl"
#include "card_material.glsl"
#include "card_table.glsl"
#include "layers_terms.glsl"
#include "card_bounced.glsl"
layout(local_size_x = 32, local_size_y = 8) in;
layout(std430, binding = CARD_TANGENTS) restrict readonly buffer Tangents
{
    vec4 tangents[];
};
layout(std430, binding = CARD_VISIBLE) restrict readonly buffer Visible
{
    uint visible[];
};
layout(std430, binding = CARD_LISTED) restrict readonly buffer Listed
{
    uint listed;
};
layout(std430, binding = CARD_LIST) restrict readonly buffer List
{
    uint list[];
};
layout(std430, binding = CARD_ORIGINS) restrict readonly buffer Origins
{
    vec4 origins[];
};
layout(std430, binding = CARD_PROBES) restrict readonly buffer Probes
{
    uvec2 probes[];
};
layout(std430, binding = CARD_REGIONS) restrict readonly buffer Regions
{
    vec4 regions[];
};
layout(std430, binding = CARD_VERTEX_PARTS) restrict readonly buffer VertexParts
{
    uint vertex_parts[];
};
layout(std430, binding = CARD_RATIOS) restrict writeonly buffer Ratios
{
    vec4 ratios[];
};

const uint SLICES = 8u, GLOSSES = 3u, SET_LOBES = 5u; // of the surface and two systems of threads; TL_CARD_LOBES each
const uint COAT = GLOSSES * SET_LOBES, LOBES = COAT + 1u;
shared vec4 lobe_at[LOBES][32];     // direction in the environment; exponent
shared vec4 lobe_weight[LOBES][32]; // its weight; later times the regions' gain
shared uint lobe_counts[GLOSSES + 1u][32];
shared vec3 sums_diffuse[SLICES][32], sums_gloss[SLICES][32], sums_all[SLICES][32];

// A probe as the CPU's vertex of a triangle that is seen.
struct Vertex {
    Part part;
    Surface surface;
    vec3 normal, viewer;
    vec4 tangent;
    float side;
};

Vertex vertex_of(uint probe)
{
    Vertex v;
    uint vertex = probes[probe].x & 0x7fffffffu;
    v.side = (probes[probe].x >> 31) != 0u ? -1.0 : 1.0;
    v.part = parts[vertex_parts[vertex]];
    v.viewer = direction_or(eye.xyz - position_of(vertex), vec3(0.0, 1.0, 0.0));
    v.tangent = tangents[vertex];
    v.surface = surface_of(v.part, normal_of(vertex), v.tangent, v.viewer, v.side, mean_texels(v.part));
    v.normal = v.surface.smooth_normal * v.side; // it lies in the middle of bumps of every direction
    return v;
}

// Lists the lobes of the vertex's gloss number `gloss`, GLOSSES: of its coat. Returns how many.
uint list_lobes(Vertex v, uint gloss, uint lane)
{
    float cosine = dot(v.normal, v.viewer);
    if (gloss == GLOSSES) {
        lobe_at[COAT][lane] = vec4(into_environment(mirror_direction(v.normal, v.viewer)), v.part.optics.w);
        lobe_weight[COAT][lane] = vec4(1.0);
        return v.part.optics.z > 0.0 ? 1u : 0u;
    }
    if ((v.part.flags.x & IS_FACETED) == 0u) {
        if (gloss > 0u || (v.part.flags.x & IS_GLOSSY) == 0u)
            return 0u;
        lobe_at[0][lane] = vec4(into_environment(mirror_direction(v.normal, v.viewer)), lobe_exponent(v.surface.glossiness));
        lobe_weight[0][lane] = vec4(1.0);
        return 1u;
    }
    if (gloss > v.part.flags.w)
        return 0u;
    vec3 viewer = v.viewer; // one at the horizon stands for those below it
    if (cosine < 0.02)
        viewer = direction_or(viewer + v.normal * (0.02 - cosine), v.normal);
    Facets f = facets_of(v.part, v.normal, v.tangent, v.side, viewer);
    if (gloss == 0u && (v.part.flags.x & HAS_TABLE) != 0u) {
        TablePlace place = table_place(v.part, f.viewer, v.surface.glossiness);
        for (uint k = 0u; k < uint(v.part.table.z); k++) {
            TableLobe lobe = table_lobe(v.part, place, int(k));
            lobe_at[k][lane] = vec4(into_environment(normalize(f.frame * lobe.local)), exp2(lobe.log_exponent));
            lobe_weight[k][lane] = vec4(table_weight(lobe, v.surface.f0), 0.0);
        }
        return uint(v.part.table.z);
    }
    WardSet w = ward_set(v.part, int(gloss), widths_of(v.part, int(gloss), v.surface.widening, v.tangent.w * v.side), f.viewer);
    FacetReflected r = reflected_of(v.part, v.surface, int(gloss));
    float sum_plain = 0.0, sum_away = 0.0;
    uint count = uint(w.set.count), first = gloss * SET_LOBES;
    for (uint k = 0u; k < count; k++) {
        WardLobe lobe = ward_lobe_of(w.facets, w.set, float(k));
        sum_plain += lobe.above * lobe.plain;
        sum_away += lobe.above * lobe.away;
        lobe_at[first + k][lane] = vec4(into_environment(f.frame * ward_local(w, lobe)), lobe.exponent);
        lobe_weight[first + k][lane] = vec4(r.plain * lobe.plain + r.away * lobe.away, 0.0);
    }
    vec3 scale = ward_scale(w, r, sum_plain, sum_away);
    for (uint k = 0u; k < count; k++)
        lobe_weight[first + k][lane].rgb *= scale;
    return count;
}

void main()
{
    uint lane = gl_LocalInvocationID.x, slice = gl_LocalInvocationID.y, at = gl_WorkGroupID.x * 32u + lane;
    bool is_there = at < listed;
    at = is_there ? at : 0u;
    uint probe = list[at];
    Vertex v = vertex_of(probe);
    if (slice <= GLOSSES)
        lobe_counts[slice][lane] = list_lobes(v, slice, lane);
    barrier();

    // The exact light of each lobe, what bounces to it, and the regions' gain.
    vec3 all = vec3(0.0), gloss = vec3(0.0), all_coat = vec3(0.0), coat = vec3(0.0), normal = into_environment(v.normal);
    for (uint i = slice; i < LOBES; i += SLICES)
        if (i % SET_LOBES < lobe_counts[i / SET_LOBES][lane]) {
            vec4 lobe = lobe_at[i][lane];
            float exponent = log2(lobe.w);
            vec3 weight = lobe_weight[i][lane].rgb;
            vec3 light = weight * fetch_lobe(lobe_atlas, lobe.xyz, exponent), more = vec3(0.0);
            if (numbers.y != 0u)
                more = weight * bounced_through(probe, v.normal, out_of_environment(lobe.xyz), lobe.w);
            all += i < COAT ? light : vec3(0.0);
            gloss += i < COAT ? more : vec3(0.0);
            all_coat += i < COAT ? vec3(0.0) : light;
            coat += i < COAT ? vec3(0.0) : more;
            lobe_weight[i][lane].rgb = weight * fetch_lobe(gain_atlas, lobe.xyz, exponent);
        }
    barrier();

    // The regions.
    bool has_fuzz = (v.part.flags.x & HAS_FUZZ) != 0u;
    vec3 diffuse = vec3(0.0), seen_fibres = vec3(0.0), all_fibres = vec3(0.0);
    vec3 fibres_axis = fuzz_axis(v.part.fuzz_more.x, v.normal, v.normal), axis = into_environment(fibres_axis);
    float fibres[FUZZ_POWERS], albedo = fuzz_lobes(v.part.fuzz.a, dot(fibres_axis, v.viewer), fibres);
    for (uint group = slice; group < uint(counts.x + 3) / 4u; group += SLICES) {
        uint seen = visible[group * uint(counts.z) + at];
        for (uint k = 0u; k < 4u && (seen != 0u || has_fuzz); k++) {
            uint region = 4u * group + k;
            if (region >= uint(counts.x))
                break;
            vec4 r = regions[2u * region], more = regions[2u * region + 1u];
            float inverse = 1.0 / r.w, cosine = dot(r.xyz, normal), open = float(seen >> 8u * k & 255u) * (1.0 / 255.0);
            if (has_fuzz) {
                float sent = fuzz_lobes_at(fibres, r.w * disc_height(dot(r.xyz, axis) * inverse));
                float above = v.part.fuzz_more.x > 0.0 ? disc_share(cosine * inverse) : 1.0;
                all_fibres += more.rgb * sent;
                seen_fibres += more.rgb * (sent * open * above);
            }
            if (open == 0.0)
                continue;
            diffuse += more.rgb * (region_lobe_diffuse(cosine, r.w, inverse) * open);
            vec3 through = vec3(0.0), through_coat = vec3(0.0);
            for (uint i = 0u; i < LOBES; i++)
                if (i % SET_LOBES < lobe_counts[i / SET_LOBES][lane]) {
                    vec4 lobe = lobe_at[i][lane];
                    float s = lobe_broadened_exponent(min(lobe.w, 1000.0), more.w); // TL_REGION_LOBE_MAX
                    vec3 part = lobe_weight[i][lane].rgb * region_lobe(dot(r.xyz, lobe.xyz), r.w, inverse, s);
                    through += i < COAT ? part : vec3(0.0);
                    through_coat += i < COAT ? vec3(0.0) : part;
                }
            vec3 arrives = more.rgb * (disc_share(cosine * inverse) * open);
            gloss += arrives * through;
            coat += arrives * through_coat;
        }
    }
    sums_diffuse[slice][lane] = diffuse;
    sums_gloss[slice][lane] = gloss;
    sums_all[slice][lane] = all;
    barrier();
    lobe_at[slice][lane] = vec4(seen_fibres, 0.0); // its lobes are summed
    lobe_weight[slice][lane] = vec4(all_fibres, 0.0);
    lobe_at[SLICES + slice][lane] = vec4(coat, 0.0);
    lobe_weight[SLICES + slice][lane] = vec4(all_coat, 0.0);
    barrier();
    if (slice != 0u || !is_there)
        return;
    for (uint i = 1u; i < SLICES; i++) {
        diffuse += sums_diffuse[i][lane];
        gloss += sums_gloss[i][lane];
        all += sums_all[i][lane];
        seen_fibres += lobe_at[i][lane].rgb;
        all_fibres += lobe_weight[i][lane].rgb;
        coat += lobe_at[SLICES + i][lane].rgb;
        all_coat += lobe_weight[SLICES + i][lane].rgb;
    }
    vec3 arrives = numbers.y != 0u ? bounced[17u * probe].rgb : vec3(0.0);
    diffuse = diffuse * fetch_map(gain_atlas, DIFFUSE_GAIN, octahedral_place(normal)) + arrives;
    vec3 ratio = share_of(diffuse, exact_diffuse(normal));
    bool has_gloss = (v.part.flags.x & (IS_FACETED | IS_GLOSSY)) != 0u;
    ratios[4u * probe] = vec4(ratio, 0.0);
    ratios[4u * probe + 1u] = vec4(has_gloss ? share_of(gloss, all) : ratio, origins[2u * at].w);
    ratios[4u * probe + 2u] = vec4(has_fuzz ? share_of(seen_fibres + arrives * albedo, all_fibres) : ratio, 0.0);
    ratios[4u * probe + 3u] = vec4(share_of(coat, all_coat), 0.0);
}
