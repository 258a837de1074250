#include "render/gbuffer/clip.h"

#include <math.h>
#include <string.h>

/* Distance inwards from a plane, times w: below 0 outside. */
static float distance_to(unsigned plane, vec4s p)
{
    float along = p.raw[plane / 2];
    bool is_upper = plane == 0 || plane == 2 || plane == 5;
    return is_upper ? p.w - along : along + p.w;
}

/* The corner on the edge between two corners, counted from the one outside: rounded so, neighbours that share
 * the edge get the same corner. */
static struct tl_clip_corner cut_edge(vec4s outside, vec4s inside, float distance_outside,
                                      float distance_inside)
{
    struct tl_clip_corner corner = {.source = -1};
    float t = distance_outside / (distance_outside - distance_inside);
    for (int i = 0; i < 4; i++)
        corner.at.raw[i] = outside.raw[i] + t * (inside.raw[i] - outside.raw[i]);
    return corner;
}

/* Returns the number of corners of `out`; 0 too when a distance is not finite. */
static int cut(unsigned plane, const struct tl_clip_corner *in, int count, struct tl_clip_corner *out)
{
    int kept = 0;
    float before = distance_to(plane, in[0].at);
    for (int i = 0; i < count; i++) {
        const struct tl_clip_corner *from = &in[i], *to = &in[(i + 1) % count];
        float after = distance_to(plane, to->at);
        if (!isfinite(before) || !isfinite(after))
            return 0;
        if (before >= 0)
            out[kept++] = *from;
        if (before >= 0 && after < 0)
            out[kept++] = cut_edge(to->at, from->at, after, before);
        else if (before < 0 && after >= 0)
            out[kept++] = cut_edge(from->at, to->at, before, after);
        before = after;
    }
    return kept;
}

int tl_clip_triangle(struct tl_clip_corner corners[TL_CLIP_CORNERS_MAX], unsigned planes)
{
    int count = 3;
    for (unsigned plane = 0; plane < TL_CLIP_PLANES && count >= 3; plane++) {
        if (!(planes & 1u << plane))
            continue;
        struct tl_clip_corner kept[2 * TL_CLIP_CORNERS_MAX];
        count = cut(plane, corners, count, kept);
        if (count > TL_CLIP_CORNERS_MAX)
            return 0; /* not convex: rounding made it so */
        memcpy(corners, kept, (size_t)count * sizeof *corners);
    }
    return count >= 3 ? count : 0;
}
