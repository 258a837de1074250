#include "render/present/backdrop.h"

#include "render/pem/chain.h"

#include <epoxy/gl.h>

/* The level of the filter chain that is seen behind: a hint of the place that does not distract. */
#define BLUR_LEVEL 3
/* Sines of the elevations between which the ground passes into the environment. The disc fades (ground.h) at
 * lower ones, from where a whole figure is framed. */
#define GROUND_BELOW -0.14f
#define GROUND_ABOVE 0.16f

static void destroy_textures(struct tl_backdrop *backdrop)
{
    tl_texture_destroy(&backdrop->sharp_texture);
    tl_texture_destroy(&backdrop->blurred_texture);
}

void tl_backdrop_release(struct tl_backdrop *backdrop)
{
    destroy_textures(backdrop);
    tl_cube_release(&backdrop->blurred);
    tl_behind_release(&backdrop->behind);
    *backdrop = (struct tl_backdrop){0};
}

static size_t cube_bytes(const tl_cube *cube)
{
    return 18 * sizeof(float) * (size_t)cube->size * (size_t)cube->size;
}

size_t tl_backdrop_bytes(const struct tl_backdrop *backdrop)
{
    return tl_texture_bytes(&backdrop->sharp_texture) + tl_texture_bytes(&backdrop->blurred_texture) +
           cube_bytes(&backdrop->blurred) + backdrop->behind.bytes;
}

static void paint_ground(tl_cube *cube, vec3s ground)
{
    for (int i = 0; i < 6 * cube->size * cube->size; i++) {
        vec3s *texel = (vec3s *)(void *)(cube->texels + 3 * (size_t)i);
        float height = tl_cube_texel_direction(cube->size, i).y;
        *texel = glms_vec3_lerp(ground, *texel, glm_smoothstep(GROUND_BELOW, GROUND_ABOVE, height));
    }
}

void tl_backdrop_set(struct tl_backdrop *backdrop, const tl_cube *cube, int filter, const vec3s *ground)
{
    struct tl_chain chain = tl_chain_build(cube, (enum tl_chain_filter)filter);
    int last = chain.level_count - 1;
    destroy_textures(backdrop);
    tl_cube_release(&backdrop->blurred);
    backdrop->blurred = tl_cube_copy(&chain.levels[last < BLUR_LEVEL ? last : BLUR_LEVEL]);
    if (ground)
        paint_ground(&backdrop->blurred, *ground);
    backdrop->revision++;
    tl_chain_release(&chain);
}

static tl_texture send_cube(tl_gpu *gpu, int size, GLenum given, const float *texels)
{
    tl_texture texture = tl_texture_create(gpu, GL_TEXTURE_CUBE_MAP, GL_RGBA32F, size, size, 6, 1);
    glTextureSubImage3D(texture.id, 0, 0, 0, 0, size, size, 6, given, GL_FLOAT, texels);
    return texture;
}

const tl_texture *tl_backdrop_sharp(struct tl_backdrop *backdrop, tl_gpu *gpu,
                                    const tl_environment *environment, tl_error *error)
{
    const tl_image *image = &environment->image;
    GLenum given = image->channels == 4 ? GL_RGBA : GL_RGB;
    int limit = tl_gpu_texture_side_max(gpu);
    tl_texture *texture = &backdrop->sharp_texture;
    if (image->width > limit || image->height > limit) {
        tl_fail(error, TL_INPUT, "%s: %d x %d texels are more than GL holds: scale it to %d",
                environment->name, image->width, image->height, limit);
        return NULL;
    }
    if (texture->id)
        return texture;
    if (environment->layout == TL_ENV_LATLONG) {
        *texture = tl_texture_create(gpu, GL_TEXTURE_2D, GL_RGBA32F, image->width, image->height, 1, 1);
        glTextureSubImage2D(texture->id, 0, 0, 0, image->width, image->height, given, GL_FLOAT,
                            image->texels);
        glTextureParameteri(texture->id, GL_TEXTURE_WRAP_S, GL_REPEAT);
    } else {
        *texture = send_cube(gpu, image->width, given, image->texels);
    }
    return texture;
}

const tl_texture *tl_backdrop_blurred(struct tl_backdrop *backdrop, tl_gpu *gpu)
{
    if (!backdrop->blurred_texture.id)
        backdrop->blurred_texture = send_cube(gpu, backdrop->blurred.size, GL_RGB, backdrop->blurred.texels);
    return &backdrop->blurred_texture;
}
