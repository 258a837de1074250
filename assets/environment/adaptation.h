/* Exposure and white point of an environment: the brightness and the white in which its light is shown, as
 * the eye adapts to it; and its ground. */
#ifndef TOILE_ASSETS_ENVIRONMENT_ADAPTATION_H
#define TOILE_ASSETS_ENVIRONMENT_ADAPTATION_H

#include "assets/base/environment.h"

#include <cglm/struct.h>

/* Luminance (Rec. 709) of the light that the built-in studio sends on upright cards: cylindrical irradiance,
 * over pi. Other places are shown as bright. */
#define TL_ADAPTED_LUMINANCE 0.462f
/* The share of a place's tint that is removed, in the logarithm: the eye adapts to most of it. */
#define TL_ADAPTED_WHITE 0.75f
/* Places that are darker or brighter than this factor are adapted to only so far. */
#define TL_ADAPTED_MAX 4096.0f

/* The factors of red, green and blue with which a picture shows light from an environment. They make the
 * luminance of upright cards under it, whichever way they face (the mean of all: cylindrical irradiance, EN
 * 12464-1), TL_ADAPTED_LUMINANCE, and take TL_ADAPTED_WHITE of its tint away (von Kries' gains in Rec. 709).
 * So they do not change as the camera or the environment turns. 1 for one without light. Pure. */
vec3s tl_adaptation_to(const tl_environment *environment);

/* The darkest and brightest luminance of a ground: on one that is darker no shadow is seen. */
#define TL_GROUND_DARKEST   0.1f
#define TL_GROUND_BRIGHTEST 0.8f

/* The reflectance of the ground that an environment shows: the light that comes from below over the light
 * that falls from above, both on level cards. Where nothing falls, 0. Pure. */
vec3s tl_adaptation_ground(const tl_environment *environment);

/* The light that falls from above on a level card, over pi: the radiance of a white one. Pure. */
vec3s tl_adaptation_above(const tl_environment *environment);

#endif
