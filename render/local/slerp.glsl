// Vectors that turn evenly from corner to corner of a triangle [Schroecker 2002, eq. 3]: along the edge of the last two, then
// towards the first. On every edge that is the equation itself, so that neighbours meet; hardware interpolates along spans.
layout(location = 104) uniform uint first_corner; // of the part, in the numbers of the surface's corners
layout(std430, binding = 9) readonly buffer CornerNumbers
{
    uint corner_numbers[];
};
layout(std430, binding = 10) readonly buffer CornerPlaces
{
    float corner_places[];
};
layout(std430, binding = 11) readonly buffer CornerNormals
{
    float corner_normals[];
};

uint corner_entry(uint corner)
{
    return 3u * corner_numbers[first_corner + 3u * uint(gl_PrimitiveID) + corner];
}

vec3 corner_place(uint corner)
{
    uint i = corner_entry(corner);
    return vec3(corner_places[i], corner_places[i + 1u], corner_places[i + 2u]);
}

vec3 corner_normal(uint corner)
{
    uint i = corner_entry(corner);
    return direction_or(vec3(corner_normals[i], corner_normals[i + 1u], corner_normals[i + 2u]), vec3(0.0, 1.0, 0.0));
}

// The shares of the corners at a point of their plane.
vec3 corner_shares(vec3 point)
{
    vec3 a = corner_place(0u) - point, b = corner_place(1u) - point, c = corner_place(2u) - point;
    vec3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b), whole = bc + ca + ab;
    vec3 shares = max(vec3(dot(bc, whole), dot(ca, whole), dot(ab, whole)), 0.0);
    float sum = shares.x + shares.y + shares.z;
    return sum > 0.0 ? shares / sum : vec3(1.0, 0.0, 0.0);
}

vec3 slerp(vec3 from, vec3 to, float t)
{
    float sine = length(cross(from, to)), angle = atan(sine, dot(from, to));
    if (sine < 1e-3)
        return direction_or(mix(from, to, t), from);
    return (sin((1.0 - t) * angle) * from + sin(t * angle) * to) / sine;
}

vec3 slerped(vec3 corners[3], vec3 shares)
{
    float rest = shares.y + shares.z;
    return slerp(corners[0], slerp(corners[1], corners[2], rest > 0.0 ? shares.z / rest : 0.0), rest);
}

vec3 slerped_normal(vec3 point)
{
    return slerped(vec3[](corner_normal(0u), corner_normal(1u), corner_normal(2u)), corner_shares(point));
}

void slerped_vectors(vec3 point, out vec3 l, out vec3 v, out vec3 h)
{
    const vec3 up = vec3(0.0, 1.0, 0.0);
    vec3 shares = corner_shares(point), ls[3], vs[3], hs[3];
    for (int i = 0; i < 3; i++) {
        vec3 place = corner_place(uint(i));
        ls[i] = towards_lamp(lamp, place, up);
        vs[i] = direction_or(eye - place, up);
        hs[i] = direction_or(ls[i] + vs[i], ls[i]);
    }
    l = slerped(ls, shares);
    v = slerped(vs, shares);
    h = slerped(hs, shares);
}
