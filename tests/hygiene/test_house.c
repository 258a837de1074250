/* The house rules that a machine can see. Includes point down; a room includes only the rooms that rooms.txt
 * lists for it; the lab is used by the table of commands alone; there is no circle of files, headers or
 * rooms, be it by includes or by linked symbols; an _internal.h belongs to its room; C++ stays in shims; no
 * file and no folder is too large; no two structs share a name; ARCHITECTURE.svg is drawn from the code as it
 * is. */
#include "tests/testing.h"

#include "config/base/file.h"
#include "config/base/memory.h"
#include "tests/hygiene/house.h"
#include "tests/hygiene/house_drawing.h"
#include "tests/hygiene/house_structs.h"

#include <string.h>

#define LINES_MAX 800 /* CONTRIBUTING.md: a longer file holds two subjects */
#define MODULES_MAX                                                                                          \
    12 /* of a room: headers that other rooms may include, each with the files that implement it */
#define ROOMS_FILE TOILE_SOURCE_DIR "/tests/hygiene/rooms.txt"

static struct house house;

static bool is_floor(const char *header)
{
    for (size_t i = 0; house_floors[i]; i++)
        if (house_starts_with_folder(header, house_floors[i]))
            return true;
    return false;
}

/* A C library's header ends in .h; some C++ libraries' headers do so too. */
static bool is_cpp_header(const char *header)
{
    const char *name = strrchr(header, '/') ? strrchr(header, '/') + 1 : header;
    return !house_ends_with(header, ".h") || strcmp(name, "tiny_gltf.h") == 0 ||
           strncmp(name, "imgui", 5) == 0 || strncmp(name, "Imf", 3) == 0 || strncmp(name, "Iex", 3) == 0 ||
           strncmp(name, "Imath", 5) == 0;
}

/* ---- The table of arrows ---- */

static char *table; /* rooms.txt, its lines ended by 0 */
static size_t table_size;

/* The part of the table's line behind "ROOM:", or NULL. */
static const char *table_row(const char *room)
{
    size_t length = strlen(room);
    for (const char *line = table; line < table + table_size; line += strlen(line) + 1)
        if (strncmp(line, room, length) == 0 && line[length] == ':')
            return line + length + 1;
    return NULL;
}

/* An entry that ends in / stands for a whole floor. */
static bool allows(const char *row, const char *room)
{
    while (*(row += strspn(row, " ")) != '\0') {
        size_t length = strcspn(row, " ");
        bool is_all = row[length - 1] == '/';
        if (strncmp(row, room, length - is_all) == 0 &&
            (room[length - is_all] == '\0' || (is_all && room[length - 1] == '/')))
            return true;
        row += length;
    }
    return false;
}

static void every_arrow_is_in_the_table(void **state)
{
    (void)state;
    const struct graph *rooms = &house.rooms;
    size_t arrows = 0, offences = 0;
    for (size_t i = 0; i < rooms->count; i++) {
        const char *row = table_row(rooms->names[i]);
        if (!row) {
            print_error(
                "%s: has no line in tests/hygiene/rooms.txt: add one that lists what it may include\n",
                rooms->names[i]);
            offences++;
            continue;
        }
        print_message("%s ->", rooms->names[i]);
        for (size_t j = 0; j < rooms->count; j++) {
            if (!rooms->arrows[i * rooms->count + j])
                continue;
            arrows++;
            print_message(" %s", rooms->names[j]);
            if (!allows(row, rooms->names[j])) {
                print_error("\n%s may not use %s: %s\n", rooms->names[i], rooms->names[j],
                            rooms->because[i * rooms->count + j]);
                offences++;
            }
        }
        print_message("\n");
    }
    print_message("%zu rooms, %zu arrows, %zu outside of the table\n", rooms->count, arrows, offences);
    assert_int_equal(offences, 0);
}

/* An entry that the code does not use must be removed: the table describes the architecture as it is. */
static void every_entry_of_the_table_is_used(void **state)
{
    (void)state;
    const struct graph *rooms = &house.rooms;
    size_t offences = 0;
    for (const char *line = table; line < table + table_size; line += strlen(line) + 1) {
        if (*line == '#' || *line == '\0')
            continue;
        char room[256];
        if (sscanf(line, "%255[^:]:", room) != 1 || graph_find(rooms, room) == rooms->count) {
            print_error("rooms.txt: %s: no such room\n", line);
            offences++;
            continue;
        }
        size_t from = graph_find(rooms, room);
        for (const char *entry = strchr(line, ':') + 1; *(entry += strspn(entry, " ")) != '\0';) {
            size_t length = strcspn(entry, " ");
            char name[256];
            snprintf(name, sizeof name, "%.*s", (int)length, entry);
            bool is_used = false;
            for (size_t to = 0; to < rooms->count; to++)
                is_used =
                    is_used || (rooms->arrows[from * rooms->count + to] && allows(name, rooms->names[to]));
            if (!is_used) {
                print_error("rooms.txt: %s does not use %s: strike it out\n", room, name);
                offences++;
            }
            entry += length;
        }
    }
    assert_int_equal(offences, 0);
}

/* ---- Circles ---- */

static size_t count_circles(const struct graph *graph, const char *of)
{
    bool *skip = tl_alloc(graph->count + 1, sizeof *skip);
    size_t *circle = tl_alloc(graph->count + 1, sizeof *circle), circles = 0;
    for (size_t size; (size = graph_circle(graph, skip, circle)) > 0; circles++) {
        print_error("a circle of %zu %s:\n", size, of);
        for (size_t i = 0; i < size; i++)
            for (size_t j = 0; j < size; j++)
                if (graph->arrows[circle[i] * graph->count + circle[j]])
                    print_error("    %s -> %s: %s\n", graph->names[circle[i]], graph->names[circle[j]],
                                graph->because[circle[i] * graph->count + circle[j]]);
    }
    free(skip);
    free(circle);
    return circles;
}

static void nothing_goes_round_in_circles(void **state)
{
    (void)state;
    size_t files = count_circles(&house.pairs, "files"), headers = count_circles(&house.headers, "headers"),
           rooms = count_circles(&house.rooms, "rooms");
    print_message("circles: %zu of files, %zu of headers, %zu of rooms\n", files, headers, rooms);
    assert_int_equal(files + headers + rooms, 0);
}

/* ---- Lines and folders ---- */

/* NULL, or what is wrong with an include of the file `path`. The arrow itself is the table's business. */
static const char *check_include(const char *path, const struct house_include *include)
{
    bool is_test = house_starts_with_folder(path, "tests");
    if (!include->quoted)
        return is_cpp_header(include->header) && !house_ends_with(path, "_shim.cpp")
                   ? "is C++ outside of a *_shim.cpp"
                   : NULL;
    if (house_starts_with_folder(include->header, "tests"))
        return is_test ? NULL : "the program includes a test";
    if (!is_floor(include->header))
        return "is not written from the root";
    if (house_starts_with_folder(include->header, "app/lab") && !is_test &&
        !house_starts_with_folder(path, "app/lab") && strcmp(path, "app/commands.c") != 0)
        return "is the lab's, which app/commands.c alone uses";
    if (!house_ends_with(include->header, "_internal.h"))
        return NULL;
    const char *code = is_test ? path + strlen("tests/") : path;
    size_t room = (size_t)(strrchr(include->header, '/') - include->header);
    return strncmp(code, include->header, room + 1) == 0 && !strchr(code + room + 1, '/')
               ? NULL
               : "is internal to another room";
}

/* A module is a header that is not internal, with the files that implement it. */
static size_t count_modules(const char *room)
{
    size_t count = 0;
    for (size_t i = 0; i < house.file_count; i++)
        count += strcmp(house.files[i].room, room) == 0 && house_ends_with(house.files[i].path, ".h") &&
                 !house_ends_with(house.files[i].path, "_internal.h");
    return count;
}

static void every_line_keeps_the_rules(void **state)
{
    (void)state;
    size_t offences = 0;
    for (size_t i = 0; i < house.file_count; i++) {
        const struct house_file *file = &house.files[i];
        for (size_t j = 0; j < file->include_count; j++) {
            const char *fault = check_include(file->path, &file->includes[j]);
            if (fault) {
                print_error("%s:%zu: %s: %s\n", file->path, file->includes[j].line, file->includes[j].header,
                            fault);
                offences++;
            }
        }
        if (file->unreadable) {
            print_error("%s:%s: is no include that this test can read\n", file->path, file->unreadable);
            offences++;
        }
        if (file->line_count > LINES_MAX) {
            print_error("%s: has %zu lines: split it, at most %d\n", file->path, file->line_count, LINES_MAX);
            offences++;
        }
        if (house_ends_with(file->path, ".cpp") && !house_ends_with(file->path, "_shim.cpp")) {
            print_error("%s: C++ outside of a *_shim.cpp\n", file->path);
            offences++;
        }
        const bool is_first = i == 0 || strcmp(house.files[i - 1].room, file->room) != 0;
        const size_t modules = is_first ? count_modules(file->room) : 0;
        if (modules > MODULES_MAX) {
            print_error("%s: holds %zu modules: divide it, at most %d\n", file->room, modules, MODULES_MAX);
            offences++;
        }
    }
    assert_true(house.own_count > 300); /* the tree was read */
    assert_int_equal(offences, 0);
}

/* ---- Names ---- */

static void no_two_structs_share_a_name(void **state)
{
    (void)state;
    size_t count, offences = 0;
    struct house_struct *structs = house_structs_read(&house, TOILE_SOURCE_DIR, &count);
    for (size_t i = 1; i < count; i++) {
        if (strcmp(structs[i].name, structs[i - 1].name) != 0)
            continue;
        print_error("struct %s: defined in %s and in %s\n", structs[i].name, structs[i - 1].path,
                    structs[i].path);
        offences++;
    }
    print_message("%zu structs\n", count);
    assert_true(count > 500); /* the definitions were found */
    assert_int_equal(offences, 0);
    house_structs_release(&structs, count);
}

static void definitions_of_structs_are_found(void **state)
{
    (void)state;
    static const char *const definitions[] = {
        "struct tl_a {\n    int x;\n};", "typedef struct tl_a {", "int x;\nstruct tl_a\n{",
        "(struct b){0}; static const struct { int x; } c; struct tl_a {"};
    static const char *const others[] = {"struct tl_a;",
                                         "struct tl_a *make(void)\n{",
                                         "(struct tl_a){0}",
                                         "struct {",
                                         "construct a {",
                                         "structure a {",
                                         ""};
    char name[8];
    for (size_t i = 0; i < TL_COUNT(definitions); i++) {
        const char *rest = house_next_struct(definitions[i], name, sizeof name);
        assert_non_null(rest);
        assert_string_equal(name, "tl_a");
        assert_null(house_next_struct(rest, name, sizeof name));
    }
    for (size_t i = 0; i < TL_COUNT(others); i++)
        assert_null(house_next_struct(others[i], name, sizeof name));
}

/* ---- The drawing ---- */

static void the_drawing_is_of_this_code(void **state)
{
    (void)state;
    char *drawn = NULL, *kept = NULL;
    size_t drawn_size = 0, kept_size = 0;
    FILE *out = open_memstream(&drawn, &drawn_size);
    assert_non_null(out);
    house_draw(&house, out);
    fclose(out);
    tl_error error = {0};
    assert_ok(tl_file_read(TOILE_SOURCE_DIR "/ARCHITECTURE.svg", &kept, &kept_size, &error), error);
    if (drawn_size != kept_size || memcmp(drawn, kept, kept_size) != 0)
        fail_msg("ARCHITECTURE.svg is not of this code: ./dev rooms draws it again");
    free(drawn);
    free(kept);
}

/* ---- The rules themselves ---- */

static void the_rules_tell_good_from_bad(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        struct house_include include;
        bool good;
    } cases[] = {
        {"config/options.c", {"config/base/file.h", true, 1}, true},
        {"app/scene/session.c", {"session.h", true, 1}, false},
        {"app/scene/session.c", {"application/session.h", true, 1}, false},
        {"app/scene/session.c", {"tests/testing.h", true, 1}, false},
        {"tests/app/scene/test_session.c", {"tests/testing.h", true, 1}, true},
        {"app/scene/session.c", {"math.h", false, 1}, true},
        {"app/scene/session.c", {"vector", false, 1}, false},
        {"app/scene/session.c", {"imgui/imgui.h", false, 1}, false},
        {"assets/gltf/gltf_shim.h", {"tiny_gltf.h", false, 1}, false},
        {"assets/gltf/gltf_shim.cpp", {"tiny_gltf.h", false, 1}, true},
        {"assets/image/exr_shim.cpp", {"ImfInputFile.h", false, 1}, true},
        {"assets/image/exr.c", {"ImfInputFile.h", false, 1}, false},
        {"cloth/mesh/topology_shim.cpp", {"OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh", false, 1}, true},
        {"render/frame/jobs.c", {"render/frame/renderer_internal.h", true, 1}, true},
        {"render/frame/inner/jobs.c", {"render/frame/renderer_internal.h", true, 1}, false},
        {"render/frames/jobs.c", {"render/frame/renderer_internal.h", true, 1}, false},
        {"render/light/light.c", {"render/frame/renderer_internal.h", true, 1}, false},
        {"tests/render/frame/test_jobs.c", {"render/frame/renderer_internal.h", true, 1}, true},
        {"tests/render/light/test_light.c", {"render/frame/renderer_internal.h", true, 1}, false},
        {"app/commands.c", {"app/lab/check/commands.h", true, 1}, true},
        {"app/lab/trade/trade.c", {"app/lab/experiments/experiment.h", true, 1}, true},
        {"tests/app/settings/test_affects.c", {"app/lab/flight/fly_account.h", true, 1}, true},
        {"app/main.c", {"app/lab/check/commands.h", true, 1}, false},
        {"app/measure/cmd_plan.c", {"app/lab/trade/trade.h", true, 1}, false},
    };
    for (size_t i = 0; i < TL_COUNT(cases); i++)
        if ((check_include(cases[i].path, &cases[i].include) == NULL) != cases[i].good)
            fail_msg("%s: %s: should be %s", cases[i].path, cases[i].include.header,
                     cases[i].good ? "accepted" : "refused");
    assert_true(allows("config cloth/mesh", "cloth/mesh"));
    assert_false(allows("config cloth/mesh", "cloth/mesh/fine"));
    assert_false(allows("config cloth/mesh", "cloth"));
    assert_false(allows("config cloth/meshes", "cloth/mesh"));
    assert_true(allows("config cloth/", "cloth/mesh"));
    assert_true(allows("cloth/", "cloth"));
    assert_false(allows("cloth/", "clothes"));
}

static void circles_are_found(void **state)
{
    (void)state;
    char *names[] = {"a", "b", "c", "d", "e"};
    struct graph graph;
    graph_create(&graph, names, 5);
    bool skip[5] = {false};
    size_t circle[5];
    int height[5];
    graph_add(&graph, 0, 1, "");
    graph_add(&graph, 1, 2, "");
    graph_add(&graph, 0, 2, "");
    graph_add(&graph, 3, 3, ""); /* a file that includes its own header */
    assert_int_equal(graph_circle(&graph, skip, circle), 0);
    graph_heights(&graph, height);
    assert_int_equal(height[0], 2);
    assert_int_equal(height[2], 0);
    graph_add(&graph, 2, 1, "");
    graph_add(&graph, 3, 4, "");
    graph_add(&graph, 4, 3, "");
    assert_int_equal(graph_circle(&graph, skip, circle), 2);
    assert_int_equal(circle[0], 1);
    assert_int_equal(circle[1], 2);
    assert_int_equal(graph_circle(&graph, skip, circle), 2);
    assert_int_equal(circle[0], 3);
    assert_int_equal(graph_circle(&graph, skip, circle), 0);
    graph_release(&graph);
}

static int read_all(void **state)
{
    (void)state;
    tl_error error = {0};
    if (!tl_file_read(ROOMS_FILE, &table, &table_size, &error)) {
        print_error("%s\n", error.message);
        return 1;
    }
    for (size_t i = 0; i < table_size; i++)
        if (table[i] == '\n')
            table[i] = '\0';
    house_read(&house, TOILE_SOURCE_DIR);
    house_read_objects(&house, TOILE_OBJECTS, TOILE_BINARY_DIR);
    return 0;
}

static int release_all(void **state)
{
    (void)state;
    house_release(&house);
    free(table);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_rules_tell_good_from_bad),     cmocka_unit_test(circles_are_found),
        cmocka_unit_test(every_line_keeps_the_rules),       cmocka_unit_test(every_arrow_is_in_the_table),
        cmocka_unit_test(every_entry_of_the_table_is_used), cmocka_unit_test(nothing_goes_round_in_circles),
        cmocka_unit_test(definitions_of_structs_are_found), cmocka_unit_test(no_two_structs_share_a_name),
        cmocka_unit_test(the_drawing_is_of_this_code),
    };
    return cmocka_run_group_tests(tests, read_all, release_all);
}
