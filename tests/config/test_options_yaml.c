/* Whole documents: what is read, what is refused and in which words, print and read back, and random damage.
 */
#include "tests/testing.h"

#include "config/base/file.h"
#include "config/base/memory.h"
#include "config/options.h"
#include "tests/config/sample_tables.h"

#include <string.h>

static struct sample sample;
static struct tl_binding bindings[SAMPLE_TABLES];

static int begin(void **state)
{
    (void)state;
    memset(&sample, 0, sizeof sample);
    sample_bind(&sample, bindings);
    return 0;
}

static void accept(const char *document)
{
    tl_error error = {0};
    assert_ok(tl_options_read_yaml(bindings, SAMPLE_TABLES, "s.yaml", document, strlen(document), &error),
              error);
}

static void refuse(const char *document, const char *message)
{
    tl_error error = {0};
    assert_false(tl_options_read_yaml(bindings, SAMPLE_TABLES, "s.yaml", document, strlen(document), &error));
    assert_string_equal(error.message, message);
    assert_int_equal(error.code, TL_USAGE);
}

static void test_document_is_read(void **state)
{
    (void)state;
    accept("# a scene\n"
           "light:\n"
           "  regions: 48 # half\n"
           "  lobe: 'single'\n"
           "  ground: no\n"
           "scene: {title: 'it''s: #1', tint: [0.5, 0.25, 0]}\n");
    assert_int_equal(sample.light.regions, 48);
    assert_int_equal(sample.light.lobe, 0);
    assert_false(sample.light.ground);
    assert_true(sample.scene.tint[0] == 0.5f && sample.scene.tint[1] == 0.25f && sample.scene.tint[2] == 0);
    assert_string_equal(sample.scene.title, "it's: #1");
    assert_true(sample.light.softness == 0.05f); /* not named: as it was */
}

static void test_documents_with_nothing(void **state)
{
    (void)state;
    struct sample before = sample;
    static const char *const empty[] = {"",
                                        "\n",
                                        "# only a comment\n",
                                        "---\n",
                                        "{}\n",
                                        "light:\n",
                                        "light: {}\n",
                                        "\xEF\xBB\xBF# a byte order mark\n",
                                        "%YAML 1.1\n---\nlight:\n...\n"};
    for (size_t i = 0; i < TL_COUNT(empty); i++)
        accept(empty[i]);
    assert_memory_equal(&sample, &before, sizeof sample);
}

static void test_windows_line_ends_and_byte_order_mark(void **state)
{
    (void)state;
    accept("\xEF\xBB\xBFlight:\r\n  regions: 12\r\nscene:\r\n  title: a\r\n");
    assert_int_equal(sample.light.regions, 12);
    assert_string_equal(sample.scene.title, "a");
}

static void test_messages_name_line_and_key(void **state)
{
    (void)state;
    static const struct {
        const char *document, *message;
    } cases[] = {
        {"light:\n  lobe: dual\n\n  regions: 7000\n",
         "s.yaml:4: light.regions: 7000 is out of range: expected a whole number from 6 to 384"},
        {"light:\n  regionz: 12\n", "s.yaml:2: light.regionz: no such option: did you mean light.regions?"},
        {"scene:\n  title: a\nlights:\n  regions: 12\n",
         "s.yaml:3: lights: no such table: did you mean light?"},
        {"light:\n  regions:\n", "s.yaml:2: light.regions: an empty value is not a whole number: expected a "
                                 "whole number from 6 to 384"},
        {"light:\n  regions: [1, 2]\n",
         "s.yaml:2: light.regions: [1, 2] is not a whole number: expected a whole number from 6 to 384"},
        {"light:\n  regions: {a: 1}\n",
         "s.yaml:2: light.regions: is a table inside a table: expected one value"},
        {"scene:\n  title: [a]\n", "s.yaml:2: scene.title: is a list: expected one value"},
        {"scene:\n  tint: [1, [2], 3]\n",
         "s.yaml:2: scene.tint: is a long or nested list: expected one value or [a, b, c]"},
        {"scene:\n  tint: [1, 1, 1, 1]\n",
         "s.yaml:2: scene.tint: is a long or nested list: expected one value or [a, b, c]"},
        {"scene:\n  tint: []\n", "s.yaml:2: scene.tint: [] is not a number: expected [r, g, b], each from 0 "
                                 "to 1 linear, \"#rrggbb\", lab(L, a, b) or a CSS name"},
        {"light:\n  regions: 12\n  lobe: dual\n  regions: 24\n",
         "s.yaml:4: light.regions: is given twice, first on line 2: remove one"},
        {"light:\n  regions: 12\nscene:\n  title: a\nlight:\n  lobe: dual\n",
         "s.yaml:5: light: is given twice, first on line 1: remove one"},
        {"regions: 12\n", "s.yaml:1: regions: is no table: expected options, indented below it"},
        {"light.regions: 12\n",
         "s.yaml:1: light.regions: stands outside a table: write it as `light: {regions: ...}`"},
        {"light: [1]\n", "s.yaml:1: light: is no table: expected options, indented below it"},
        {"just text\n", "s.yaml:1: expected tables of options, as in `light: {regions: 96}`"},
        {"- light\n", "s.yaml:1: expected tables of options, as in `light: {regions: 96}`"},
        {"{[a]: b}\n", "s.yaml:1: a list or table stands where a table's name was expected"},
        {"light: {{a: b}: c}\n", "s.yaml:1: a list or table stands where an option's name was expected"},
        {"light: &l\n  regions: 12\n", "s.yaml:1: anchors (&name) are not used here: remove it"},
        {"light:\n  regions: &r 12\n", "s.yaml:2: anchors (&name) are not used here: remove it"},
        {"light:\n  regions: *r\n", "s.yaml:2: aliases (*name) are not used here: write the value out"},
        {"light:\n  regions: !!int 12\n", "s.yaml:2: tags (!name) are not used here: remove it"},
        {"scene:\n  title: \"a\\0b\"\n", "s.yaml:2: a zero byte stands in the text: remove it"},
        {"light:\n  regions: 12\n---\nscene:\n  title: a\n",
         "s.yaml:3: a second document begins: keep one to a file"},
        {"light:\n  regions: 12\n bad: [\n",
         "s.yaml:3: not valid YAML: while parsing a block mapping, did not find expected key: check the "
         "indentation (spaces, no tabs), quotes and brackets"},
        {"light:\n\tregions: 12\n",
         "s.yaml:2: not valid YAML: while scanning for the next token, found character that cannot start any "
         "token: check the indentation (spaces, no tabs), quotes and brackets"},
        {"scene:\n  title: \"open\n",
         "s.yaml:3: not valid YAML: while scanning a quoted scalar, found unexpected end of stream: check "
         "the indentation (spaces, no tabs), quotes and brackets"},
        {"scene:\n  title: caf\xE9 au lait\n",
         "s.yaml:2: invalid trailing UTF-8 octet: write the file as UTF-8 text"},
        {"scene:\n  title: a\x01\n",
         "s.yaml:2: control characters are not allowed: write the file as UTF-8 text"},
    };
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        refuse(cases[i].document, cases[i].message);
        begin(state);
    }
}

static void test_other_encodings_are_refused(void **state)
{
    (void)state;
    static const char utf16[] = "\xFF\xFEl\0i\0g\0h\0t\0:\0\n\0";
    tl_error error = {0};
    assert_false(tl_options_read_yaml(bindings, SAMPLE_TABLES, "s.yaml", utf16, sizeof utf16 - 1, &error));
    assert_string_equal(error.message, "s.yaml:1: invalid leading UTF-8 octet: write the file as UTF-8 text");
    static const char zeros[64];
    assert_false(tl_options_read_yaml(bindings, SAMPLE_TABLES, "s.yaml", zeros, sizeof zeros, &error));
}

/* A document that is all brackets must not take time or stack in proportion to anything but its length. */
static void test_deep_and_large_documents(void **state)
{
    (void)state;
    size_t size = TL_LIMIT_YAML_BYTES;
    char *document = tl_alloc(size + 2, 1);
    tl_error error = {0};
    static const char fillers[] = {'[', '{', '-', '?', ' ', '#', 'a', '"', '&', '\n'};
    for (size_t i = 0; i < sizeof fillers; i++) {
        memset(document, fillers[i], size);
        memcpy(document, "scene:\n  tint: [", 16);
        tl_options_read_yaml(bindings, SAMPLE_TABLES, "s.yaml", document, size, &error);
        memset(document, fillers[i], size);
        tl_options_read_yaml(bindings, SAMPLE_TABLES, "s.yaml", document, size, &error);
    }
    memset(document, '#', size + 1);
    assert_ok(tl_options_read_yaml(bindings, SAMPLE_TABLES, "s.yaml", document, size, &error), error);
    assert_false(tl_options_read_yaml(bindings, SAMPLE_TABLES, "s.yaml", document, size + 1, &error));
    assert_string_equal(error.message, "s.yaml: is larger than 1 MiB: that is no list of options");
    free(document);
}

static char *print_document(void)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    tl_options_print_yaml(bindings, SAMPLE_TABLES, out);
    fclose(out);
    return text;
}

/* Printed and read back, every bit of every field is the same; text that YAML would take for something else
 * included. */
static void test_print_and_read_back(void **state)
{
    (void)state;
    static const char *const texts[] = {"",
                                        "none",
                                        "~",
                                        "null",
                                        "12",
                                        "true",
                                        "a: b",
                                        "# no comment",
                                        "- item",
                                        "[a, b]",
                                        "{a: b}",
                                        "&a",
                                        "*a",
                                        "!a",
                                        "%a",
                                        "@a",
                                        "`a",
                                        "\"quoted\" 'twice'",
                                        "back\\slash \\n",
                                        " leading and trailing ",
                                        "...",
                                        "---",
                                        "a\\",
                                        "caf\xC3\xA9 \xF0\x9F\x91\x97",
                                        "? x",
                                        "|",
                                        ">"};
    for (size_t i = 0; i < TL_COUNT(texts); i++) {
        begin(state);
        sample.scene.title = texts[i];
        sample.scene.file = texts[i];
        sample.light.softness = 1.0f / 3 + (float)i / 9;
        sample.light.bias_m = 1e11 / (double)(i + 3);
        sample.light.lobe = (int)(i % 3);
        sample.light.ground = i % 2;
        sample.scene.tint[1] = 1 / (float)(i + 1);
        sample.scene.target[2] = -100 / (float)(i + 1);
        struct sample before = sample;
        char *document = print_document();
        begin(state);
        accept(document);
        assert_true(tl_options_equal(&sample_light_table, &sample.light, &before.light));
        assert_true(tl_options_equal(&sample_scene_table, &sample.scene, &before.scene));
        free(document);
    }
}

static void test_files(void **state)
{
    (void)state;
    tl_error error = {0};
    assert_ok(tl_folder_make(TOILE_SCRATCH_DIR "/yaml", &error), error);
    struct tl_writer writer;
    assert_ok(tl_writer_begin(&writer, TOILE_SCRATCH_DIR "/yaml/s.yaml", &error), error);
    fputs("scene:\n  file: a.glb\n  garment: b.glb\n", writer.stream);
    assert_ok(tl_writer_commit(&writer, &error), error);
    assert_ok(tl_options_read_yaml_file(bindings, SAMPLE_TABLES, TOILE_SCRATCH_DIR "/yaml/s.yaml", &error),
              error);
    assert_string_equal(sample.scene.file, TOILE_SCRATCH_DIR "/yaml/a.glb");
    assert_string_equal(sample.scene.garment, TOILE_SCRATCH_DIR "/yaml/b.glb");

    assert_false(
        tl_options_read_yaml_file(bindings, SAMPLE_TABLES, TOILE_SCRATCH_DIR "/yaml/none.yaml", &error));
    assert_string_equal(error.message, TOILE_SCRATCH_DIR "/yaml/none.yaml: no such file: check the path");
    assert_ok(tl_writer_begin(&writer, TOILE_SCRATCH_DIR "/yaml/large.yaml", &error), error);
    assert_int_equal(ftruncate(fileno(writer.stream), (off_t)TL_LIMIT_YAML_BYTES + 1), 0);
    assert_ok(tl_writer_commit(&writer, &error), error);
    assert_false(
        tl_options_read_yaml_file(bindings, SAMPLE_TABLES, TOILE_SCRATCH_DIR "/yaml/large.yaml", &error));
    assert_string_equal(error.message,
                        TOILE_SCRATCH_DIR "/yaml/large.yaml: is larger than 1 MiB: make it smaller");
}

/* xorshift64* [Vigna 2016]: the same damage on every run. */
static uint64_t random_state = 0x9E3779B97F4A7C15u;
static size_t random_below(size_t bound)
{
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return (size_t)((random_state * 0x2545F4914F6CDD1Du) >> 33) % bound;
}

/* One random edit of a document of `*size` bytes in a buffer of `room`. */
static void damage(char *document, size_t *size, size_t room)
{
    static const char telling[] = ":-[]{},&*!|>'\"%@`#?\n\t \\0.e\xC3\xA9\xFF";
    size_t at = random_below(*size);
    switch (random_below(5)) {
    case 0: /* another byte */
        document[at] = telling[random_below(sizeof telling)];
        break;
    case 1: /* a flipped bit */
        document[at] = (char)(document[at] ^ (1 << random_below(8)));
        break;
    case 2: /* cut off */
        *size = at + 1;
        break;
    case 3: { /* a piece repeated elsewhere */
        size_t length = random_below(*size - at) + 1, to = random_below(room - length + 1);
        memmove(document + to, document + at, length);
        *size = to + length > *size ? to + length : *size;
        break;
    }
    case 4: { /* a piece taken out */
        size_t length = random_below(*size - at);
        memmove(document + at, document + at + length, *size - at - length);
        *size -= length;
        break;
    }
    }
}

/* Whatever a file holds: it is read, or refused with a message, and what was set lies within its range. Run
 * under ASan this is the fuzz test in small. */
static void test_random_damage(void **state)
{
    char *original = print_document();
    size_t room = 2 * strlen(original);
    size_t refused = 0;
    for (int round = 0; round < 20000; round++) {
        begin(state);
        char *document = tl_alloc(room, 1);
        size_t size = strlen(original);
        memcpy(document, original, size);
        for (size_t edits = random_below(6) + 1; edits > 0; edits--)
            damage(document, &size, room);
        char *exact =
            tl_alloc(size, 1); /* a buffer of just this size, so that ASan sees a byte read beyond it */
        memcpy(exact, document, size);
        tl_error error = {0};
        bool read = tl_options_read_yaml(bindings, SAMPLE_TABLES, "s.yaml", exact, size, &error);
        refused += !read;
        assert_true(read || error.message[0] != '\0');
        assert_in_range(sample.light.regions, 6, 384);
        assert_in_range(sample.light.lobe, 0, 2);
        assert_true(sample.light.softness >= 0.001f && sample.light.softness <= 10);
        assert_true(strlen(sample.scene.title) < TL_STRING_SIZE);
        free(exact);
        free(document);
    }
    assert_in_range(refused, 5000,
                    19900); /* the edits both spare and break documents, or they test nothing */
    free(original);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_document_is_read, begin),
        cmocka_unit_test_setup(test_documents_with_nothing, begin),
        cmocka_unit_test_setup(test_windows_line_ends_and_byte_order_mark, begin),
        cmocka_unit_test_setup(test_messages_name_line_and_key, begin),
        cmocka_unit_test_setup(test_other_encodings_are_refused, begin),
        cmocka_unit_test_setup(test_deep_and_large_documents, begin),
        cmocka_unit_test_setup(test_print_and_read_back, begin),
        cmocka_unit_test_setup(test_files, begin),
        cmocka_unit_test_setup(test_random_damage, begin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
