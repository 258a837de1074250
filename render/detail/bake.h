/* Maps derived from a height field [004]: normals, offsets, horizons, the spread of normals, gloss that it
 * widens. Pure; each function makes a new image, of the size of what it is made from unless it says
 * otherwise. Deterministic at any thread count. */
#ifndef TOILE_RENDER_DETAIL_BAKE_H
#define TOILE_RENDER_DETAIL_BAKE_H

#include "assets/base/mesh.h"
#include "render/detail/field.h"

/* F32 x1 in metres from a picture's first channel: `base_m` + value * `scale_m`; a byte's value is its share
 * of 255. */
tl_image tl_bake_heights(const tl_image *picture, float base_m, float scale_m);

/* Heights averaged to fewer texels: `width` and `height` at most those of `heights`, which is F32 x1. */
tl_image tl_bake_smaller(const tl_image *heights, int width, int height);

/* Slopes (dh/dx, dh/dy) in tangent space, metres a metre, by central differences; one-sided at borders that
 * do not repeat. F32 x2. */
tl_image tl_bake_slopes(const struct tl_height_field *field);

/* The offset bump map D = (-k dh/dx, -k dh/dy): what a normal is moved by. F32 x2. */
tl_image tl_bake_offsets(const tl_image *slopes, float k);

/* N' = normalise(-k dh/dx, -k dh/dy, 1), F32 x3. And as files hold it: U8 x3, 0.5 + 0.5 n. */
tl_image tl_bake_normals(const tl_image *slopes, float k);
tl_image tl_bake_encoded(const tl_image *normals);

/* Normals of a mesh's own space, F32 x3: tangent-space ones (read at the mesh's UV, periodic) turned by its
 * frames, which must have tangents. `width` x `height` texels over the UV square; zero where no triangle
 * lies. */
tl_image tl_bake_object_normals(const tl_mesh *mesh, const tl_image *normals, int width, int height);

/* Sines of the horizon's height over the surface, seen from each texel: angle k of n looks along
 * (cos, sin)(2 pi k / n) in tangent space; angles 4 i to 4 i + 3 are the channels of image i. U8 x4. */
#define TL_HORIZON_ANGLES_MAX 32
struct tl_horizon_maps {
    int angle_count;
    tl_image images[TL_HORIZON_ANGLES_MAX / 4];
};
/* `angle_count`: a multiple of 4, at most TL_HORIZON_ANGLES_MAX. */
struct tl_horizon_maps tl_bake_horizons(const struct tl_height_field *field, int angle_count);
void tl_horizon_maps_release(struct tl_horizon_maps *maps);
/* Interpolated between texels and angles. `x`, `y`: where it looks, not both 0. */
float tl_horizon_sine(const struct tl_horizon_maps *maps, const struct tl_height_field *field, vec2s uv,
                      float x, float y);

/* What averages of normals need: (x, y, x^2, y^2) of unit normals, F32 x4, from F32 x3 or from bytes. Means
 * over texels of it give the mean normal and its spread. */
tl_image tl_bake_moments(const tl_image *normals);
/* Of averaged moments: the length of the mean normal. */
float tl_moments_length(vec4s moments);

/* Glossiness of a surface of `glossiness` whose normals are averaged over `window` x `window` texels
 * [Toksvig]. U8 x1, linear, as a factor on `glossiness`. */
tl_image tl_bake_gloss(const tl_image *moments, float glossiness, int window);

size_t tl_image_size_bytes(const tl_image *image);

#endif
