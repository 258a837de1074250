/* The review camera: an orbit about a target. Pure. */
#ifndef TOILE_APP_SCENE_CAMERA_H
#define TOILE_APP_SCENE_CAMERA_H

#include "app/settings/settings.h"

/* True when the settings place the camera. A distance of 0 stands for the one that frames the scene, a target
 * of 0 0 0 for the middle of the scene. */
bool tl_camera_is_placed(const struct tl_camera_params *params);

/* Shares of the picture's height that a garment fills, and that garment and body fill together. */
#define TL_CAMERA_GARMENT 0.75f
#define TL_CAMERA_BODY    0.94f

/* The framed extent: the most distant points of a thing in directions all around, in metres of the world. */
enum { TL_FRAMING_POINTS = 64 };
struct tl_framing {
    struct tl_box box;
    float share; /* of the picture's height that it shall fill */
    int count;
    vec3s points[TL_FRAMING_POINTS];
    int head_count; /* of what stands out above and is shown whole, together within TL_CAMERA_BODY */
    vec3s head[TL_FRAMING_POINTS];
};
/* Adds a thing, by its positions; a framing of zeros and a share is empty. */
void tl_framing_add(struct tl_framing *framing, const vec3s *points, size_t count);
/* Adds those of the points that are higher than what is framed as what stands out above it. */
void tl_framing_add_head(struct tl_framing *framing, const vec3s *points, size_t count);
/* The extent of a box, for which a cylinder about it stands: it is framed alike from all sides. */
struct tl_framing tl_framing_of_box(struct tl_box box, float share);

/* The camera of the frame. With distance_m = 0 what is framed fills its share of the height of an image of
 * the given aspect (width / height), or less where nine tenths of its width are filled. With a distance but
 * no target the eye looks at the box's middle from there. What stands out above is in the picture: the eye
 * looks higher, and from further away where that is not enough. */
struct tl_camera tl_camera_frame(const struct tl_camera_params *params, const struct tl_framing *framing,
                                 float aspect);

#endif
