/* Maps derived from a height field [Wimmer n.d.]: normals, horizons, the spread of normals, and the gloss
 * widened by it. Each function returns a new image, which the caller releases, of the size of its source
 * unless stated otherwise. Pure; deterministic at any number of threads. */
#ifndef TOILE_RENDER_DETAIL_BAKE_H
#define TOILE_RENDER_DETAIL_BAKE_H

#include "assets/base/mesh.h"
#include "render/detail/field.h"

/* Heights in metres, F32 x1, from the first channel of a picture: `base_m` + value * `scale_m`; the value of
 * a byte is byte / 255. */
tl_image tl_bake_heights(const tl_image *picture, float base_m, float scale_m);

/* Heights averaged to fewer texels: `width` and `height` at most those of `heights`, which is F32 x1. */
tl_image tl_bake_smaller(const tl_image *heights, int width, int height);

/* Slopes (dh/dx, dh/dy) in tangent space, metres per metre, by central differences; one-sided at borders that
 * do not repeat. F32 x2. */
tl_image tl_bake_slopes(const struct tl_height_field *field);

/* The normal map N' = normalise(-k dh/dx, -k dh/dy, 1), F32 x3. */
tl_image tl_bake_normals(const tl_image *slopes, float k);
/* The same as image files store it: U8 x3, 0.5 + 0.5 n. */
tl_image tl_bake_encoded(const tl_image *normals);

/* Horizon maps [Max 1988]: the sine of the elevation of the horizon seen from each texel, by azimuth. Angle k
 * of n is the direction (cos, sin)(2 pi k / n) in tangent space; angles 4 i to 4 i + 3 are the channels of
 * image i. U8 x4. Released by tl_horizon_maps_release. */
#define TL_HORIZON_ANGLES_MAX 32
struct tl_horizon_maps {
    int angle_count;
    tl_image images[TL_HORIZON_ANGLES_MAX / 4];
};
/* `angle_count`: a multiple of 4, at most TL_HORIZON_ANGLES_MAX. */
struct tl_horizon_maps tl_bake_horizons(const struct tl_height_field *field, int angle_count);
void tl_horizon_maps_release(struct tl_horizon_maps *maps);

/* The moments (x, y, x^2, y^2) of unit normals, F32 x4, from normals in F32 x3 or bytes. Averages of the
 * moments give the mean normal and its spread. `offsets`: those of (-h_u, -h_v), at most 16, in place of x
 * and y [Wimmer n.d., Offset Bump Maps]. */
tl_image tl_bake_moments(const tl_image *normals, bool offsets);
/* The mixed moment x y of unit normals, F32 x1: with the others it gives the covariance of slopes along u and
 * v [Olano and Baker 2010]. */
tl_image tl_bake_cross_moments(const tl_image *normals, bool offsets);
/* The length of the mean normal, from averaged moments. */
float tl_moments_length(vec4s moments);

/* Glossiness of a surface whose normals are averaged over `window` x `window` texels [Toksvig 2005], as a
 * factor on `glossiness`. U8 x1, linear. */
tl_image tl_bake_gloss(const tl_image *moments, float glossiness, int window);

/* Size of the texels of an image. */
size_t tl_image_size_bytes(const tl_image *image);

#endif
