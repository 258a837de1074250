/* Every citation resolves: an author and a year stand in brackets and are a key of docs/references.md, the
 * four sources have the sections, figures and equations that are cited, every key is cited, and every page of
 * docs/ that a text names exists. */
#include "tests/hygiene/sources.h"

#include "config/base/file.h"
#include "config/base/memory.h"
#include "tests/hygiene/house.h"
#include "tests/testing.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#define REFERENCES "docs/references.md"
#define KEY_SIZE   64

struct key {
    char name[KEY_SIZE];
    size_t citations;
};

static struct sources sources;
static struct key *keys;
static size_t key_count;

/* ---- Keys ---- */

/* Rows of tables whose first cell ends in a year or in n.d. */
static void read_keys(const char *page)
{
    for (const char *row = page; row; row = strchr(row, '\n')) {
        row += *row == '\n';
        char name[KEY_SIZE];
        if (sscanf(row, "| %63[^|\n] |", name) != 1)
            continue;
        size_t length = strlen(name);
        while (length > 0 && name[length - 1] == ' ')
            name[--length] = '\0';
        if (length < 5 || !(isdigit((unsigned char)name[length - 1]) || house_ends_with(name, "n.d.")))
            continue;
        keys = tl_resize(keys, key_count + 1, sizeof *keys);
        keys[key_count] = (struct key){.citations = 0};
        memcpy(keys[key_count++].name, name, length + 1);
    }
}

static struct key *find_key(const char *text, size_t end)
{
    for (size_t i = 0; i < key_count; i++) {
        size_t length = strlen(keys[i].name);
        if (length < end && strncmp(text + end - length, keys[i].name, length) == 0 &&
            strchr("[ ", text[end - length - 1]))
            return &keys[i];
    }
    return NULL;
}

/* ---- Sections of the four sources ---- */

static const struct {
    const char *key;
    const char *sections; /* each between bars */
    int figures, equations;
} parts[] = {
    {"Heidrich and Seidel 1999", "|1|2|3|3.1|3.2|4|4.1|4.2|4.3|4.4|4.5|5|5.1|5.2|6|7|", 10, 9},
    {"Schroecker 2002",
     "|1|2|2.1|2.2|3|3.1|3.2|3.3|4|4.1|4.2|4.2.1|4.2.2|4.2.3|4.3|4.4|4.5|5|5.1|5.2|5.3|5.4|6|", 12, 7},
    {"Knuth et al. 2014", "|1|2|3|3.1|3.2|3.3|3.4|4|5|6|", 8, 5},
    {"Wimmer n.d.", /* titles of slides */
     "|Cube Maps for Env Mapping|Sphere Mapping|Dual Paraboloid Mapping|Reflective Environment Mapping|"
     "Refractive Environment Mapping|Specular Environment Mapping|Irradiance Environment Mapping|"
     "Normal Mapping|Parallax normal mapping|Offset limited Parallax normal mapping|Mathematics|"
     "Cylinder Example|Basic Algorithm (Eye Space)|Fast Algorithm (Tangent Space)|Square Patch Assumption|"
     "Offset Bump Maps|Creating Tangent Space|EMNM|Horizon Mapping|Relief Mapping|Advanced Methods|",
     0, 0}};

/* One part of a citation: "3.2", "figure 5", "eq. 3", or a slide's title. */
static bool has_part(size_t source, const char *part, size_t length)
{
    static const char *const numbered[] = {"figures ", "figure ", "eq. "};
    for (size_t i = 0; i < TL_COUNT(numbered); i++)
        if (strncmp(part, numbered[i], strlen(numbered[i])) == 0) {
            int number = atoi(part + strlen(numbered[i]));
            return number > 0 && number <= (i < 2 ? parts[source].figures : parts[source].equations);
        }
    char *barred = tl_format("|%.*s|", (int)length, part);
    bool has = strstr(parts[source].sections, barred) != NULL;
    free(barred);
    return has;
}

/* The first part behind the key which the source lacks; NULL: it has all, up to a bracket or semicolon. A key
 * without parts stands for the whole. */
static const char *absent_part(const char *key, const char *behind)
{
    size_t source = 0;
    while (source < TL_COUNT(parts) && strcmp(parts[source].key, key) != 0)
        source++;
    if (source == TL_COUNT(parts) || behind[0] != ',')
        return NULL;
    bool counts = false; /* figures or equations: the word stands before the first number alone */
    for (const char *at = behind + 2; *at && !strchr("];", *at);) {
        size_t length = strcspn(at, ",];");
        const char *joint = strstr(at, " and ");
        if (joint && (size_t)(joint - at) < length)
            length = (size_t)(joint - at);
        counts = strncmp(at, "fig", 3) == 0 || strncmp(at, "eq.", 3) == 0 ||
                 (counts && isdigit((unsigned char)at[0]));
        if (!(counts && isdigit((unsigned char)at[0])) && !has_part(source, at, length))
            return at;
        at += length;
        at += strncmp(at, " and ", 5) == 0 ? 5 : *at == ',' ? 2 : 0;
    }
    return NULL;
}

/* ---- Citations ---- */

/* The end of a year, or of n.d., that begins at `at`; 0 where none begins. */
static size_t year_end(const char *text, size_t at)
{
    if (strncmp(text + at, "n.d.", 4) == 0)
        return at + 4;
    if (strncmp(text + at, "18", 2) != 0 && strncmp(text + at, "19", 2) != 0 &&
        strncmp(text + at, "20", 2) != 0)
        return 0;
    for (size_t i = 0; i < 4; i++)
        if (!isdigit((unsigned char)text[at + i]))
            return 0;
    return isalnum((unsigned char)text[at + 4]) ? 0 : at + 4;
}

/* Whether the word that ends before the blank at `blank` is a name, or the end of "et al.". */
static bool follows_name(const char *text, size_t blank)
{
    size_t begin = blank;
    while (begin > 0 && (isalpha((unsigned char)text[begin - 1]) || strchr("-'.,", text[begin - 1])))
        begin--;
    const char *word = text + begin;
    size_t length = blank - begin;
    if (length > 0 && word[length - 1] == ',')
        length--;
    if (length == 3 && strncmp(word, "al.", 3) == 0)
        return true;
    return length > 1 && isupper((unsigned char)word[0]) && islower((unsigned char)word[1]) &&
           word[length - 1] != '.' && strncmp(word, "The ", 4) != 0;
}

static bool is_in_brackets(const char *text, size_t at)
{
    for (size_t i = at; i > 0 && at - i < 200; i--) {
        if (text[i - 1] == '[')
            return true;
        if (text[i - 1] == ']')
            return false;
    }
    return false;
}

/* Whether a number of a paper stands at `at`, as in "[0 0 4]" without the blanks. */
static bool is_number(const char *text, size_t at)
{
    return strncmp(text + at, "[00", 3) == 0 && isdigit((unsigned char)text[at + 3]) &&
           text[at + 4] != '\0' && strchr("], ", text[at + 4]);
}

/* NULL, or what is wrong with the citation of which a year begins at `at`. *key: the key that it has. */
static const char *check_year(const char *text, size_t at, struct key **key)
{
    size_t end = year_end(text, at);
    *key = NULL;
    if (end == 0 || at < 2 || text[at - 1] != ' ' || !follows_name(text, at - 1))
        return NULL;
    *key = find_key(text, end);
    if (!is_in_brackets(text, at))
        return "cites outside of brackets: write [Author Year, section]";
    if (!*key)
        return "is no key of " REFERENCES;
    return absent_part((*key)->name, text + end) ? "cites a section, figure or equation that the source lacks"
                                                 : NULL;
}

static void every_citation_is_a_key(void **state)
{
    (void)state;
    size_t offences = 0, citations = 0;
    for (size_t i = 0; i < sources.count; i++) {
        const struct source *file = &sources.files[i];
        if (strcmp(file->path, REFERENCES) == 0 || house_ends_with(file->path, "/test_citations.c"))
            continue;
        for (size_t at = 0; file->joined[at]; at++) {
            struct key *key;
            const char *fault = is_number(file->joined, at) ? "is the number of a paper: write its key"
                                                            : check_year(file->joined, at, &key);
            if (fault) {
                size_t begin = at < 40 ? 0 : at - 40;
                print_error("%s:%zu: \"%.*s\" %s\n", file->path, file->lines[at], (int)(at - begin + 8),
                            file->joined + begin, fault);
                offences++;
            } else if (key) {
                key->citations++;
                citations++;
            }
        }
    }
    for (size_t i = 0; i < key_count; i++)
        if (keys[i].citations == 0) {
            print_error("%s: nothing cites %s: strike it out\n", REFERENCES, keys[i].name);
            offences++;
        }
    print_message("%zu citations of %zu sources\n", citations, key_count);
    assert_true(citations > 150); /* the tree was read */
    assert_int_equal(offences, 0);
}

static void no_key_is_listed_twice(void **state)
{
    (void)state;
    for (size_t i = 0; i < key_count; i++)
        for (size_t j = 0; j < i; j++)
            assert_string_not_equal(keys[i].name, keys[j].name);
}

/* ---- Pages ---- */

static void every_page_exists(void **state)
{
    (void)state;
    size_t offences = 0, pages = 0;
    for (size_t i = 0; i < sources.count; i++) {
        const struct source *file = &sources.files[i];
        if (house_ends_with(file->path, ".sh"))
            continue; /* scripts of tests name files that they make up */
        for (const char *at = file->joined; (at = strstr(at, "docs/")) != NULL; at++) {
            size_t length = strspn(at, "abcdefghijklmnopqrstuvwxyz/_-");
            if (strncmp(at + length, ".md", 3) != 0)
                continue;
            char *path = tl_format("%s/%.*s.md", TOILE_SOURCE_DIR, (int)length, at);
            pages++;
            if (!tl_file_exists(path)) {
                print_error("%s:%zu: %.*s.md: there is no such page\n", file->path,
                            file->lines[at - file->joined], (int)length, at);
                offences++;
            }
            free(path);
        }
    }
    assert_true(pages > 10);
    assert_int_equal(offences, 0);
}

/* ---- The rules themselves ---- */

static void the_rules_tell_good_from_bad(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        bool is_citation, good;
    } cases[] = {
        {"a lobe [Knuth et al. 2014, 3.2] of", true, true},
        {"a lobe [as Knuth et al. 2014; Blinn 1978]", true, true},
        {"a lobe\n * [Knuth et\n * al. 2014].", true, true},
        {"\"a lobe [Knuth \"\n    \"et al. 2014]\"", true, true},
        {"[Wimmer n.d.]", true, true},
        {"[Wimmer n.d., Horizon Mapping]", true, true},
        {"[Wimmer n.d., Horizon Maps]", true, false},
        {"[Heidrich and Seidel 1999, 3.1, figure 2 and eq. 2 and 3; Schroecker 2002, 4.2]", true, true},
        {"[Heidrich and Seidel 1999, 4.6]", true, false},
        {"[Knuth et al. 2014, figure 9]", true, false},
        {"[Knuth et al. 2014, 3.1 and eq. 6]", true, false},
        {"(Blinn 1978)", true, false},
        {"Knuth et al. 2014 have", true, false},
        {"[Blinn 1979]", true, false},
        {"[Nobody and Blinn, 1978]", true, false},
        {"of ["
         "004] and",
         true, false},
        {"of ["
         "000, 3.1] and",
         true, false},
        {"The 2014 algorithm, and CIE 1976, VERTICES 2048, Rec. 2020", false, true},
        {"2000 vertices, [2000]", false, true},
    };
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        size_t *lines, found = 0, bad = 0;
        char *text = sources_join("a.c", cases[i].text, &lines);
        for (size_t at = 0; text[at]; at++) {
            struct key *key = NULL;
            bool is_bad = is_number(text, at) || check_year(text, at, &key);
            bad += is_bad;
            found += is_bad || key;
        }
        if ((found > 0) != cases[i].is_citation || (bad == 0) != cases[i].good)
            fail_msg("%s: should be %s", cases[i].text, cases[i].good ? "accepted" : "refused");
        free(text);
        free(lines);
    }
}

static int read_all(void **state)
{
    (void)state;
    sources_read(&sources, TOILE_SOURCE_DIR);
    for (size_t i = 0; i < sources.count; i++)
        if (strcmp(sources.files[i].path, REFERENCES) == 0)
            read_keys(sources.files[i].text);
    return 0;
}

static int release_all(void **state)
{
    (void)state;
    sources_release(&sources);
    free(keys);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_rules_tell_good_from_bad),
        cmocka_unit_test(no_key_is_listed_twice),
        cmocka_unit_test(every_citation_is_a_key),
        cmocka_unit_test(every_page_exists),
    };
    return cmocka_run_group_tests(tests, read_all, release_all);
}
