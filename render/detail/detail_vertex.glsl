// The vectors of Blinn's form [Wimmer n.d., Basic Algorithm (Eye Space)], for the fragments of a triangle, or at its
// vertices from where they are interpolated.

// B1 = N_n x P_v, B2 = P_u x N_n and N = |P_u x P_v| N_n, turned to the normal's side where UVs are mirrored; zeros where
// the UVs span no area.
void detail_offsets(vec3 normal, vec3 p_u, vec3 p_v, out vec3 offset_u, out vec3 offset_v, out vec3 area_normal)
{
    float area = dot(normal, cross(p_u, p_v)), turned = sign(area);
    offset_u = turned * cross(normal, p_v);
    offset_v = turned * cross(p_u, normal);
    area_normal = abs(area) * normal;
}

#ifdef DETAIL_EYE_SPACE
#ifdef DETAIL_VERTICES
layout(location = 4) in vec3 vertex_p_u; // means of the triangles around a vertex
layout(location = 5) in vec3 vertex_p_v;
layout(location = 25) uniform mat3 into_eye_space;
out vec3 offset_u, offset_v, area_normal;

void set_offsets(vec3 normal)
{
    detail_offsets(into_eye_space * normal, into_eye_space * vertex_p_u, into_eye_space * vertex_p_v, offset_u, offset_v,
                   area_normal);
}
#else
in vec3 offset_u, offset_v, area_normal;
#endif
#endif
