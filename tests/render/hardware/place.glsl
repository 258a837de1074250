
#undef main
uint hardware_hash(uint h)
{
    h = (h ^ h >> 16) * 0x7feb352du;
    h = (h ^ h >> 15) * 0x846ca68bu;
    return h ^ h >> 16;
}

// Vertices are placed to 1/256 of a pixel: each moves by up to half of that, of an image 96 pixels wide, by its place
// alone, so that triangles keep their edges in common. Those that fill the screen lie where they are.
void main()
{
    shader_main();
    vec2 place = gl_Position.xy / gl_Position.w;
    if (gl_Position.w == 1.0 && place == floor(place))
        return;
    uint x = hardware_hash(floatBitsToUint(gl_Position.x) ^ hardware_hash(floatBitsToUint(gl_Position.y)));
    vec2 moved = vec2(float(x), float(hardware_hash(x))) * (2.0 / 4294967296.0) - 1.0;
    gl_Position.xy += moved * (2.0 / 96.0 / 512.0) * gl_Position.w;
}
