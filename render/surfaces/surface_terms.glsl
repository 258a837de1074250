// The material of a sample from the values of its maps, for GLSL and C (surface_terms.h).
#ifdef GL_core_profile
#include "bumps_terms.glsl"
#endif
#ifndef TERM
#define TERM
#endif

#define SEWING_THREAD_F0 0.04f // of a sewing thread on glossier cloth

// Colours and glossiness of a sample.
struct SurfaceColours {
    vec3 diffuse, f0;
    float glossiness;
};

// Values of maps that are of no colour of their own, or come after the material's.
struct SurfaceTexels {
    vec3 tint;         // of the weave, on the diffuse colour; 1: none
    float gloss;       // what the weave adds to glossiness
    float yarns;       // factor of yarns that differ from one another
    float occlusion;   // factor on diffuse light
    float thread, shade; // of what is sewn; 0: nothing
};

TERM SurfaceTexels surface_texels(void)
{
    SurfaceTexels none;
    none.tint = vec3(1.0f, 1.0f, 1.0f);
    none.yarns = none.occlusion = 1.0f;
    none.gloss = none.thread = none.shade = 0.0f;
    return none;
}

// A channel of a colour with the thread's over it where there is thread, in the shade of seams.
TERM float sewn_channel(float cloth, float thread, SurfaceTexels texels)
{
    return (cloth + min(texels.thread, 1.0f) * (thread - cloth)) * max(1.0f - texels.shade, 0.0f);
}

// `cloth`: the material's own, with its maps of colour, reflectance and gloss. `back` is seen in its place where
// `shows_back`: it takes nothing from the maps but gloss and occlusion. `thread`: the colour of seams.
TERM SurfaceColours surface_colours(SurfaceColours cloth, SurfaceTexels texels, bool shows_back, vec3 back_diffuse,
                                    vec3 back_f0, vec3 thread)
{
    vec3 kd = vec3_scale(vec3_multiply(cloth.diffuse, texels.tint), texels.yarns), f0 = vec3_scale(cloth.f0, texels.yarns);
    float open = texels.occlusion;
    kd = vec3((shows_back ? back_diffuse.x : kd.x) * open, (shows_back ? back_diffuse.y : kd.y) * open,
              (shows_back ? back_diffuse.z : kd.z) * open);
    f0 = vec3(shows_back ? back_f0.x : f0.x, shows_back ? back_f0.y : f0.y, shows_back ? back_f0.z : f0.z);
    SurfaceColours colours;
    colours.diffuse = vec3(sewn_channel(kd.x, thread.x, texels), sewn_channel(kd.y, thread.y, texels),
                           sewn_channel(kd.z, thread.z, texels));
    colours.f0 = vec3(sewn_channel(f0.x, min(f0.x, SEWING_THREAD_F0), texels),
                      sewn_channel(f0.y, min(f0.y, SEWING_THREAD_F0), texels),
                      sewn_channel(f0.z, min(f0.z, SEWING_THREAD_F0), texels));
    colours.glossiness = max(min(cloth.glossiness + texels.gloss, 1.0f), 0.0f);
    return colours;
}

// A sample's surface as light sees it.
struct SurfaceShape {
    vec3 normal; // of the shading, unit, on the side that is seen
    float glossiness;
    vec3 widening; // bumps_widening
    float open;    // factor on the diffuse colour
};

// A smooth surface with these bumps; where there is no tangent, without them. `side`: 1, or -1 for the back, which is a
// surface of its own with the whole frame turned over. `own_glossiness`: of the material without maps and yarns.
TERM SurfaceShape surface_shape(int minify, Bumps bumps, vec3 normal, vec3 smooth_normal, vec3 tangent, float handedness,
                                float side, vec3 viewer, float own_glossiness, float glossiness)
{
    bool has_tangent = dot(tangent, tangent) > 0.0f;
    float own_rough = 1.0f - own_glossiness, rough = 1.0f - glossiness;
    vec3 bent = bent_normal(bumps.normal, normal, tangent, handedness, smooth_normal);
    vec3 view = into_tangent_space(viewer, smooth_normal, tangent, handedness);
    vec3 wider = bumps_widening(minify, own_rough, rough, bumps);
    float plain = detail_widening(own_rough, rough, 0.0f);
    SurfaceShape shape;
    shape.normal = vec3(side * (has_tangent ? bent.x : smooth_normal.x), side * (has_tangent ? bent.y : smooth_normal.y),
                        side * (has_tangent ? bent.z : smooth_normal.z));
    shape.glossiness = has_tangent ? 1.0f - bumps_roughness(minify, rough, bumps, view) : glossiness;
    shape.widening = vec3(has_tangent ? wider.x : plain, has_tangent ? wider.y : plain, has_tangent ? wider.z : 0.0f);
    shape.open = has_tangent ? detail_open(bumps.mean_length) : 1.0f;
    return shape;
}
