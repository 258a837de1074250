#include "assets/body/form.h"

#include "assets/base/version.h"
#include "config/base/memory.h"
#include "config/cache/cache.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The form is one closed loft from the underside of the base plate to the tip of the finial: rings of COLUMNS
 * points, from the back over -X and the front to +X, grouped into bands. Normals are smooth within a band;
 * neighbouring bands repeat their common ring, so the surface is closed once welded by position. */
enum { COLUMNS = 64, HALF = COLUMNS / 2, RING_VERTICES = COLUMNS + 1, MAX_RINGS = 192, MAX_BANDS = 16 };
enum form_material { CANVAS, WOOD, IRON, FORM_MATERIALS };

struct ring {
    double x[RING_VERTICES], z[RING_VERTICES], y;
};

struct band {
    int first_ring, ring_count;
    enum form_material material;
    bool flat; /* a horizontal face: UVs are (x, z) rather than (around, along) */
};

struct loft {
    struct ring rings[MAX_RINGS];
    int ring_count;
    struct band bands[MAX_BANDS];
    int band_count;
};

struct profile_point {
    double y, radius;
};

/* The profiles of the turned parts, from below: smooth curves through their points. */
static const struct profile_point plate_rim[] = {
    {0.000, 0.150}, {0.003, 0.154}, {0.009, 0.154}, {0.013, 0.149}};
static const struct profile_point plate_top[] = {{0.013, 0.149}, {0.019, 0.110}, {0.027, 0.070},
                                                 {0.040, 0.042}, {0.056, 0.030}, {0.070, 0.0265}};
static const struct profile_point pole[] = {
    {0.070, 0.0190}, {0.085, 0.0235}, {0.105, 0.0215}, {0.150, 0.0165}, {0.300, 0.0150}, {0.430, 0.0165},
    {0.458, 0.0190}, {0.472, 0.0255}, {0.487, 0.0285}, {0.502, 0.0255}, {0.516, 0.0190}, {0.540, 0.0160},
    {0.620, 0.0160}, {0.655, 0.0190}, {0.672, 0.0270}, {0.686, 0.0310}, {0.7003, 0.0310}};
static const struct profile_point neck_cap[] = {
    {1.4697, 0.0620}, {1.4735, 0.0650}, {1.4800, 0.0650}, {1.4840, 0.0610}, {1.4880, 0.0420},
    {1.4920, 0.0200}, {1.5000, 0.0115}, {1.5100, 0.0110}, {1.5220, 0.0180}, {1.5380, 0.0255},
    {1.5550, 0.0265}, {1.5720, 0.0215}, {1.5870, 0.0120}, {1.5960, 0.0065}, {1.6000, 0.0000}};

#define NECK_CAP_Z 0.004 /* the neck leans forward */

/* Heights of the torso's rings: denser where the surface turns over, at the hem and on the shoulders. */
struct ring_span {
    double end;
    int rings;
};
static const struct ring_span torso_spans[] = {
    {0.7003, 1}, {0.7120, 4}, {0.7240, 2}, {1.2440, 28}, {1.3340, 9}, {1.4400, 16}, {1.4640, 3}, {1.4697, 3},
};

/* Mirrors the half that was filled (columns 0 to HALF), and puts its ends exactly into the mirror plane. */
static struct ring mirrored(struct ring ring)
{
    ring.x[0] = ring.x[HALF] = 0;
    for (int j = 0; j <= HALF; j++) {
        ring.x[COLUMNS - j] = -ring.x[j];
        ring.z[COLUMNS - j] = ring.z[j];
    }
    return ring;
}

static struct ring circle(double y, double radius, double centre_z)
{
    struct ring ring = {.y = y};
    for (int j = 0; j <= HALF; j++) {
        double angle = M_PI * j / HALF;
        ring.x[j] = -radius * sin(angle);
        ring.z[j] = centre_z - radius * cos(angle);
    }
    return mirrored(ring);
}

/* The torso's section at height y, its columns at equal arc lengths. */
static struct ring section(double y)
{
    enum { SAMPLES = 180 };
    double length[SAMPLES + 1] = {0}, x = 0, z = 0;
    for (int i = 0; i <= SAMPLES; i++) {
        double angle = M_PI * i / SAMPLES, r = tl_form_radius(y, angle);
        double next_x = -r * sin(angle), next_z = -r * cos(angle);
        if (i > 0)
            length[i] = length[i - 1] + hypot(next_x - x, next_z - z);
        x = next_x;
        z = next_z;
    }
    struct ring ring = {.y = y};
    for (int j = 0, i = 0; j <= HALF; j++) {
        double wanted = length[SAMPLES] * j / HALF;
        while (i < SAMPLES - 1 && length[i + 1] < wanted)
            i++;
        double angle = M_PI * (i + (wanted - length[i]) / (length[i + 1] - length[i])) / SAMPLES;
        double r = tl_form_radius(y, angle);
        ring.x[j] = -r * sin(angle);
        ring.z[j] = -r * cos(angle);
    }
    return mirrored(ring);
}

static struct ring between(const struct ring *a, const struct ring *b, double t)
{
    struct ring ring = {.y = a->y + (b->y - a->y) * t};
    for (int j = 0; j <= HALF; j++) {
        ring.x[j] = a->x[j] + (b->x[j] - a->x[j]) * t;
        ring.z[j] = a->z[j] + (b->z[j] - a->z[j]) * t;
    }
    return mirrored(ring);
}

static void add_ring(struct loft *loft, const struct ring *ring)
{
    assert(loft->ring_count < MAX_RINGS && loft->band_count > 0);
    loft->bands[loft->band_count - 1].ring_count++;
    loft->rings[loft->ring_count++] = *ring;
}

/* Bands meet in a crease: the new one repeats the last ring, so that normals are not smoothed across it. */
static void begin_band(struct loft *loft, enum form_material material, bool flat)
{
    assert(loft->band_count < MAX_BANDS);
    int first = loft->ring_count;
    loft->bands[loft->band_count++] = (struct band){.first_ring = first, .material = material, .flat = flat};
    if (first > 0)
        add_ring(loft, &loft->rings[first - 1]);
}

/* A flat face from the last ring to `target`, in steps so that it has no long triangles. */
static void add_face(struct loft *loft, enum form_material material, const struct ring *target, int steps)
{
    begin_band(loft, material, true);
    struct ring from = loft->rings[loft->ring_count - 1];
    for (int s = 1; s < steps; s++) {
        struct ring step = between(&from, target, (double)s / steps);
        add_ring(loft, &step);
    }
    add_ring(loft, target);
}

/* Catmull-Rom through the profile, `steps` rings from point to point; begins at the last ring when it is the
 * profile's first point. */
static void add_turned(struct loft *loft, const struct profile_point *profile, int count, int steps,
                       double centre_z)
{
    for (int i = 0; i + 1 < count; i++) {
        const struct profile_point *p = &profile[i > 0 ? i - 1 : 0], *a = &profile[i], *b = &profile[i + 1];
        const struct profile_point *q = &profile[i + 2 < count ? i + 2 : i + 1];
        for (int s = 1; s <= steps; s++) {
            double t = (double)s / steps, t2 = t * t, t3 = t2 * t;
            double wp = 0.5 * (2 * t2 - t3 - t), wa = 0.5 * (3 * t3 - 5 * t2 + 2);
            double wb = 0.5 * (4 * t2 - 3 * t3 + t), wq = 0.5 * (t3 - t2);
            struct ring ring =
                circle(wp * p->y + wa * a->y + wb * b->y + wq * q->y,
                       wp * p->radius + wa * a->radius + wb * b->radius + wq * q->radius, centre_z);
            add_ring(loft, &ring);
        }
    }
}

static void add_torso(struct loft *loft)
{
    begin_band(loft, CANVAS, false);
    double y = torso_spans[0].end;
    for (size_t i = 1; i < TL_COUNT(torso_spans); i++) {
        double step = (torso_spans[i].end - y) / torso_spans[i].rings;
        for (int k = 1; k <= torso_spans[i].rings; k++) {
            struct ring ring = section(y + step * k);
            add_ring(loft, &ring);
        }
        y = torso_spans[i].end;
    }
}

static void build_loft(struct loft *loft)
{
    struct ring ring = circle(0, 0, 0);
    begin_band(loft, IRON, true);
    add_ring(loft, &ring);
    ring = circle(0, plate_rim[0].radius, 0);
    add_ring(loft, &ring);
    begin_band(loft, IRON, false);
    add_turned(loft, plate_rim, TL_COUNT(plate_rim), 1, 0);
    begin_band(loft, IRON, false);
    add_turned(loft, plate_top, TL_COUNT(plate_top), 2, 0);
    ring = circle(pole[0].y, pole[0].radius, 0);
    add_face(loft, IRON, &ring, 1);
    begin_band(loft, WOOD, false);
    add_turned(loft, pole, TL_COUNT(pole), 2, 0);
    ring = section(torso_spans[0].end);
    add_face(loft, WOOD, &ring, 5);
    add_torso(loft);
    ring = circle(neck_cap[0].y, neck_cap[0].radius, NECK_CAP_Z);
    add_face(loft, WOOD, &ring, 1);
    begin_band(loft, WOOD, false);
    add_turned(loft, neck_cap, TL_COUNT(neck_cap), 2, NECK_CAP_Z);
}

static bool is_pinched(const struct ring *ring)
{
    return fabs(ring->x[HALF / 2]) < 1e-9;
}

static double column_step(const struct ring *a, const struct ring *b, int j, int k)
{
    return hypot(hypot(b->x[k] - a->x[j], b->z[k] - a->z[j]), b->y - a->y);
}

/* Unrolled: u along the tape from the front centre, v down from the band's first ring along the front. */
static void fill_uvs(const struct loft *loft, const struct band *band, vec2s *uvs)
{
    double along = 0;
    for (int i = 0; i < band->ring_count; i++) {
        const struct ring *ring = &loft->rings[band->first_ring + i];
        double around = 0;
        if (i > 0)
            along += column_step(ring - 1, ring, HALF, HALF);
        for (int j = 0; j < COLUMNS; j++)
            around += column_step(ring, ring, j, j + 1);
        for (int j = 0; j <= COLUMNS; j++) {
            double u = ((double)j / COLUMNS - 0.5) * around;
            uvs[i * RING_VERTICES + j] = band->flat ? (vec2s){{(float)ring->x[j], (float)ring->z[j]}}
                                                    : (vec2s){{(float)u, (float)-along}};
        }
    }
}

/* Two triangles a quad, one where a ring is pinched to a point; the diagonals mirror. */
static size_t fill_indices(const struct loft *loft, const struct band *band, uint32_t base, uint32_t *indices)
{
    size_t count = 0;
    for (int i = 0; i + 1 < band->ring_count; i++) {
        const struct ring *lower = &loft->rings[band->first_ring + i];
        for (int j = 0; j < COLUMNS; j++) {
            uint32_t a = base + (uint32_t)(i * RING_VERTICES + j), b = a + 1;
            uint32_t c = b + RING_VERTICES, d = a + RING_VERTICES;
            bool mirror = j >= HALF;
            const uint32_t first[3] = {a, b, mirror ? d : c}, second[3] = {mirror ? b : a, c, d};
            const uint32_t whole_lower[3] = {a, c, d}, whole_upper[3] = {a, b, d};
            if (is_pinched(lower)) {
                memcpy(indices + count, whole_lower, sizeof whole_lower);
                count += 3;
            } else if (is_pinched(lower + 1)) {
                memcpy(indices + count, whole_upper, sizeof whole_upper);
                count += 3;
            } else {
                memcpy(indices + count, first, sizeof first);
                memcpy(indices + count + 3, second, sizeof second);
                count += 6;
            }
        }
    }
    return count;
}

static void sum_range(vec3s *normals, size_t count)
{
    vec3s sum = glms_vec3_zero();
    for (size_t i = 0; i < count; i++)
        sum = glms_vec3_add(sum, normals[i]);
    for (size_t i = 0; i < count; i++)
        normals[i] = sum;
}

/* Area-weighted within the band; the back seam's two columns, and a pinched ring's points, share theirs. */
static void fill_normals(const struct loft *loft, const struct band *band, const struct tl_mesh_part *part,
                         uint32_t base, tl_mesh *mesh)
{
    for (uint32_t t = 0; t < part->index_count; t += 3) {
        const uint32_t *v = &mesh->indices[part->first_index + t];
        vec3s side = glms_vec3_sub(mesh->positions[v[1]], mesh->positions[v[0]]);
        vec3s other = glms_vec3_sub(mesh->positions[v[2]], mesh->positions[v[0]]);
        vec3s area = glms_vec3_cross(side, other);
        for (int k = 0; k < 3; k++)
            mesh->normals[v[k]] = glms_vec3_add(mesh->normals[v[k]], area);
    }
    for (int i = 0; i < band->ring_count; i++) {
        vec3s *row = &mesh->normals[base + (uint32_t)(i * RING_VERTICES)];
        if (is_pinched(&loft->rings[band->first_ring + i]))
            sum_range(row, RING_VERTICES);
        row[0] = row[COLUMNS] = glms_vec3_add(row[0], row[COLUMNS]);
        for (int j = 0; j <= COLUMNS; j++)
            row[j] = glms_vec3_normalize(row[j]);
    }
}

static tl_mesh mesh_of(const struct loft *loft)
{
    size_t rings = (size_t)loft->ring_count, bands = (size_t)loft->band_count;
    tl_mesh mesh = {.vertex_count = rings * RING_VERTICES, .part_count = bands};
    mesh.positions = TL_NEW_ARRAY(vec3s, mesh.vertex_count);
    mesh.normals = TL_NEW_ARRAY(vec3s, mesh.vertex_count);
    mesh.uvs = TL_NEW_ARRAY(vec2s, mesh.vertex_count);
    mesh.indices = TL_NEW_ARRAY(uint32_t, rings * COLUMNS * 6);
    mesh.parts = TL_NEW_ARRAY(struct tl_mesh_part, bands);
    for (size_t i = 0; i < rings; i++) {
        const struct ring *ring = &loft->rings[i];
        for (size_t j = 0; j < RING_VERTICES; j++)
            mesh.positions[i * RING_VERTICES + j] =
                (vec3s){{(float)ring->x[j], (float)ring->y, (float)ring->z[j]}};
    }
    for (size_t b = 0; b < bands; b++) {
        const struct band *band = &loft->bands[b];
        uint32_t base = (uint32_t)(band->first_ring * RING_VERTICES);
        fill_uvs(loft, band, mesh.uvs + base);
        size_t count = fill_indices(loft, band, base, mesh.indices + mesh.index_count);
        mesh.parts[b] = (struct tl_mesh_part){.first_index = (uint32_t)mesh.index_count,
                                              .index_count = (uint32_t)count,
                                              .material = (int)band->material};
        fill_normals(loft, band, &mesh.parts[b], base, &mesh);
        mesh.index_count += count;
    }
    tl_mesh_measure_uvs(&mesh);
    return mesh;
}

tl_material tl_form_canvas(void)
{
    tl_material canvas = tl_material_default("canvas");
    canvas.diffuse = (vec3s){{0.62f, 0.54f, 0.43f}};
    canvas.specular = (vec3s){{0.02f, 0.02f, 0.02f}};
    return canvas;
}

static tl_material *form_materials(void)
{
    tl_material *materials = TL_NEW_ARRAY(tl_material, FORM_MATERIALS);
    materials[CANVAS] = tl_form_canvas();
    materials[WOOD] = tl_material_default("wood");
    materials[WOOD].diffuse = (vec3s){{0.115f, 0.055f, 0.027f}};
    materials[WOOD].glossiness = 0.96f;
    materials[IRON] = tl_material_default("iron");
    materials[IRON].diffuse = (vec3s){{0.020f, 0.020f, 0.022f}};
    materials[IRON].specular = (vec3s){{0.16f, 0.16f, 0.16f}};
    materials[IRON].glossiness = 0.93f;
    return materials;
}

tl_avatar tl_avatar_form(void)
{
    struct loft *loft = TL_NEW(struct loft);
    struct tl_cache_key key = tl_cache_key_begin();
    tl_cache_key_add(&key, TL_BUILTIN_VERSION, sizeof TL_BUILTIN_VERSION);
    tl_cache_key_add(&key, "form", strlen("form"));
    if (!tl_cache_read(&key, loft, sizeof *loft)) {
        build_loft(loft);
        tl_cache_store(&key, loft, sizeof *loft);
    }
    tl_avatar avatar = {.model = {.name = tl_copy_string("form"),
                                  .mesh = mesh_of(loft),
                                  .material_count = FORM_MATERIALS,
                                  .materials = form_materials()}};
    free(loft);
    return avatar;
}
