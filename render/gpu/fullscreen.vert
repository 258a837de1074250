#version 450 core
// One triangle over the whole viewport, at depth 1: `uv` runs from (0, 0) at the lower left to (1, 1).
out vec2 uv;

void main()
{
    uv = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
    gl_Position = vec4(2.0 * uv - 1.0, 1.0, 1.0);
}
