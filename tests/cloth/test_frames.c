/* Normals and tangents against an independent MikkTSpace, written from its description (Mikkelsen 2008,
 * "Simulation of Wrinkled Surfaces Revisited", and the comments of its reference code): per corner, in
 * double, by walking from triangle to triangle around each vertex, with no sorted lists and no fans shared
 * with what is tested. */
#include "bodies.h"
#include "cloth/frames.h"
#include "cloth/vec3d.h"
#include "sheets.h"
#include "testing.h"

/* ---- The oracle ---- */

struct oracle {
    const tl_mesh *mesh;
    const vec3s *positions;
    const uint32_t *weld;
};

static uint32_t corner_vertex(const struct oracle *o, size_t corner)
{
    return o->mesh->indices[corner];
}

static vec3d corner_place(const struct oracle *o, size_t corner)
{
    return vec3d_from(o->positions[corner_vertex(o, corner)]);
}

static size_t turn(size_t corner, size_t by)
{
    return corner - corner % 3 + (corner + by) % 3;
}

static double angle_between(vec3d a, vec3d b)
{
    double lengths = vec3d_norm(a) * vec3d_norm(b);
    return lengths > 0 ? acos(fmin(fmax(vec3d_dot(a, b) / lengths, -1), 1)) : 0;
}

static vec3d oracle_normal(const struct oracle *o, uint32_t vertex)
{
    vec3d sum = {0};
    for (size_t c = 0; c < o->mesh->index_count; c++) {
        if (o->weld[corner_vertex(o, c)] != o->weld[vertex])
            continue;
        vec3d next = vec3d_sub(corner_place(o, turn(c, 1)), corner_place(o, c));
        vec3d last = vec3d_sub(corner_place(o, turn(c, 2)), corner_place(o, c));
        vec3d face = vec3d_unit_or(vec3d_cross(next, last), (vec3d){0});
        sum = vec3d_muladd(sum, face, angle_between(next, last));
    }
    return vec3d_unit_or(sum, (vec3d){0});
}

static double uv_area(const struct oracle *o, size_t triangle)
{
    vec2s a = o->mesh->uvs[o->mesh->indices[3 * triangle]];
    vec2s b = o->mesh->uvs[o->mesh->indices[3 * triangle + 1]];
    vec2s c = o->mesh->uvs[o->mesh->indices[3 * triangle + 2]];
    return ((double)b.x - (double)a.x) * ((double)c.y - (double)a.y) -
           ((double)b.y - (double)a.y) * ((double)c.x - (double)a.x);
}

/* dP/du of the linear map from UV to space. */
static vec3d tangent_of(const struct oracle *o, size_t triangle)
{
    const uint32_t *v = &o->mesh->indices[3 * triangle];
    vec3d d1 = vec3d_sub(vec3d_from(o->positions[v[1]]), vec3d_from(o->positions[v[0]]));
    vec3d d2 = vec3d_sub(vec3d_from(o->positions[v[2]]), vec3d_from(o->positions[v[0]]));
    double t21 = (double)o->mesh->uvs[v[1]].y - (double)o->mesh->uvs[v[0]].y;
    double t31 = (double)o->mesh->uvs[v[2]].y - (double)o->mesh->uvs[v[0]].y;
    return vec3d_scale(vec3d_sub(vec3d_scale(d1, t31), vec3d_scale(d2, t21)), 1 / uv_area(o, triangle));
}

static bool same_mikk(const struct oracle *o, size_t a, size_t b)
{
    uint32_t va = corner_vertex(o, a), vb = corner_vertex(o, b);
    return o->weld[va] == o->weld[vb] && o->mesh->uvs[va].x == o->mesh->uvs[vb].x &&
           o->mesh->uvs[va].y == o->mesh->uvs[vb].y;
}

/* Marks all corners that the one at `corner` reaches around its vertex. */
static void walk(const struct oracle *o, size_t corner, bool *reached)
{
    reached[corner] = true;
    for (size_t other = 0; other < o->mesh->index_count; other++) {
        if (reached[other] || !same_mikk(o, corner, other) ||
            (uv_area(o, corner / 3) > 0) != (uv_area(o, other / 3) > 0))
            continue;
        bool shares =
            same_mikk(o, turn(corner, 1), turn(other, 2)) || same_mikk(o, turn(corner, 2), turn(other, 1));
        if (shares)
            walk(o, other, reached);
    }
}

static vec3d oracle_tangent(const struct oracle *o, size_t corner)
{
    bool *reached = TL_NEW_ARRAY(bool, o->mesh->index_count);
    walk(o, corner, reached);
    vec3d normal = oracle_normal(o, corner_vertex(o, corner)), sum = {0};
    for (size_t c = 0; c < o->mesh->index_count; c++) {
        if (!reached[c])
            continue;
        vec3d next = vec3d_sub(corner_place(o, turn(c, 1)), corner_place(o, c));
        vec3d last = vec3d_sub(corner_place(o, turn(c, 2)), corner_place(o, c));
        next = vec3d_muladd(next, normal, -vec3d_dot(next, normal));
        last = vec3d_muladd(last, normal, -vec3d_dot(last, normal));
        vec3d t = tangent_of(o, c / 3);
        t = vec3d_unit_or(vec3d_muladd(t, normal, -vec3d_dot(t, normal)), (vec3d){0});
        sum = vec3d_muladd(sum, t, angle_between(next, last));
    }
    free(reached);
    return vec3d_unit_or(sum, (vec3d){0});
}

/* ---- Meshes ---- */

static double noise(uint32_t i, uint32_t channel)
{
    uint32_t x = i * 2654435761u ^ (channel + 1) * 2246822519u;
    x = (x ^ (x >> 15)) * 2246822519u;
    x ^= x >> 13;
    return (double)x / 2147483648.0 - 1;
}

/* A sheet whose right half mirrors the UVs of its left half about the middle column, and that is cut at a
 * quarter: UVs jump there while places do not. */
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

static void deform(const tl_mesh *mesh, const uint32_t *weld, uint32_t seed, vec3s *out)
{
    for (size_t i = 0; i < mesh->vertex_count; i++)
        for (uint32_t k = 0; k < 3; k++)
            out[i].raw[k] = mesh->positions[i].raw[k] + (float)(0.03 * noise(weld[i] + 1000 * seed, k));
}

static double degrees_between(vec3d a, vec3d b)
{
    return angle_between(a, b) * 180 / M_PI;
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

/* A vertex on the mirror line is a corner of two groups, of which it shows one: its tangent must be that of
 * one of its corners; all others have one group, and agree with every corner. */
static void test_against_oracle(void **state)
{
    (void)state;
    tl_garment garment = mirrored_and_cut();
    const tl_mesh *mesh = &garment.model.mesh;
    struct buffers b = make_buffers(mesh);
    tl_frames *frames = tl_frames_create(mesh, b.weld);
    double worst_normal = 0, worst_tangent = 0;
    for (uint32_t seed = 0; seed < 5; seed++) {
        deform(mesh, b.weld, seed, b.positions);
        tl_frames_update(frames, b.positions, b.normals, b.tangents);
        assert_orthonormal(&b, mesh->vertex_count);
        const struct oracle oracle = {mesh, b.positions, b.weld};
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            double best = 180, worst = 0;
            for (size_t c = 0; c < mesh->index_count; c++) {
                if (mesh->indices[c] != v)
                    continue;
                double off = degrees_between(oracle_tangent(&oracle, c), tangent_at(&b, v));
                bool right_hand = uv_area(&oracle, c / 3) < 0; /* v runs down */
                if ((b.tangents[v].w > 0) == right_hand)
                    best = fmin(best, off);
                worst = fmax(worst, off);
            }
            bool on_mirror = v < 13 * 9 && v % 13 == 6;
            worst_tangent = fmax(worst_tangent, on_mirror ? best : worst);
            worst_normal =
                fmax(worst_normal, degrees_between(oracle_normal(&oracle, v), vec3d_from(b.normals[v])));
        }
    }
    printf("worst normal %.4f deg, worst tangent %.4f deg\n", worst_normal, worst_tangent);
    assert_true(worst_normal <= 0.05);
    assert_true(worst_tangent <= 0.05);
    tl_frames_destroy(&frames);
    free_buffers(&b);
    sheet_free(&garment);
}

#define TURN 0.9 /* radians of a cylinder that a sheet of 1 m is rolled to */
static vec3s roll(double u, double v)
{
    double radius = 1 / TURN, angle = (u - 0.5) * TURN;
    return (vec3s){{(float)(radius * sin(angle)), (float)v, (float)(radius * cos(angle))}};
}

/* A sheet rolled about y: normals are radial, tangents follow the circle, the bitangent is up, v runs down.
 * Inner vertices of a regular grid see the cylinder alike on both sides but for the diagonal: within the
 * angle of one cell. */
static void test_cylinder(void **state)
{
    (void)state;
    const struct sheet_shape shape = {64, 16, 1, 0.25};
    tl_garment garment = sheet_make(&shape, roll);
    const tl_mesh *mesh = &garment.model.mesh;
    struct buffers b = make_buffers(mesh);
    tl_frames *frames = tl_frames_create(mesh, b.weld);
    tl_frames_update(frames, b.positions, b.normals, b.tangents);
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
    tl_frames_destroy(&frames);
    free_buffers(&b);
    sheet_free(&garment);
}

/* Collapsed triangles, UVs of one point, vertices that nothing uses, a sheet crumpled into a point. */
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
    struct buffers b = make_buffers(mesh);
    tl_frames *frames = tl_frames_create(mesh, b.weld);
    tl_frames_update(frames, b.positions, b.normals, b.tangents);
    assert_orthonormal(&b, mesh->vertex_count);
    assert_near(b.normals[48].y, 1, 0); /* unused: +Y */
    memset(b.positions, 0, mesh->vertex_count * sizeof(vec3s));
    tl_frames_update(frames, b.positions, b.normals, b.tangents);
    assert_orthonormal(&b, mesh->vertex_count);
    assert_near(b.normals[24].z, 1, 1e-6); /* kept from before */
    tl_frames_destroy(&frames);
    free_buffers(&b);
    sheet_free(&garment);
}

/* A sheet drawn from both sides with vertices of their own: each side has its own normal. */
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
    tl_frames *frames = tl_frames_create(&mesh, b.weld);
    tl_frames_update(frames, b.positions, b.normals, b.tangents);
    for (int i = 0; i < 6; i++) {
        assert_near(b.normals[i].z, i < 3 ? 1 : -1, 1e-6);
        assert_near(b.tangents[i].x, 1, 1e-6);
        assert_near(b.tangents[i].w, i < 3 ? 1 : -1, 0);
    }
    tl_frames_destroy(&frames);
    free_buffers(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_oracle),
        cmocka_unit_test(test_cylinder),
        cmocka_unit_test(test_degenerate_input_stays_finite),
        cmocka_unit_test(test_both_sides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
