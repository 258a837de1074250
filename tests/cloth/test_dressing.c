/* Real garments on real bodies: they settle and hang, do not tear, slide off or tremble, and the body does
 * not show through. The bounds are what a viewer would notice, not what the solver reaches. */
#include "assets/avatar.h"
#include "cloth/measure.h"
#include "cloth/state.h"
#include "tests/cloth/sheets.h"
#include "tests/testing.h"

#include "config/base/log.h"

/* Of the skirt and of trousers, which meet every bound on it. Layers tremble and the shirt does not balance
 * on edges as long. */
#define COARSE_EDGE_M 0.027f

struct dressed {
    tl_garment garment;
    tl_avatar avatar;
    tl_collider *collider;
    tl_cloth *cloth;
};

static void dress(struct dressed *d)
{
    tl_error error = {0};
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    d->collider = tl_collider_create(&d->avatar.model.mesh, true, &error);
    d->cloth = tl_cloth_create(&d->garment, &fabric, &params, &error);
    assert_non_null(d->cloth);
}

static void undress(struct dressed *d)
{
    tl_cloth_destroy(&d->cloth);
    tl_collider_destroy(&d->collider);
    tl_garment_release(&d->garment);
    tl_avatar_release(&d->avatar);
}

static vec3d centre(const tl_cloth *cloth)
{
    vec3d sum = {0};
    for (size_t i = 0; i < cloth->particles.count; i++)
        sum = vec3d_muladd(sum, cloth->particles.x[i], 1 / (double)cloth->particles.count);
    return sum;
}

/* Depth in the body: the largest of 15 points of every cloth triangle. A point inside would show the body. */
static double deepest_inside(const struct dressed *d)
{
    const double reach_m = 0.05;
    double deepest = 0;
    for (size_t t = 0; t < d->cloth->topology.triangle_count; t++) {
        const uint32_t *v = d->cloth->topology.triangles[t];
        for (int i = 0; i <= 4; i++)
            for (int j = 0; i + j <= 4; j++) {
                vec3d p = vec3d_scale(d->cloth->particles.x[v[0]], i / 4.0);
                p = vec3d_muladd(p, d->cloth->particles.x[v[1]], j / 4.0);
                p = vec3d_muladd(p, d->cloth->particles.x[v[2]], (4 - i - j) / 4.0);
                const double point[3] = {p.x, p.y, p.z};
                struct tl_contact contact;
                if (tl_collider_query(d->collider, point, reach_m, &contact))
                    deepest = fmax(deepest, -contact.distance_m);
            }
    }
    return deepest;
}

static vec3d normal_of(const tl_cloth *cloth, size_t triangle)
{
    const uint32_t *v = cloth->topology.triangles[triangle];
    const vec3d *x = cloth->particles.x;
    return vec3d_unit_or(vec3d_cross(vec3d_sub(x[v[1]], x[v[0]]), vec3d_sub(x[v[2]], x[v[0]])), (vec3d){0});
}

/* The largest angle in degrees by which two triangles are folded. */
static double sharpest_fold(const tl_cloth *cloth)
{
    double least = 1;
    for (size_t t = 0; t < cloth->topology.triangle_count; t++)
        for (int corner = 0; corner < 3; corner++) {
            uint32_t other = cloth->topology.neighbour[t][corner];
            if (other != TL_NONE)
                least = fmin(least, vec3d_dot(normal_of(cloth, t), normal_of(cloth, other)));
        }
    return acos(fmax(least, -1)) * 180 / M_PI;
}

/* The largest displacement per frame in 15 frames, in m/s: the motion that a viewer sees. */
static double creep(struct dressed *d)
{
    tl_error error = {0};
    const double rate = d->cloth->params.frame_rate;
    double fastest = 0;
    vec3d *before = TL_NEW_ARRAY(vec3d, d->cloth->particles.count);
    for (int frame = 0; frame < 15; frame++) {
        memcpy(before, d->cloth->particles.x, d->cloth->particles.count * sizeof *before);
        assert_ok(tl_cloth_step(d->cloth, d->collider, &error), error);
        for (size_t i = 0; i < d->cloth->particles.count; i++)
            fastest = fmax(fastest, rate * vec3d_distance(before[i], d->cloth->particles.x[i]));
    }
    free(before);
    return fastest;
}

/* A garment at rest does not visibly move in the third second: at 2 mm/s a garment that fills the screen
 * moves by a pixel in half a second. Preview's hem still swings a little then; settle has stopped. Coarse
 * meshes are left out, because probes at the middles of edges touch instead of vertices: at 3 cm settle
 * continues at 2 to 5 mm/s. */
static void check_creep(struct dressed *d, const char *name)
{
    double speed = creep(d);
    printf("%s, %s: creeps at %.2g mm/s in the third second\n", name,
           tl_cloth_solver_names[d->cloth->params.solver], 1e3 * speed);
    assert_true(speed < 2e-3);
}

/* Checks speed and displacement in the two seconds after settling. `balances`: in creases of a tight suit a
 * vertex has contact with one plane, and so is pressed to and fro, by at most a sixth of a millimetre a
 * frame. */
static void check_rest(struct dressed *d, const char *name, bool balances)
{
    tl_error error = {0};
    vec3d start = centre(d->cloth);
    assert_ok(tl_cloth_settle(d->cloth, d->collider, &error), error);
    struct tl_cloth_report settled = tl_cloth_measure(d->cloth, d->collider);
    vec3d rest = centre(d->cloth);
    double rms = 0;
    for (int frame = 0; frame < 60; frame++) {
        assert_ok(tl_cloth_step(d->cloth, d->collider, &error), error);
        rms = fmax(rms, tl_cloth_moved_from(d->cloth, d->cloth->good_x) * d->cloth->params.frame_rate);
    }
    struct tl_cloth_report after = tl_cloth_measure(d->cloth, d->collider);
    double drift = vec3d_distance(rest, centre(d->cloth)), deepest = deepest_inside(d);
    printf("%s: sank %.1f mm settling, out of balance by %.2g, strain %.2f, then in 60 frames drift %.2f mm, "
           "at most %.2f mm/s rms from frame to frame, deepest %.2f mm, between vertices %.2f mm\n",
           name, 1e3 * (start.y - rest.y), tl_cloth_balance(d->cloth).residual.rms, after.max_strain,
           1e3 * drift, 1e3 * rms, 1e3 * after.deepest_m, 1e3 * deepest);
    assert_true(settled.settled || !balances);
    assert_int_equal(settled.open_seams, 0);
    assert_true(start.y - rest.y <
                0.08); /* a flared skirt sinks as its folds form; more would mean that it slides off */
    assert_true(after.max_strain < 1); /* torn cloth is stretched many times its length */
    assert_true(drift < 2e-3);
    assert_true(rms < (balances ? 5e-3 : 1e-2));
    assert_true(after.deepest_m < 1e-3);
    assert_true(deepest < 1e-3);
}

static void check_files(const char *garment, const char *avatar)
{
    tl_error error = {0};
    struct dressed d = {0};
    const char *garment_path = test_data(garment), *avatar_path = test_data(avatar);
    assert_ok(tl_garment_load(garment_path, &d.garment, &error), error);
    assert_ok(tl_avatar_load(avatar_path, &d.avatar, &error), error);
    dress(&d);
    check_rest(&d, garment, false);
    undress(&d);
}

static void test_sports_suit(void **state)
{
    (void)state;
    check_files("garments/mh_female_sportsuit01.glb", "avatars/mh_female_body.glb");
}

static void test_built_in(void **state)
{
    (void)state;
    tl_error error = {0};
    for (const char *const *name = tl_garment_names; *name; name++) {
        if (tl_garment_is_for_figure(*name)) /* test_drafted hangs it */
            continue;
        struct dressed d = {.avatar = tl_avatar_form()};
        assert_ok(tl_garment_cut(*name,
                                 strcmp(*name, "skirt") == 0 ? COARSE_EDGE_M : params_defaults().edge_m,
                                 &d.garment, &error),
                  error);
        dress(&d);
        check_rest(&d, *name, true);
        if (strcmp(*name, "dress") == 0) {
            double fold_deg = sharpest_fold(d.cloth);
            printf("%s: folded by at most %.0f degrees an edge\n", *name, fold_deg);
            assert_true(fold_deg < 150); /* sharper is a knife's edge */
            check_creep(&d, *name);
        }
        undress(&d);
    }
}

static double distance_to(const void *collider, const double point[3])
{
    struct tl_contact contact;
    return tl_collider_query(collider, point, 0.3, &contact) ? contact.distance_m : 0.3;
}

/* What is drafted from a body's measures hangs on that body: sewn, clear of it, nowhere through itself, its
 * strain that of its weight. */
static void check_drafted(const char *name, const char *body)
{
    tl_error error = {0};
    struct dressed d = {0};
    const char *path = body ? test_data(body) : NULL;
    if (body)
        assert_ok(tl_avatar_load(path, &d.avatar, &error), error);
    else
        d.avatar = tl_avatar_figure();
    tl_collider *skin = tl_collider_create(&d.avatar.model.mesh, false, &error);
    const struct tl_wearer wearer = {
        body ? body : "figure", &d.avatar.model.mesh, {distance_to, skin}, false};
    const float edge_m = strcmp(name, "trousers") == 0 ? COARSE_EDGE_M : params_defaults().edge_m;
    assert_ok(tl_garment_cut_for(name, edge_m, &wearer, &d.garment, &error), error);
    tl_collider_destroy(&skin);
    dress(&d);
    struct tl_cloth_params params = d.cloth->params;
    params.self_contact = true;
    assert_ok(tl_cloth_set(d.cloth, &d.cloth->fabric, &params, &error), error);
    check_rest(&d, name, true);
    struct tl_cloth_report rest = tl_cloth_measure(d.cloth, d.collider);
    printf("%s on %s: %zu crossings, rms strain %.4f\n", name, wearer.name, rest.crossing_count,
           rest.rms_strain);
    assert_int_equal(rest.crossing_count, 0);
    assert_near(rest.deepest_m, 0, 1e-6);
    assert_true(rest.rms_strain < 0.01);
    undress(&d);
}

static void test_drafted(void **state)
{
    (void)state;
    for (const char *const *name = tl_garment_names; *name; name++) {
        if (!tl_garment_is_for_figure(*name))
            continue;
        check_drafted(*name, NULL);
        if (strcmp(*name, "shirt") == 0) /* on these bodies its collar starts crossed */
            continue;
        check_drafted(*name, "avatars/mh_female_body.glb");
    }
}

/* A few of ten thousand vertices may oscillate between substeps, which is not visible in frames. Settling
 * still ends, and none oscillates for long, because the strain limit shortens the same edges in every
 * substep. */
static void test_fine_rests(void **state)
{
    (void)state;
    tl_error error = {0};
    struct dressed d = {.avatar = tl_avatar_form()};
    assert_ok(tl_garment_cut("dress", 0.0107f, &d.garment, &error), error);
    dress(&d);
    assert_ok(tl_cloth_settle(d.cloth, d.collider, &error), error);
    assert_true(d.cloth->settled);
    for (int frame = 0; frame < 10; frame++)
        assert_ok(tl_cloth_step(d.cloth, d.collider, &error), error);
    double speed = tl_cloth_max_speed(d.cloth);
    printf("dress, fine: at most %.2g mm/s between substeps\n", 1e3 * speed);
    assert_true(speed < 0.03);
    undress(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sports_suit),
        cmocka_unit_test(test_built_in),
        cmocka_unit_test(test_drafted),
        cmocka_unit_test(test_fine_rests),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
