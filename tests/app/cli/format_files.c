/* format_files write FOLDER: writes a patch of cloth as the kinds of glTF file that take an encoder:
 * plain.glb, draco.glb, meshopt.glb and morph.glb, whose clip bends the patch by a morph target.
 * format_files coverage FILE.exr: prints the mean of its alpha, the share of the picture that is covered.
 * format_files box FILE.exr: prints the lower and the upper corner, in metres, of the points of its garment
 * (--aov). */
#include "render/inspect/aovs.h"
#include "tests/assets/gltf/packed.h"
#include "tests/exr_channel.h"
#include "tests/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The views' order: positions, UVs, indices, displacements, times, weights. Weight 1 at 1 s moves the patch's
 * free edge 0.5 m outwards. */
static struct packed_glb *make_morph(const struct patch *patch)
{
    static const float times_s[] = {0, 1, 2}, weights[] = {0, 1, 0};
    static float moves[3 * PATCH_VERTICES];
    for (int i = 0; i < PATCH_VERTICES; i++)
        moves[3 * i] = 0.5f * patch->uvs[2 * i];
    struct packed_glb *glb = TL_NEW(struct packed_glb);
    packed_put(glb, patch->positions, sizeof patch->positions);
    packed_put(glb, patch->uvs, sizeof patch->uvs);
    packed_put(glb, patch->indices, sizeof patch->indices);
    packed_put(glb, moves, sizeof moves);
    packed_put(glb, times_s, sizeof times_s);
    packed_put(glb, weights, sizeof weights);
    int written = snprintf(
        glb->json, sizeof glb->json,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"weights\":[0],\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},"
        "\"indices\":2,\"targets\":[{\"POSITION\":3}]}]}],"
        "\"animations\":[{\"name\":\"bend\",\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,"
        "\"path\":\"weights\"}}],\"samplers\":[{\"input\":4,\"output\":5}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":%d,\"type\":\"VEC2\"},"
        "{\"bufferView\":2,\"componentType\":5125,\"count\":%d,\"type\":\"SCALAR\"},"
        "{\"bufferView\":3,\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\"},"
        "{\"bufferView\":4,\"componentType\":5126,\"count\":3,\"type\":\"SCALAR\"},"
        "{\"bufferView\":5,\"componentType\":5126,\"count\":3,\"type\":\"SCALAR\"}],"
        "\"bufferViews\":[%s],\"buffers\":[{\"byteLength\":%zu}]}",
        PATCH_VERTICES, PATCH_VERTICES, PATCH_INDICES, PATCH_VERTICES, glb->views, glb->binary_size);
    assert_true((size_t)written < sizeof glb->json);
    return glb;
}

static void write_files(void)
{
    struct patch patch = patch_make();
    const struct {
        const char *name;
        struct packed_glb *glb;
    } files[] = {{"plain.glb", packed_make(&patch, PLAIN)},
                 {"draco.glb", packed_make(&patch, DRACO_EDGEBREAKER)},
                 {"meshopt.glb", packed_make(&patch, MESHOPT_FILTERS)},
                 {"morph.glb", make_morph(&patch)}};
    for (size_t i = 0; i < TL_COUNT(files); i++) {
        packed_write(files[i].glb, files[i].name);
        free(files[i].glb);
    }
}

static int print_coverage(const char *path)
{
    int width, height;
    double sum = 0;
    float *alpha = exr_read_channel(path, "A", &width, &height);
    assert_non_null(alpha);
    for (int i = 0; i < width * height; i++)
        sum += (double)alpha[i];
    free(alpha);
    printf("%.4f\n", sum / (width * height));
    return 0;
}

static int print_box(const char *path)
{
    static const char *const axes[] = {"P.x", "P.y", "P.z"};
    float lower[3], upper[3];
    int width, height;
    float *garment = exr_read_channel(path, TL_AOV_GARMENT, &width, &height);
    assert_non_null(garment);
    for (int c = 0; c < 3; c++) {
        float *values = exr_read_channel(path, axes[c], &width, &height);
        assert_non_null(values);
        lower[c] = INFINITY;
        upper[c] = -INFINITY;
        for (int i = 0; i < width * height; i++) {
            if (!(garment[i] > 0))
                continue;
            lower[c] = fminf(lower[c], values[i]);
            upper[c] = fmaxf(upper[c], values[i]);
        }
        free(values);
    }
    free(garment);
    for (int c = 0; c < 6; c++)
        printf("%.5f%s", (double)(c < 3 ? lower[c] : upper[c - 3]), c < 5 ? " " : "\n");
    return 0;
}

int main(int argc, char **argv)
{
    if (argc == 3 && strcmp(argv[1], "coverage") == 0)
        return print_coverage(argv[2]);
    if (argc == 3 && strcmp(argv[1], "box") == 0)
        return print_box(argv[2]);
    if (argc != 3 || strcmp(argv[1], "write") != 0 || chdir(argv[2]) != 0) {
        fprintf(stderr, "usage: format_files write FOLDER | coverage FILE.exr | box FILE.exr\n");
        return 2;
    }
    write_files();
    return 0;
}
