#include "assets/specimen/specimen.h"

#include "assets/sewing/panel.h"
#include "assets/specimen/cusick.h"
#include "config/base/memory.h"

#include <math.h>
#include <string.h>

const char *const tl_specimen_names[] = {"sheet", "disc", "sphere", "torus", "plate", NULL};

#define SHEET_SIDE_M    0.5
#define SHEET_HEIGHT_M  0.44f
#define BALL_RADIUS_M   0.12f
#define BALL_HEIGHT_M   0.30f
#define SPHERE_RADIUS_M 0.15f
#define TORUS_RING_M    0.12f /* of the circle in its middle */
#define TORUS_TUBE_M    0.055f
#define SOLID_HEIGHT_M  0.20f
#define TORUS_TILT      1.05f /* rad: its axis, from upright towards the viewer */
#define PLATE_RADIUS_M  0.15f

static tl_material *plain_material(const char *name)
{
    tl_material *material = TL_NEW(tl_material);
    *material = tl_material_default(name);
    material->diffuse = (vec3s){{0.8f, 0.8f, 0.8f}};
    material->double_sided = true;
    return material;
}

static tl_model model_of(const char *name, tl_mesh mesh)
{
    mesh.part_count = 1;
    mesh.parts = TL_NEW(struct tl_mesh_part);
    mesh.parts[0].index_count = (uint32_t)mesh.index_count;
    tl_mesh_measure_uvs(&mesh);
    return (tl_model){
        .name = tl_copy_string(name), .mesh = mesh, .material_count = 1, .materials = plain_material(name)};
}

static tl_mesh new_mesh(size_t vertex_count, size_t index_count)
{
    return (tl_mesh){.vertex_count = vertex_count,
                     .positions = TL_NEW_ARRAY(vec3s, vertex_count),
                     .normals = TL_NEW_ARRAY(vec3s, vertex_count),
                     .uvs = TL_NEW_ARRAY(vec2s, vertex_count),
                     .index_count = index_count,
                     .indices = TL_NEW_ARRAY(uint32_t, index_count)};
}

/* A surface of revolution about +Y: a point at turn (u) and along the profile (v), both in [0, 1]. */
struct profile {
    float ring, tube; /* radii, metres; a sphere has no ring */
    float from, to;   /* rad: angles along the tube that v runs through, from the top outwards */
    vec3s centre;
    float tilt;
    bool flat; /* a level plate of radius `tube` instead: v runs from its middle to its rim */
};

static vec3s tilted(vec3s p, float angle)
{
    float c = cosf(angle), s = sinf(angle);
    return (vec3s){{p.x, c * p.y - s * p.z, s * p.y + c * p.z}};
}

/* The two sides of the seam, at the back, have bitwise equal positions, so that normals are smooth across it.
 */
static void place_vertex(tl_mesh *mesh, size_t index, const struct profile *profile, float u, float v)
{
    bool closed = profile->ring > 0;
    float turn = 2 * (float)M_PI * (u < 1 ? u : 0), span = profile->to - profile->from;
    float along = profile->from + span * (v < 1 || !closed ? v : 0);
    vec3s outwards = {{-sinf(turn), 0, -cosf(turn)}};
    vec3s normal = glms_vec3_scale(outwards, sinf(along));
    normal.y = cosf(along);
    vec3s place =
        glms_vec3_add(glms_vec3_scale(outwards, profile->ring), glms_vec3_scale(normal, profile->tube));
    if (profile->flat) {
        normal = (vec3s){{0, 1, 0}};
        place = glms_vec3_scale(outwards, profile->tube * v);
    }
    mesh->normals[index] = tilted(normal, profile->tilt);
    mesh->positions[index] = glms_vec3_add(profile->centre, tilted(place, profile->tilt));
    float girth = 2 * (float)M_PI * (profile->ring + profile->tube);
    mesh->uvs[index] = (vec2s){{girth * u, profile->tube * span * v}};
}

/* A pole is a single point: the triangles without area there are left out. */
static tl_mesh revolve(const struct profile *profile, float edge_m)
{
    float girth = 2 * (float)M_PI * (profile->ring + profile->tube);
    float length = (profile->to - profile->from) * profile->tube;
    size_t around = (size_t)fmaxf(girth / edge_m, 6), along = (size_t)fmaxf(length / edge_m, 4);
    bool poles = profile->ring <= 0;
    tl_mesh mesh = new_mesh((around + 1) * (along + 1), 6 * around * along);
    mesh.index_count = 0;
    for (size_t j = 0; j <= along; j++)
        for (size_t i = 0; i <= around; i++)
            place_vertex(&mesh, j * (around + 1) + i, profile, (float)i / (float)around,
                         (float)j / (float)along);
    for (size_t j = 0; j < along; j++)
        for (size_t i = 0; i < around; i++) {
            uint32_t a = (uint32_t)(j * (around + 1) + i), b = a + 1, c = a + (uint32_t)around + 1, d = c + 1;
            const uint32_t upper[3] = {a, d, b}, lower[3] = {a, c, d};
            if (!(poles && j == 0)) {
                memcpy(&mesh.indices[mesh.index_count], upper, sizeof upper);
                mesh.index_count += 3;
            }
            if (!(poles && !profile->flat && j == along - 1)) {
                memcpy(&mesh.indices[mesh.index_count], lower, sizeof lower);
                mesh.index_count += 3;
            }
        }
    return mesh;
}

static const struct profile sphere_profile = {
    .tube = SPHERE_RADIUS_M, .to = (float)M_PI, .centre = {{0, SOLID_HEIGHT_M, 0}}};
static const struct profile ball_profile = {
    .tube = BALL_RADIUS_M, .to = (float)M_PI, .centre = {{0, BALL_HEIGHT_M, 0}}};
static const struct profile torus_profile = {.ring = TORUS_RING_M,
                                             .tube = TORUS_TUBE_M,
                                             .to = 2 * (float)M_PI,
                                             .centre = {{0, SOLID_HEIGHT_M, 0}},
                                             .tilt = TORUS_TILT};

static const struct profile plate_profile = {
    .tube = PLATE_RADIUS_M, .to = 1, .centre = {{0, SOLID_HEIGHT_M, 0}}, .tilt = TORUS_TILT, .flat = true};

/* Level cloth, its warp away from the viewer. */
static tl_garment cut_level(const char *name, const struct tl_curve *outline, float edge_m, float height_m)
{
    tl_panel_mesh panel = tl_panel_cut(outline, 4, (double)edge_m);
    tl_mesh mesh = new_mesh(panel.point_count, 3 * panel.triangle_count);
    vec2s *pattern = TL_NEW_ARRAY(vec2s, panel.point_count);
    for (size_t i = 0; i < panel.point_count; i++) {
        float x = (float)panel.points[i].x, y = (float)panel.points[i].y;
        pattern[i] = (vec2s){{x, y}};
        mesh.positions[i] = (vec3s){{x, height_m, -y}};
        mesh.normals[i] = (vec3s){{0, 1, 0}};
        mesh.uvs[i] = (vec2s){{x, -y}};
    }
    memcpy(mesh.indices, panel.triangles, mesh.index_count * sizeof *mesh.indices);
    tl_panel_release(&panel);
    return (tl_garment){.model = model_of(name, mesh), .pattern = pattern};
}

static tl_garment cut_sheet(float edge_m)
{
    const struct tl_point corners[4] = {{-SHEET_SIDE_M / 2, -SHEET_SIDE_M / 2},
                                        {SHEET_SIDE_M / 2, -SHEET_SIDE_M / 2},
                                        {SHEET_SIDE_M / 2, SHEET_SIDE_M / 2},
                                        {-SHEET_SIDE_M / 2, SHEET_SIDE_M / 2}};
    struct tl_curve outline[4];
    for (int i = 0; i < 4; i++) {
        outline[i] = tl_curve_line(corners[i], corners[(i + 1) % 4]);
        outline[i].segments = (int)fmax(SHEET_SIDE_M / (double)edge_m + 0.5, 1);
    }
    return cut_level("sheet", outline, edge_m, SHEET_HEIGHT_M);
}

/* A cubic curve approximates a quarter circle to 0.03 %. */
static tl_garment cut_disc(float edge_m)
{
    const double handle = 4 * (M_SQRT2 - 1) / 3 * TL_CUSICK_DISC_M;
    struct tl_curve outline[4];
    for (int i = 0; i < 4; i++) {
        double c = round(cos(M_PI / 2 * i)), s = round(sin(M_PI / 2 * i));
        const struct tl_point from = {TL_CUSICK_DISC_M * c, TL_CUSICK_DISC_M * s};
        const struct tl_point to = {-TL_CUSICK_DISC_M * s, TL_CUSICK_DISC_M * c};
        outline[i] =
            (struct tl_curve){.control = {from,
                                          {from.x - handle * s, from.y + handle * c},
                                          {to.x + handle * c, to.y + handle * s},
                                          to},
                              .segments = (int)fmax(M_PI / 2 * TL_CUSICK_DISC_M / (double)edge_m + 0.5, 1)};
    }
    tl_garment disc = cut_level("disc", outline, edge_m, (float)TL_CUSICK_HEIGHT_M);
    size_t count = disc.model.mesh.vertex_count;
    disc.pins = TL_NEW_ARRAY(uint32_t, count);
    for (uint32_t i = 0; i < count; i++)
        if (hypot((double)disc.pattern[i].x, (double)disc.pattern[i].y) <= TL_CUSICK_PLATE_M)
            disc.pins[disc.pin_count++] = i;
    return disc;
}

bool tl_specimen_make(const char *name, float edge_m, tl_garment *out)
{
    if (strcmp(name, "sheet") == 0)
        *out = cut_sheet(edge_m);
    else if (strcmp(name, "disc") == 0)
        *out = cut_disc(edge_m);
    else if (strcmp(name, "sphere") == 0)
        *out = (tl_garment){.model = model_of(name, revolve(&sphere_profile, edge_m)), .solid = true};
    else if (strcmp(name, "torus") == 0)
        *out = (tl_garment){.model = model_of(name, revolve(&torus_profile, edge_m)), .solid = true};
    else if (strcmp(name, "plate") == 0)
        *out = (tl_garment){.model = model_of(name, revolve(&plate_profile, edge_m)), .solid = true};
    else
        return false;
    return true;
}

tl_avatar tl_specimen_ball(void)
{
    return (tl_avatar){.model = model_of("ball", revolve(&ball_profile, 0.01f))};
}
