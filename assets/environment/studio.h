/* The built-in studio: a grey room and the lamps that hang in it, as data (tl_environment_studio
 * renders them).
 *
 * Each light is a rectangle far away, seen from the scene's middle; the image is the sum of the room and all
 * lights. Threads: pure. */
#ifndef TOILE_ASSETS_ENVIRONMENT_STUDIO_H
#define TOILE_ASSETS_ENVIRONMENT_STUDIO_H

#include "assets/base/environment.h"

#include <cglm/struct.h>

#include <stddef.h>

struct tl_studio_light {
    const char *name;
    float azimuth_deg, elevation_deg; /* of its middle: from +Z towards +X, and up */
    float half_width, half_height;    /* at distance 1 from the scene: tangents of half its angles */
    float edge;                       /* half-width of its soft edge, same unit */
    vec3s radiance;
};

/* The direction of the eye for which the lights stand, as camera.yaw_deg. */
#define TL_STUDIO_VIEW_DEG 25.0f

extern const struct tl_studio_light tl_studio_lights[];
extern const size_t tl_studio_light_count;

/* Axes of a light: out = towards its middle, right = level, up; a right-handed frame seen from outside. */
struct tl_studio_axes {
    vec3s out, right, up;
};
struct tl_studio_axes tl_studio_light_axes(const struct tl_studio_light *light);

/* Radiance of the empty room from a unit direction: grey, so one value; and of the same room as a backdrop,
 * whose wall is lit behind the figure as seen in the direction TL_STUDIO_VIEW_DEG. */
float tl_studio_room(vec3s direction);
float tl_studio_backdrop(vec3s direction);

/* Built-in lights that need no file: soft boxes and one strong small lamp in a grey
 * room, 512 x 256 lat-long. */
tl_environment tl_environment_studio(void);

/* The same radiance from every direction, for furnace tests. */
tl_environment tl_environment_constant(float red, float green, float blue);

/* Makes the environment of this name: "studio", "white" (1 from everywhere), "none" (black). False for
 * another name, *out untouched. */
bool tl_environment_find(const char *name, tl_environment *out);

#endif
