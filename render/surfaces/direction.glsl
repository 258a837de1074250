// A direction that is never NaN: vectors too short to have one become `fallback`.
vec3 direction_or(vec3 v, vec3 fallback)
{
    float square = dot(v, v);
    return square > 1e-30 ? v * inversesqrt(square) : fallback;
}
