// Vertices of all surfaces, one after the other.
layout(std430, binding = CARD_POSITIONS) restrict readonly buffer Positions
{
    float positions[];
};
layout(std430, binding = CARD_NORMALS) restrict readonly buffer Normals
{
    float normals[];
};
layout(std430, binding = CARD_INDICES) restrict readonly buffer Indices
{
    uint indices[];
};

vec3 position_of(uint v)
{
    return vec3(positions[3u * v], positions[3u * v + 1u], positions[3u * v + 2u]);
}

vec3 normal_of(uint v)
{
    return vec3(normals[3u * v], normals[3u * v + 1u], normals[3u * v + 2u]);
}

uvec3 corners_of(uint triangle)
{
    return uvec3(indices[3u * triangle], indices[3u * triangle + 1u], indices[3u * triangle + 2u]);
}
