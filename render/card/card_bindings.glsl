// Bindings of the storage buffers of a frame on the graphics card, for GLSL and C (card_internal.h). A program declares
// at most sixteen of them. Those marked * are of visibility/card_points.h.
#define CARD_POSITIONS 0        // * [vertices][3], world
#define CARD_NORMALS 1          // * [vertices][3]
#define CARD_INDICES 2          // * [triangles][3]
#define CARD_PROBES 3           // * [probes][2]: vertex, and its back << 31; surface
#define CARD_TRIANGLE_PROBES 4  // * [triangles][front, back][3]
#define CARD_LISTED 5           // * [1]: how many probes are seen
#define CARD_LIST 6             // * the probes that are seen
#define CARD_ORIGINS 7          // * [listed][2]: where rays start, 1: covered; normal
#define CARD_VISIBLE 8          // * [regions / 4][probes]: by place in the list, a byte a region
#define CARD_NODES 9            // * the tree (trace.glsl: TREE_BINDING)
#define CARD_TRIANGLES 10       // * ... and its triangles
#define CARD_TANGENTS 11        // [vertices]: along u; handedness
#define CARD_UVS 12             // [vertices]
#define CARD_TRIANGLE_PARTS 13  // [triangles]: part, surface << 12, class << 16; and the bits below
#define CARD_VERTEX_PARTS 14    // [vertices]: part
#define CARD_PARTS 15           // the materials (card_material.glsl)
#define CARD_FROM 16            // [probes][4]: the three that it takes bounced light from; 1: it has its own, other side << 1
#define CARD_SHARES 17          // [probes]: their shares
#define CARD_OWN 18             // probes with bounced light of their own; then those of the ground's vertices
#define CARD_RINGS 19           // [probes + 1] firsts, then neighbours
#define CARD_TILES 20           // [classes][tiles]: x, y << 16
#define CARD_WORK 21            // indirect dispatches: class k of materials over its tiles at 4 k; then:
#define CARD_REGIONS 22         // [regions][2]: direction, sine; power, spread
#define CARD_RATIOS 23          // [probes][4]: of diffuse light; of gloss, 1: covered; of fibres; of the coat
#define CARD_FOUND 24           // [probes][17]: what bounces to it: E / pi, 1: known; terms of card_bounced.glsl
#define CARD_BOUNCED 25         // ... and the mean with its neighbours
#define CARD_SENT 26            // [probes]: radiance, 1: known; of the frame before
#define CARD_SENT_NOW 27        // ... of this one; then E / pi, 1: known
#define CARD_ALBEDOS 28         // [parts][5]: of even light, the same with what lobes send; front, back; transmission; w: emission
#define CARD_SKY 29             // [6 x 32 x 32]: colour; sum of luminance up to and with it
#define CARD_BORDER_FIRSTS 30   // of the class at work, as render/construction has them
#define CARD_BORDER_NEAR 31
#define CARD_BORDERS 32
#define CARD_PROFILES 33
#define CARD_YARNS 34
#define CARD_LOBE_SETS 35       // tables of lobe sets (card_table.glsl)
#define CARD_PATHS 36           // [samples]: Path of card_rest.comp
#define CARD_HOLES 37           // * holes that alpha cuts (holes.glsl)
#define CARD_BUFFERS 38

// Bits of a triangle's part.
#define CARD_IS_OPEN 0x40000000u
#define CARD_TRANSMITS 0x80000000u

#define CARD_CLASSES_MAX 12
#define CARD_WORK_OF_32 60 // over the listed probes, so many a group
#define CARD_WORK_OF_4 64
#define CARD_WORDS 68
