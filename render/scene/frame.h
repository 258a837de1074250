/* One frame's scene: surfaces, environment, lamps and camera. */
#ifndef TOILE_RENDER_SCENE_FRAME_H
#define TOILE_RENDER_SCENE_FRAME_H

#include "assets/base/surface.h"
#include "assets/environment/environment.h"
#include "render/scene/camera.h"
#include "render/scene/lamp.h"

#define TL_FRAME_SHIFTS 16

/* Read-only inputs of one frame. */
typedef struct tl_frame {
    struct tl_camera camera;
    const tl_surface *surfaces;
    size_t surface_count;
    const tl_environment *environment;
    uint64_t environment_revision; /* changes when the environment does */
    float environment_yaw;         /* rad: the environment turned about +Y, counter-clockwise from above */
    const struct tl_lamp *lamps;
    size_t lamp_count; /* at most TL_LAMPS_MAX */
    double time_s;
    bool aovs;   /* keep the samples that render/inspect/aovs.h reads */
    bool still;  /* a still image: every round is completed, however long that takes */
    bool smooth; /* while nothing changes, the mean of TL_FRAME_SHIFTS images, each shifted by a part of a
                    pixel: edges lose their steps. Methods that average light in passes draw one. */
} tl_frame;

#endif
