/* What is built in comes from the cache as it is made: the studio, the form, start shapes of garments.
 * Oracle: the same without a cache, to the bit. */
#include "tests/testing.h"

#include "assets/body/form.h"
#include "assets/cut/garment_cut.h"
#include "assets/cut/options.h"
#include "assets/environment/environment.h"
#include "assets/environment/studio.h"
#include "config/base/hash.h"
#include "config/cache/cache.h"

#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>

#define FOLDER TOILE_SCRATCH_DIR "/start"

static uint64_t hash_mesh(uint64_t hash, const tl_mesh *mesh)
{
    hash = tl_hash_words(hash, mesh->positions, mesh->vertex_count * sizeof *mesh->positions);
    hash = tl_hash_words(hash, mesh->normals, mesh->vertex_count * sizeof *mesh->normals);
    hash = tl_hash_words(hash, mesh->uvs, mesh->vertex_count * sizeof *mesh->uvs);
    return tl_hash_words(hash, mesh->indices, mesh->index_count * sizeof *mesh->indices);
}

static uint64_t hash_image(uint64_t hash, const tl_image *image)
{
    return tl_hash_words(hash, tl_image_floats(image),
                         3 * (size_t)image->width * (size_t)image->height * sizeof(float));
}

static uint64_t garment(const char *name, float edge_m, float ease_m)
{
    tl_garment garment;
    tl_error error;
    const struct tl_cut_params sizes = {.ease_m = ease_m};
    assert_true(tl_garment_cut_sized(name, edge_m, &sizes, NULL, &garment, &error));
    uint64_t hash = hash_mesh(TL_HASH_START, &garment.model.mesh);
    tl_garment_release(&garment);
    return hash;
}

enum { STUDIO, BACKDROP, FORM, DRESS, WIDE_DRESS, FINE_DRESS, SKIRT, COUNT };

static void make_all(uint64_t hashes[COUNT])
{
    tl_environment studio = tl_environment_studio();
    tl_avatar form = tl_avatar_form();
    hashes[STUDIO] = hash_image(TL_HASH_START, &studio.image);
    hashes[BACKDROP] = hash_image(TL_HASH_START, &studio.backdrop);
    hashes[FORM] = hash_mesh(TL_HASH_START, &form.model.mesh);
    hashes[DRESS] = garment("dress", 0.04f, 0);
    hashes[WIDE_DRESS] = garment("dress", 0.04f, 0.001f); /* as many vertices */
    hashes[FINE_DRESS] = garment("dress", 0.019f, 0);     /* from one of edges twice as long */
    hashes[SKIRT] = garment("skirt", 0.04f, 0);
    tl_avatar_release(&form);
    tl_environment_release(&studio);
}

/* The number of files, and of those among them that were used since 1970, as all are made to have been then.
 */
static void count_files(size_t *files, size_t *used)
{
    struct tl_cache_entry *entries = tl_cache_list(FOLDER, files);
    *used = 0;
    for (size_t i = 0; i < *files; i++) {
        const struct timespec long_ago[2] = {{0}, {0}};
        char path[4096];
        snprintf(path, sizeof path, "%s/%s", FOLDER, entries[i].name);
        *used += entries[i].used.tv_sec > 0;
        utimensat(AT_FDCWD, path, long_ago, 0);
    }
    free(entries);
}

static void what_is_kept_is_what_is_made(void **state)
{
    (void)state;
    uint64_t plain[COUNT], first[COUNT], second[COUNT];
    size_t files, used, more;
    make_all(plain);
    tl_cache_use(FOLDER, 1 << 26);
    tl_cache_clear(FOLDER);
    make_all(first);
    count_files(&files, &used);
    assert_true(files >= COUNT); /* rings around the form are kept as well */
    make_all(second);
    count_files(&more, &used);
    assert_int_equal(more, files);
    assert_int_equal(used, files - 1); /* all but the coarse cut of FINE_DRESS were read */
    assert_memory_equal(plain, first, sizeof plain);
    assert_memory_equal(plain, second, sizeof plain);
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < i; k++)
            assert_true(plain[i] != plain[k]);
    tl_cache_clear(FOLDER);
    tl_cache_use(NULL, 0);
    rmdir(FOLDER);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_kept_is_what_is_made)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
