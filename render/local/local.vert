#version 450 core
// Vertices of surfaces lit by a lamp, with the values that the shading option computes per vertex. GOURAUD: the light
// itself. COSINES: the inputs of the model. VECTORS: unit vectors to interpolate, in tangent space with TANGENT_SPACE.
// TEXELS: drawn over its UVs.
#define VERTEX_STAGE
#include "gloss.glsl"
#include "terms.glsl"

// The same uniforms as in surface.glsl, whose textures are not needed here.
layout(location = 1) uniform vec3 material_specular;
layout(location = 2) uniform vec4 material_scalars;

#ifdef TEXELS
layout(location = 99) uniform vec4 chart; // offset, factor on UV
#endif

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 vertex_normal;
layout(location = 2) in vec4 vertex_tangent;
layout(location = 3) in vec2 vertex_uv;

invariant gl_Position;
out vec3 point;
out vec3 normal;
out vec4 tangent;
out vec2 uv;
#if defined(GOURAUD)
out vec4 lit_front, lit_back; // gloss; diffuse
#elif defined(COSINES)
out vec4 cosines_normal; // of the front face: n.l, n.v, n.h; h.l
out vec4 cosines_plane;  // t.h, b.h, t.l, t.v
out vec2 cosines_across; // b.l, b.v
out float cosine_lamp;   // l.v
#elif defined(VECTORS)
out vec3 to_lamp, to_eye, halfway;
#endif
#ifdef DETAIL_EYE_SPACE
#define DETAIL_VERTICES
#include "detail_vertex.glsl"
#endif

#if defined(GOURAUD) || defined(COSINES) || defined(VECTORS)
const vec3 UP = vec3(0.0, 1.0, 0.0);

void vectors_at(vec3 place, out vec3 l, out vec3 v, out vec3 h)
{
#ifdef MATRIX
    l = constant_lamp;
    v = constant_eye;
#else
    l = towards_lamp(lamp, place, UP);
    v = direction_or(eye - place, UP);
#endif
    h = direction_or(l + v, l);
}
#endif

#ifdef GOURAUD
vec4 lit(vec3 n, float side, vec3 l, vec3 v, vec3 h)
{
    Frame frame = frame_of(n, vertex_tangent.xyz, side);
    Cosines c = cosines_of(frame, l, v, h);
    c.hand = side * (vertex_tangent.w < 0.0 ? -1.0 : 1.0);
    vec3 light = gloss(c, material_specular, lobe_exponent(material_scalars.x), vec3(0.0));
#ifdef STEP
    float shown = c.a > 0.0 ? 1.0 : 0.0;
#else
    float shown = self_shadow_ramp(c.a);
#endif
    return shown * vec4(light, matt(c));
}
#endif

void main()
{
    point = position;
    normal = vertex_normal;
    tangent = vertex_tangent;
#ifdef DETAIL_EYE_SPACE
    set_offsets(vertex_normal);
#endif
    uv = vertex_uv;
#ifdef TEXELS
    gl_Position = vec4(2.0 * (chart.xy + uv * chart.zw) - 1.0, 0.0, 1.0);
#else
    gl_Position = view_projection * vec4(position, 1.0);
#endif
#if defined(GOURAUD) || defined(COSINES) || defined(VECTORS)
    vec3 l, v, h;
    vec3 n = direction_or(vertex_normal, UP);
    vectors_at(position, l, v, h);
#endif
#if defined(GOURAUD)
    lit_front = lit(n, 1.0, l, v, h);
    lit_back = lit(-n, -1.0, l, v, h);
#elif defined(COSINES)
    Frame frame = frame_of(n, vertex_tangent.xyz, 1.0);
    cosines_normal = vec4(dot(n, l), dot(n, v), dot(n, h), dot(h, l));
    cosines_plane = vec4(dot(frame.t, h), dot(frame.b, h), dot(frame.t, l), dot(frame.t, v));
    cosines_across = vec2(dot(frame.b, l), dot(frame.b, v));
    cosine_lamp = dot(l, v);
#elif defined(VECTORS)
#ifdef TANGENT_SPACE
    vec3 t = thread_direction(n, vertex_tangent.xyz, 1.0, 0.0);
    mat3 into = transpose(mat3(t, (vertex_tangent.w < 0.0 ? -1.0 : 1.0) * cross(n, t), n));
    l = into * l;
    v = into * v;
    h = into * h;
#endif
    to_lamp = l;
    to_eye = v;
    halfway = h;
#endif
}
