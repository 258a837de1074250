// The sheen of fibres (render/brdf/fuzz.h).
struct Fibres {
    vec3 axis; // world
    float weights[FUZZ_POWERS];
    float albedo, under; // of white ones; what is left to the rest of the material
};

Fibres fibres_of(Part part, vec3 normal, vec3 shown, vec3 viewer)
{
    Fibres f;
    f.axis = fuzz_axis(part.fuzz_more.x, normal, shown);
    f.albedo = fuzz_lobes(part.fuzz.a, dot(f.axis, viewer), f.weights);
    f.under = 1.0 - f.albedo * part.fuzz_more.y;
    return f;
}

// The unshadowed light of the environment.
vec3 exact_fibres(Fibres f)
{
    vec2 place = octahedral_place(into_environment(f.axis));
    vec3 light = vec3(0.0);
    for (int k = 0; k < FUZZ_POWERS; k++)
        light += f.weights[k] * fetch_map(lobe_atlas, 3 * k, place); // TL_FUZZ_INDEX
    return max(light, 0.0);
}
