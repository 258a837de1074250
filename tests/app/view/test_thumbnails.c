/* Thumbnails: of environments against their definition, of a fabric against its colour, from the cache byte
 * for byte, and of a list that opens, closes and opens again. */
#include "tests/testing.h"

#include "app/settings/settings.h"
#include "app/view/thumbnails/thumbnail.h"
#include "app/view/thumbnails/thumbnails.h"
#include "config/cache/cache.h"

#include <string.h>
#include <unistd.h>

static const uint8_t *pixel(const tl_image *image, int x, int y)
{
    return tl_image_bytes(image) + 4 * (y * image->width + x);
}

/* White is 1 from everywhere, which PBR Neutral takes to 0.87 linear: sRGB 240; none is black. */
static void environments(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int value;
    } cases[] = {{"white", 240}, {"none", 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        tl_image image;
        tl_error error = {0};
        assert_ok(tl_thumbnail_of_environment(cases[i].name, &image, &error), error);
        assert_int_equal(image.width, 2 * TL_THUMBNAIL_HEIGHT);
        for (int p = 0; p < image.width * image.height; p++)
            for (int c = 0; c < 3; c++)
                assert_near(tl_image_bytes(&image)[4 * p + c], cases[i].value, 1);
        tl_image_release(&image);
    }
}

/* Satin is red in the middle, and nothing covers the corners; the cache gives back the same. */
static void a_fabric_is_drawn_once(void **state)
{
    (void)state;
    tl_image first, second;
    tl_error error = {0};
    char folder[] = TOILE_SCRATCH_DIR "/thumbnails-XXXXXX";
    assert_non_null(mkdtemp(folder));
    tl_cache_use(folder, 1 << 20);
    assert_ok(tl_thumbnail_of_fabric("satin", &first, &error), error);
    const uint8_t *middle = pixel(&first, TL_THUMBNAIL_HEIGHT / 2, 2 * TL_THUMBNAIL_HEIGHT / 3);
    const uint8_t *corner = pixel(&first, 1, 1);
    assert_true(middle[0] > 2 * middle[1] && middle[0] > 2 * middle[2]);
    assert_true(corner[0] == corner[1] && corner[1] == corner[2]);
    size_t entries;
    free(tl_cache_list(folder, &entries));
    assert_int_equal(entries, 1);
    assert_ok(tl_thumbnail_of_fabric("satin", &second, &error), error);
    const size_t bytes = (size_t)4 * TL_THUMBNAIL_HEIGHT * TL_THUMBNAIL_HEIGHT;
    assert_memory_equal(first.texels, second.texels, bytes);
    tl_image_release(&second);
    assert_ok(tl_thumbnail_of_fabric("denim", &second, &error), error); /* of another key */
    assert_true(memcmp(first.texels, second.texels, bytes) != 0);
    tl_image_release(&first);
    tl_image_release(&second);
    tl_cache_clear(folder);
    tl_cache_use(NULL, 0);
    rmdir(folder);
}

static void wake(void) {}

static const struct tl_option *find(const struct tl_settings *settings, const char *name)
{
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind((struct tl_settings *)settings, bindings);
    for (int i = 0; i < TL_SETTINGS_TABLES; i++)
        for (size_t r = 0; r < bindings[i].table->row_count; r++)
            if (strcmp(bindings[i].table->rows[r].name, name) == 0)
                return &bindings[i].table->rows[r];
    return NULL;
}

/* A list that closes before its first thumbnail is made goes on when it opens again; other lists have none.
 */
static void lists(void **state)
{
    (void)state;
    static struct tl_settings settings;
    const struct tl_option *environment = find(&settings, "environment"),
                           *garment = find(&settings, "garment");
    tl_thumbnails *thumbnails = tl_thumbnails_create(wake);
    size_t count;
    tl_thumbnails_follow(thumbnails, garment);
    assert_null(tl_thumbnails_images(thumbnails, &count));
    tl_thumbnails_follow(thumbnails, environment);
    tl_thumbnails_follow(thumbnails, NULL);
    assert_null(tl_thumbnails_images(thumbnails, &count));
    size_t rises = 0;
    for (count = 0; count < 3; usleep(1000)) {
        rises += tl_thumbnails_follow(thumbnails, environment);
        assert_non_null(tl_thumbnails_images(thumbnails, &count));
    }
    assert_true(rises >= 1 && rises <= 3);
    assert_false(tl_thumbnails_follow(thumbnails, environment));
    tl_thumbnails_follow(thumbnails, find(&settings, "fabric"));
    tl_thumbnails_destroy(&thumbnails); /* in the middle of the work */
    assert_null(thumbnails);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(environments),
        cmocka_unit_test(a_fabric_is_drawn_once),
        cmocka_unit_test(lists),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
