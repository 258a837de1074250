#include "tests/app/stability/extremes_light.h"

#include "assets/image/exr.h"
#include "config/base/memory.h"
#include "tests/app/stability/outcome.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The ordinary scene: a pleated curtain, 1 m square, that hangs over a floor in the built-in studio. */
#define CURTAIN_CELLS 40
#define PLEATS        3
#define PLEAT_M       0.08f

static vec3s curtain_point(float u, float v)
{
    float depth = PLEAT_M * (0.3f + 0.7f * v) * sinf(2 * (float)M_PI * PLEATS * u);
    return (vec3s){{u - 0.5f, 1 - 0.98f * v, depth}};
}

static vec3s floor_point(float u, float v)
{
    return (vec3s){{1.6f * (u - 0.5f), 0, v - 0.4f}};
}

/* Appends a grid; u to the right, v down (or towards the viewer), so that it faces +Z (or up). */
static void add_grid(tl_mesh *mesh, size_t columns, size_t rows, vec3s (*point)(float u, float v))
{
    size_t base = mesh->vertex_count, vertices = (columns + 1) * (rows + 1);
    mesh->positions = tl_resize(mesh->positions, base + vertices, sizeof *mesh->positions);
    mesh->uvs = tl_resize(mesh->uvs, base + vertices, sizeof *mesh->uvs);
    mesh->indices = tl_resize(mesh->indices, mesh->index_count + 6 * columns * rows, sizeof *mesh->indices);
    for (size_t row = 0; row <= rows; row++)
        for (size_t column = 0; column <= columns; column++) {
            float u = (float)column / (float)columns, v = (float)row / (float)rows;
            mesh->positions[mesh->vertex_count] = point(u, v);
            mesh->uvs[mesh->vertex_count++] = (vec2s){{u, v}};
        }
    for (size_t row = 0; row < rows; row++)
        for (size_t column = 0; column < columns; column++) {
            uint32_t corner = (uint32_t)(base + row * (columns + 1) + column),
                     below = (uint32_t)(columns + 1);
            const uint32_t quad[] = {corner,     corner + below,     corner + below + 1,
                                     corner + 0, corner + below + 1, corner + 1};
            memcpy(&mesh->indices[mesh->index_count], quad, sizeof quad);
            mesh->index_count += TL_COUNT(quad);
        }
}

/* Normals weighted by area; tangents along x, made square to them. */
static void make_frames(tl_mesh *mesh)
{
    free(mesh->normals);
    free(mesh->tangents);
    mesh->normals = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    mesh->tangents = TL_NEW_ARRAY(vec4s, mesh->vertex_count);
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        const uint32_t *corner = &mesh->indices[i];
        vec3s first = mesh->positions[corner[0]];
        vec3s cross = glms_vec3_cross(glms_vec3_sub(mesh->positions[corner[1]], first),
                                      glms_vec3_sub(mesh->positions[corner[2]], first));
        for (int c = 0; c < 3; c++)
            mesh->normals[corner[c]] = glms_vec3_add(mesh->normals[corner[c]], cross);
    }
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        vec3s normal = mesh->normals[v] = glms_vec3_normalize(mesh->normals[v]);
        const vec3s right = {{1, 0, 0}};
        vec3s along =
            glms_vec3_normalize(glms_vec3_sub(right, glms_vec3_scale(normal, glms_vec3_dot(right, normal))));
        mesh->tangents[v] = (vec4s){{along.x, along.y, along.z, -1}};
    }
}

static void fill_surface(struct tl_extreme_scene *scene)
{
    static uint64_t revision; /* unique for every scene, so that a renderer reuses nothing */
    tl_mesh *mesh = &scene->mesh;
    revision++;
    mesh->part_count = 1;
    mesh->parts = tl_resize(mesh->parts, 1, sizeof *mesh->parts);
    mesh->parts[0] = (struct tl_mesh_part){.index_count = (uint32_t)mesh->index_count, .uv_metres = 1};
    scene->surface = tl_surface_of_mesh("extreme", mesh, &scene->material);
    scene->surface.topology_revision = scene->surface.motion_revision = revision;
}

static tl_image copy_image(const tl_image *image)
{
    tl_image copy = tl_image_create(image->width, image->height, image->channels, image->type);
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    memcpy(tl_image_floats(&copy), tl_image_floats(image), count * sizeof(float));
    return copy;
}

/* The studio, which is computed once: its texels take longer than a picture of them. */
static tl_environment studio(void)
{
    static tl_environment made;
    if (!made.name)
        made = tl_environment_studio();
    tl_environment copy = made;
    copy.name = tl_copy_string(made.name);
    copy.image = copy_image(&made.image);
    copy.backdrop = copy_image(&made.backdrop);
    return copy;
}

static void make_ordinary(struct tl_extreme_scene *out)
{
    *out = (struct tl_extreme_scene){.environment = studio(),
                                     .material = tl_material_default("extreme"),
                                     .camera = {.eye = {{0.7f, 0.9f, 2.6f}},
                                                .target = {{0, 0.45f, 0}},
                                                .up = {{0, 1, 0}},
                                                .fov_y = glm_rad(30),
                                                .near_m = 0.02f,
                                                .far_m = 30}};
    out->material.diffuse = out->material.specular = (vec3s){{0.5f, 0.5f, 0.5f}};
    out->material.glossiness = 0.7f;
    out->material.double_sided = true;
    add_grid(&out->mesh, CURTAIN_CELLS, CURTAIN_CELLS, curtain_point);
    add_grid(&out->mesh, 8, 8, floor_point);
    make_frames(&out->mesh);
}

/* Lights. */

static tl_environment black_environment(int width, int height)
{
    tl_environment made = tl_environment_constant(0, 0, 0);
    tl_image_release(&made.image);
    made.layout = TL_ENV_LATLONG;
    made.image = tl_image_create(width, height, 3, TL_IMAGE_F32);
    return made;
}

/* One texel of `radiance` in a black map, at a place given by its share of the image. */
static void light_texel(struct tl_extreme_scene *scene, int width, int height, float u, float v,
                        float radiance)
{
    tl_environment_release(&scene->environment);
    scene->environment = black_environment(width, height);
    int x = (int)(u * (float)width), y = (int)(v * (float)height);
    float *texel = tl_image_floats(&scene->environment.image) + 3 * ((size_t)y * (size_t)width + (size_t)x);
    texel[0] = texel[1] = texel[2] = scene->environment.peak = radiance;
}

static void black(struct tl_extreme_scene *scene)
{
    tl_environment_release(&scene->environment);
    scene->environment = black_environment(64, 32);
}

static void texel_half(struct tl_extreme_scene *scene)
{
    light_texel(scene, 64, 32, 0.1f, 0.3f, 65504);
}

static void texel_million(struct tl_extreme_scene *scene)
{
    light_texel(scene, 64, 32, 0.1f, 0.3f, 1e6f);
}

static void one_texel_map(struct tl_extreme_scene *scene)
{
    light_texel(scene, 1, 1, 0, 0, 1);
}

static void large_map(struct tl_extreme_scene *scene)
{
    light_texel(scene, 8192, 4096, 0.1f, 0.3f, 1e6f);
    float *texels = tl_image_floats(&scene->environment.image);
    for (size_t i = 0; i < (size_t)8192 * 4096 * 3; i++)
        texels[i] = texels[i] > 0 ? texels[i] : 0.5f;
}

static void dirty_texels(struct tl_extreme_scene *scene)
{
    float *texels = tl_image_floats(&scene->environment.image);
    texels[3000] = NAN;
    texels[6001] = INFINITY;
    texels[9002] = -5;
}

/* A light at the texel that `direction` points to. */
static void light_from(struct tl_extreme_scene *scene, vec3s direction)
{
    vec3s d = glms_vec3_normalize(direction);
    float u = 0.5f + atan2f(d.x, -d.z) / (2 * (float)M_PI), v = acosf(d.y) / (float)M_PI;
    light_texel(scene, 128, 64, fminf(u, 0.999f), fminf(v, 0.999f), 1000);
}

static void light_behind_viewer(struct tl_extreme_scene *scene)
{
    light_from(scene, glms_vec3_sub(scene->camera.eye, scene->camera.target));
}

static void light_before_viewer(struct tl_extreme_scene *scene)
{
    vec3s view = glms_vec3_sub(scene->camera.target, scene->camera.eye);
    view.y = 0.2f; /* above the floor, which would hide it from everything */
    light_from(scene, view);
}

static void light_overhead(struct tl_extreme_scene *scene)
{
    light_from(scene, (vec3s){{0, 1, 0}});
}

static void light_in_floor(struct tl_extreme_scene *scene)
{
    light_from(scene, (vec3s){{1, 0.001f, 0.2f}});
}

/* Materials. */

static void matt(struct tl_extreme_scene *scene)
{
    scene->material.glossiness = 0;
}

static void s_200(struct tl_extreme_scene *scene)
{
    scene->material.glossiness = 0.995f;
}

static void s_million(struct tl_extreme_scene *scene)
{
    scene->material.glossiness = 1 - 1e-6f;
}

static void mirror(struct tl_extreme_scene *scene)
{
    scene->material.glossiness = 1;
}

/* Nothing but mirrors: light from a lamp by way of a mirror on matt cloth is noise in any reference. */
static void only_mirrors(struct tl_extreme_scene *scene)
{
    mirror(scene);
    scene->material.diffuse = glms_vec3_zero();
    scene->material.specular = (vec3s){{0.9f, 0.9f, 0.9f}};
}

static void black_material(struct tl_extreme_scene *scene)
{
    scene->material.diffuse = scene->material.specular = glms_vec3_zero();
}

/* Shapes. */

static void flat_sheet(struct tl_extreme_scene *scene)
{
    for (size_t v = 0; v < scene->mesh.vertex_count; v++)
        if (scene->mesh.positions[v].y > 0.01f)
            scene->mesh.positions[v].z = 0;
    make_frames(&scene->mesh);
}

/* The light lies in the sheet's plane. */
static void sheet_edge_on(struct tl_extreme_scene *scene)
{
    light_from(scene, (vec3s){{1, 0.7f, 0}});
    flat_sheet(scene);
}

static void grazing_view(struct tl_extreme_scene *scene)
{
    scene->camera.eye = (vec3s){{3, 0.012f, 0.02f}};
    scene->camera.target = (vec3s){{0, 0.01f, 0}};
    flat_sheet(scene);
}

static void scaled(struct tl_extreme_scene *scene, float factor)
{
    for (size_t v = 0; v < scene->mesh.vertex_count; v++)
        scene->mesh.positions[v] = glms_vec3_scale(scene->mesh.positions[v], factor);
    struct tl_camera *camera = &scene->camera;
    camera->eye = glms_vec3_scale(camera->eye, factor);
    camera->target = glms_vec3_scale(camera->target, factor);
    camera->near_m *= factor;
    camera->far_m *= factor;
}

static void one_millimetre(struct tl_extreme_scene *scene)
{
    scaled(scene, 0.001f);
}

static void hundred_metres(struct tl_extreme_scene *scene)
{
    scaled(scene, 100);
}

/* A floor a hundred times as large as the scene that shadow maps are fitted to without it. */
static void with_ground(struct tl_extreme_scene *scene)
{
    scene->ground = true;
    for (size_t v = 0; v < scene->mesh.vertex_count; v++)
        scene->mesh.positions[v].y += 0.05f; /* else the floor lies in the ground */
    scene->camera.eye = (vec3s){{0.7f, 3, 9}};
}

/* One triangle a kilometre away, seen past a curtain at arm's length with a near plane of a millimetre. */
static void depth_ratio(struct tl_extreme_scene *scene)
{
    static const float far_away[3][3] = {{-400, -400, -1000}, {400, -400, -1000}, {0, 600, -1000}};
    uint32_t base = (uint32_t)(scene->mesh.vertex_count - 3); /* the floor's last corners are taken for it */
    for (uint32_t c = 0; c < 3; c++)
        scene->mesh.positions[base + c] = (vec3s){{far_away[c][0], far_away[c][1], far_away[c][2]}};
    const uint32_t triangle[] = {base, base + 1, base + 2};
    memcpy(&scene->mesh.indices[scene->mesh.index_count - 3], triangle, sizeof triangle);
    make_frames(&scene->mesh);
    scene->camera.near_m = 1e-3f;
    scene->camera.far_m = 2e3f;
}

static void zero_normals(struct tl_extreme_scene *scene)
{
    for (size_t v = 0; v < scene->mesh.vertex_count; v += 7) {
        scene->mesh.normals[v] = glms_vec3_zero();
        scene->mesh.tangents[v] = glms_vec4_zero();
    }
}

static void degenerate_uvs(struct tl_extreme_scene *scene)
{
    for (size_t v = 0; v < scene->mesh.vertex_count; v++) {
        scene->mesh.uvs[v] = (vec2s){{0, 0}};
        scene->mesh.tangents[v] = glms_vec4_zero();
    }
}

/* Makes every ninth triangle a point and every eleventh a needle, and duplicates every thirteenth. */
static void degenerate_triangles(struct tl_extreme_scene *scene)
{
    tl_mesh *mesh = &scene->mesh;
    size_t triangles = mesh->index_count / 3;
    mesh->indices = tl_resize(mesh->indices, 2 * mesh->index_count, sizeof *mesh->indices);
    for (size_t t = 0; t < triangles; t++) {
        const uint32_t *corner = &mesh->indices[3 * t];
        uint32_t *more = &mesh->indices[mesh->index_count];
        if (t % 9 == 0)
            more[0] = more[1] = more[2] = corner[0];
        else if (t % 11 == 0)
            more[0] = corner[0], more[1] = more[2] = corner[1];
        else if (t % 13 == 0)
            memcpy(more, corner, 3 * sizeof *more);
        else
            continue;
        mesh->index_count += 3;
    }
}

static void one_triangle(struct tl_extreme_scene *scene)
{
    scene->mesh.index_count = 3;
    const vec3s corners[] = {{{-0.5f, 0, 0}}, {{0.5f, 0, 0}}, {{0, 1, 0}}};
    for (uint32_t c = 0; c < 3; c++) {
        scene->mesh.indices[c] = c;
        scene->mesh.positions[c] = corners[c];
    }
    make_frames(&scene->mesh);
}

static void million_triangles(struct tl_extreme_scene *scene)
{
    scene->mesh.vertex_count = scene->mesh.index_count = 0;
    add_grid(&scene->mesh, 708, 708, curtain_point);
    make_frames(&scene->mesh);
}

static void nothing(struct tl_extreme_scene *scene)
{
    scene->mesh.index_count = 0;
}

/* Cameras. */

static void camera_inside(struct tl_extreme_scene *scene)
{
    scene->camera.eye = scene->mesh.positions[20 * (CURTAIN_CELLS + 1) + 20];
    scene->camera.target = (vec3s){{0.4f, 0.2f, 0.3f}};
}

static void camera_at_origin(struct tl_extreme_scene *scene)
{
    scene->camera.eye = glms_vec3_zero();
    scene->camera.target = (vec3s){{0, 1, 0.2f}};
}

static void near_is_far(struct tl_extreme_scene *scene)
{
    scene->camera.far_m = scene->camera.near_m;
}

static void eye_is_target(struct tl_extreme_scene *scene)
{
    scene->camera.target = scene->camera.eye;
}

static void up_is_view(struct tl_extreme_scene *scene)
{
    scene->camera.up = glms_vec3_sub(scene->camera.target, scene->camera.eye);
}

/* Figures for 24 regions with blurred variance maps (16 to 25 %), and for rays moving (5.5 %) with a margin
 * for images of so few pixels. A sun: half of the pixels at its shadow's edge may be wrong. */
#define PAPER  TL_STATED_SHARE
#define REVIEW 0.08
#define SUN    0.12
/* The chain makes 0.51 to 3.14 times of one texel's light, by its place (LIGHT.md, finding 1). */
#define CHAIN    2.14
#define ORDINARY "what the methods are known for"
#define POINT                                                                                                \
    "a point of light: its shadow's edge is a map's texel, or a ray's grain, wide; the chain makes 0.51 to " \
    "3.14 times of it"
#define RAYS         "light.visibility=rays light.composition=ratio"
#define SEPARATE_SUN RAYS " light.sun=true"
#define MIRROR                                                                                               \
    "paper: what a mirror reflects of the scene is black [Knuth et al. 2014, 6]; review: the cache lights "  \
    "it"
#define BOUNCED "paper: nothing bounces; review: two bands of bounced light"

/* clang-format off: one extreme a line, or two. */
const struct tl_extreme tl_extremes[] = {
    {"ordinary scene", .bounds = {PAPER, REVIEW}, .why = ORDINARY},
    {"environment all black", .change = black, .bounds = {0, 0}, .why = "there is no light"},
    {"one texel of 65504", .change = texel_half, .bounds = {CHAIN, SUN}, .why = POINT,
     .remedies = {SEPARATE_SUN}},
    {"one texel of 1e6", .change = texel_million, .bounds = {CHAIN, SUN}, .why = POINT,
     .remedies = {SEPARATE_SUN}},
    {"map of 1 x 1 texel", .change = one_texel_map, .bounds = {PAPER, 0.10},
     .why = "light from below the floor too: more of it is hidden"},
    {"map of 8192 x 4096", .change = large_map, .bounds = {0.30, 0.10}, .slow = true,
     .why = "the same, with a point of light", .remedies = {"light.regions=96"}},
    {"NaN, Inf, negative texels", .change = dirty_texels, .bounds = {PAPER, REVIEW}, .from_file = true,
     .why = "cleaned by the reader; then as the ordinary scene"},
    {"light behind the viewer", .change = light_behind_viewer, .bounds = {CHAIN, SUN}, .why = POINT,
     .remedies = {SEPARATE_SUN}},
    {"light before the viewer", .change = light_before_viewer, .bounds = {CHAIN, SUN}, .why = POINT,
     .remedies = {SEPARATE_SUN}},
    {"light along the normal", .change = light_overhead, .bounds = {CHAIN, SUN}, .why = POINT,
     .remedies = {SEPARATE_SUN}},
    {"light in the floor's plane", .change = light_in_floor, .bounds = {CHAIN, SUN}, .why = POINT,
     .remedies = {SEPARATE_SUN}},
    {"sheet edge-on to the light", .change = sheet_edge_on, .bounds = {CHAIN, SUN}, .why = POINT,
     .remedies = {SEPARATE_SUN}},
    {"N = 6", .assignments = "light.regions=6", .bounds = {TL_NO_WORSE, 0.25},
     .why = "few shadows for all of the light", .remedies = {"light.regions=24"}},
    {"N = 384", .assignments = "light.regions=384", .bounds = {PAPER, REVIEW}, .why = ORDINARY},
    {"shadow maps of 8 texels", .assignments = "light.map_size=8", .bounds = {PAPER, REVIEW},
     .why = "a texel of 0.2 m; fewer texels are refused, rays need no maps"},
    {"shadow maps of 1 texel", .assignments = "light.map_size=1", .why = "it would shadow all behind it",
     .refused = true},
    {"shadow maps of 4096", .assignments = "light.map_size=4096 light.regions=6 light.blur_m=0", .slow = true,
     .bounds = {TL_NO_WORSE, 0.25}, .why = "as N = 6", .remedies = {"light.regions=24", "light.regions=24"}},
    {"g = 0", .change = matt, .bounds = {PAPER, REVIEW}, .why = ORDINARY},
    {"s = 200", .assignments = "reference.lobe_samples=64", .change = s_200, .bounds = {0.35, 0.15},
     .why = MIRROR, .remedies = {RAYS " light.reflect_scene=true"}},
    {"s = 1e6", .change = s_million, .bounds = {0.45, 0.20}, .why = MIRROR,
     .remedies = {RAYS " light.reflect_scene=true"}},
    {"g = 1", .change = mirror, .bounds = {0.45, 0.20}, .why = MIRROR,
     .remedies = {RAYS " light.reflect_scene=true"}},
    {"light between pleats", .assignments = "light.bounce=all reference.bounce_samples=64",
     .bounds = {0.45, 0.22}, .why = BOUNCED, .remedies = {RAYS, "light.method=reference"}},
    {"light between mirrors", .assignments = "light.bounce=all", .change = only_mirrors,
     .bounds = {1.6, 0.95},
     .why = "paper: what a mirror reflects of the scene is black; review: so is a mirror in a mirror",
     .remedies = {"light.method=reference", "light.method=reference"}},
    {"black material", .change = black_material, .bounds = {0, 0}, .why = "nothing is reflected"},
    {"grazing view", .change = grazing_view, .bounds = {TL_NO_WORSE, 0.12},
     .why = "a pixel spans many points of the floor", .remedies = {RAYS}},
    {"garment of 1 mm", .change = one_millimetre, .bounds = {PAPER, REVIEW},
     .why = "as the ordinary scene: bias and blur of maps follow its size"},
    {"garment of 100 m", .change = hundred_metres, .bounds = {PAPER, REVIEW},
     .why = "as the ordinary scene: maps are fitted to what there is"},
    {"receivers outside of the maps", .change = with_ground, .bounds = {PAPER, REVIEW}, .why = ORDINARY},
    {"depth ratio of 1e6", .change = depth_ratio, .bounds = {TL_NO_WORSE, TL_STATED_SHARE},
     .why = "maps fitted to a kilometre; a triangle of 800 m keeps three points",
     .remedies = {"light.method=reference"}},
    {"normals of length 0", .change = zero_normals, .bounds = {PAPER, REVIEW},
     .why = "as the ordinary scene: vertices that know no outside keep no light"},
    {"degenerate UVs", .change = degenerate_uvs, .bounds = {PAPER, REVIEW},
     .why = "as the ordinary scene: no map reads them"},
    {"zero-area and double triangles", .change = degenerate_triangles, .bounds = {PAPER, REVIEW},
     .why = ORDINARY},
    {"one triangle", .change = one_triangle, .bounds = {PAPER, REVIEW}, .why = "nothing shadows it"},
    {"a million triangles", .assignments = "light.map_size=64", .change = million_triangles, .slow = true,
     .bounds = {PAPER, REVIEW}, .why = "few texels for as many triangles", .remedies = {"light.regions=96"}},
    {"no triangle at all", .change = nothing, .bounds = {0, 0}, .why = "nothing is drawn"},
    {"camera inside of the cloth", .change = camera_inside, .bounds = {PAPER, REVIEW}, .why = ORDINARY},
    {"camera at the origin", .change = camera_at_origin, .bounds = {TL_NO_WORSE, 0.10},
     .why = "at the foot of the curtain, where little light comes", .remedies = {RAYS}},
    {"near plane = far plane", .change = near_is_far, .why = "there is no depth to draw in", .refused = true},
    {"eye = target", .change = eye_is_target, .why = "there is no direction to look in", .refused = true},
    {"up = direction of view", .change = up_is_view, .why = "there is no upright", .refused = true},
    {"ordinary scene again", .bounds = {PAPER, REVIEW}, .why = "no extreme leaves a trace"},
};
/* clang-format on */
const size_t tl_extreme_count = TL_COUNT(tl_extremes);

/* Writes the environment to a file and reads it back, because the file reader checks its values. */
static bool reload_environment(struct tl_extreme_scene *scene, tl_error *error)
{
    static const char *const channels[] = {"R", "G", "B"};
    char folder[] = "/tmp/toile-stability-XXXXXX";
    if (!mkdtemp(folder))
        return tl_fail(error, TL_OUTPUT, "%s: cannot be made: is /tmp writable?", folder);
    char *path = tl_format("%s/environment.exr", folder);
    tl_environment loaded;
    bool done = tl_exr_save(path, &(struct tl_exr_layer){channels, &scene->environment.image}, 1, error) &&
                tl_environment_load(path, &loaded, error);
    unlink(path);
    rmdir(folder);
    free(path);
    if (!done)
        return false;
    tl_environment_release(&scene->environment);
    scene->environment = loaded;
    return true;
}

bool tl_extreme_scene_make(const struct tl_extreme *extreme, struct tl_extreme_scene *out, tl_error *error)
{
    make_ordinary(out);
    if (extreme->change)
        extreme->change(out);
    fill_surface(out);
    if (!extreme->from_file || reload_environment(out, error))
        return true;
    tl_extreme_scene_release(out);
    return false;
}

void tl_extreme_scene_release(struct tl_extreme_scene *scene)
{
    tl_mesh_release(&scene->mesh);
    tl_environment_release(&scene->environment);
    *scene = (struct tl_extreme_scene){0};
}

tl_frame tl_extreme_frame(struct tl_extreme_scene *scene)
{
    return (tl_frame){.camera = scene->camera,
                      .surfaces = &scene->surface,
                      .surface_count = 1,
                      .environment = &scene->environment,
                      .environment_revision = scene->surface.motion_revision};
}
