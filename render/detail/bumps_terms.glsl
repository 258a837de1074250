// Bumps that are smaller than a sample, and normals that they bend, for GLSL and C (bump_statistics.h). Tangent space: x
// along u, y along minus v, z outwards.
#ifdef GL_core_profile
#include "vectors.glsl"
#include "detail_terms.glsl"
#endif
#ifndef TERM
#define TERM
#endif

// enum tl_detail_minify
#define MINIFY_TOKSVIG 1
#define MINIFY_LEAN 2

// A mean normal, the variances of the slopes about it along x and y and their covariance, and its length before
// normalisation.
struct Bumps {
    vec3 normal;
    vec3 spread;
    float mean_length;
};

// A single normal.
TERM Bumps bumps_of_normal(vec3 normal)
{
    Bumps bumps;
    bumps.normal = normal;
    bumps.spread = vec3(0.0f, 0.0f, 0.0f);
    bumps.mean_length = 1.0f;
    return bumps;
}

// ... from a texel of 0 to 1; slopes along u and v are multiplied.
TERM Bumps bumps_of_texel(vec3 texel, float scale_u, float scale_v)
{
    return bumps_of_normal(vec3(scale_u * (2.0f * texel.x - 1.0f), scale_v * (2.0f * texel.y - 1.0f), 2.0f * texel.z - 1.0f));
}

TERM float bumps_length(vec3 spread)
{
    return sqrt(min(max(1.0f - spread.x - spread.y, 0.0025f), 1.0f)); // neglecting the variance of z
}

// Averages of x, y, their squares and x y. The variances and the covariance are those of [Olano and Baker 2010, eq. 5].
TERM Bumps bumps_of_moments(float x, float y, float xx, float yy, float xy, float scale_u, float scale_v)
{
    Bumps bumps;
    bumps.normal = vec3(scale_u * x, scale_v * y, sqrt(max(1.0f - xx - yy, 0.0f)));
    bumps.spread = vec3(scale_u * scale_u * max(xx - x * x, 0.0f), scale_v * scale_v * max(yy - y * y, 0.0f),
                        scale_u * scale_v * (xy - x * y));
    bumps.mean_length = bumps_length(bumps.spread);
    return bumps;
}

// The same averages of offsets (-h_u, -h_v) in place of x and y.
TERM Bumps bumps_of_offsets(float x, float y, float xx, float yy, float xy, float scale_u, float scale_v)
{
    Bumps bumps = bumps_of_moments(x, y, xx, yy, xy, scale_u, scale_v);
    bumps.normal.z = 1.0f;
    return bumps;
}

// Mean slopes and the spread about them: of what is sewn.
TERM Bumps bumps_of_slopes(float slope_x, float slope_y, vec3 spread)
{
    Bumps bumps;
    bumps.normal = direction_or(vec3(-slope_x, -slope_y, 1.0f), vec3(0.0f, 0.0f, 1.0f));
    bumps.spread = spread;
    bumps.mean_length = bumps_length(spread);
    return bumps;
}

// The sum of two layers of bumps: slopes add as those of summed heights do, and so do their variances.
TERM Bumps bumps_add(Bumps a, Bumps b)
{
    Bumps sum;
    sum.normal = vec3(a.normal.x * b.normal.z + b.normal.x * a.normal.z, a.normal.y * b.normal.z + b.normal.y * a.normal.z,
                      a.normal.z * b.normal.z);
    sum.spread = vec3_add(a.spread, b.spread);
    sum.mean_length = a.mean_length * b.mean_length;
    return sum;
}

// Roughness 1 - g of a surface with these bumps; `view` is in tangent space.
TERM float bumps_roughness(int minify, float rough, Bumps bumps, vec3 view)
{
    float variance = detail_variance(bumps.mean_length), square = view.x * view.x + view.y * view.y;
    float share = square > 1e-12f ? view.x * view.x / square : 0.5f;
    float both = square > 1e-12f ? 2.0f * bumps.spread.z * view.x * view.y / square : 0.0f;
    float along = bumps.spread.x * share + bumps.spread.y * (1.0f - share) + both;
    float across = bumps.spread.x * (1.0f - share) + bumps.spread.y * share - both;
    return minify == MINIFY_TOKSVIG ? detail_widened(rough, variance, variance, 1.0f)
           : minify == MINIFY_LEAN  ? detail_widened(rough, along, across, abs(view.z))
                                    : rough;
}

// The sum of maps and bumps in squared widths of facets along u and v, and to the product of both: a symmetric matrix.
// `own_rough` is the roughness of the material, `rough` with its maps and yarns.
TERM vec3 bumps_widening(int minify, float own_rough, float rough, Bumps bumps)
{
    float variance = minify == MINIFY_TOKSVIG ? detail_variance(bumps.mean_length) : 0.0f;
    bool is_lean = minify == MINIFY_LEAN;
    return vec3(detail_widening(own_rough, rough, is_lean ? bumps.spread.x : variance),
                detail_widening(own_rough, rough, is_lean ? bumps.spread.y : variance),
                is_lean ? 2.0f * bumps.spread.z : 0.0f);
}

// The normal with bumps, unit: the square patch approximation [Wimmer n.d.], for a multiple of (-h_x, -h_y, 1). MikkTSpace:
// the interpolated frame is used as it is, and normalised once at the end.
TERM vec3 bent_normal(vec3 mapped, vec3 normal, vec3 tangent, float handedness, vec3 fallback)
{
    vec3 bitangent = vec3_scale(cross(normal, tangent), handedness);
    vec3 sum = vec3_add(vec3_scale(tangent, mapped.x), vec3_scale(bitangent, mapped.y));
    return direction_or(vec3_add(vec3_scale(normal, mapped.z), sum), fallback);
}

// A direction in the tangent space of the front.
TERM vec3 into_tangent_space(vec3 d, vec3 smooth_normal, vec3 tangent, float handedness)
{
    vec3 along = vec3_subtract(tangent, vec3_scale(smooth_normal, dot(smooth_normal, tangent)));
    vec3 t = direction_or(along, vec3(0.0f, 0.0f, 0.0f));
    vec3 b = vec3_scale(cross(smooth_normal, t), handedness < 0.0f ? -1.0f : 1.0f);
    return vec3(dot(d, t), dot(d, b), dot(d, smooth_normal));
}

// The shading normal that no longer turns away from the viewer (detail_facing).
TERM vec3 facing_normal(vec3 n, vec3 viewer)
{
    float lift = detail_facing(dot(n, viewer));
    vec3 facing = direction_or(vec3_add(n, vec3_scale(viewer, lift)), n);
    return vec3(lift > 0.0f ? facing.x : n.x, lift > 0.0f ? facing.y : n.y, lift > 0.0f ? facing.z : n.z);
}
