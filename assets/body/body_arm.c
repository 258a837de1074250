#include "assets/body/body.h"

#include "assets/body/section.h"

#include <math.h>

/* The section's part that the arm on +X has: the largest beside the trunk. */
static const struct tl_section *find_arm(const struct tl_section *sections, size_t count)
{
    const struct tl_section *found = NULL;
    for (size_t i = 0; i < count; i++)
        if (sections[i].lower.x > 0 && (!found || sections[i].girth_m > found->girth_m))
            found = &sections[i];
    return found;
}

struct arm_section {
    double y, girth;
    vec3s middle;
};

/* Sections of the arm from a height downwards; returns how many there are until the arm ends. */
static size_t follow_arm(const tl_mesh *mesh, double from, double step, struct arm_section *out,
                         size_t maximum)
{
    size_t count = 0;
    for (bool found = true; found && count < maximum; count += found) {
        const struct tl_plane plane = tl_plane_level((float)(from - step * (double)count));
        struct tl_section *sections;
        size_t section_count = tl_mesh_sections(mesh, &plane, &sections);
        const struct tl_section *arm = find_arm(sections, section_count);
        found = arm != NULL;
        if (found) {
            vec2s middle = glms_vec2_scale(glms_vec2_add(arm->lower, arm->upper), 0.5f);
            out[count] = (struct arm_section){
                from - step * (double)count, (double)arm->girth_m, {{middle.x, plane.point.y, middle.y}}};
        }
        tl_sections_release(&sections, section_count);
    }
    return count;
}

/* The middle line in equal steps, from its sections of equal heights. */
static void even_line(const struct arm_section *sections, size_t count, struct tl_body_arm *out)
{
    double total = 0, walked = 0;
    for (size_t i = 0; i + 1 < count; i++)
        total += (double)glms_vec3_distance(sections[i].middle, sections[i + 1].middle);
    out->length = total;
    for (size_t k = 0, i = 0; k < TL_ARM_STEPS; k++) {
        double wanted = total * (double)k / (TL_ARM_STEPS - 1);
        double next = (double)glms_vec3_distance(sections[i].middle, sections[i + 1].middle);
        while (i + 2 < count && walked + next < wanted) {
            walked += next;
            i++;
            next = (double)glms_vec3_distance(sections[i].middle, sections[i + 1].middle);
        }
        float t = (float)fmin((wanted - walked) / next, 1);
        out->middle[k] = glms_vec3_lerp(sections[i].middle, sections[i + 1].middle, t);
    }
}

/* Directions over a tenth of the arm to both sides, so that frames turn evenly. */
static void turn_frames(struct tl_body_arm *arm)
{
    const size_t reach = TL_ARM_STEPS / 10;
    for (size_t k = 0; k < TL_ARM_STEPS; k++) {
        size_t before = k > reach ? k - reach : 0,
               after = k + reach < TL_ARM_STEPS ? k + reach : TL_ARM_STEPS - 1;
        vec3s along = glms_vec3_normalize(glms_vec3_sub(arm->middle[after], arm->middle[before]));
        vec3s ahead = {{0, 0, 1}};
        ahead = glms_vec3_normalize(glms_vec3_sub(ahead, glms_vec3_scale(along, along.z)));
        arm->along[k] = along;
        arm->ahead[k] = ahead;
        arm->outer[k] = glms_vec3_cross(ahead, along);
        if (arm->outer[k].x < 0)
            arm->outer[k] = glms_vec3_negate(arm->outer[k]);
    }
}

bool tl_body_measure_arm(const tl_mesh *mesh, double underarm_y, struct tl_body_arm *out)
{
    enum { MAXIMUM = 256, MINIMUM = 20 };
    const double step = 0.005, hand = 0.25; /* the hand's share of the arm's height */
    struct arm_section sections[MAXIMUM];
    size_t count = follow_arm(mesh, underarm_y, step, sections, MAXIMUM), wrist = 0;
    if (count < MINIMUM)
        return false;
    for (size_t i = 0; (double)i < (1 - hand) * (double)count; i++)
        if (sections[i].girth < sections[wrist].girth)
            wrist = i;
    even_line(sections, wrist + 1, out);
    turn_frames(out);
    return true;
}

double tl_body_arm_girth(const tl_mesh *mesh, const struct tl_body_arm *arm, size_t step, double length,
                         struct tl_ring *ring)
{
    const struct tl_plane plane = {arm->middle[step], arm->ahead[step], arm->outer[step]};
    struct tl_section *sections;
    size_t count = tl_mesh_sections(mesh, &plane, &sections);
    const struct tl_section *found = NULL;
    double nearest = INFINITY;
    for (size_t i = 0; i < count; i++) {
        double distance = (double)glms_vec2_norm(
            glms_vec2_scale(glms_vec2_add(sections[i].lower, sections[i].upper), 0.5f));
        if (distance < nearest) {
            nearest = distance;
            found = &sections[i];
        }
    }
    double girth = found ? (double)found->girth_m : 0;
    if (found && ring)
        tl_section_ring(found, false, length, ring);
    tl_sections_release(&sections, count);
    return girth;
}
