#version 450 core
// Column: the number of a term; row: a trial.
#include "bounced_terms.glsl"
#include "directions_terms.glsl"
#include "facets_terms.glsl"
#include "lamp_terms.glsl"
#include "layers_terms.glsl"
#include "ground.glsl"
#include "lobes_terms.glsl"
#include "models_terms.glsl"
#include "normalise_terms.glsl"
#include "sample_terms.glsl"
#include "spread_terms.glsl"
#include "surface_terms.glsl"
#include "terms.glsl"
#include "one_text.glsl"

layout(location = 0) out float value;

void main()
{
    value = one_text(int(gl_FragCoord.x), uint(gl_FragCoord.y));
}
