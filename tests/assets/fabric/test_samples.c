/* Files of measured reflectance: what is read, and one line for each thing that can be wrong with them. */
#include "assets/fabric/samples.h"

#include "config/base/memory.h"

#include "tests/testing.h"

#include <string.h>

#define PATH "test_samples.csv"

/* Writes a header, `count` good lines and one more. */
static void write_file(const char *header, const char *line, int count, const char *last)
{
    FILE *stream = fopen(PATH, "wb");
    assert_non_null(stream);
    fprintf(stream, "%s\n", header);
    for (int i = 0; i < count; i++)
        fprintf(stream, "%s\n", line);
    fprintf(stream, "%s", last);
    assert_int_equal(fclose(stream), 0);
}

#define ANGLES  "theta_l,phi_l,theta_v,phi_v,r,g,b"
#define VECTORS "l_x l_y l_z v_x v_y v_z value"

/* The same directions as angles and as vectors, among columns that are skipped, in another order, with a
 * comment, semicolons and the line ends of Windows. */
static void both_forms_are_read(void **state)
{
    (void)state;
    struct tl_reflectance_samples samples;
    tl_error error = {0};
    write_file("# from a gonioreflectometer\r\nb;g;r;spot;phi_v;theta_v;phi_l;theta_l\r",
               "3;2;1;7;90;60;180;30\r", 40, "");
    assert_ok(tl_reflectance_samples_load(PATH, &samples, &error), error);
    assert_int_equal(samples.count, 40);
    const float wanted[] = {-0.5f, 0, 0.8660254f, 0, 0.8660254f, 0.5f, 1, 2, 3};
    const vec3s *parts[] = {&samples.items[39].l, &samples.items[39].v, &samples.items[39].value};
    for (int i = 0; i < 9; i++)
        assert_near(parts[i / 3]->raw[i % 3], wanted[i], 1e-6);
    tl_reflectance_samples_release(&samples);

    write_file(VECTORS, "-0.5 0 0.8660254 0\t0.8660254 0.5 2", 40, "-0.5 0 0.8660254 0 0.8660254 0.5 4e-1");
    assert_ok(tl_reflectance_samples_load(PATH, &samples, &error), error);
    assert_int_equal(samples.count, 41);
    parts[0] = &samples.items[0].l, parts[1] = &samples.items[0].v;
    for (int i = 0; i < 6; i++)
        assert_near(parts[i / 3]->raw[i % 3], wanted[i], 1e-6);
    for (int c = 0; c < 3; c++) {
        assert_near(samples.items[0].value.raw[c], 2, 0);
        assert_near(samples.items[40].value.raw[c], 0.4, 1e-7);
    }
    tl_reflectance_samples_release(&samples);
    unlink(PATH);
}

static void refuses(const char *header, const char *line, int count, const char *last, const char *words)
{
    struct tl_reflectance_samples samples;
    tl_error error = {0};
    write_file(header, line, count, last);
    bool read = tl_reflectance_samples_load(PATH, &samples, &error);
    print_message("%s\n", error.message);
    assert_false(read);
    assert_int_equal(error.code, TL_INPUT);
    assert_null(samples.items);
    assert_non_null(strstr(error.message, words));
    assert_null(strchr(error.message, '\n'));
    unlink(PATH);
}

static void each_fault_has_its_line(void **state)
{
    (void)state;
    const char *good = "30,0,60,90,1,2,3";
    refuses("theta_l,phi_l,theta_v,r,g,b", good, 40, "", "line 1: does not name the columns of directions");
    refuses("theta_l,phi_l,theta_v,phi_v,r,g", good, 40, "",
            "line 1: does not name the columns of reflectance");
    refuses("l_x,l_y,l_z,v_x,v_y,r,g,b", good, 40, "", "columns of directions");
    refuses(ANGLES ",r", good, 40, "", "line 1: names a column twice");
    refuses("30,0,60,90,1,2,3", good, 40, "", "does not name the columns");
    refuses(ANGLES, good, 40, "30,0,60,90,1,2", "line 42: sample of 6 numbers, not 7");
    refuses(ANGLES, good, 40, "30,0,60,,1,2,3", "of 6 numbers, not 7");
    refuses(ANGLES, good, 40, "30,0,60,90,1,2,3,4", "line 42: has more numbers");
    refuses(ANGLES, good, 40, "30,0,60,90,nan,2,3", "\"nan\" is no number");
    refuses(ANGLES, good, 40, "30,0,60,90,1e99,2,3", "\"1e99\" is no number");
    refuses(ANGLES, good, 40, "30,0,60,90,1x,2,3", "\"1x\" is no number");
    refuses(ANGLES, good, 40, "30,0,60,90,1,-1e-3,3", "line 42: reflectance is negative");
    refuses(ANGLES, good, 40, "30,0,60,90,1,2,1e7", "more than 1000000 per sr");
    refuses(ANGLES, good, 40, "91,0,60,90,1,2,3", "line 42: the light is below the surface");
    refuses(ANGLES, good, 40, "30,0,120,90,1,2,3", "line 42: the viewer is below the surface");
    refuses(VECTORS, "0 0 1 0 0 1 1", 40, "0 0 2 0 0 1 1", "line 42: l is no unit vector");
    refuses(VECTORS, "0 0 1 0 0 1 1", 40, "0 0 1 0 0 0 1", "line 42: v is no unit vector");
    refuses(ANGLES, good, 31, "", "has 31 samples: at least 32");
    refuses(ANGLES, "30,0,60,90,0,0,0", 40, "", "reflects no light");
    refuses("# nothing else", "#", 40, "", "has no line that names its columns");
}

/* The limit on samples holds, and a file over the limit on bytes is not read: a sparse file of 300 MB. */
static void sizes_are_limited(void **state)
{
    (void)state;
    refuses("l_z v_z l_x l_y v_x v_y value", "1 1 0 0 0 0 1", TL_REFLECTANCE_SAMPLES_MAX, "1 1 0 0 0 0 1",
            "line 1000002: is one more than the 1000000 samples");
    struct tl_reflectance_samples samples;
    tl_error error = {0};
    write_file(ANGLES, "", 0, "");
    assert_int_equal(truncate(PATH, 300 << 20), 0);
    assert_false(tl_reflectance_samples_load(PATH, &samples, &error));
    assert_non_null(strstr(error.message, "more than 256 MB"));
    unlink(PATH);
    assert_false(tl_reflectance_samples_load("no_such_file.csv", &samples, &error));
    assert_null(samples.items);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_forms_are_read),
        cmocka_unit_test(each_fault_has_its_line),
        cmocka_unit_test(sizes_are_limited),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
