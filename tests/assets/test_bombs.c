/* Small files that would cost much: each is read or refused within the memory and the time that a file of its
 * size may take, by a process of its own, whose peak is that of this file alone. */
#include "assets/environment/environment.h"
#include "assets/image/image_file.h"
#include "assets/model.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include "tests/assets/hostile.h"
#include "tests/testing.h"

#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

/* Of a file below a megabyte. */
#define BYTES_MAX   ((long)256 << 20)
#define SECONDS_MAX 2.0

static bool load_model(const char *path, tl_error *error)
{
    tl_model model;
    bool loaded = tl_model_load(path, &model, error);
    for (size_t i = 0; i < model.ignored_count; i++)
        snprintf(error->message, sizeof error->message, "read, but: %s", model.ignored[i]);
    tl_model_release(&model);
    return loaded;
}

static bool load_image(const char *path, tl_error *error)
{
    tl_image image;
    bool loaded = tl_image_load(path, &image, error);
    tl_image_release(&image);
    return loaded;
}

static bool load_environment(const char *path, tl_error *error)
{
    tl_environment environment;
    bool loaded = tl_environment_load(path, &environment, error);
    tl_environment_release(&environment);
    return loaded;
}

/* Loads the file in a child, and prints a row: the bomb, its size, its peak, its CPU time, the answer. */
static void measure(const char *path, bool (*load)(const char *, tl_error *), bool must_be_refused)
{
    fflush(stdout);
    pid_t child = fork();
    if (child == 0) {
        tl_error error = {0};
        bool loaded = load(path, &error);
        printf("    %s\n", error.message[0] ? error.message : "read");
        fflush(stdout);
        _exit(loaded ? 0 : error.code == TL_INPUT ? 2 : 3);
    }
    int status;
    struct rusage used;
    assert_int_equal(wait4(child, &status, 0, &used), child);
    double seconds = (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                     1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
    printf("  %-28s %8zu bytes %6ld MiB %6.2f s\n", strrchr(path, '/') + 1, tl_file_size(path),
           used.ru_maxrss / 1024, seconds);
    assert_true(WIFEXITED(status));
    assert_true(WEXITSTATUS(status) == 2 || (!must_be_refused && WEXITSTATUS(status) == 0));
    assert_true(tl_file_size(path) < (3 << 20)); /* the tests' own files are small */
#ifndef __SANITIZE_ADDRESS__
    size_t megabytes = 1 + tl_file_size(path) / (1 << 20);
    assert_true(used.ru_maxrss * 1024 < BYTES_MAX * (long)megabytes);
    assert_true(seconds < SECONDS_MAX * (double)megabytes);
#endif
}

/* ---- Writing ---- */

struct text {
    FILE *stream;
    char *bytes;
    size_t size;
};

static struct text *begin(struct text *text)
{
    text->stream = open_memstream(&text->bytes, &text->size);
    return text;
}

static const char *end(struct text *text, const char *name)
{
    const char *path = scratch(name);
    fclose(text->stream);
    scratch_write(path, text->bytes, text->size);
    free(text->bytes);
    return path;
}

static void put_32(FILE *stream, uint32_t value)
{
    for (int shift = 24; shift >= 0; shift -= 8)
        fputc((int)(value >> shift & 255), stream);
}

static void put_chunk(FILE *stream, const char *type, const void *bytes, size_t size)
{
    uLong crc = crc32(crc32(0, (const Bytef *)type, 4), size ? bytes : (const void *)"", (uInt)size);
    put_32(stream, (uint32_t)size);
    fwrite(type, 1, 4, stream);
    fwrite(bytes, 1, size, stream);
    put_32(stream, (uint32_t)crc);
}

/* A PNG of 8 bits and four channels, whose data are `raw_bytes` zeros, whatever its size. */
static const char *write_png(const char *name, uint32_t width, uint32_t height, size_t raw_bytes)
{
    struct text text;
    z_stream stream = {0};
    static uint8_t zeros[1 << 16], packed[4 << 20];
    assert_int_equal(deflateInit(&stream, 9), Z_OK);
    stream.next_out = packed;
    stream.avail_out = sizeof packed;
    for (size_t left = raw_bytes; left > 0;
         left -= stream.avail_in == 0 ? sizeof zeros < left ? sizeof zeros : left : 0) {
        stream.next_in = zeros;
        stream.avail_in = (uInt)(left < sizeof zeros ? left : sizeof zeros);
        assert_int_equal(deflate(&stream, Z_NO_FLUSH), Z_OK);
        assert_int_equal(stream.avail_in, 0);
    }
    assert_int_equal(deflate(&stream, Z_FINISH), Z_STREAM_END);
    const uint8_t header[13] = {(uint8_t)(width >> 24),
                                (uint8_t)(width >> 16),
                                (uint8_t)(width >> 8),
                                (uint8_t)width,
                                (uint8_t)(height >> 24),
                                (uint8_t)(height >> 16),
                                (uint8_t)(height >> 8),
                                (uint8_t)height,
                                8,
                                6};
    begin(&text);
    fwrite("\x89PNG\r\n\x1a\n", 1, 8, text.stream);
    put_chunk(text.stream, "IHDR", header, sizeof header);
    put_chunk(text.stream, "IDAT", packed, stream.total_out);
    put_chunk(text.stream, "IEND", NULL, 0);
    deflateEnd(&stream);
    return end(&text, name);
}

/* A progressive JPEG of three components: `scans` scans of `scan_bytes` zeros, each a scan of DC coefficients
 * of 0. */
static const char *write_jpeg(const char *name, int side, int scans, size_t scan_bytes)
{
    struct text text;
    FILE *stream = begin(&text)->stream;
    const uint8_t size[2] = {(uint8_t)(side >> 8), (uint8_t)side};
    fwrite("\xff\xd8\xff\xdb\0\x43\0", 1, 7, stream);
    for (int i = 0; i < 64; i++)
        fputc(1, stream);
    fwrite("\xff\xc2\0\x11\x08", 1, 5, stream);
    fwrite(size, 1, 2, stream);
    fwrite(size, 1, 2, stream);
    fwrite("\3\1\x11\0\2\x11\0\3\x11\0", 1, 10, stream);
    fwrite("\xff\xc4\0\x14\0\1\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 1, 22, stream);
    for (int scan = 0; scan < scans; scan++) {
        fwrite("\xff\xda\0\x0c\3\1\0\2\0\3\0\0\0\0", 1, 14, stream);
        for (size_t i = 0; i < scan_bytes; i++)
            fputc(0, stream);
    }
    fwrite("\xff\xd9", 1, 2, stream);
    return end(&text, name);
}

/* glTF with the given lists after the asset. */
static void begin_gltf(struct text *text)
{
    fprintf(begin(text)->stream, "{\"asset\":{\"version\":\"2.0\"}");
}

static void put_list(struct text *text, const char *name, const char *item, size_t count)
{
    fprintf(text->stream, ",\"%s\":[", name);
    for (size_t i = 0; i < count; i++)
        fprintf(text->stream, "%s%s", i ? "," : "", item);
    fprintf(text->stream, "]");
}

static const char *end_gltf(struct text *text, const char *name)
{
    fprintf(text->stream, "}");
    return end(text, name);
}

#define ONE_MESH "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}"

/* ---- The bombs ---- */

/* One mesh of a million zeros, which take no bytes of the file, at 60 nodes. */
static void instances(void **state)
{
    (void)state;
    struct text text;
    begin_gltf(&text);
    put_list(&text, "nodes", "{\"mesh\":0}", 60);
    put_list(&text, "meshes", ONE_MESH, 1);
    put_list(&text, "accessors", "{\"componentType\":5126,\"count\":1048575,\"type\":\"VEC3\"}", 1);
    measure(end_gltf(&text, "instances.gltf"), load_model, true);
}

/* Lists whose items are short in the file and long in memory. */
static void short_items(void **state)
{
    (void)state;
    static const struct {
        const char *list, *item;
    } cases[] = {{"extras", "0"},
                 {"extras", "[]"},
                 {"extras", "{}"},
                 {"extras", "\"\""},
                 {"materials", "{}"},
                 {"nodes", "{}"},
                 {"textures", "{}"},
                 {"extensionsUsed", "\"a\""},
                 {"samplers", "{}"},
                 {"meshes", "{\"primitives\":[]}"},
                 {"scenes", "{}"},
                 {"images", "{\"uri\":\"a\"}"},
                 {"animations", "{\"channels\":[],\"samplers\":[]}"}};
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        struct text text;
        char name[64];
        begin_gltf(&text);
        put_list(&text, cases[i].list, cases[i].item, 1000000 / (strlen(cases[i].item) + 1));
        if (strcmp(cases[i].list, "nodes") != 0)
            put_list(&text, "nodes", "{\"mesh\":0}", 1);
        if (strcmp(cases[i].list, "meshes") != 0)
            put_list(&text, "meshes", ONE_MESH, 1);
        put_list(&text, "accessors", "{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}", 1);
        snprintf(name, sizeof name, "%s_%zu.gltf", cases[i].list, i);
        measure(end_gltf(&text, name), load_model, false);
    }
}

/* Pictures that are small as files: of a huge size, with more data than their size takes, with many scans. */
static void pictures(void **state)
{
    (void)state;
    measure(write_png("plain.png", 8192, 8192, (size_t)8192 * (4 * 8192 + 1)), load_image, true);
    measure(write_png("overfull.png", 16, 16, (size_t)256 << 20), load_image, true);
    measure(write_png("bearable.png", 3000, 3000, (size_t)3000 * (4 * 3000 + 1)), load_image, false);
    measure(write_jpeg("progressive.jpg", 16384, 1, 40000), load_image, true);
    measure(write_jpeg("scans.jpg", 3000, 10000, 50), load_image, true);
    measure(write_jpeg("bearable.jpg", 3000, 10, 40000), load_image, false);
}

/* Many materials of a small picture each use another copy of it. */
static void maps_of_one_picture(void **state)
{
    (void)state;
    write_png("map.png", 2000, 2000, (size_t)2000 * (4 * 2000 + 1));
    struct text text;
    begin_gltf(&text);
    put_list(&text, "nodes", "{\"mesh\":0}", 1);
    put_list(&text, "meshes", ONE_MESH, 1);
    put_list(&text, "accessors", "{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}", 1);
    put_list(&text, "images", "{\"uri\":\"map.png\"}", 200);
    fprintf(text.stream, ",\"textures\":[");
    for (int i = 0; i < 200; i++)
        fprintf(text.stream, "%s{\"source\":%d}", i ? "," : "", i);
    fprintf(text.stream, "],\"materials\":[");
    for (int i = 0; i < 200; i++)
        fprintf(text.stream, "%s{\"normalTexture\":{\"index\":%d}}", i ? "," : "", i);
    fprintf(text.stream, "]");
    measure(end_gltf(&text, "maps.gltf"), load_model, false);

    begin(&text);
    for (int i = 0; i < 300; i++) {
        fprintf(text.stream, "newmtl m%d\nmap_Kd ", i);
        for (int k = 0; k < i; k++)
            fprintf(text.stream, "./");
        fprintf(text.stream, "map.png\n");
    }
    end(&text, "maps.mtl");
    fprintf(begin(&text)->stream, "mtllib maps.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n");
    for (int i = 0; i < 300; i++)
        fprintf(text.stream, "usemtl m%d\nf 1 2 3\n", i);
    measure(end(&text, "maps.obj"), load_model, false);
}

/* Faces that cross themselves have no ears to be cut. */
static void crossing_polygons(void **state)
{
    (void)state;
    struct text text;
    uint32_t seed = 20240229;
    begin(&text);
    for (int i = 0; i < 1000; i++)
        fprintf(text.stream, "v %u %u 0\n", next_random(&seed) % 100, next_random(&seed) % 100);
    for (int face = 0; face < 200; face++) {
        fprintf(text.stream, "f");
        for (int i = 0; i < 1000; i++)
            fprintf(text.stream, " %u", 1 + next_random(&seed) % 1000);
        fprintf(text.stream, "\n");
    }
    measure(end(&text, "crossing.obj"), load_model, false);
}

/* Every triangle has a corner at the first vertex. */
static void one_crowded_vertex(void **state)
{
    (void)state;
    struct text text;
    fprintf(begin(&text)->stream, "v 0 0 0\n");
    for (int i = 0; i < 30000; i++)
        fprintf(text.stream, "v %d %d 0\n", i, i % 7);
    for (int i = 2; i < 30000; i++)
        fprintf(text.stream, "f 1 %d %d\n", i, i + 1);
    measure(end(&text, "crowded.obj"), load_model, false);
}

/* An attribute that claims 2 GB, and pictures of claimed sizes. */
static void radiance(void **state)
{
    (void)state;
    static const char attribute[] = "\x76\x2f\x31\x01\2\0\0\0channels\0chlist\0\xff\xff\xff\x7f";
    const char *path = scratch("attribute.exr");
    scratch_write(path, attribute, sizeof attribute - 1);
    measure(path, load_environment, true);
    static const char huge[] = "#?RADIANCE\n\n-Y 16384 +X 16384\n\2\2\x40\0";
    path = scratch("claims.hdr");
    scratch_write(path, huge, sizeof huge - 1);
    measure(path, load_environment, true);
    struct text text;
    fprintf(begin(&text)->stream, "#?RADIANCE\n\n-Y 8000 +X 16000\n");
    for (int i = 0; i < 240000; i++)
        fputc(i % 2 ? 0 : 255, text.stream); /* runs of 127 */
    measure(end(&text, "runs.hdr"), load_environment, true);
}

/* What a user allows lifts the limit of small files, and is a limit itself. */
static void the_user_decides(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_image image;
    const char *path = write_png("allowed.png", 5000, 5000, (size_t)5000 * (4 * 5000 + 1));
    assert_false(tl_image_load(path, &image, &error));
    assert_non_null(strstr(error.message, "needs 191 MiB, but 128 MiB are allowed for a file of"));
    tl_memory_allow((uint64_t)4 << 30);
    assert_ok(tl_image_load(path, &image, &error), error);
    tl_image_release(&image);
    tl_memory_allow((uint64_t)100 << 20);
    assert_false(tl_image_load(path, &image, &error));
    assert_non_null(strstr(error.message, "needs 191 MiB of 100 MiB allowed"));
    tl_memory_allow(0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(instances),         cmocka_unit_test(short_items),
        cmocka_unit_test(pictures),          cmocka_unit_test(maps_of_one_picture),
        cmocka_unit_test(crossing_polygons), cmocka_unit_test(one_crowded_vertex),
        cmocka_unit_test(radiance),          cmocka_unit_test(the_user_decides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
