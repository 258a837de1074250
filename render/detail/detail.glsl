// Fabric detail: where a height field is visible and what it shadows; the GLSL counterpart of field.c. DETAIL_MODE,
// DETAIL_SHADOW and DETAIL_MINIFY are the numbers of the enums in options.h. The uniforms are declared in surface.glsl.
// Tangent space: x along u, y along minus v, z outwards. The back face sees the same sheet from below, with its heights
// negated.
#include "surface.glsl"
#include "bumps_terms.glsl"

#ifndef DETAIL_MODE
#define DETAIL_MODE 0
#define DETAIL_SHADOW 0
#define DETAIL_MINIFY 0
#endif
#define DETAIL_BLINN 1
#define DETAIL_EYE 3
#define DETAIL_PARALLAX 4
#define DETAIL_PARALLAX_LIMITED 5
#define DETAIL_RELIEF 6
// Normals follow the derivatives of the surface, which slopes then need not.
#define DETAIL_DERIVED (DETAIL_MODE == DETAIL_BLINN || DETAIL_MODE == DETAIL_EYE)
#define DETAIL_SHADOW_HORIZON 1
#define DETAIL_SHADOW_RELIEF 2

// Bits of detail_flags: the maps that the part has, and the axes along which its field does not repeat.
const int DETAIL_OWN_MOMENTS = 1, DETAIL_WEAVE_MOMENTS = 2, DETAIL_HEIGHTS = 4, DETAIL_HORIZONS = 8;
const int DETAIL_CLAMP_U = 16, DETAIL_CLAMP_V = 32;

layout(binding = 8) uniform sampler2D detail_heights;       // m
layout(binding = 9) uniform sampler2DArray detail_horizons; // sines at DETAIL_ANGLES angles, four per layer; then those of the back
layout(binding = 10) uniform sampler2DArray detail_own_moments; // of the normal map: (x, y), (x^2, y^2), (x y, 0)
layout(binding = 11) uniform sampler2DArray detail_weave_moments;
layout(binding = 12) uniform sampler2D detail_cones; // of the front and of the back

bool has_detail(int map)
{
    return (detail_flags & map) != 0;
}

// The visible point of a surface: displaced UV, height there on the visible side, and whether nothing is visible: the
// point lies beyond the end of the field, or the view ray leaves the field. `tilt` is added to the front's normal in
// tangent space where the surface turns on the way.
struct DetailPlace {
    vec2 uv;
    float height;
    bool outside;
    vec2 tilt;
};

vec2 detail_field_uv(vec2 uv)
{
    vec3 point = vec3(uv, 1.0);
    return vec2(dot(detail_rows[0], point), dot(detail_rows[1], point));
}

// Samples a layer of maps of the field at its level of detail.
vec2 detail_layer(sampler2DArray map, vec2 uv, float layer)
{
#if defined(VERTEX_STAGE)
    return textureLod(map, vec3(detail_field_uv(uv), layer), 0.0).xy;
#elif defined(DETAIL_SHIFTED)
    mat2 turned = transpose(mat2(detail_rows[0].xy, detail_rows[1].xy));
    return textureGrad(map, vec3(detail_field_uv(uv), layer), turned * unmoved_across, turned * unmoved_down).xy;
#else
    return texture(map, vec3(detail_field_uv(uv), layer)).xy;
#endif
}

#ifndef VERTEX_STAGE
// Orthonormal tangent, bitangent and normal of the front as columns. `v * frame` is v in tangent space.
mat3 detail_frame(vec3 smooth_normal, vec4 tangent)
{
    vec3 along = tangent.xyz - smooth_normal * dot(smooth_normal, tangent.xyz);
    float square = dot(along, along);
    vec3 t = square > 1e-30 ? along * inversesqrt(square) : vec3(0.0);
    return mat3(t, (tangent.w < 0.0 ? -1.0 : 1.0) * cross(smooth_normal, t), smooth_normal);
}

#if DETAIL_MODE >= DETAIL_PARALLAX || DETAIL_SHADOW == DETAIL_SHADOW_RELIEF
// The mip level of the field at which texels have the size of a sample, from the UV before displacement.
float detail_level(vec2 uv)
{
    vec2 place = detail_field_uv(uv) * vec2(textureSize(detail_heights, 0));
    vec2 across = dFdx(place), down = dFdy(place);
    return texel_level(dot(across, across), dot(down, down));
}

// Clearance of a ray at height `rise` (m over the mesh) above the field. `along` is the UV per metre of height.
float detail_clearance(vec2 uv, vec2 along, float rise, float from, float side, float level)
{
    vec2 place = detail_field_uv(uv + (rise - from) * along);
    return rise - side * textureLod(detail_heights, place, level).r;
}

// UV per metre of height, along a direction of tangent space.
vec2 detail_along(vec3 direction, float side)
{
    return vec2(direction.x, -direction.y) * (detail_slant(side * direction.z) / detail_range.z);
}

vec2 detail_bounds(float side)
{
    return side > 0.0 ? detail_range.xy : -detail_range.yx;
}
#endif

#ifdef DETAIL_CURVED
// The turn of the front's normal on the way along a direction of the tangent plane, per metre of it: the change of
// interpolated normals within the triangle, in tangent space. Point and normal come as they are interpolated, linear
// over the triangle, for at an outline the neighbours of a pixel lie far beyond it.
vec2 detail_turn(vec3 point, vec3 normal, mat3 frame, vec2 direction)
{
    vec3 along = frame * vec3(direction, 0.0), across = dFdx(point), down = dFdy(point);
    float aa = dot(across, across), ad = dot(across, down), dd = dot(down, down), area = aa * dd - ad * ad;
    if (!(area > 1e-6 * aa * dd))
        return vec2(0.0);
    float a = dot(across, along), d = dot(down, along);
    vec3 turn = ((dd * a - ad * d) * dFdx(normal) + (aa * d - ad * a) * dFdy(normal)) / area;
    return (turn * frame).xy / max(length(normal), 0.1);
}

// Width of a pixel at a point, across the view, m.
float detail_pixel_m(vec3 point, vec3 eye)
{
    vec3 v = normalize(eye - point), across = dFdx(point), down = dFdy(point);
    across -= v * dot(v, across);
    down -= v * dot(v, down);
    return sqrt(max(dot(across, across), dot(down, down)));
}

// The share of a step of UV to a neighbouring pixel that bumps take which are turned towards the viewer: they are at
// most twice as long as they are wide.
float detail_shortened(vec3 step, vec3 v)
{
    float square = dot(step, step), along = dot(v, step);
    return square > 0.0 ? min(2.0 * sqrt(max(1.0 - along * along / square, 0.0)), 1.0) : 1.0;
}

// The mip level of the field for bumps that face the viewer, as those at an outline do, where the mesh does not.
float detail_facing_level(float pixel_m)
{
    vec2 size = vec2(textureSize(detail_heights, 0)) / detail_range.z;
    vec2 u = vec2(detail_rows[0].x, detail_rows[1].x) * size, v = vec2(detail_rows[0].y, detail_rows[1].y) * size;
    return texel_level(dot(u, u) * pixel_m * pixel_m, dot(v, v) * pixel_m * pixel_m);
}

// A view ray over a curved surface.
struct DetailCurve {
    vec2 uv, view, turn; // on the mesh; tangential part of the direction to the eye; how the normal turns along it
    float z, curvature, side, level;
};

// The way along the surface to below the ray. On a circle of radius r it is r asin(x / (r + h)): its first three
// powers, where x / r is how the normal turns.
vec2 detail_curve_way(DetailCurve ray, float distance)
{
    float height = detail_over_circle(ray.z, ray.curvature, distance);
    float bent = distance * distance * ray.side * dot(ray.turn, ray.view) / 6.0 - height;
    return distance * (ray.view + ray.side * bent * ray.turn);
}

vec2 detail_curve_uv(DetailCurve ray, float distance)
{
    vec2 way = detail_curve_way(ray, distance);
    return ray.uv + vec2(way.x, -way.y) / detail_range.z;
}

float detail_curve_clearance(DetailCurve ray, float distance)
{
    float stands = ray.side * textureLod(detail_heights, detail_field_uv(detail_curve_uv(ray, distance)), ray.level).r;
    return detail_over_circle(ray.z, ray.curvature, distance) - stands;
}

// Relief over the circle that touches the surface along the view: equal steps from the top of the field until the ray
// is below it, then bisection. A ray that leaves at the top hits nothing. Nor does one to the back of cloth that does
// not come from above the field there: it came through the front, which it did not hit.
DetailPlace detail_curved(vec2 uv, vec3 view, float side, float level, vec2 turn)
{
    vec2 bounds = detail_bounds(side);
    float k = side * dot(turn, view.xy) / max(dot(view.xy, view.xy), 1e-6);
    float z = max(side * view.z, 0.05);
    DetailCurve ray = DetailCurve(uv, view.xy, turn, z, k, side, level);
    bool passes = k > 0.0 && z * z + 2.0 * k * bounds.x < 0.0, starts_below = z * z + 2.0 * k * bounds.y < 0.0;
    float above = starts_below ? -z / k : detail_circle_distance(z, k, bounds.y);
    float last = passes ? -2.0 * z / k - above : detail_circle_distance(z, k, bounds.x);
    float first = above, below = above, over = detail_curve_clearance(ray, above), under = over;
    for (int i = 1; i <= detail_steps.x && under > 0.0; i++) {
        above = below;
        over = under;
        below = mix(first, last, float(i) / float(detail_steps.x));
        under = detail_curve_clearance(ray, below);
    }
    bool misses = (passes && under > 0.0) || (starts_below && side < 0.0);
    for (int i = 0; i < detail_steps.y; i++) {
        float middle = 0.5 * (above + below), left = detail_curve_clearance(ray, middle);
        bool is_under = left <= 0.0;
        above = is_under ? above : middle;
        over = is_under ? over : left;
        below = is_under ? middle : below;
        under = is_under ? left : under;
    }
    float span = over - under, hit = span > 0.0 ? above + (below - above) * min(over / span, 1.0) : above;
    return DetailPlace(detail_curve_uv(ray, hit), detail_over_circle(z, k, hit), misses, hit * turn);
}
#endif

#if DETAIL_MODE == DETAIL_RELIEF && !defined(DETAIL_CURVED)
// The height at which a ray through uv on the mesh hits the field, as in tl_field_relief.
float detail_hit(vec2 uv, vec2 along, float side, float level)
{
    int levels = textureQueryLevels(detail_heights), coarse = min(int(level), levels - 1);
    float lod = float(max(coarse - levels + textureQueryLevels(detail_cones), 0));
    vec2 bounds = detail_bounds(side), texels = vec2(textureSize(detail_heights, coarse));
    mat2 turned = transpose(mat2(detail_rows[0].xy, detail_rows[1].xy));
    vec2 speed = -(turned * along) * texels;
    float slant = (bounds.y - bounds.x) * exp2(float(coarse)) * length(speed);
    float above = bounds.y, over = detail_clearance(uv, along, above, 0.0, side, level), below = above, under = over;
    for (int left = detail_steps.x; left > 0 && under > 0.0; left--) {
        above = below;
        over = under;
        vec2 place = detail_field_uv(uv + above * along), at = place * texels - 0.5;
        vec2 cones = textureLod(detail_cones, place, lod).rg;
        float stride = over * detail_cone_step(side > 0.0 ? cones.r : cones.g, slant);
        stride = max(stride, min(detail_to_line(at.x, speed.x), detail_to_line(at.y, speed.y)));
        below = max(above - max(stride, detail_due(above - bounds.x, float(left))), bounds.x);
        under = detail_clearance(uv, along, below, 0.0, side, level);
    }
    for (int i = 0; i < detail_steps.y; i++) {
        float middle = 0.5 * (above + below), left = detail_clearance(uv, along, middle, 0.0, side, level);
        bool is_under = left <= 0.0;
        above = is_under ? above : middle;
        over = is_under ? over : left;
        below = is_under ? middle : below;
        under = is_under ? left : under;
    }
    float span = over - under;
    return span > 0.0 ? above + (below - above) * min(over / span, 1.0) : above;
}
#endif

// For relief that bends: the turn of the normal along the view, and the width of a pixel.
vec3 detail_bend(vec3 point, vec3 normal, mat3 frame, vec3 view, vec3 eye)
{
#ifdef DETAIL_CURVED
    return vec3(detail_turn(point, normal, frame, view.xy), detail_pixel_m(point, eye));
#else
    return vec3(0.0);
#endif
}

// The smooth normal below the visible point.
vec3 detail_turned(mat3 frame, vec3 smooth_normal, DetailPlace place)
{
    return normalize(smooth_normal + frame * vec3(place.tilt, 0.0));
}

// The visible point. `view` points to the eye in the tangent space of the front; `side` is -1 for a back face; `bend`
// is that of detail_bend.
DetailPlace detail_place(vec2 uv, vec3 view, float side, vec3 bend)
{
    DetailPlace place = DetailPlace(uv, 0.0, false, vec2(0.0));
#if DETAIL_MODE >= DETAIL_PARALLAX || DETAIL_SHADOW == DETAIL_SHADOW_RELIEF
    if (has_detail(DETAIL_HEIGHTS)) {
        float level = detail_level(uv);
        float height = side * textureLod(detail_heights, detail_field_uv(uv), level).r;
#if DETAIL_MODE == DETAIL_PARALLAX
        place.uv += height * detail_along(view, side);
#elif DETAIL_MODE == DETAIL_PARALLAX_LIMITED
        place.uv += height * vec2(view.x, -view.y) / detail_range.z;
#elif defined(DETAIL_CURVED)
        place = detail_curved(uv, view, side, detail_facing_level(bend.z), bend.xy);
        height = place.height;
#elif DETAIL_MODE == DETAIL_RELIEF
        vec2 along = detail_along(view, side);
        height = detail_hit(uv, along, side, level);
        place.uv += height * along;
#endif
        place.height = height;
#ifdef DETAIL_CLIPPED
        vec2 at = detail_field_uv(place.uv), beyond = abs(at - 0.5);
        place.outside = place.outside || (has_detail(DETAIL_CLAMP_U) && !(beyond.x <= 0.5)) || (has_detail(DETAIL_CLAMP_V) && !(beyond.y <= 0.5));
#endif
    }
#endif
    return place;
}

#if DETAIL_SHADOW != 0
const float DETAIL_STEP = 6.28318531 / float(DETAIL_ANGLES);

struct DetailHorizon {
    vec4 sines[DETAIL_ANGLES / 4]; // at angles k DETAIL_STEP from the tangent
};

// The coordinates at which horizons are read and their derivatives.
struct DetailLookup {
    vec2 place, across, down;
    int layer; // first layer of the visible side
};

DetailLookup detail_lookup(vec2 uv, float side, vec2 across, vec2 down)
{
    mat2 turned = transpose(mat2(detail_rows[0].xy, detail_rows[1].xy));
    return DetailLookup(detail_field_uv(uv), turned * across, turned * down, side > 0.0 ? 0 : DETAIL_ANGLES / 4);
}

vec4 detail_horizon_layer(DetailLookup lookup, int layer)
{
    return textureGrad(detail_horizons, vec3(lookup.place, float(lookup.layer + layer)), lookup.across, lookup.down);
}

DetailHorizon detail_horizon(DetailLookup lookup)
{
    DetailHorizon horizon;
    for (int i = 0; i < DETAIL_ANGLES / 4; i++)
        horizon.sines[i] = detail_horizon_layer(lookup, i);
    return horizon;
}

// Index of the angle before a direction; `turned` is the angle from there to the direction.
int detail_angle(vec2 toward, out float turned)
{
    float turn = dot(toward, toward) > 0.0 ? atan(toward.y, toward.x) / DETAIL_STEP + float(DETAIL_ANGLES) : 0.0;
    turned = fract(turn) * DETAIL_STEP;
    return int(turn) % DETAIL_ANGLES;
}

float detail_horizon_sine(DetailHorizon horizon, vec2 toward)
{
    float turned;
    int first = detail_angle(toward, turned), second = (first + 1) % DETAIL_ANGLES;
    return detail_between(horizon.sines[first / 4][first % 4], horizon.sines[second / 4][second % 4], turned, DETAIL_STEP);
}

// The same for a single direction, reading two layers only.
float detail_horizon_toward(DetailLookup lookup, vec2 toward)
{
    float turned;
    int first = detail_angle(toward, turned), second = (first + 1) % DETAIL_ANGLES;
    return detail_between(detail_horizon_layer(lookup, first / 4)[first % 4],
                          detail_horizon_layer(lookup, second / 4)[second % 4], turned, DETAIL_STEP);
}

// The fraction of the light of a uniform sky that reaches a point over its horizon; `normal` is in tangent space, on
// the visible side.
float detail_ambient(DetailHorizon horizon, vec3 normal)
{
    float seen = 0.0, open = 0.0;
    for (int k = 0; k < DETAIL_ANGLES; k++) {
        float angle = DETAIL_STEP * float(k), a = normal.x * cos(angle) + normal.y * sin(angle);
        seen += detail_slice_over(a, normal.z, horizon.sines[k / 4][k % 4]);
        open += detail_slice_over(a, normal.z, 0.0);
    }
    return open > 0.0 ? seen / open : 1.0;
}

// The fraction of a lobe about `mirror` (tangent space, visible side) above the horizon.
float detail_gloss_seen(DetailHorizon horizon, vec3 mirror, float rough)
{
    float width = max(sqrt(rough), 0.04);
    return clamp(0.5 + 0.5 * (mirror.z - detail_horizon_sine(horizon, mirror.xy)) / width + 0.5 * min(width, 1.0), 0.0, 1.0);
}
#endif

// The fraction of a lamp's light that is not shadowed by the surface's own bumps. `light` points to the lamp in the
// tangent space of the front; `across` and `down` are the derivatives of the UV before displacement.
float detail_shadow(DetailPlace place, vec3 light, float side, vec2 across, vec2 down)
{
#if DETAIL_SHADOW == DETAIL_SHADOW_HORIZON
    if (has_detail(DETAIL_HORIZONS)) {
        float horizon = detail_horizon_toward(detail_lookup(place.uv, side, across, down), light.xy);
        return detail_over_horizon(side * light.z, horizon, fwidth(side * light.z - horizon));
    }
#elif DETAIL_SHADOW == DETAIL_SHADOW_RELIEF
    if (has_detail(DETAIL_HEIGHTS)) {
        vec2 bounds = detail_bounds(side);
        vec2 along = vec2(light.x, -light.y) * (detail_climb(side * light.z) / detail_range.z); // UV per metre of height
        vec2 texels = vec2(textureSize(detail_heights, 0));
        mat2 turned = transpose(mat2(detail_rows[0].xy, detail_rows[1].xy));
        vec2 dx = turned * across * texels, dy = turned * down * texels;
        float level = texel_level(dot(dx, dx), dot(dy, dy));
        float stands = side * textureLod(detail_heights, detail_field_uv(place.uv), level).r;
        float from = stands + DETAIL_LIFT * (bounds.y - bounds.x);
        float rise = min(bounds.y - from, DETAIL_REACH / max(length(turned * along), 1e-6));
        bool lit = side * light.z > 0.0;
        for (int i = 1; i <= detail_steps.x && lit && rise > 0.0; i++) {
            float height = from + rise * float(i) / float(detail_steps.x);
            lit = detail_clearance(place.uv, along, height, stands, side, level) >= 0.0;
        }
        return lit ? 1.0 : 0.0;
    }
#endif
    return 1.0;
}

#endif

#ifndef VERTEX_STAGE
// The change of a point with its UV within a triangle: the derivatives of the point by u and by v, in metres; false
// where there are none.
bool detail_derivatives(vec3 point, vec2 uv, out vec3 p_u, out vec3 p_v)
{
    vec3 point_x = dFdx(point), point_y = dFdy(point);
    vec2 uv_x = dFdx(uv), uv_y = dFdy(uv);
    float determinant = uv_x.x * uv_y.y - uv_x.y * uv_y.x;
    bool is_known = abs(determinant) > 1e-20;
    p_u = is_known ? (point_x * uv_y.y - point_y * uv_x.y) / determinant : vec3(0.0);
    p_v = is_known ? (point_y * uv_x.x - point_x * uv_y.x) / determinant : vec3(0.0);
    return is_known;
}

// The factors on a weave's slopes along u and v where cloth is stretched.
vec2 detail_slope_factors(vec3 point, vec2 uv)
{
    vec3 p_u, p_v;
    detail_derivatives(point, uv, p_u, p_v);
    return vec2(detail_slope_factor(length(p_u), detail_range.z), detail_slope_factor(length(p_v), detail_range.z));
}

#if DETAIL_DERIVED
#include "detail_vertex.glsl"

// Blinn's N' = N + h_u (N_n x P_v) + h_v (P_u x N_n), with screen-space derivatives of the triangle or those of its
// vertices. `mapped` has slopes per metre of the nominal size of a UV unit.
vec3 detail_derived(vec3 mapped, vec3 normal, vec3 point, vec2 uv)
{
    vec2 h = mapped.xy / max(mapped.z, 1e-3) * detail_range.z * vec2(-1.0, 1.0); // v runs down
#if DETAIL_MODE == DETAIL_EYE
    vec3 sum = (area_normal + h.x * offset_u + h.y * offset_v) * into_eye_space; // back into the world, where light is
#else
    vec3 p_u, p_v, offset_u, offset_v, area_normal;
    detail_derivatives(point, uv, p_u, p_v);
    detail_offsets(normal, p_u, p_v, offset_u, offset_v, area_normal);
    vec3 sum = area_normal + h.x * offset_u + h.y * offset_v;
#endif
    float square = dot(sum, sum);
    return square > 1e-30 && square < 1e30 ? sum * inversesqrt(square) : normal;
}
#endif
#endif
