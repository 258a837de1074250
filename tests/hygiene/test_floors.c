/* The house rules that a machine can see, over every source file of the five floors: includes point down
 * only, C++ stays in shims, no file is two rooms. */
#include "tests/testing.h"

#include "config/file.h"
#include "config/memory.h"

#include <ftw.h>
#include <string.h>

#define LINES_MAX 800 /* CONTRIBUTING.md: past 800 it is two rooms */

/* Each floor and what it may include; render and cloth never see each other. */
static const struct {
    const char *floor;
    const char *sees[6];
} floors[] = {
    {"config", {"config"}},
    {"assets", {"config", "assets"}},
    {"cloth", {"config", "assets", "cloth"}},
    {"render", {"config", "assets", "render"}},
    {"app", {"config", "assets", "cloth", "render", "app"}},
};

static bool starts_with_folder(const char *path, const char *folder)
{
    size_t length = strlen(folder);
    return strncmp(path, folder, length) == 0 && path[length] == '/';
}

static bool ends_with(const char *text, const char *end)
{
    size_t length = strlen(text), end_length = strlen(end);
    return length >= end_length && strcmp(text + length - end_length, end) == 0;
}

/* NULL, or what is wrong with a quoted include in the file `path` (from the root). */
static const char *check_project_include(const char *path, const char *header)
{
    for (size_t i = 0; i < TL_COUNT(floors); i++) {
        if (!starts_with_folder(path, floors[i].floor))
            continue;
        for (size_t j = 0; floors[i].sees[j]; j++)
            if (starts_with_folder(header, floors[i].sees[j]))
                return NULL;
        for (size_t j = 0; j < TL_COUNT(floors); j++)
            if (starts_with_folder(header, floors[j].floor))
                return "points up, or across between cloth and render";
        return "is not written from the root";
    }
    return "stands outside the five floors";
}

/* A C library's header ends in .h; these end so too and are C++ all the same. */
static bool is_cpp_header(const char *header)
{
    const char *name = strrchr(header, '/') ? strrchr(header, '/') + 1 : header;
    return !ends_with(header, ".h") || strcmp(name, "tiny_gltf.h") == 0 || strncmp(name, "imgui", 5) == 0;
}

/* NULL, or what is wrong with one line of the file `path`. */
static const char *check_line(const char *path, const char *line)
{
    line += strspn(line, " \t");
    if (*line != '#')
        return NULL;
    line++;
    line += strspn(line, " \t");
    if (strncmp(line, "include", 7) != 0)
        return NULL;
    line += 7;
    line += strspn(line, " \t");
    char header[256] = "";
    if (sscanf(line, "\"%255[^\"]\"", header) == 1)
        return check_project_include(path, header);
    if (sscanf(line, "<%255[^>]>", header) == 1)
        return is_cpp_header(header) && !ends_with(path, "_shim.cpp") ? "is C++ outside a *_shim.cpp" : NULL;
    return "is not an include that this test can read";
}

static size_t offences, files;

static void check_file(const char *full, const char *path)
{
    char *data = NULL;
    size_t size = 0;
    tl_error error = {0};
    assert_ok(tl_file_read(full, &data, &size, &error), error);
    size_t number = 0;
    char *rest = data;
    for (char *line; (line = strsep(&rest, "\n")) != NULL && (rest || *line);) {
        number++;
        const char *fault = check_line(path, line);
        if (fault) {
            print_error("%s:%zu: %s: %s\n", path, number, line, fault);
            offences++;
        }
    }
    if (number > LINES_MAX) {
        print_error("%s:%zu: is longer than %d lines: make it two rooms\n", path, number, LINES_MAX);
        offences++;
    }
    if (ends_with(path, ".cpp") && !ends_with(path, "_shim.cpp")) {
        print_error("%s:1: C++ outside a *_shim.cpp\n", path);
        offences++;
    }
    free(data);
    files++;
}

static int visit(const char *full, const struct stat *status, int type, struct FTW *where)
{
    (void)status;
    (void)where;
    if (type == FTW_F && (ends_with(full, ".c") || ends_with(full, ".h") || ends_with(full, ".cpp")))
        check_file(full, full + strlen(TOILE_SOURCE_DIR) + 1);
    return 0;
}

static void test_every_file(void **state)
{
    (void)state;
    for (size_t i = 0; i < TL_COUNT(floors); i++) {
        char *folder = tl_format("%s/%s", TOILE_SOURCE_DIR, floors[i].floor);
        assert_int_equal(nftw(folder, visit, 16, FTW_PHYS), 0);
        free(folder);
    }
    assert_true(files > 20); /* it did look */
    assert_int_equal(offences, 0);
}

/* The rules themselves, on lines that keep and break them. */
static void test_rules(void **state)
{
    (void)state;
    static const struct {
        const char *path, *line;
        bool good;
    } cases[] = {
        {"config/options.c", "#include \"config/file.h\"", true},
        {"config/options.c", "#include \"assets/base/mesh.h\"", false},
        {"assets/base/mesh.c", "#include \"config/error.h\"", true},
        {"assets/base/mesh.c", "#include \"cloth/cloth.h\"", false},
        {"cloth/solvers/xpbd.c", "#include \"assets/garment.h\"", true},
        {"cloth/solvers/xpbd.c", "#include \"render/renderer.h\"", false},
        {"render/frame/frame.c", "#include \"assets/base/surface.h\"", true},
        {"render/frame/frame.c", "  #  include \"cloth/cloth.h\"", false},
        {"render/frame/frame.c", "#include \"app/scene/session.h\"", false},
        {"app/scene/session.c", "#include \"render/renderer.h\"", true},
        {"app/scene/session.c", "#include \"session.h\"", false},
        {"app/scene/session.c", "#include \"application/session.h\"", false},
        {"app/scene/session.c", "#include \"tests/testing.h\"", false},
        {"app/scene/session.c", "#include <math.h>", true},
        {"app/scene/session.c", "#include <vector>", false},
        {"app/scene/session.c", "#include <imgui/imgui.h>", false},
        {"assets/gltf_shim.h", "#include <tiny_gltf.h>", false},
        {"assets/gltf/gltf_shim.cpp", "#include <tiny_gltf.h>", true},
        {"cloth/topology_shim.cpp", "#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>", true},
        {"cloth/topology_shim.cpp", "#include \"render/gpu/gpu.h\"", false},
        {"app/main.c", "#include HEADER", false},
        {"app/main.c", "// #include <vector>", true},
        {"app/main.c", "", true},
    };
    for (size_t i = 0; i < TL_COUNT(cases); i++)
        if ((check_line(cases[i].path, cases[i].line) == NULL) != cases[i].good)
            fail_msg("%s: %s: should be %s", cases[i].path, cases[i].line,
                     cases[i].good ? "fine" : "refused");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rules),
        cmocka_unit_test(test_every_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
