/* Normals and tangents against formulas, and against MikkTSpace written from its description
 * (mikk_oracle.h). */
#include "assets/garment.h"
#include "cloth/mesh/topology.h"
#include "cloth/tangents/tangent_frames.h"
#include "tests/cloth/bodies.h"
#include "tests/cloth/sheets.h"
#include "tests/cloth/tangents/mikk_oracle.h"
#include "tests/testing.h"

#include <omp.h>
#include <time.h>

/* ---- Meshes ---- */

static double noise(uint32_t i, uint32_t channel)
{
    uint32_t x = i * 2654435761u ^ (channel + 1) * 2246822519u;
    x = (x ^ (x >> 15)) * 2246822519u;
    x ^= x >> 13;
    return (double)x / 2147483648.0 - 1;
}

/* A sheet whose right half mirrors the UVs of its left half about the middle column, and with a cut at a
 * quarter, where UVs jump and positions do not. */
static tl_garment mirrored_and_cut(void)
{
    const struct sheet_shape shape = {12, 8, 1.2, 0.8};
    tl_garment garment = sheet_make(&shape, NULL);
    tl_mesh *mesh = &garment.model.mesh;
    size_t old = mesh->vertex_count, added = 0;
    mesh->positions = tl_resize(mesh->positions, 2 * old, sizeof(vec3s));
    mesh->uvs = tl_resize(mesh->uvs, 2 * old, sizeof(vec2s));
    for (size_t i = 0; i < old; i++) {
        if (mesh->uvs[i].x > 0.6f)
            mesh->uvs[i].x = 1.2f - mesh->uvs[i].x;
        mesh->uvs[i].y += 0.3f * mesh->uvs[i].x; /* not orthogonal */
        mesh->uvs[i].x += i % 13 > 3 ? 2 : 0;
    }
    uint32_t *copies = TL_NEW_ARRAY(uint32_t, old);
    for (size_t i = 0; i < mesh->index_count; i++) {
        uint32_t v = mesh->indices[i];
        size_t quad = i / 6 % (size_t)shape.columns;
        if (v % 13 != 3 || quad < 3)
            continue; /* the cut's right side gets vertices of its own */
        if (copies[v] == 0) {
            copies[v] = (uint32_t)(old + added++);
            mesh->positions[copies[v]] = mesh->positions[v];
            mesh->uvs[copies[v]] = (vec2s){{mesh->uvs[v].x + 2, mesh->uvs[v].y}};
        }
        mesh->indices[i] = copies[v];
    }
    free(copies);
    mesh->vertex_count = old + added;
    return garment;
}

/* Waves of a tenth of the garment's size, and noise at every position, `roughness` times the mean edge. Fixed
 * by `seed`. */
static void deform(const tl_mesh *mesh, const uint32_t *weld, uint32_t seed, double roughness, vec3s *out)
{
    struct tl_box box = tl_box_of(mesh->positions, mesh->vertex_count);
    double size = vec3d_distance(vec3d_from(box.lower), vec3d_from(box.upper)), edges = 0;
    for (size_t i = 0; i < mesh->index_count; i++)
        edges += vec3d_distance(vec3d_from(mesh->positions[mesh->indices[i]]),
                                vec3d_from(mesh->positions[mesh->indices[i - i % 3 + (i + 1) % 3]]));
    double edge = edges / (double)mesh->index_count;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            vec3s p = mesh->positions[i];
            double phase = 2 * M_PI / size *
                               ((double)p.raw[(k + 1) % 3] * (1 + noise(seed, k)) +
                                (double)p.raw[(k + 2) % 3] * (1 + noise(seed, 3 + k))) +
                           M_PI * noise(seed, 6 + k);
            out[i].raw[k] = (float)((double)p.raw[k] + 0.1 * size * sin(phase) +
                                    roughness * edge * noise(weld[i] + 100003 * seed, k));
        }
}

static double degrees_between(vec3d a, vec3d b)
{
    return oracle_angle(a, b) * 180 / M_PI;
}

struct buffers {
    vec3s *positions, *normals;
    vec4s *tangents;
    uint32_t *weld;
};

static struct buffers make_buffers(const tl_mesh *mesh)
{
    struct buffers b = {TL_NEW_ARRAY(vec3s, mesh->vertex_count), TL_NEW_ARRAY(vec3s, mesh->vertex_count),
                        TL_NEW_ARRAY(vec4s, mesh->vertex_count), TL_NEW_ARRAY(uint32_t, mesh->vertex_count)};
    tl_weld_positions(mesh->positions, mesh->vertex_count, b.weld);
    memcpy(b.positions, mesh->positions, mesh->vertex_count * sizeof(vec3s));
    return b;
}

static void free_buffers(struct buffers *b)
{
    free(b->positions);
    free(b->normals);
    free(b->tangents);
    free(b->weld);
}

static vec3d tangent_at(const struct buffers *b, size_t i)
{
    return (vec3d){(double)b->tangents[i].x, (double)b->tangents[i].y, (double)b->tangents[i].z};
}

static void assert_orthonormal(const struct buffers *b, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        vec3d n = vec3d_from(b->normals[i]), t = tangent_at(b, i);
        assert_near(vec3d_norm(n), 1, 1e-5);
        assert_near(vec3d_norm(t), 1, 1e-5);
        assert_near(vec3d_dot(n, t), 0, 1e-5);
        assert_near(fabsf(b->tangents[i].w), 1, 0);
    }
}

/* ---- Tests ---- */

struct errors {
    double worst_normal, worst_tangent, normals, tangents; /* degrees; the latter two are sums */
    size_t normal_count, tangent_count, undetermined;
};

/* The corner of a vertex in the group of most of its corners, the first if several are equal. */
static size_t showing_corner(const struct oracle *o, uint32_t vertex)
{
    size_t best = ORACLE_NONE, maximum = 0;
    for (size_t c = o->first_at[o->weld[vertex]]; c != ORACLE_NONE; c = o->next_at[c]) {
        size_t votes = 0;
        if (oracle_vertex(o, c) != vertex || !oracle_grouped(o, c))
            continue;
        for (size_t d = c; d != ORACLE_NONE; d = o->next_at[d])
            votes += oracle_vertex(o, d) == vertex && o->group[d] == o->group[c];
        best = votes > maximum ? c : best;
        maximum = votes > maximum ? votes : maximum;
    }
    return best;
}

/* Compares every vertex that the oracle gives a normal or a tangent. Sums that almost cancel (a thousandth of
 * one triangle's) have no direction that float positions determine. */
static void compare(const tl_mesh *mesh, const struct buffers *b, struct errors *errors)
{
    const double cancelled = 1e-3;
    struct oracle o = oracle_make(mesh, b->positions, b->normals, b->weld);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        size_t any = o.first_at[b->weld[v]], shown = showing_corner(&o, v);
        while (any != ORACLE_NONE && oracle_vertex(&o, any) != v)
            any = o.next_at[any];
        if (any == ORACLE_NONE)
            continue; /* in no triangle */
        vec3d normal = oracle_normal_sum(&o, any);
        if (vec3d_norm(normal) < cancelled) {
            errors->undetermined++;
            continue;
        }
        double off = degrees_between(normal, vec3d_from(b->normals[v]));
        errors->worst_normal = fmax(errors->worst_normal, off);
        errors->normals += off;
        errors->normal_count++;
        if (shown == ORACLE_NONE)
            continue; /* no UV area around it */
        vec3d tangent = oracle_tangent_sum(&o, shown);
        if (vec3d_norm(tangent) < cancelled) {
            errors->undetermined++;
            continue;
        }
        off = degrees_between(tangent, tangent_at(b, v));
        errors->worst_tangent = fmax(errors->worst_tangent, off);
        errors->tangents += off;
        errors->tangent_count++;
        int hand = o.hand[shown / 3];
        assert_near(b->tangents[v].w, -hand, 0); /* v runs down */
    }
    oracle_release(&o);
}

static void print_errors(const char *name, const tl_mesh *mesh, const struct errors *e)
{
    printf("%s, %zu vertices: normals %.1e deg (mean %.1e)", name, mesh->vertex_count, e->worst_normal,
           e->normals / (double)e->normal_count);
    if (e->tangent_count > 0)
        printf(", tangents %.1e deg (mean %.1e)", e->worst_tangent, e->tangents / (double)e->tangent_count);
    printf("\n");
}

#define ALLOWED_DEG 0.05

/* Deformed by waves with little and with much noise. */
static void check_deformations(const char *name, const tl_mesh *mesh, uint32_t seeds)
{
    struct buffers b = make_buffers(mesh);
    tl_tangent_frames *frames = tl_tangent_frames_create(mesh, b.weld);
    struct errors errors = {0};
    for (uint32_t seed = 0; seed < seeds; seed++) {
        deform(mesh, b.weld, seed, seed % 2 == 0 ? 0.1 : 0.5, b.positions);
        tl_tangent_frames_update(frames, b.positions, b.normals, b.tangents);
        assert_orthonormal(&b, mesh->vertex_count);
        compare(mesh, &b, &errors);
    }
    print_errors(name, mesh, &errors);
    assert_true(errors.worst_normal <= ALLOWED_DEG);
    assert_true(errors.worst_tangent <= ALLOWED_DEG);
    assert_true(errors.normal_count > 0);
    assert_true(errors.undetermined <= errors.normal_count / 500);
    tl_tangent_frames_destroy(&frames);
    free_buffers(&b);
}

static void test_mirrored_and_cut(void **state)
{
    (void)state;
    tl_garment garment = mirrored_and_cut();
    check_deformations("mirrored and cut", &garment.model.mesh, 6);
    sheet_free(&garment);
}

/* A mesh with every irregularity that a file may have: random UVs, so that handedness changes from triangle
 * to triangle; a third of the vertices with the UV of another; flipped triangles; edges with three and four
 * triangles. */
static void test_tangled_mesh(void **state)
{
    (void)state;
    const struct sheet_shape shape = {20, 20, 1, 1};
    tl_garment garment = sheet_make(&shape, NULL);
    tl_mesh *mesh = &garment.model.mesh;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        uint32_t from = noise(i, 7) > 0.3 ? i - i % 4 : i;
        mesh->uvs[i] = (vec2s){{(float)noise(from, 8), (float)noise(from, 9)}};
    }
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        uint32_t *t = mesh->indices + i, second = t[1];
        if (noise(i, 10) > 0.6) {
            t[1] = t[2];
            t[2] = second;
        } else if (noise(i, 10) < -0.6) {
            t[2] = (uint32_t)((noise(i, 11) + 1) / 2 * (double)(mesh->vertex_count - 1));
        }
    }
    check_deformations("tangled", mesh, 6);
    sheet_free(&garment);
}

static void check_file(const char *path)
{
    tl_garment garment;
    tl_error error;
    assert_ok(tl_garment_load(test_data(path), &garment, &error), error);
    check_deformations(path, &garment.model.mesh, garment.model.mesh.vertex_count > 20000 ? 2 : 4);
    tl_garment_release(&garment);
}

#define FILE_TEST(name, path)                                                                                \
    static void test_##name(void **state)                                                                    \
    {                                                                                                        \
        (void)state;                                                                                         \
        check_file("garments/" path);                                                                        \
    }
FILE_TEST(female_sportsuit, "mh_female_sportsuit01.glb")
FILE_TEST(male_casualsuit, "mh_male_casualsuit06.glb")
FILE_TEST(folds, "bjs_clothFolds.glb")
FILE_TEST(knife_pleats, "cipc_dress_knife_stage.obj")
FILE_TEST(draped_dress, "diffcloth_dress-handsup-drape.obj")
FILE_TEST(long_sleeved_dress, "diffcloth_dress-v5k-f10k.obj")
FILE_TEST(plain_skirt, "diffcloth_skirt3448.obj")
FILE_TEST(tshirt, "diffcloth_tshirt1000-tri.obj")

static void test_built_in_garments(void **state)
{
    (void)state;
    for (const char *const *name = tl_garment_names; *name; name++) {
        tl_garment garment;
        tl_error error;
        assert_ok(tl_garment_cut(*name, 0.03f, &garment, &error), error);
        check_deformations(*name, &garment.model.mesh, 4);
        tl_garment_release(&garment);
    }
}

#define TURN 0.9 /* radians of a cylinder that a sheet of 1 m is rolled to */
static vec3s roll(double u, double v)
{
    double radius = 1 / TURN, angle = (u - 0.5) * TURN;
    return (vec3s){{(float)(radius * sin(angle)), (float)v, (float)(radius * cos(angle))}};
}

/* A sheet rolled about y: normals are radial, tangents follow the circle, the bitangent is up, v runs down.
 * At inner vertices of a regular grid the cylinder is symmetric except for the diagonal: errors are within
 * the angle of one cell. */
static void test_cylinder(void **state)
{
    (void)state;
    const struct sheet_shape shape = {64, 16, 1, 0.25};
    tl_garment garment = sheet_make(&shape, roll);
    const tl_mesh *mesh = &garment.model.mesh;
    struct buffers b = make_buffers(mesh);
    tl_tangent_frames *frames = tl_tangent_frames_create(mesh, b.weld);
    tl_tangent_frames_update(frames, b.positions, b.normals, b.tangents);
    double cell_deg = TURN / 64 * 180 / M_PI;
    for (int row = 1; row < shape.rows; row++)
        for (int column = 1; column < shape.columns; column++) {
            uint32_t i = sheet_vertex(&shape, column, row);
            double angle = ((double)column / shape.columns - 0.5) * TURN;
            vec3d radial = {sin(angle), 0, cos(angle)}, along = {cos(angle), 0, -sin(angle)};
            assert_true(degrees_between(radial, vec3d_from(b.normals[i])) < 0.05 * cell_deg);
            assert_true(degrees_between(along, tangent_at(&b, i)) < 0.05 * cell_deg);
            assert_near(b.tangents[i].w, 1, 0);
            vec3d bitangent = vec3d_cross(vec3d_from(b.normals[i]), tangent_at(&b, i));
            assert_true(bitangent.y > 0.999);
        }
    tl_tangent_frames_destroy(&frames);
    free_buffers(&b);
    sheet_free(&garment);
}

/* Collapsed triangles, equal UVs, unused vertices, a sheet collapsed to a point. */
static void test_degenerate_input_stays_finite(void **state)
{
    (void)state;
    const struct sheet_shape shape = {6, 6, 0.6, 0.6};
    tl_garment garment = sheet_make(&shape, NULL);
    tl_mesh *mesh = &garment.model.mesh;
    for (int i = 0; i < 20; i++)
        mesh->uvs[i] = (vec2s){{0.5f, 0.5f}};
    mesh->indices[7] = mesh->indices[6];
    for (size_t i = 0; i < mesh->index_count; i++)
        if (mesh->indices[i] == 48)
            mesh->indices[i] = 47;
    struct buffers b = make_buffers(mesh), first = make_buffers(mesh);
    tl_tangent_frames *frames = tl_tangent_frames_create(mesh, b.weld);
    tl_tangent_frames_update(frames, b.positions, b.normals, b.tangents);
    memcpy(first.tangents, b.tangents, mesh->vertex_count * sizeof(vec4s));
    assert_orthonormal(&b, mesh->vertex_count);
    assert_near(b.normals[48].y, 1, 0); /* unused: +Y */
    memset(b.positions, 0, mesh->vertex_count * sizeof(vec3s));
    tl_tangent_frames_update(frames, b.positions, b.normals, b.tangents);
    assert_orthonormal(&b, mesh->vertex_count);
    assert_near(b.normals[24].z, 1, 1e-6); /* kept from before */

    /* After bending, the vertices without UVs keep tangents of their own; after a reset they start again. */
    deform(mesh, b.weld, 1, 0.1, b.positions);
    tl_tangent_frames_update(frames, b.positions, b.normals, b.tangents);
    memcpy(b.positions, mesh->positions, mesh->vertex_count * sizeof(vec3s));
    tl_tangent_frames_update(frames, b.positions, b.normals, b.tangents);
    assert_memory_not_equal(first.tangents, b.tangents, mesh->vertex_count * sizeof(vec4s));
    tl_tangent_frames_reset(frames);
    tl_tangent_frames_update(frames, b.positions, b.normals, b.tangents);
    assert_memory_equal(first.tangents, b.tangents, mesh->vertex_count * sizeof(vec4s));
    free_buffers(&first);
    tl_tangent_frames_destroy(&frames);
    free_buffers(&b);
    sheet_free(&garment);
}

/* A sheet modelled from both sides with separate vertices: each side has its own normal. */
static void test_both_sides(void **state)
{
    (void)state;
    const vec3s corners[] = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}};
    vec3s positions[6];
    vec2s uvs[6];
    uint32_t indices[] = {0, 1, 2, 3, 5, 4};
    for (int i = 0; i < 6; i++) {
        positions[i] = corners[i % 3];
        uvs[i] = (vec2s){{corners[i % 3].x, -corners[i % 3].y}};
    }
    const tl_mesh mesh = {
        .vertex_count = 6, .positions = positions, .uvs = uvs, .index_count = 6, .indices = indices};
    struct buffers b = make_buffers(&mesh);
    tl_tangent_frames *frames = tl_tangent_frames_create(&mesh, b.weld);
    tl_tangent_frames_update(frames, b.positions, b.normals, b.tangents);
    for (int i = 0; i < 6; i++) {
        assert_near(b.normals[i].z, i < 3 ? 1 : -1, 1e-6);
        assert_near(b.tangents[i].x, 1, 1e-6);
        assert_near(b.tangents[i].w, i < 3 ? 1 : -1, 0);
    }
    tl_tangent_frames_destroy(&frames);
    free_buffers(&b);
}

/* An open fan and a ring of 100 triangles that share one vertex: two chains, and more spokes than are
 * buffered at a time. */
static void test_long_fans(void **state)
{
    (void)state;
    enum { SIDES = 100 };
    vec3s positions[2 * SIDES + 2] = {{{0}}};
    vec2s uvs[2 * SIDES + 2] = {{{0}}};
    uint32_t indices[6 * SIDES];
    for (uint32_t i = 0; i <= SIDES; i++) { /* 1 .. SIDES + 1: the fan's rim; then the ring's */
        double turn = 0.9 * M_PI * i / SIDES, round = 2 * M_PI * i / SIDES;
        positions[1 + i] = (vec3s){{(float)cos(turn), (float)sin(turn), 0.2f * (float)sin(7 * turn)}};
        if (i < SIDES)
            positions[2 + SIDES + i] = (vec3s){{(float)cos(round), -1 + (float)sin(round), 0.3f}};
    }
    for (uint32_t i = 0; i < 2 * SIDES + 2; i++)
        uvs[i] = (vec2s){{positions[i].x + positions[i].z, -positions[i].y}};
    for (uint32_t i = 0; i < SIDES; i++) {
        const uint32_t fan[3] = {0, 1 + i, 2 + i};
        const uint32_t ring[3] = {0, 2 + SIDES + i, 2 + SIDES + (i + 1) % SIDES};
        memcpy(indices + (size_t)3 * i, fan, sizeof fan);
        memcpy(indices + (size_t)3 * (SIDES + i), ring, sizeof ring);
    }
    const tl_mesh mesh = {.vertex_count = TL_COUNT(positions),
                          .positions = positions,
                          .uvs = uvs,
                          .index_count = TL_COUNT(indices),
                          .indices = indices};
    check_deformations("long fans", &mesh, 6);
}

/* Directions do not depend on size, even if squares of areas come near the limits of float. */
static void test_sizes(void **state)
{
    (void)state;
    tl_garment garment = mirrored_and_cut();
    tl_mesh *mesh = &garment.model.mesh;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        mesh->positions[i] = glms_vec3_scale(mesh->positions[i], 1e-6f);
    check_deformations("a thousandth of a millimetre", mesh, 2);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        mesh->positions[i] = glms_vec3_scale(mesh->positions[i], 1e12f);
    check_deformations("a thousand kilometres", mesh, 2);
    sheet_free(&garment);
}

/* Vertices around one that is not finite keep their frames, and the others are updated. */
static void test_positions_that_are_not_finite(void **state)
{
    (void)state;
    const float bad[] = {NAN, INFINITY, -INFINITY, 3e38f};
    tl_garment garment = mirrored_and_cut();
    const tl_mesh *mesh = &garment.model.mesh;
    struct buffers b = make_buffers(mesh), clean = make_buffers(mesh);
    tl_tangent_frames *frames = tl_tangent_frames_create(mesh, b.weld);
    deform(mesh, b.weld, 1, 0.1, b.positions);
    tl_tangent_frames_update(frames, b.positions, clean.normals, clean.tangents);
    const uint32_t middle = 4 * 13 + 8; /* row and column of no cut and no mirror */
    for (size_t i = 0; i < TL_COUNT(bad); i++) {
        vec3s kept = b.positions[middle];
        b.positions[middle].y = bad[i];
        tl_tangent_frames_update(frames, b.positions, b.normals, b.tangents);
        assert_orthonormal(&b, mesh->vertex_count);
        b.positions[middle] = kept;
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            int rows = abs((int)(v / 13) - 4), columns = abs((int)(v % 13) - 8);
            bool far = rows > 1 || columns > 1, kept_frame = rows + columns <= 1 && !isfinite(bad[i]);
            if (far || kept_frame)
                assert_memory_equal(&b.normals[v], &clean.normals[v], sizeof(vec3s));
        }
        tl_tangent_frames_update(frames, b.positions, b.normals, b.tangents);
        assert_memory_equal(b.normals, clean.normals, mesh->vertex_count * sizeof(vec3s));
        assert_memory_equal(b.tangents, clean.tangents, mesh->vertex_count * sizeof(vec4s));
    }
    tl_tangent_frames_destroy(&frames);
    free_buffers(&b);
    free_buffers(&clean);
    sheet_free(&garment);
}

static vec3s wave(double u, double v)
{
    return (vec3s){{(float)u, (float)v, (float)(0.05 * sin(9 * u + 4 * v))}};
}

static void test_threads_do_not_matter(void **state)
{
    (void)state;
    const struct sheet_shape shape = {120, 120, 1, 1};
    tl_garment garment = sheet_make(&shape, wave);
    const tl_mesh *mesh = &garment.model.mesh;
    struct buffers b = make_buffers(mesh), one = make_buffers(mesh);
    int threads = omp_get_max_threads();
    for (int count = 1; count <= 3; count++) {
        tl_tangent_frames *frames = tl_tangent_frames_create(mesh, b.weld);
        struct buffers *to = count == 1 ? &one : &b;
        omp_set_num_threads(count);
        tl_tangent_frames_update(frames, b.positions, to->normals, to->tangents);
        assert_memory_equal(to->normals, one.normals, mesh->vertex_count * sizeof(vec3s));
        assert_memory_equal(to->tangents, one.tangents, mesh->vertex_count * sizeof(vec4s));
        tl_tangent_frames_destroy(&frames);
    }
    omp_set_num_threads(threads);
    free_buffers(&b);
    free_buffers(&one);
    sheet_free(&garment);
}

static double thread_seconds(void)
{
    struct timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* Prints the time on one core, the best of many; not checked. */
static void test_print_speed(void **state)
{
    (void)state;
    const int sides[] = {99, 315}, repeats[] = {300, 30};
    int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    for (size_t i = 0; i < TL_COUNT(sides); i++) {
        const struct sheet_shape shape = {sides[i], sides[i], 1, 1};
        tl_garment garment = sheet_make(&shape, wave);
        const tl_mesh *mesh = &garment.model.mesh;
        struct buffers b = make_buffers(mesh);
        tl_tangent_frames *frames = tl_tangent_frames_create(mesh, b.weld);
        double best = INFINITY;
        for (int k = 0; k < repeats[i]; k++) {
            double begin = thread_seconds();
            tl_tangent_frames_update(frames, b.positions, b.normals, b.tangents);
            best = fmin(best, thread_seconds() - begin);
        }
        assert_orthonormal(&b, mesh->vertex_count);
        printf("%zu vertices: %.3f ms, %.1f ns a vertex\n", mesh->vertex_count, 1e3 * best,
               1e9 * best / (double)mesh->vertex_count);
        tl_tangent_frames_destroy(&frames);
        free_buffers(&b);
        sheet_free(&garment);
    }
    omp_set_num_threads(threads);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mirrored_and_cut),
        cmocka_unit_test(test_tangled_mesh),
        cmocka_unit_test(test_female_sportsuit),
        cmocka_unit_test(test_male_casualsuit),
        cmocka_unit_test(test_folds),
        cmocka_unit_test(test_knife_pleats),
        cmocka_unit_test(test_draped_dress),
        cmocka_unit_test(test_long_sleeved_dress),
        cmocka_unit_test(test_plain_skirt),
        cmocka_unit_test(test_tshirt),
        cmocka_unit_test(test_built_in_garments),
        cmocka_unit_test(test_cylinder),
        cmocka_unit_test(test_degenerate_input_stays_finite),
        cmocka_unit_test(test_both_sides),
        cmocka_unit_test(test_long_fans),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_positions_that_are_not_finite),
        cmocka_unit_test(test_threads_do_not_matter),
        cmocka_unit_test(test_print_speed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
