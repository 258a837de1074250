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
    float row, column, gloss, side;
    int orders;
    bool has_gloss;
};

// The first of two nodes, and the share of the second (tl_lobe_set_between).
vec2 between(float at, int count)
{
    at = clamp(at, 0.0, float(count - 1));
    int first = min(int(at), max(count - 2, 0));
    return vec2(float(first), at - float(first));
}

TablePlace table_place(Part part, vec3 viewer, float glossiness)
{
    TablePlace at;
    at.side = viewer.y < 0.0 ? -1.0 : 1.0;
    vec2 column = between(lobe_set_column(at.side * viewer.x, at.side * viewer.y), TL_LOBE_SET_AZIMUTHS);
    vec2 row = between(lobe_set_row(viewer.z), TL_LOBE_SET_COSINES);
    at.has_gloss = part.table.w > 1.0;
    vec2 gloss = at.has_gloss ? between((glossiness - part.table.x) / (part.table.y - part.table.x) * (part.table.w - 1.0), int(part.table.w))
                              : vec2(0.0);
    at.first = int(part.table_first.x) + SET_NODE * ((int(gloss.x) * TL_LOBE_SET_COSINES + int(row.x)) * TL_LOBE_SET_AZIMUTHS + int(column.x));
    at.row = row.y;
    at.column = column.y;
    at.gloss = gloss.y;
    at.orders = int(lobe_sets[at.first + 1].z);
    return at;
}

struct TableLobe {
    vec3 local; // in the frame of the threads, not unit
    float log_exponent, low, high;
};

TableLobe table_lobe(Part part, TablePlace at, int k)
{
    vec4 direction = vec4(0.0), weights = vec4(0.0);
    int count = int(part.table.z);
    for (int g = 0; g < (at.has_gloss ? 2 : 1); g++)
        for (int i = 0; i < 4; i++) {
            float share = ((i & 1) != 0 ? at.column : 1.0 - at.column) * ((i & 2) != 0 ? at.row : 1.0 - at.row);
            share *= !at.has_gloss ? 1.0 : g == 0 ? 1.0 - at.gloss : at.gloss;
            int node = at.first + SET_NODE * ((g * TL_LOBE_SET_COSINES + (i >> 1)) * TL_LOBE_SET_AZIMUTHS + (i & 1));
            int lobe = (at.orders >> (4 * g + i) & 1) != 0 ? count - 1 - k : k;
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
