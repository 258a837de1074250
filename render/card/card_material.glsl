// The material at a point, from what maps hold there, and the lobes of its gloss (render/shade). C fills Part in
// materials.c.
#include "surface_terms.glsl"
#include "models_terms.glsl"

struct Part {
    vec4 diffuse;          // colour, glossiness
    vec4 specular;         // F0; factor on the normal map
    vec4 back_diffuse;     // strength of occlusion
    vec4 back_specular;    // factor on a weave's heights
    vec4 ward[3];          // squared widths along weft and warp: of the surface, of two systems of threads
    vec4 threads[2];       // ratio of their colour to the diffuse one
    vec4 turn;             // cosine and sine of the rotation, metres of a UV unit, lobes of a set at most
    vec4 weave;            // repeats per UV unit, factor on steps
    vec4 yarns;            // per UV unit: warp, weft; how many of each repeat
    vec4 mean_colour;      // of all maps: factor on the colour, factor of occlusion
    vec4 mean_specular;    // ... factors on F0, on glossiness
    vec4 mean_gloss;       // ... what is added to glossiness; mixed moments of the two layers of bumps
    vec4 mean_own;         // ... the first layer of bumps
    vec4 mean_weave;       // ... the second
    vec4 sizes, rows;      // of the construction
    vec4 sewing_thread;
    vec4 fuzz;             // colour, roughness
    vec4 fuzz_more;        // how far it follows the bumps
    vec4 law;              // of the diffuse reflectance
    vec4 table;            // of lobe sets: glossiness at both ends, lobes, steps of glossiness
    uvec4 table_first;     // its first vector; enum tl_facets, tl_masking; tl_reflectance, tl_fresnel << 4
    vec4 optics;           // index, extinction; share under a coat, exponent of its lobe
    vec4 emission;
    vec4 transmission;     // w: openness
    vec4 map_rows[12];     // two of each map, from the mesh's UV
    uvec4 flags;           // bits; first triangle of the surface; maps, by bit; systems of threads
};
const uint IS_GLOSSY = 1u, IS_FACETED = 2u, HAS_OWN_BUMPS = 4u, OWN_ARE_MOMENTS = 8u, HAS_WEAVE_BUMPS = 16u,
           WEAVE_ARE_MOMENTS = 32u, HAS_YARNS = 64u, IS_SEWN = 128u, FADES = 256u, HAS_BACK = 512u, IS_BOUNDED = 1024u,
           HAS_FUZZ = 2048u, IS_WOVEN = 4096u, HAS_MAP = 8192u, HAS_BUMPS = 16384u, HAS_TABLE = 32768u,
           TRANSMITS = 65536u, LEAN = 1u << 20, TOKSVIG = 1u << 21;
layout(std430, binding = CARD_PARTS) restrict readonly buffer Parts
{
    Part parts[];
};

// The material with its maps at a place, and the sum of its bumps there.
struct Texels {
    SurfaceColours cloth;
    SurfaceTexels more;
    Bumps bumps;
};

Bumps layer_of(vec4 texel, float mixed, vec2 scale, bool are_moments)
{
    return are_moments ? bumps_of_moments(texel.x, texel.y, texel.z, texel.w, mixed, scale.x, scale.y)
                       : bumps_of_texel(texel.xyz, scale.x, scale.y);
}

// `own`, `woven`: texels of the two layers of bumps, with their mixed moments; `stretch`: factors on a weave's slopes.
Bumps layers_of(Part part, vec4 own, float own_mixed, vec4 woven, float woven_mixed, vec2 stretch)
{
    Bumps bumps = bumps_of_normal(vec3(0.0, 0.0, 1.0));
    if ((part.flags.x & HAS_OWN_BUMPS) != 0u)
        bumps = bumps_add(bumps, layer_of(own, own_mixed, vec2(part.specular.w), (part.flags.x & OWN_ARE_MOMENTS) != 0u));
    if ((part.flags.x & HAS_WEAVE_BUMPS) != 0u)
        bumps = bumps_add(bumps, layer_of(woven, woven_mixed, part.back_specular.w * stretch, (part.flags.x & WEAVE_ARE_MOMENTS) != 0u));
    return bumps;
}

// The means of all maps: what a vertex shows, which has no neighbours to filter over.
Texels mean_texels(Part part)
{
    Texels t = Texels(SurfaceColours(part.diffuse.rgb, part.specular.rgb * part.mean_specular.rgb, part.diffuse.a * part.mean_specular.a),
                      surface_texels(), layers_of(part, part.mean_own, part.mean_gloss.y, part.mean_weave, part.mean_gloss.z, vec2(1.0)));
    t.more.tint = part.mean_colour.rgb;
    t.more.occlusion = part.mean_colour.a;
    t.more.gloss = part.mean_gloss.x;
    return t;
}

struct Surface {
    vec3 smooth_normal, shown; // unit; towards the front, and towards the viewer
    float glossiness;
    vec3 widening, diffuse, f0;
};

// `normal`: towards the front, not unit; `side`: 1: the front is seen; -1: the back.
Surface surface_of(Part part, vec3 normal, vec4 tangent, vec3 viewer, float side, Texels at)
{
    int minify = (part.flags.x & LEAN) != 0u ? MINIFY_LEAN : (part.flags.x & TOKSVIG) != 0u ? MINIFY_TOKSVIG : 0;
    bool shows_back = (part.flags.x & HAS_BACK) != 0u && side < 0.0;
    SurfaceColours seen = surface_colours(at.cloth, at.more, shows_back, part.back_diffuse.rgb, part.back_specular.rgb, part.sewing_thread.rgb);
    Surface surface;
    surface.smooth_normal = direction_or(normal, vec3(0.0, 1.0, 0.0));
    surface.shown = side * surface.smooth_normal;
    surface.diffuse = seen.diffuse;
    surface.f0 = seen.f0;
    surface.glossiness = seen.glossiness;
    surface.widening = vec3(0.0);
    if ((part.flags.x & HAS_MAP) != 0u)
        surface.widening.xy = vec2(detail_widening(1.0 - part.diffuse.a, 1.0 - seen.glossiness, 0.0));
    if ((part.flags.x & HAS_BUMPS) != 0u) {
        SurfaceShape shape = surface_shape(minify, at.bumps, normal, surface.smooth_normal, tangent.xyz, tangent.w, side, viewer,
                                           part.diffuse.a, seen.glossiness);
        surface.shown = shape.normal;
        surface.glossiness = shape.glossiness;
        surface.widening = shape.widening;
        surface.diffuse *= shape.open;
    }
    surface.shown = facing_normal(surface.shown, viewer);
    return surface;
}

// ---- The gloss of facets ----

// The frame of the threads: columns tangent, bitangent, normal; and the viewer in it.
struct Facets {
    mat3 frame;
    vec3 viewer;
};

Facets facets_of(Part part, vec3 n, vec4 tangent, float side, vec3 viewer)
{
    vec3 t = thread_direction(n, tangent.xyz, part.turn.x, side * part.turn.y);
    Facets f;
    f.frame = mat3(t, cross(n, t) * (tangent.w * side < 0.0 ? -1.0 : 1.0), n);
    f.viewer = viewer * f.frame;
    return f;
}

// Squared widths along weft and warp, and their product, of gloss 0: the surface; 1, 2: threads.
vec3 widths_of(Part part, int gloss, vec3 widening, float handedness)
{
    FacetWidening more = facet_widening(part.turn.x, part.turn.y, handedness, widening.x, widening.y, widening.z);
    float weft = facet_square(part.ward[gloss].x, more.weft), warp = facet_square(part.ward[gloss].y, more.warp);
    return vec3(weft, warp, facet_product(weft, warp, more.product));
}

// Enum tl_fresnel. Threads have Schlick's term.
int fresnel_kind(Part part, int gloss)
{
    return gloss > 0 ? FRESNEL_SCHLICK : int(part.table_first.w >> 4);
}

bool is_bounded(Part part, int gloss)
{
    return gloss > 0 || (part.flags.x & IS_BOUNDED) != 0u;
}

// The reflectance of facets; with an index, the factor on fresnel_by_index.
FacetReflected reflected_of(Part part, Surface surface, int gloss)
{
    if (gloss > 0)
        return thread_reflected(surface.f0, surface.diffuse, part.threads[gloss - 1].rgb);
    FacetReflected r = facet_reflected(surface.f0);
    r.away *= fresnel_kind(part, 0) == FRESNEL_SCHLICK ? 1.0 : 0.0;
    return r;
}

// A set of lobes that stands for Ward's facets, in the axes of their widths (render/brdf/ward_lanes.h).
struct WardSet {
    FacetAxes axes;
    WardFacets facets;
    LobeSet set;
    WardValues albedo;
};

WardSet ward_set(Part part, int gloss, vec3 widths, vec3 viewer)
{
    WardSet w;
    w.axes = facet_axes(widths.x, widths.y, widths.z);
    WardFacets f = WardFacets(is_bounded(part, gloss), fresnel_kind(part, gloss), part.optics.x, part.optics.y,
                              w.axes.cosine * viewer.x + w.axes.sine * viewer.y,
                              w.axes.cosine * viewer.y - w.axes.sine * viewer.x, max(viewer.z, 1e-6));
    float weft = 0.707106781 * sqrt(w.axes.square_x), warp = 0.707106781 * sqrt(w.axes.square_y);
    w.facets = f;
    w.set = lobe_set(weft, warp, f.x, f.y, f.z, 1.0, part.turn.w);
    SlopeQuadrature nodes = slope_quadrature(weft, warp, f.x, f.y, f.z);
    w.albedo = WardValues(0.0, 0.0, 0.0);
    for (int i = 0; i < SLOPE_POINTS; i++) {
        WardValues node = ward_node(f, nodes, i);
        w.albedo.share += node.share;
        w.albedo.plain += node.plain;
        w.albedo.away += node.away;
    }
    w.albedo.plain *= nodes.share / w.albedo.share;
    w.albedo.away *= nodes.share / w.albedo.share;
    return w;
}

// The direction of a lobe in the frame of the threads.
vec3 ward_local(WardSet w, WardLobe lobe)
{
    return vec3(w.axes.cosine * lobe.x - w.axes.sine * lobe.y, w.axes.cosine * lobe.y + w.axes.sine * lobe.x, lobe.z);
}

// The factor by which a set's lobes reflect its albedo.
vec3 ward_scale(WardSet w, FacetReflected r, float sum_plain, float sum_away)
{
    vec3 sum = r.plain * sum_plain + r.away * sum_away;
    return (r.plain * w.albedo.plain + r.away * w.albedo.away) / max(sum, 1e-20);
}
