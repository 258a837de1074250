/* The promises of render/frame/job_io.h, checked for every job of the frame: its bits are those of its list,
 * each field has the type and the address that its kind calls for, and what it reads exists by then. The run
 * functions of this file take the place of the renderer's; no GL is needed. */
#include "config/base/memory.h"
#include "render/frame/job_io.h"
#include "render/frame/jobs.h"
#include "tests/testing.h"

/* The meaning of a list's entry: resources read and written (NONE: neither), and whether it is a field. */
struct entry {
    int reads, writes;
    bool is_field;
};
#define NONE                         (-1)
#define ENTRY_READS(member)          {TL_RESOURCE_OF_##member, NONE, true},
#define ENTRY_AFTER(bit)             {bit, NONE, false},
#define ENTRY_SEES(member)           {NONE, NONE, true},
#define ENTRY_WRITES(member)         {NONE, TL_RESOURCE_OF_##member, true},
#define ENTRY_WRITES_IN(member, bit) {NONE, bit, true},
#define ENTRY_EXTENDS(member, bit)   {TL_RESOURCE_OF_##member, bit, true},
#define ENTRY_USES(member)           {NONE, NONE, true},
#define ENTRY(kind, ...)             ENTRY_##kind(__VA_ARGS__)

#define LIST_OF(name, facts, what) static const struct entry name##_entries[] = {TL_JOB_##name(ENTRY)};
TL_JOBS(LIST_OF)

static const struct {
    const char *name;
    const struct entry *entries;
    size_t count, struct_size;
} lists[] = {
#define ROW(name, facts, what)                                                                               \
    {#name, name##_entries, TL_COUNT(name##_entries), sizeof(struct tl_##name##_job)},
    TL_JOBS(ROW)};

static struct tl_resources all;
static const char *ran; /* the last job whose run function was called */

/* A field that is read points to const, any other does not; both point to the resource of their own name. */
#define CHECK_CONST(member, address)                                                                         \
    assert_true(_Generic(job->member, const __typeof__(*(address)) * : true, default : false));              \
    assert_ptr_equal(job->member, address);
#define CHECK_MUTABLE(member, address)                                                                       \
    assert_true(_Generic(job->member, __typeof__(*(address)) * : true, default : false));                    \
    assert_ptr_equal(job->member, address);
#define CHECK_READS(member) CHECK_CONST(member, tl_resource_##member(&all))
#define CHECK_AFTER(bit)
#define CHECK_SEES(member)           CHECK_READS(member)
#define CHECK_WRITES(member)         CHECK_MUTABLE(member, tl_resource_##member(&all))
#define CHECK_WRITES_IN(member, bit) CHECK_WRITES(member)
#define CHECK_EXTENDS(member, bit)   CHECK_WRITES(member)
#define CHECK_USES(member)           CHECK_WRITES(member)
#define CHECK(kind, ...)             CHECK_##kind(__VA_ARGS__)

#define CHECK_FIELDS(name, facts, what)                                                                      \
    bool tl_run_##name(const struct tl_##name##_job *job, tl_error *error)                                   \
    {                                                                                                        \
        (void)error;                                                                                         \
        ran = #name;                                                                                         \
        TL_JOB_##name(CHECK) return true;                                                                    \
    }
TL_JOBS(CHECK_FIELDS)

static void a_jobs_bits_are_those_of_its_list(void **state)
{
    (void)state;
    assert_int_equal(tl_frame_job_count, TL_COUNT(lists));
    for (size_t i = 0; i < TL_COUNT(lists); i++) {
        tl_bits reads = 0, writes = 0;
        size_t fields = 0;
        for (size_t k = 0; k < lists[i].count; k++) {
            const struct entry *entry = &lists[i].entries[k];
            reads |= entry->reads == NONE ? 0 : TL_BIT(entry->reads);
            writes |= entry->writes == NONE ? 0 : TL_BIT(entry->writes);
            fields += entry->is_field;
        }
        assert_string_equal(tl_frame_jobs[i].name, lists[i].name);
        assert_int_equal(tl_frame_jobs[i].reads, reads);
        assert_int_equal(tl_frame_jobs[i].writes, writes);
        assert_int_equal(lists[i].struct_size, fields * sizeof(void *));
    }
}

/* Lists give a job the address of a member, or the handle that it holds. */
#define CHECK_ADDRESS(member, ...) assert_ptr_equal(tl_resource_##member(&all), &all.member);
#define CHECK_HANDLE(member, ...)                                                                            \
    all.member = (void *)&handles[count++];                                                                  \
    assert_ptr_equal(tl_resource_##member(&all), all.member);

static void a_field_points_to_the_resource_of_its_name(void **state)
{
    (void)state;
    static char handles[8]; /* addresses that differ, never read */
    size_t count = 0;
    TL_INPUT_RESOURCES(CHECK_ADDRESS)
    TL_MADE_RESOURCES(CHECK_ADDRESS, CHECK_ADDRESS, CHECK_HANDLE)
    TL_OTHER_RESOURCES(CHECK_ADDRESS, CHECK_ADDRESS, CHECK_HANDLE)
    for (int i = 0; i < tl_frame_job_count; i++) {
        ran = "";
        assert_true(tl_frame_jobs[i].run(&all, 0, NULL));
        assert_string_equal(ran, tl_frame_jobs[i].name);
    }
}

static void what_a_job_reads_is_an_input_or_was_written_before(void **state)
{
    (void)state;
    const tl_bits inputs = TL_BIT(TL_INPUT_COUNT) - 1;
    tl_bits there = inputs;
    for (int i = 0; i < tl_frame_job_count; i++) {
        const tl_job *job = &tl_frame_jobs[i];
        for (int bit = 0; bit < TL_RESOURCE_COUNT; bit++)
            if (job->reads & ~there & TL_BIT(bit))
                fail_msg("%s reads %s before any job has written it", job->name, tl_resource_names[bit]);
        assert_int_equal(job->writes & inputs, 0);
        assert_true(job->writes != 0);
        there |= job->writes;
    }
    assert_int_equal(there, 2 * TL_BIT(TL_RESOURCE_COUNT - 1) - 1); /* no resource is left unmade */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_jobs_bits_are_those_of_its_list),
        cmocka_unit_test(a_field_points_to_the_resource_of_its_name),
        cmocka_unit_test(what_a_job_reads_is_an_input_or_was_written_before),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
