#include "render/pem/memory.h"
#include "render/pem/slices.h"

#include "tests/testing.h"

#define MB 1048576.0

/* Six faces of RGBA16F, four bytes of RG16F; N times. The PEM columns are double: that is the paper's, and
 * why both are printed. */
static void figure_8_is_what_its_formats_take(void **state)
{
    (void)state;
    for (int row = 0; row < TL_PAPER_ROWS; row++) {
        const struct tl_paper_memory *paper = &tl_paper_memory[row];
        printf("N = %3d:", paper->regions);
        for (int i = 0; i < TL_PAPER_PEMS; i++) {
            double cubes = (double)tl_memory_cubes(paper->regions, tl_paper_pem_sizes[i]) / MB;
            double chains = (double)tl_memory_chains(paper->regions, tl_paper_pem_sizes[i]) / MB;
            printf("  %d^2: paper %g MB, without mips %g, with %.2f", tl_paper_pem_sizes[i],
                   paper->pems_mb[i], cubes, chains);
            assert_near(paper->pems_mb[i], 2 * cubes, 0);
            assert_true(chains > 1.333 * cubes && chains < 4.0 / 3 * cubes);
        }
        printf("\n");
        for (int i = 0; i < TL_PAPER_MAPS; i++)
            assert_near(paper->maps_mb[i],
                        (double)tl_memory_shadow_maps(paper->regions, tl_paper_map_sizes[i], 4) / MB, 0);
    }
}

static tl_cube even_cube(int size)
{
    tl_cube cube = tl_cube_create(size);
    for (int i = 0; i < 18 * size * size; i++)
        cube.texels[i] = 1;
    return cube;
}

/* Cropped maps of smaller regions take less; slices are measured without making them. Sums of texels can fall
 * by the area of the regions only: what the filters reach beyond them stays. */
static void cropped_forms_take_less(void **state)
{
    (void)state;
    static struct tl_regions regions;
    tl_cube cube = even_cube(128);
    double before = INFINITY;
    const int counts[] = {6, 24, 64, 96, 384};
    for (int i = 0; i < 5; i++) {
        tl_regions_cut_sphere(&cube, counts[i], &regions);
        static struct tl_slices slices;
        uint32_t needed = tl_exponents_needed(0.95f, 0.95f);
        double chains = (double)tl_memory_chains(regions.count, 128) / MB;
        double paraboloids = (double)tl_memory_paraboloids(&cube, &regions, TL_CHAIN_SQRT_COSINE, 12) / MB;
        double expected = (double)tl_slices_bytes_of(&cube, &regions, needed);
        tl_slices_make(&slices, &cube, &regions, needed);
        assert_near((double)tl_slices_bytes(&slices), expected, 0);
        tl_slices_release(&slices);
        printf("N = %3d: chains %.1f MB, paraboloids cropped %.2f MB, slices for g = 0.95 %.2f MB, for any g "
               "%.1f MB\n",
               regions.count, chains, paraboloids, expected / MB,
               (double)tl_slices_bytes_of(&cube, &regions, 0xffffffff) / MB);
        assert_true(paraboloids < chains && expected / MB < 0.15 * regions.count);
        assert_true(paraboloids / regions.count < before);
        before = paraboloids / regions.count;
        tl_regions_release(&regions);
    }
    tl_cube_release(&cube);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(figure_8_is_what_its_formats_take),
        cmocka_unit_test(cropped_forms_take_less),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
