// Look-ups in an environment map by a world direction (env/layout.h). The layout is #defined: CUBE, SPHERE, PARABOLOID,
// LATLONG or OCTAHEDRAL; MATRIX: paraboloids by projective matrices; HALF 0 or 1: only the light of that map, which another
// pass adds to that of the other one.
layout(location = 5) uniform mat3 turn; // world to picture

#ifdef CUBE
layout(binding = 6) uniform samplerCubeArray maps;

vec3 look_up(vec3 direction, int slot, float level)
{
    return textureLod(maps, vec4(turn * direction, float(slot)), level).rgb;
}

#elif defined(SPHERE)
layout(binding = 6) uniform sampler2DArray maps;

// The half vector of d and +Z, by whichever of two forms does not cancel.
vec3 look_up(vec3 direction, int slot, float level)
{
    vec3 d = turn * direction;
    float across = max(length(d.xy), 1e-20);
    vec2 point = d.z > 0.0 ? d.xy * inversesqrt(2.0 * (1.0 + d.z)) : d.xy * (sqrt(0.5 * (1.0 - d.z)) / across);
    return textureLod(maps, vec3(0.5 + 0.5 * point.x, 0.5 - 0.5 * point.y, float(slot)), level).rgb;
}

#elif defined(PARABOLOID)
layout(binding = 6) uniform sampler2DArray maps;
#ifdef MATRIX
layout(location = 40) uniform mat4 front_matrix; // eq. 7: P S M^-1, then [-1, 1] to [0, 1]
layout(location = 41) uniform mat4 back_matrix;

// Both maps are looked up; the alpha of the first one selects between them.
vec3 look_up(vec3 direction, int slot, float level)
{
    vec4 front = front_matrix * vec4(direction, 1.0), back = back_matrix * vec4(direction, 1.0);
    vec2 front_place = front.xy / max(front.w, 1e-6), back_place = back.xy / max(back.w, 1e-6);
    vec3 front_layer = vec3(front_place, float(2 * slot));
    bool in_front = textureLod(maps, front_layer, 0.0).a > 0.5;
#ifdef HALF
    if (in_front == (HALF == 1))
        return vec3(0.0);
#endif
    return textureLod(maps, in_front ? front_layer : vec3(back_place, float(2 * slot + 1)), level).rgb;
}
#else
vec3 look_up(vec3 direction, int slot, float level)
{
    vec3 d = turn * direction;
    bool behind = d.z < 0.0;
    vec2 point = d.xy / (1.0 + abs(d.z));
    point.x = behind ? -point.x : point.x;
    float layer = float(2 * slot + (behind ? 1 : 0));
    return textureLod(maps, vec3(0.5 + 0.5 * point.x, 0.5 - 0.5 * point.y, layer), level).rgb;
}
#endif

#elif defined(LATLONG)
layout(binding = 6) uniform sampler2DArray maps;

vec3 look_up(vec3 direction, int slot, float level)
{
    return textureLod(maps, vec3(latlong_place(turn * direction), float(slot)), level).rgb;
}

#elif defined(OCTAHEDRAL)
layout(binding = 6) uniform sampler2DArray maps;

// A step across a side of the unfolded octahedron lands on the same side, mirrored about its centre.
vec3 octahedral_texel(ivec2 texel, int side, int slot, int level)
{
    bool over_x = texel.x < 0 || texel.x >= side, over_y = texel.y < 0 || texel.y >= side;
    ivec2 inside = clamp(texel, ivec2(0), ivec2(side - 1));
    inside.y = over_x ? side - 1 - inside.y : inside.y;
    inside.x = over_y ? side - 1 - inside.x : inside.x;
    return texelFetch(maps, ivec3(inside, slot), level).rgb;
}

vec3 octahedral_level(vec2 place, int slot, int level)
{
    int side = max(textureSize(maps, 0).x >> level, 1);
    vec2 texel = place * float(side) - 0.5;
    ivec2 first = ivec2(floor(texel));
    vec2 over = texel - vec2(first);
    vec3 upper = mix(octahedral_texel(first, side, slot, level), octahedral_texel(first + ivec2(1, 0), side, slot, level),
                     over.x);
    vec3 lower = mix(octahedral_texel(first + ivec2(0, 1), side, slot, level),
                     octahedral_texel(first + ivec2(1, 1), side, slot, level), over.x);
    return mix(upper, lower, over.y);
}

vec3 look_up(vec3 direction, int slot, float level)
{
    vec2 place = octahedral_place(turn * direction);
    int last = textureQueryLevels(maps) - 1, whole = min(int(level), last);
    vec3 light = octahedral_level(place, slot, whole);
#ifdef MINIFY
    light = mix(light, octahedral_level(place, slot, min(whole + 1, last)), clamp(level - float(whole), 0.0, 1.0));
#endif
    return light;
}
#endif
