// The lobes of facets that have a table (render/shade/lobe_set_table.h).
#include "lobe_set_terms.glsl"
layout(std430, binding = CARD_LOBE_SETS) restrict readonly buffer LobeSets
{
    vec4 lobe_sets[]; // [gloss][row][column][TL_LOBE_FIT_MAX][2]: direction, exponent's logarithm; weights, orders
};
const int SET_NODE = 22; // vectors of a node

// The cell that a viewer is in, and the place within.
struct TablePlace {
    int first; // the vectors of its first node
    LobeSetPlace at;
    int orders;
    bool has_gloss;
};

TablePlace table_place(Part part, vec3 viewer, float glossiness)
{
    TablePlace place;
    LobeSetPlace at = lobe_set_place(viewer.x, viewer.y, viewer.z, glossiness, part.table.x, part.table.y, int(part.table.w));
    int node = (at.gloss.first * TL_LOBE_SET_COSINES + at.row.first) * TL_LOBE_SET_AZIMUTHS + at.column.first;
    place.at = at;
    place.first = int(part.table_first.x) + SET_NODE * node;
    place.orders = int(lobe_sets[place.first + 1].z);
    place.has_gloss = part.table.w > 1.0;
    return place;
}

struct TableLobe {
    vec3 local; // in the frame of the threads, not unit
    float log_exponent, low, high;
};

TableLobe table_lobe(Part part, TablePlace place, int k)
{
    LobeSetPlace at = place.at;
    vec4 direction = vec4(0.0), weights = vec4(0.0);
    int count = int(part.table.z);
    for (int g = 0; g < (place.has_gloss ? 2 : 1); g++)
        for (int i = 0; i < 4; i++) {
            float share = ((i & 1) != 0 ? at.column.share : 1.0 - at.column.share) * ((i & 2) != 0 ? at.row.share : 1.0 - at.row.share);
            share *= !place.has_gloss ? 1.0 : g == 0 ? 1.0 - at.gloss.share : at.gloss.share;
            int node = place.first + SET_NODE * ((g * TL_LOBE_SET_COSINES + (i >> 1)) * TL_LOBE_SET_AZIMUTHS + (i & 1));
            int lobe = (place.orders >> (4 * g + i) & 1) != 0 ? count - 1 - k : k;
            direction += share * lobe_sets[node + 2 * lobe];
            weights += share * lobe_sets[node + 2 * lobe + 1];
        }
    return TableLobe(vec3(at.side * direction.xy, direction.z), direction.w, weights.x, weights.y);
}

vec3 table_weight(TableLobe lobe, vec3 f0)
{
    return lobe.low * vec3(lobe_set_low_share(f0.r), lobe_set_low_share(f0.g), lobe_set_low_share(f0.b)) +
           lobe.high * vec3(lobe_set_high_share(f0.r), lobe_set_high_share(f0.g), lobe_set_high_share(f0.b));
}
