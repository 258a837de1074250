#include "render/bounce/bounce_internal.h"

#include "config/base/memory.h"
#include "config/colour/luminance.h"

#include <math.h>
#include <stdlib.h>

/* Texels along a face: 2.8 degrees each. */
#define SIZE  32
#define COUNT (6 * SIZE * SIZE)

static vec3s texel_of(const struct tl_bounce_sky *sky, int texel)
{
    const float *colour = sky->cube.texels + 3 * texel;
    return (vec3s){{colour[0], colour[1], colour[2]}};
}

/* Means of the environment's texels, by their solid angles. A cube that is smaller is repeated. */
static tl_cube reduce(const tl_cube *cube)
{
    const int size = cube->size, step = size > SIZE ? size / SIZE : 1;
    float *angles = TL_NEW_ARRAY(float, (size_t)size *(size_t)size);
    tl_cube reduced = tl_cube_create(SIZE);
    tl_cube_solid_angles(size, angles);
    for (int i = 0; i < COUNT; i++) {
        const int face = i / (SIZE * SIZE), x = i % SIZE * size / SIZE, y = i / SIZE % SIZE * size / SIZE;
        double sums[3] = {0}, whole = 0;
        for (int j = 0; j < step * step; j++) {
            const int at = (y + j / step) * size + x + j % step;
            const double angle = (double)angles[at];
            whole += angle;
            for (int c = 0; c < 3; c++)
                sums[c] += angle * (double)cube->texels[3 * (face * size * size + at) + c];
        }
        for (int c = 0; c < 3; c++)
            reduced.texels[3 * i + c] = (float)(sums[c] / whole);
    }
    free(angles);
    return reduced;
}

void tl_bounce_sky_follow(struct tl_bounce_sky *sky, const tl_cube *cube, uint64_t revision)
{
    if (sky->cube.texels && sky->revision == revision)
        return;
    float angles[SIZE * SIZE];
    tl_cube_solid_angles(SIZE, angles);
    tl_bounce_sky_release(sky);
    *sky = (struct tl_bounce_sky){
        .revision = revision, .cube = reduce(cube), .sums = TL_NEW_ARRAY(double, COUNT + 1)};
    for (int i = 0; i < COUNT; i++)
        sky->sums[i + 1] =
            sky->sums[i] + tl_luminance_exact(sky->cube.texels + 3 * i) * (double)angles[i % (SIZE * SIZE)];
}

vec3s tl_bounce_sky_colour(const struct tl_bounce_sky *sky, vec3s direction, float *pdf)
{
    const vec3s colour = texel_of(sky, tl_cube_texel(SIZE, direction));
    *pdf = sky->sums[COUNT] > 0 ? (float)(tl_luminance_exact(colour.raw) / sky->sums[COUNT]) : 0;
    return colour;
}

bool tl_bounce_sky_sample(const struct tl_bounce_sky *sky, vec2s at, vec3s *direction)
{
    const double wanted = (double)at.x * sky->sums[COUNT];
    int low = 0, high = COUNT;
    if (!(sky->sums[COUNT] > 0))
        return false;
    while (high - low > 1) { /* sums[low] <= wanted < sums[high] */
        const int middle = (low + high) / 2;
        if (sky->sums[middle] <= wanted)
            low = middle;
        else
            high = middle;
    }
    const double along = (wanted - sky->sums[low]) / (sky->sums[low + 1] - sky->sums[low]);
    *direction = glms_vec3_normalize(tl_cube_direction(low / (SIZE * SIZE),
                                                       ((float)(low % SIZE) + (float)along) / SIZE,
                                                       ((float)(low / SIZE % SIZE) + at.y) / SIZE));
    return true;
}

void tl_bounce_sky_release(struct tl_bounce_sky *sky)
{
    tl_cube_release(&sky->cube);
    free(sky->sums);
    *sky = (struct tl_bounce_sky){0};
}
