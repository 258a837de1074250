#include "render/env/emitters.h"

#include "render/env/exponent.h"

#include "tests/testing.h"

#define SIZE   64
#define TEXELS ((size_t)6 * SIZE * SIZE)

/* Lights of very different strength and colour, mostly dim: one texel in 50 outshines its neighbours a
 * thousand times. */
static tl_cube sparks(void)
{
    tl_cube cube = tl_cube_create(SIZE);
    for (uint32_t i = 0; i < 6 * SIZE * SIZE; i++) {
        uint32_t hash = (i + 1) * 2654435761u;
        hash ^= hash >> 15;
        hash *= 2246822519u;
        hash ^= hash >> 13;
        float strength = hash % 50 == 0 ? 1000 : 1;
        for (size_t c = 0; c < 3; c++)
            cube.texels[3 * (size_t)i + c] = strength * (float)(hash >> (8 + 8 * c) & 255) / 255;
    }
    return cube;
}

static float *solid_angles(int size)
{
    float *angles = calloc((size_t)size * (size_t)size, sizeof *angles);
    for (int i = 0; i < size * size; i++)
        angles[i] = tl_cube_solid_angle(size, i % size, i / size);
    return angles;
}

static vec3s direction_of(int i, int count)
{
    float y = 1 - 2 * ((float)i + 0.5f) / (float)count, phi = (float)i * 2.39996323f,
          radius = sqrtf(1 - y * y);
    return (vec3s){{radius * cosf(phi), y, radius * sinf(phi)}};
}

/* The integral itself: every texel as 3 x 3 points. */
#define FINE 3
static void integrate(const tl_cube *cube, const float *fine_angles, vec3s direction, float s, double out[3])
{
    int fine = FINE * SIZE;
    out[0] = out[1] = out[2] = 0;
    for (int i = 0; i < 6 * fine * fine; i++) {
        int face = i / (fine * fine), x = i % fine, y = i / fine % fine;
        vec3s point = glms_vec3_normalize(
            tl_cube_direction(face, ((float)x + 0.5f) / (float)fine, ((float)y + 0.5f) / (float)fine));
        double lobe = (double)tl_lobe_cosine(s, glms_vec3_dot(point, direction)) *
                      (double)fine_angles[i % (fine * fine)];
        for (int c = 0; c < 3; c++)
            out[c] += lobe * (double)cube->texels[3 * ((face * SIZE + y / FINE) * SIZE + x / FINE) + c];
    }
}

/* Merging costs less than 0.2 % on average, where neighbours differ most in strength and colour; in a
 * direction that few of them light it is more. Without it the error is that of a texel's shape. */
static void merged_light_is_that_of_all_texels(void **state)
{
    (void)state;
    tl_cube cube = sparks();
    float *angles = solid_angles(SIZE), *fine_angles = solid_angles(FINE * SIZE);
    uint32_t *order = tl_emitters_order(SIZE);
    tl_emitter *texels = tl_emitters_collect(&cube, angles, order, TEXELS);
    const float exponents[] = {1, 1.4f, 2, 4, 8, 16, 25, 40, 64, 128, 400};
    for (size_t e = 0; e < sizeof exponents / sizeof *exponents; e++) {
        float s = exponents[e], steps[TL_LANES] = {0};
        struct tl_emitters emitters = tl_emitters_merge(texels, TEXELS, SIZE, s);
        double worst = 0, sum = 0;
        struct tl_lobe_packet packet;
        vec3s directions[TL_LANES];
        float got[3][TL_LANES];
        for (int i = 0; i < TL_LANES; i++)
            directions[i] = direction_of(i, TL_LANES);
        tl_lobe_packet_set(&packet, directions, steps, s);
        tl_emitters_convolve(&emitters, &packet, got);
        for (int i = 0; i < TL_LANES; i++) {
            double expected[3];
            integrate(&cube, fine_angles, directions[i], s, expected);
            for (int c = 0; c < 3; c++) {
                double error = fabs((double)got[c][i] / expected[c] - 1);
                worst = fmax(worst, error);
                sum += error / (3 * TL_LANES);
            }
        }
        printf("s = %5.1f: %zu blocks, error mean %.3f %%, worst %.3f %%\n", (double)s, emitters.count,
               100 * sum, 100 * worst);
        tl_emitters_release(&emitters);
        assert_true(sum < 0.002 && worst < 0.01);
    }
    free(texels);
    free(order);
    free(angles);
    free(fine_angles);
    tl_cube_release(&cube);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(merged_light_is_that_of_all_texels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
