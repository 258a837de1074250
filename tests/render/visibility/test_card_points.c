/* Visibility at the vertices of a picture on the graphics card against Embree's (points.c): which probes are
 * listed, which are covered, and what each sees of each region, as surfaces move and the environment turns.
 * Faults put into the shaders are found. */
#include "render/visibility/card_points.h"

#include "config/base/memory.h"
#include "render/visibility/card_points.glsl"
#include "render/visibility/refresh.h"
#include "tests/render/tree_rays.h"
#include "tests/render/visibility/points_stage.h"

#include <epoxy/gl.h>

#include "tests/testing.h"

enum { REGIONS = 26, IDS_WIDTH = 64 };
#define RAISED_M 0.26f

/* A value is rounded to a byte on the card and to sixteen bits here; sums of a few floats differ by less than
 * 1e-6. */
#define ROUNDING (0.5 / 255 + 0.5 / 65535 + 1e-6)

struct compared {
    size_t probes, covered, lifted, values, between; /* ... neither 0 nor 1 */
    size_t other_lists, other_covers, other_origins, other_values;
};

/* IDs of all samples' triangles, one a pixel. */
static tl_texture make_ids(tl_gpu *gpu, const uint32_t *seen, size_t count)
{
    const int height = (int)((count + IDS_WIDTH - 1) / IDS_WIDTH);
    tl_texture ids = tl_texture_create(gpu, GL_TEXTURE_2D, GL_R32UI, IDS_WIDTH, height, 1, 1);
    uint32_t *texels = TL_NEW_ARRAY(uint32_t, (size_t)IDS_WIDTH * (size_t)height);
    for (size_t i = 0; i < count; i++)
        texels[i] = ((seen[i] & ~TL_SAMPLE_BACK) + 1) | (seen[i] & TL_SAMPLE_BACK);
    glTextureSubImage2D(ids.id, 0, 0, 0, IDS_WIDTH, height, GL_RED_INTEGER, GL_UNSIGNED_INT, texels);
    free(texels);
    return ids;
}

static vec3s *make_directions(const struct stage *stage)
{
    const int count = stage->regions.count, rays = stage->params.rays;
    vec3s *directions = TL_NEW_ARRAY(vec3s, (size_t)(count * rays));
    for (int k = 0; k < rays; k++)
        for (int i = 0; i < count; i++)
            directions[k * count + i] =
                tl_turn_direction(rays == 1 ? stage->regions.items[i].direction
                                            : tl_region_sample(&stage->regions, i, (uint32_t)k),
                                  stage->request.environment_yaw);
    return directions;
}

/* The origin of a probe's rays: where it lies slightly inside another surface's body, beyond that. */
static vec3s origin_of(const struct stage *stage, const struct tl_cache_probe *probe, vec3s normal,
                       float offset)
{
    const vec3s at = stage->ranges.surfaces[probe->surface]->positions[probe->vertex];
    const vec3s origin = glms_vec3_add(at, glms_vec3_scale(normal, offset));
    const struct tl_trace_hit above =
        tl_trace_nearest(stage->trace, origin, normal, 0, TL_COVER_OFFSETS * offset);
    if (above.surface == TL_TRACE_NONE || !above.back || above.surface == probe->surface)
        return origin;
    const struct tl_trace_hit below =
        tl_trace_nearest(stage->trace, glms_vec3_sub(origin, glms_vec3_scale(normal, 2 * offset)),
                         glms_vec3_negate(normal), 0, INFINITY);
    const bool is_inside = below.surface == above.surface && below.back;
    return glms_vec3_add(origin, glms_vec3_scale(normal, is_inside ? above.distance_m + offset : 0));
}

static size_t first_vertex(const struct stage *stage, size_t surface)
{
    size_t first = 0;
    for (size_t s = 0; s < surface; s++)
        first += stage->ranges.surfaces[s]->vertex_count;
    return first;
}

/* Both ways in motion. `kept`: values by probe, or NULL. */
static struct compared compare(struct stage *stage, struct tl_card_points *card, tl_gpu *gpu,
                               uint8_t (*kept)[REGIONS])
{
    tl_error error = {0};
    struct compared result = {0};
    const size_t count = stage->samples.count;
    uint32_t *seen = TL_NEW_ARRAY(uint32_t, 2 * count); /* then the other sides of what light comes through */
    size_t seen_count = count;
    for (size_t i = 0; i < count; i++) {
        seen[i] = stage->samples.items[i].triangle;
        if (tl_material_transmits(tl_triangle_material(&stage->ranges, seen[i] & ~TL_SAMPLE_BACK)))
            seen[seen_count++] = seen[i] ^ TL_SAMPLE_BACK;
    }
    stage->request.samples = NULL;
    stage->request.seen = seen;
    stage->request.seen_count = seen_count;
    step(stage, true);

    tl_texture ids = make_ids(gpu, seen, count);
    vec3s *directions = make_directions(stage);
    const struct tl_card_points_light light = {.directions = directions,
                                               .region_count = stage->regions.count,
                                               .ray_count = stage->params.rays,
                                               .ground = stage->request.ground};
    assert_ok(tl_card_points_follow(card, gpu, &stage->ranges, stage->request.ground,
                                    stage->request.shapes_revision, &error),
              error);
    tl_card_points_list(card, &ids, 1);
    assert_ok(tl_card_points_trace(card, &light, &error), error);
    assert_near(card->offset_m, tl_trace_offset(stage->trace), 0);

    uint32_t listed;
    tl_buffer_read(&card->work, CARD_LISTED * sizeof listed, &listed, sizeof listed);
    assert_in_range(listed, 0, card->probe_count);
    uint32_t *list = TL_NEW_ARRAY(uint32_t, listed);
    vec4s(*origins)[2] = tl_alloc(listed, sizeof *origins);
    uint8_t *values = TL_NEW_ARRAY(uint8_t, card->values.bytes);
    bool *is_listed = TL_NEW_ARRAY(bool, card->probe_count), *wanted = TL_NEW_ARRAY(bool, card->probe_count);
    tl_buffer_read(&card->list, 0, list, listed * sizeof *list);
    tl_buffer_read(&card->origins, 0, origins, listed * sizeof *origins);
    tl_buffer_read(&card->values, 0, values, card->values.bytes);
    size_t stride;
    const uint16_t *expected = tl_points_values(stage->points, &stride);
    for (size_t i = 0; i < seen_count; i++) {
        uint32_t corners[3];
        size_t s;
        tl_triangle_find(&stage->ranges, seen[i] & ~TL_SAMPLE_BACK, corners, &s);
        for (int k = 0; k < 3; k++)
            wanted[2 * (first_vertex(stage, s) + corners[k]) + (seen[i] & TL_SAMPLE_BACK ? 1 : 0)] = true;
    }
    for (size_t k = 0; k < listed; k++) {
        if (list[k] >= card->probe_count || is_listed[list[k]]) {
            result.other_lists++;
            continue;
        }
        is_listed[list[k]] = true;
        const struct tl_cache_probe *probe = &card->items[list[k]];
        const tl_surface *surface = stage->ranges.surfaces[probe->surface];
        if (!wanted[2 * (first_vertex(stage, probe->surface) + probe->vertex) + probe->back])
            continue; /* counted below */
        const uint32_t point = tl_points_of_vertex(stage->points, probe->surface, probe->vertex, probe->back);
        const vec3s normal = glms_vec3_scale(surface->normals[probe->vertex], probe->back ? -1 : 1);
        const vec3s origin = origin_of(stage, probe, normal, card->offset_m);
        const bool is_covered = origins[k][0].w > 0;
        result.covered += is_covered;
        result.lifted +=
            glms_vec3_distance(origin, surface->positions[probe->vertex]) > 1.5f * card->offset_m;
        result.other_covers += is_covered != tl_points_is_covered(stage->points, point);
        result.other_origins += glms_vec3_distance(origin, glms_vec3(origins[k][0])) > 1e-6f ||
                                glms_vec3_distance(normal, glms_vec3(origins[k][1])) > 1e-6f;
        for (int i = 0; i < stage->regions.count; i++) {
            const uint8_t byte = values[4 * ((size_t)(i / 4) * card->probe_count + k) + (size_t)(i % 4)];
            const double value = (double)expected[point * stride + (size_t)i] / (double)TL_VISIBILITY_ONE;
            result.values++;
            if (kept)
                kept[list[k]][i] = byte;
            result.between += byte != 0 && byte != 255;
            result.other_values += fabs((double)byte / 255 - value) > ROUNDING;
        }
    }
    result.probes = listed;
    for (size_t p = 0; p < card->probe_count; p++) {
        const struct tl_cache_probe *probe = &card->items[p];
        result.other_lists +=
            is_listed[p] != wanted[2 * (first_vertex(stage, probe->surface) + probe->vertex) + probe->back];
    }
    free(wanted);
    free(list);
    free(origins);
    free(values);
    free(is_listed);
    free(seen);
    free(directions);
    tl_texture_destroy(&ids);
    return result;
}

static size_t faults_of(const struct compared *result)
{
    return result->other_lists + result->other_covers + result->other_origins + result->other_values;
}

static struct compared expect_equal(struct stage *stage, struct tl_card_points *card, tl_gpu *gpu,
                                    const char *what)
{
    const struct compared result = compare(stage, card, gpu, NULL);
    print_message("%s: %zu probes, %zu covered, %zu lifted; %zu values, %zu in between; wrong: %zu lists, "
                  "%zu covers, %zu "
                  "origins, %zu values\n",
                  what, result.probes, result.covered, result.lifted, result.values, result.between,
                  result.other_lists, result.other_covers, result.other_origins, result.other_values);
    assert_int_equal(faults_of(&result), 0);
    return result;
}

/* Raises the sphere into the sheet: some of the sheet's vertices lie inside it, some close above. */
static void raise_sphere(struct stage *stage, float by)
{
    for (size_t i = 0; i < stage->sphere.mesh.vertex_count; i++)
        stage->sphere.mesh.positions[i].y += by;
    stage->sphere.surface.motion_revision++;
    refresh_scene(stage);
}

/* Light comes through the sheet, and on the way a part of it. */
static void open_sheet(struct stage *stage)
{
    const uint64_t revision = stage->sheet.surface.topology_revision;
    stage->sheet.material.openness = 0.4f;
    stage->sheet.material.transmission = (vec3s){{0.3f, 0.3f, 0.3f}};
    stage->sheet.surface.topology_revision = revision + 1;
    stage->request.shapes_revision++;
    refresh_scene(stage);
}

static void test_visibility_is_embrees(void **state)
{
    struct stage stage;
    struct tl_card_points card = {0};
    stage_open(&stage, REGIONS);
    expect_equal(&stage, &card, *state, "a ray a region");
    move_sheet(&stage, 0.13f);
    raise_sphere(&stage, RAISED_M);
    stage.request.environment_yaw = 0.7f;
    struct compared result = expect_equal(&stage, &card, *state, "moved, raised, turned");
    assert_true(result.covered > 0 && result.lifted > 0);
    open_sheet(&stage);
    result = expect_equal(&stage, &card, *state, "through an open sheet");
    assert_true(result.between > result.values / 20);
    stage.params.rays = 3;
    expect_equal(&stage, &card, *state, "three rays a region");
    tl_card_points_release(&card);
    stage_close(&stage);
}

/* The same work gives the same bytes, whatever was listed before, in whichever order groups come to the list.
 */
static void test_frames_repeat(void **state)
{
    struct stage stage;
    struct tl_card_points card = {0};
    stage_open(&stage, REGIONS);
    const size_t probes =
        2 * (stage.sheet.mesh.vertex_count + stage.sphere.mesh.vertex_count + TL_GROUND_VERTICES);
    uint8_t(*values[2])[REGIONS];
    for (int i = 0; i < 2; i++) {
        values[i] = tl_alloc(probes, sizeof *values[i]);
        stage.params.rays = 2;
        compare(&stage, &card, *state, values[i]);
        stage.samples.count /= 2;
        stage.params.rays = 1;
        const struct compared fewer = compare(&stage, &card, *state, NULL);
        assert_int_equal(faults_of(&fewer), 0);
        make_samples(&stage);
    }
    assert_int_equal(card.probe_count, probes);
    assert_memory_equal(values[0], values[1], probes * sizeof *values[0]);
    tl_card_points_release(&card);
    stage_close(&stage);
    free(values[0]);
    free(values[1]);
}

static void test_faults_are_found(void **state)
{
    static const struct {
        int program;
        const char *program_file;
        struct card_edit edit;
    } faults[] = {
        {TL_CARD_MARK, "mark.comp", {"mark.comp", "+ (id >> 31)", "+ (id >> 30)"}},
        {TL_CARD_MARK, "mark.comp", {"mark.comp", "~CARD_BACK) - 1u", "~CARD_BACK)"}},
        {TL_CARD_SEEN, "seen.comp", {"seen.comp", "both && sides", "sides"}},
        {TL_CARD_SEEN, "seen.comp", {"seen.comp", "(both && sides[side ^ 1u] == frame)", "false"}},
        {TL_CARD_GATHER, "gather.comp", {"gather.comp", "marks[probe] == frame", "marks[probe] != 0u"}},
        {TL_CARD_GATHER, "gather.comp", {"gather.comp", "sums[thread] - 1u", "sums[thread]"}},
        {TL_CARD_GATHER, "gather.comp", {"gather.comp", "+ 63u) / 64u", ") / 64u"}},
        {TL_CARD_PLACE, "place.comp", {"place.comp", "!lift(", "lift("}},
        {TL_CARD_PLACE, "place.comp", {"place.comp", "normal * (above.distance + offset)", "0.0 * normal"}},
        {TL_CARD_PLACE, "place.comp", {"visibility_terms.glsl", "OFFSETS 100", "OFFSETS 50"}},
        {TL_CARD_TRACE, "visible.comp", {"visible.comp", "cosine < -TL_SINE_BELOW", "cosine < 0.0"}},
        {TL_CARD_TRACE,
         "visible.comp",
         {"visible.comp", "cosine < 0.0 ? direction - 2.0 * cosine * normal :", ""}},
        {TL_CARD_TRACE, "visible.comp", {"visible.comp", "weight * share", "weight"}},
        {TL_CARD_TRACE, "visible.comp", {"visible.comp", "ray * region_count + region", "region"}},
        {TL_CARD_TRACE,
         "visible.comp",
         {"visible.comp", "tree_transmittance(origin", "float(!tree_occluded(origin"}},
        {TL_CARD_TRACE, "visible.comp", {"visibility_terms.glsl", "max(abs(cosine), 0.03125f)", "1.0"}},
    };
    struct stage stage;
    stage_open(&stage, REGIONS);
    stage.params.rays = 2;
    raise_sphere(&stage, RAISED_M);
    open_sheet(&stage);
    for (size_t f = 0; f < TL_COUNT(faults); f++) {
        struct card_edit edits[CARD_EDITS_MAX] = {faults[f].edit};
        if (strstr(faults[f].edit.replacement, "tree_occluded"))
            edits[1] = (struct card_edit){"visible.comp", "0.0, 1e30)", "0.0, 1e30))"};
        char *texts[CARD_EDITS_MAX] = {NULL};
        tl_error error = {0};
        struct tl_embedded *shaders = card_list_shaders(edits, texts);
        struct tl_card_points card = {0};
        assert_ok(tl_program_create_compute(*state, shaders, faults[f].program_file, NULL,
                                            &card.programs[faults[f].program], &error),
                  error);
        size_t found = 0;
        for (int frame = 0; frame < 2; frame++) {
            stage.samples.count /= 2; /* the second frame shows less */
            const struct compared result = compare(&stage, &card, *state, NULL);
            found += faults_of(&result);
        }
        make_samples(&stage);
        if (found == 0)
            print_error("a fault is not found: %s\n", faults[f].edit.text);
        assert_true(found > 0);
        tl_card_points_release(&card);
        free(shaders);
        for (int e = 0; e < CARD_EDITS_MAX; e++)
            free(texts[e]);
    }
    stage_close(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_visibility_is_embrees),
        cmocka_unit_test(test_frames_repeat),
        cmocka_unit_test(test_faults_are_found),
    };
    return cmocka_run_group_tests(tests, card_gpu_open, card_gpu_close);
}
