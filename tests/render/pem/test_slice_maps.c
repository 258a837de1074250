#include "render/pem/slice_maps.h"

#include "render/gpu/shaders.h"
#include "render/pem/chain.h"
#include "render/pem/memory.h"
#include "render/pem/pems.h"

#include "tests/testing.h"

#include <epoxy/gl.h>

#include <string.h>

#define SIZE    32
#define REGIONS 24
#define PROBES  256
#define LEVELS  6

static int open_gpu(void **state)
{
    tl_error error = {0};
    *state = tl_gpu_create_headless(&error);
    if (!*state)
        print_error("%s\n", error.message);
    return *state ? 0 : -1;
}

static int close_gpu(void **state)
{
    tl_gpu *gpu = *state;
    int leaked = tl_gpu_bytes(gpu) != 0 || tl_gpu_message_count(gpu) != 0;
    tl_gpu_destroy(&gpu);
    return leaked;
}

/* One row a level, one column a direction. */
static const char probe[] = "#version 450 core\n"
                            "#include \"slices.glsl\"\n"
                            "layout(location = 0) uniform int region;\n"
                            "layout(location = 1) uniform float levels[6];\n"
                            "layout(binding = 0) uniform sampler2D directions;\n"
                            "layout(location = 0) out vec4 light;\n"
                            "void main() {\n"
                            "  ivec2 p = ivec2(gl_FragCoord.xy);\n"
                            "  vec3 d = texelFetch(directions, ivec2(p.x, 0), 0).xyz;\n"
                            "  light = vec4(slice_fetch(region, d, levels[p.y]), 1.0);\n"
                            "}\n";

static vec3s direction_of(int i)
{
    float y = 1 - 2 * ((float)i + 0.5f) / PROBES, phi = (float)i * 2.39996323f, radius = sqrtf(1 - y * y);
    return (vec3s){{radius * cosf(phi), y, radius * sinf(phi)}};
}

static tl_cube bright_cube(float lamp)
{
    tl_cube cube = tl_cube_create(SIZE);
    for (uint32_t i = 0; i < 18 * SIZE * SIZE; i++)
        cube.texels[i] = (float)(((i + 1) * 2654435761u) >> 20) / 4096 * (i / 3 % 97 == 0 ? lamp : 1);
    return cube;
}

/* Shared exponent and three mantissas of nine bits [GL 4.5, section 8.5.2]. */
static void quantise(float colour[3], float scale)
{
    float maximum = fmaxf(fmaxf(colour[0], colour[1]), colour[2]) / scale;
    if (maximum <= 0)
        return;
    int exponent = (int)fmaxf(-16, floorf(log2f(maximum))) + 1;
    if (roundf(ldexpf(maximum, 9 - exponent)) >= 512)
        exponent++;
    for (int c = 0; c < 3; c++)
        colour[c] = scale * ldexpf(floorf(ldexpf(colour[c] / scale, 9 - exponent) + 0.5f), exponent - 9);
}

static struct tl_regions regions;
static struct tl_slices slices;

static size_t texel_count(int exponent)
{
    size_t side = (size_t)slices.side[exponent];
    return side * side * (size_t)regions.count;
}

/* Of the region's maps that are blended. */
static float brightest_texel(int region, struct tl_exponent_blend blend)
{
    float brightest = 0;
    for (int k = blend.index; k <= blend.index + (blend.weight > 0); k++) {
        const size_t values = 3 * (size_t)slices.side[k] * (size_t)slices.side[k];
        for (size_t i = 0; i < values; i++)
            brightest = fmaxf(brightest, slices.texels[k][(size_t)region * values + i]);
    }
    return brightest;
}

/* The texture holds what the format makes of the CPU's texels, and the shader fetches as the CPU does: what
 * remains is how finely software GL interpolates. */
static void fetches_agree(tl_gpu *gpu, float lamp, float scale)
{
    tl_cube cube = bright_cube(lamp);
    tl_regions_cut_sphere(&cube, REGIONS, &regions);
    const uint32_t all = 1u | 7u << 11 | 3u << (TL_EXPONENT_COUNT - 1);
    tl_slices_make(&slices, &cube, &regions, all);
    struct tl_slice_maps maps = {0};
    tl_slice_maps_upload(&maps, gpu, &slices);
    for (int k = 0; k <= TL_EXPONENT_COUNT; k++)
        for (size_t i = 0; i < (slices.texels[k] ? texel_count(k) : 0); i++)
            quantise(slices.texels[k] + 3 * i, scale);

    const struct tl_embedded *vertex = tl_embedded_find(tl_embedded_shaders, "fullscreen.vert");
    const struct tl_embedded *fetch = tl_embedded_find(tl_embedded_shaders, "slices.glsl");
    const struct tl_embedded shaders[] = {
        *vertex, *fetch, {"probe.frag", "render/test/probe.frag", probe, sizeof probe - 1}, {0}};
    tl_program program;
    tl_error error = {0};
    assert_ok(tl_program_create(gpu, shaders, "fullscreen.vert", "probe.frag", &program, &error), error);
    const unsigned format = GL_RGBA32F;
    tl_target target = tl_target_create(gpu, PROBES, LEVELS, &format, 1, false);
    tl_texture directions = tl_texture_create(gpu, GL_TEXTURE_2D, GL_RGBA32F, PROBES, 1, 1, 1);
    static vec4s probes[PROBES], got[LEVELS][PROBES];
    for (int i = 0; i < PROBES; i++)
        probes[i] = glms_vec4(direction_of(i), 0);
    glTextureSubImage2D(directions.id, 0, 0, 0, PROBES, 1, GL_RGBA, GL_FLOAT, probes);

    const float last = TL_EXPONENT_COUNT;
    const float levels[LEVELS] = {0, 11, 11.25f, 12.9f, last - 0.5f, last};
    double worst = 0, lit = 0;
    for (int region = 0; region < regions.count; region++) {
        glBindFramebuffer(GL_FRAMEBUFFER, target.id);
        glViewport(0, 0, PROBES, LEVELS);
        tl_gpu_reset_state(gpu);
        glUseProgram(program.id);
        glUniform1i(0, region);
        glUniform1fv(1, LEVELS, levels);
        glBindTextureUnit(0, directions.id);
        tl_slice_maps_bind(&maps);
        glBindFramebuffer(GL_FRAMEBUFFER, target.id);
        glViewport(0, 0, PROBES, LEVELS);
        tl_gpu_draw_fullscreen(gpu);
        glReadPixels(0, 0, PROBES, LEVELS, GL_RGBA, GL_FLOAT, got);
        for (int row = 0; row < LEVELS; row++) {
            struct tl_exponent_blend blend = {(int)levels[row], levels[row] - floorf(levels[row])};
            float peak = 0, brightest = brightest_texel(region, blend);
            for (int i = 0; i < PROBES; i++)
                peak = fmaxf(peak, got[row][i].y);
            lit += peak > 0;
            for (int i = 0; i < PROBES; i++) {
                vec3s expected = tl_slices_fetch(&slices, region, direction_of(i), blend);
                for (int c = 0; c < 3; c++)
                    worst = fmax(worst, fabs((double)(got[row][i].raw[c] - expected.raw[c])) /
                                            (double)fmaxf(brightest, 1e-6f * scale));
            }
        }
    }
    printf("worst difference %.2g of the region's brightest texel, %.0f of %d maps lit\n", worst, lit,
           LEVELS * regions.count);
    assert_true(worst <
                2 * TEST_WEIGHT); /* along two axes, between texels that differ by up to the brightest */
    assert_true(lit > 0.9 * LEVELS * regions.count);
    assert_int_equal(tl_slice_maps_bytes(&maps) >= tl_slices_bytes(&slices), 1);
    printf("%zu bytes of maps in %zu of texture\n", tl_slices_bytes(&slices), tl_slice_maps_bytes(&maps));
    tl_texture_destroy(&directions);
    tl_target_destroy(&target);
    tl_program_destroy(&program);
    tl_slice_maps_release(&maps);
    tl_slices_release(&slices);
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

static void the_shader_fetches_as_the_cpu(void **state)
{
    fetches_agree(*state, 30, 1);
}

/* 1e7 does not fit: the power of two that makes it fit is 256. */
static void a_sun_stays_in_range(void **state)
{
    fetches_agree(*state, 1e7f, 256);
}

/* pem/memory.h computes what is allocated. */
static void chains_take_what_is_computed(void **state)
{
    tl_gpu *gpu = *state;
    tl_cube cube = bright_cube(1);
    tl_regions_cut(&cube, REGIONS, &regions);
    struct tl_pems pems = {0};
    tl_pems_build(&pems, gpu, &cube, &regions, TL_CHAIN_SQRT_COSINE,
                  (struct tl_pem_storage){12, TL_PEM_CUBE});
    assert_int_equal(tl_pems_bytes(&pems), tl_memory_chains(REGIONS, SIZE));
    tl_pems_release(&pems);
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

static size_t stored_bytes(const tl_texture *texture)
{
    size_t bytes = 0;
    for (int level = 0; level < texture->levels; level++) {
        GLint width, height, depth;
        glGetTextureLevelParameteriv(texture->id, level, GL_TEXTURE_WIDTH, &width);
        glGetTextureLevelParameteriv(texture->id, level, GL_TEXTURE_HEIGHT, &height);
        glGetTextureLevelParameteriv(texture->id, level, GL_TEXTURE_DEPTH, &depth);
        bytes += (size_t)width * (size_t)height * (size_t)depth * 8;
    }
    return bytes;
}

/* The same for paraboloids, with what GL says of its textures; and switching back and forth leaves nothing.
 */
static void paraboloids_take_what_is_computed(void **state)
{
    tl_gpu *gpu = *state;
    tl_cube cube = bright_cube(1);
    struct tl_pems pems = {0};
    for (int sphere = 0; sphere < 2; sphere++) {
        if (sphere)
            tl_regions_cut_sphere(&cube, REGIONS, &regions);
        else
            tl_regions_cut(&cube, REGIONS, &regions);
        size_t before = tl_gpu_bytes(gpu) - tl_pems_bytes(&pems), stored = 0;
        tl_pems_build(&pems, gpu, &cube, &regions, TL_CHAIN_SQRT_COSINE,
                      (struct tl_pem_storage){7, TL_PEM_PARABOLOID});
        for (int i = 0; i < pems.array_count; i++)
            stored += stored_bytes(&pems.arrays[i]);
        size_t computed = tl_memory_paraboloids(&cube, &regions, TL_CHAIN_SQRT_COSINE, 7);
        assert_int_equal(tl_pems_bytes(&pems), computed);
        assert_int_equal(stored, computed);
        assert_int_equal(tl_gpu_bytes(gpu) - before, computed);
        assert_true(computed < tl_memory_chains(REGIONS, SIZE));
        printf("%zu bytes, cubes take %zu\n", computed, tl_memory_chains(REGIONS, SIZE));
    }
    tl_pems_build(&pems, gpu, &cube, &regions, TL_CHAIN_SQRT_COSINE, (struct tl_pem_storage){7, TL_PEM_CUBE});
    assert_int_equal(tl_pems_bytes(&pems), tl_memory_chains(REGIONS, SIZE));
    tl_pems_release(&pems);
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_shader_fetches_as_the_cpu),
        cmocka_unit_test(a_sun_stays_in_range),
        cmocka_unit_test(chains_take_what_is_computed),
        cmocka_unit_test(paraboloids_take_what_is_computed),
    };
    return cmocka_run_group_tests(tests, open_gpu, close_gpu);
}
