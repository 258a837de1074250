/* The words of the product, against the table tests/hygiene/words.txt: comments, messages, option names, JSON
 * keys and identifiers use the terms of the field, and comments begin with their subject. */
#include "tests/hygiene/sources.h"

#include "config/base/file.h"
#include "config/base/memory.h"
#include "tests/hygiene/house.h"
#include "tests/testing.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#define TABLE     TOILE_SOURCE_DIR "/tests/hygiene/words.txt"
#define WORDS_MAX 6
#define LETTERS   "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"

/* A word, or several in sequence. */
struct phrase {
    char *words[WORDS_MAX];
    size_t count;
};

struct phrases {
    struct phrase *items;
    size_t count;
};

/* The places in which a row's words are looked for. */
enum kind { KIND_ANY, KIND_TEXT, KIND_NAME, KIND_OPEN, KIND_COUNT };
static const char *const kind_names[] = {"any", "text", "name", "open"};

struct row {
    enum kind kind;
    struct phrases banned, unless;
    char *instead;
    size_t allowed, hits;
};

static struct row *rows;
static size_t row_count;
static struct sources sources;

/* ---- The table ---- */

static void add_phrase(struct phrases *phrases, const char *text, size_t length)
{
    struct phrase phrase = {.count = 0};
    for (size_t at = 0; at < length && phrase.count < WORDS_MAX;) {
        size_t word = 0;
        while (at + word < length && isalpha((unsigned char)text[at + word]))
            word++;
        if (word > 0) {
            char *copy = tl_format("%.*s", (int)word, text + at);
            for (char *letter = copy; *letter; letter++)
                *letter = (char)tolower((unsigned char)*letter);
            phrase.words[phrase.count++] = copy;
        }
        at += word + 1;
    }
    assert_true(phrase.count > 0);
    phrases->items = tl_resize(phrases->items, phrases->count + 1, sizeof *phrases->items);
    phrases->items[phrases->count++] = phrase;
}

/* Adds "one | two words | three". */
static void add_phrases(struct phrases *phrases, const char *text, size_t length)
{
    for (size_t at = 0; at < length;) {
        const char *bar = memchr(text + at, '|', length - at);
        size_t part = bar ? (size_t)(bar - text) - at : length - at;
        add_phrase(phrases, text + at, part);
        at += part + 1;
    }
}

/* KIND WORDS -> INSTEAD; or KIND WORDS -> INSTEAD; still N; or, below it, "  unless WORDS: reason". */
static void read_line(const char *line, size_t length)
{
    if (length == 0 || *line == '#')
        return;
    if (strncmp(line, "  unless ", 9) == 0) {
        const char *colon = memchr(line, ':', length);
        assert_true(row_count > 0 && colon && colon + 2 < line + length);
        add_phrases(&rows[row_count - 1].unless, line + 9, (size_t)(colon - line) - 9);
        return;
    }
    struct row row = {.kind = KIND_COUNT};
    for (int kind = 0; kind < KIND_COUNT; kind++)
        if (strncmp(line, kind_names[kind], strlen(kind_names[kind])) == 0 &&
            line[strlen(kind_names[kind])] == ' ')
            row.kind = (enum kind)kind;
    char *whole = tl_format("%.*s", (int)length, line), *arrow = strstr(whole, " -> "),
         *still = strstr(whole, "; still ");
    if (row.kind == KIND_COUNT || !arrow)
        fail_msg("%s: is no row of words.txt", whole);
    add_phrases(&row.banned, whole + strlen(kind_names[row.kind]) + 1,
                (size_t)(arrow - whole) - strlen(kind_names[row.kind]) - 1);
    if (still) {
        row.allowed = strtoul(still + strlen("; still "), NULL, 10);
        *still = '\0';
    }
    row.instead = tl_copy_string(arrow + 4);
    free(whole);
    rows = tl_resize(rows, row_count + 1, sizeof *rows);
    rows[row_count++] = row;
}

static void read_table(const char *text)
{
    for (const char *line = text; *line;) {
        size_t length = strcspn(line, "\n");
        read_line(line, length);
        line += length + (line[length] == '\n');
    }
}

static void release_phrases(struct phrases *phrases)
{
    for (size_t i = 0; i < phrases->count; i++)
        for (size_t j = 0; j < phrases->items[i].count; j++)
            free(phrases->items[i].words[j]);
    free(phrases->items);
}

static void release_table(void)
{
    for (size_t i = 0; i < row_count; i++) {
        release_phrases(&rows[i].banned);
        release_phrases(&rows[i].unless);
        free(rows[i].instead);
    }
    free(rows);
    rows = NULL;
    row_count = 0;
}

/* ---- Words of a piece ---- */

/* The words of a comment, string or identifier in lower case: parts of identifiers are words, too. */
struct words {
    char (*items)[32];
    size_t count;
};

static void split(const char *text, size_t length, struct words *words)
{
    words->count = 0;
    for (size_t at = 0; at < length;) {
        if (!isalpha((unsigned char)text[at])) {
            at++;
            continue;
        }
        char *word = words->items[words->count];
        size_t size = 0;
        do {
            if (size + 1 < sizeof words->items[0])
                word[size++] = (char)tolower((unsigned char)text[at]);
            at++;
        } while (at < length && isalpha((unsigned char)text[at]) &&
                 !(islower((unsigned char)text[at - 1]) && isupper((unsigned char)text[at])));
        word[size] = '\0';
        words->count++;
    }
}

static bool stands_at(const struct phrase *phrase, const struct words *words, size_t at)
{
    if (at + phrase->count > words->count)
        return false;
    for (size_t i = 0; i < phrase->count; i++)
        if (strcmp(words->items[at + i], phrase->words[i]) != 0)
            return false;
    return true;
}

/* Whether an exception of the row covers the word `at`. */
static bool is_excepted(const struct row *row, const struct words *words, size_t at)
{
    for (size_t i = 0; i < row->unless.count; i++)
        for (size_t back = 0; back < row->unless.items[i].count && back <= at; back++)
            if (stands_at(&row->unless.items[i], words, at - back))
                return true;
    return false;
}

static size_t count_hits(const struct row *row, const struct words *words)
{
    size_t hits = 0;
    for (size_t at = 0; at < words->count && (row->kind != KIND_OPEN || at == 0); at++)
        for (size_t i = 0; i < row->banned.count; i++)
            hits += stands_at(&row->banned.items[i], words, at) && !is_excepted(row, words, at);
    return hits;
}

/* ---- Pieces of a file ---- */

enum piece { PIECE_NONE, PIECE_COMMENT, PIECE_STRING, PIECE_NAME };

/* The kind of the piece that begins at `text`, and its length. `is_yaml`: comments begin with #. */
static enum piece next_piece(const char *text, bool is_yaml, size_t *length)
{
    const char *end;
    *length = 1;
    if (strncmp(text, "/*", 2) == 0 && !is_yaml) {
        end = strstr(text + 2, "*/");
        *length = end ? (size_t)(end - text) + 2 : strlen(text);
        return PIECE_COMMENT;
    }
    if (is_yaml ? *text == '#' : strncmp(text, "//", 2) == 0) {
        *length = strcspn(text, "\n");
        return PIECE_COMMENT;
    }
    if (*text == '"' || *text == '\'') {
        for (end = text + 1; *end && *end != *text && *end != '\n'; end++)
            end += *end == '\\' && end[1];
        *length = (size_t)(end - text) + (*end == *text);
        return *text == '"' ? PIECE_STRING : PIECE_NONE;
    }
    if (!isalpha((unsigned char)*text) && *text != '_')
        return PIECE_NONE;
    while (isalnum((unsigned char)text[*length]) || text[*length] == '_')
        ++*length;
    return PIECE_NAME;
}

static bool is_in(const struct row *row, enum piece piece)
{
    switch (row->kind) {
    case KIND_ANY:
        return piece != PIECE_NONE;
    case KIND_TEXT:
        return piece == PIECE_COMMENT || piece == PIECE_STRING;
    case KIND_NAME:
        return piece == PIECE_NAME;
    default:
        return piece == PIECE_COMMENT;
    }
}

/* Lengths of the mark of a comment, and of lines of // that follow one another, which are one comment. */
static size_t comment_length(const char *text, bool is_yaml, size_t length)
{
    const char *mark = is_yaml ? "#" : "//";
    if (strncmp(text, mark, strlen(mark)) != 0)
        return length;
    for (;;) {
        size_t gap = strspn(text + length, "\n \t");
        if (text[length] != '\n' || strncmp(text + length, "\n\n", 2) == 0 ||
            strncmp(text + length + gap, mark, strlen(mark)) != 0)
            return length;
        length += gap;
        length += strcspn(text + length, "\n");
    }
}

static void check_file(const struct source *file, struct words *words)
{
    bool is_yaml = house_ends_with(file->path, ".yaml");
    size_t line = 1, length;
    for (const char *at = file->text; *at; at += length) {
        enum piece piece = next_piece(at, is_yaml, &length);
        if (piece == PIECE_COMMENT)
            length = comment_length(at, is_yaml, length);
        if (piece != PIECE_NONE)
            split(at, length, words);
        for (size_t i = 0; i < row_count && piece != PIECE_NONE; i++) {
            bool is_sentence = isupper((unsigned char)at[strcspn(at, LETTERS)]);
            size_t hits = is_in(&rows[i], piece) && (rows[i].kind != KIND_OPEN || is_sentence)
                              ? count_hits(&rows[i], words)
                              : 0;
            rows[i].hits += hits;
            if (hits > 0 && (rows[i].allowed == 0 || getenv("TOILE_WORDS")))
                print_message("%s:%zu: %.*s -> %s\n", file->path, line, (int)(length < 100 ? length : 100),
                              at, rows[i].instead);
        }
        for (size_t i = 0; i < length; i++)
            line += at[i] == '\n';
    }
}

static bool is_product(const char *path)
{
    for (size_t i = 0; house_floors[i]; i++)
        if (house_starts_with_folder(path, house_floors[i]))
            return !house_ends_with(path, ".txt") && !house_ends_with(path, ".cmake") &&
                   !house_ends_with(path, ".md") && !house_ends_with(path, ".sh") &&
                   !house_ends_with(path, ".py");
    return false;
}

static void every_word_is_of_the_field(void **state)
{
    (void)state;
    size_t offences = 0, files = 0, longest = 0;
    for (size_t i = 0; i < sources.count; i++) {
        size_t size = strlen(sources.files[i].text);
        longest = size > longest ? size : longest;
    }
    struct words words = {.items = tl_alloc(longest + 1, sizeof *words.items)};
    for (size_t i = 0; i < sources.count; i++)
        if (is_product(sources.files[i].path)) {
            check_file(&sources.files[i], &words);
            files++;
        }
    for (size_t i = 0; i < row_count; i++) {
        if (rows[i].hits > rows[i].allowed) {
            print_error("%s %s ...: %zu times, %zu allowed: write %s\n", kind_names[rows[i].kind],
                        rows[i].banned.items[0].words[0], rows[i].hits, rows[i].allowed, rows[i].instead);
            offences++;
        }
        if (rows[i].hits < rows[i].allowed)
            print_message("%s %s ...: %zu are left of %zu: lower the number\n", kind_names[rows[i].kind],
                          rows[i].banned.items[0].words[0], rows[i].hits, rows[i].allowed);
    }
    free(words.items);
    assert_true(files > 1000 && row_count > 10); /* the tree and the table were read */
    assert_int_equal(offences, 0);
}

/* ---- The rules themselves ---- */

static void rules_are_read(void **state)
{
    (void)state;
    struct row *kept = rows;
    size_t kept_count = row_count;
    rows = NULL;
    row_count = 0;
    read_table("# a comment\n"
               "any heed | heeds -> enforce\n"
               "name look -> appearance\n"
               "  unless look up: the field's term\n"
               "text told of -> log; still 3\n"
               "open Of | What -> subject first\n");
    static const struct {
        enum piece piece;
        const char *text;
        size_t hits[4];
    } cases[] = {
        {PIECE_NAME, "tl_heed_planes", {1, 0, 0, 0}},
        {PIECE_NAME, "tlHeedPlanes", {1, 0, 0, 0}},
        {PIECE_NAME, "heedless", {0, 0, 0, 0}},
        {PIECE_COMMENT, "/* Of what heeds and heeds. */", {2, 0, 0, 1}},
        {PIECE_COMMENT, "/* The look of it */", {0, 0, 0, 0}},
        {PIECE_NAME, "struct_look", {0, 1, 0, 0}},
        {PIECE_NAME, "tl_look_up_cube", {0, 0, 0, 0}},
        {PIECE_STRING, "\"it is told\n of\"", {0, 0, 1, 0}},
        {PIECE_STRING, "\"What is\"", {0, 0, 0, 0}},
    };
    char space[64][32];
    struct words words = {.items = space};
    assert_int_equal(row_count, 4);
    assert_int_equal(rows[2].allowed, 3);
    assert_string_equal(rows[2].instead, "log");
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        split(cases[i].text, strlen(cases[i].text), &words);
        for (size_t j = 0; j < row_count; j++)
            assert_int_equal(is_in(&rows[j], cases[i].piece) ? count_hits(&rows[j], &words) : 0,
                             cases[i].hits[j]);
    }
    size_t length;
    assert_int_equal(next_piece("/* a */ b", false, &length), PIECE_COMMENT);
    assert_int_equal(length, 7);
    assert_int_equal(next_piece("\"a\\\"b\" c", false, &length), PIECE_STRING);
    assert_int_equal(length, 6);
    assert_int_equal(next_piece("# a\nb", true, &length), PIECE_COMMENT);
    assert_int_equal(comment_length("// a\n    // b\nc", false, 4), 13);
    assert_int_equal(comment_length("// a\n\n// b", false, 4), 4);
    release_table();
    rows = kept;
    row_count = kept_count;
}

static int read_all(void **state)
{
    (void)state;
    char *text = NULL;
    size_t size;
    tl_error error = {0};
    if (!tl_file_read(TABLE, &text, &size, &error)) {
        print_error("%s\n", error.message);
        return 1;
    }
    read_table(text);
    free(text);
    sources_read(&sources, TOILE_SOURCE_DIR);
    return 0;
}

static int release_all(void **state)
{
    (void)state;
    release_table();
    sources_release(&sources);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rules_are_read),
        cmocka_unit_test(every_word_is_of_the_field),
    };
    return cmocka_run_group_tests(tests, read_all, release_all);
}
