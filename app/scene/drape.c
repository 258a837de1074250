#include "app/scene/drape.h"

#include "app/scene/drape_version.h"
#include "cloth/step/snapshot.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "config/cache/cache.h"

#include <stdlib.h>
#include <string.h>

/* A clip's first pose may be far from the rest pose that a garment was made for. The avatar walks there in
 * this time, before frame 0, so that the cloth is carried along instead of torn. */
#define POSE_IN_S 1.0

/* More than any garment here that fits is, by root mean square: 0.6 to 2.1 %. Preview passes over the edges
 * once a substep, and with too few of them what is fine hangs longer, up to the strain limit. */
#define STRETCHED 0.03

static void log_stretch(const struct tl_cloth_params *params, double strain)
{
    if (!(params->settle_s > 0) || !(strain > STRETCHED))
        return;
    if (params->substeps > 0)
        tl_info("the cloth is stretched by %.0f %%: it is tight, or cloth.substeps=%d are too few for edges "
                "so fine",
                100 * strain, params->substeps);
    else
        tl_info("the cloth is stretched by %.0f %%: it is tight", 100 * strain);
}

/* Reports what came crossed and could not be untangled: a garment that is too tight, or one that its file
 * ties in knots. */
static void log_crossings(const struct tl_cloth_params *params, const tl_cloth *cloth)
{
    size_t count =
        params->self_contact && params->settle_s > 0 ? tl_cloth_measure(cloth, NULL).crossing_count : 0;
    if (count > 0)
        tl_info("the cloth still passes through itself: %zu pairs of its triangles cross", count);
}

/* A garment with a larger share of its vertices deeper inside the body than this was not made for it: on
 * their own bodies three in a thousand of a suit's are. */
#define NOTICED_DEPTH_M 0.005
#define NOTICED_SHARE   0.01

/* A garment as authored that was made for another body is not refitted; a warning is logged. */
static void log_depth(const struct tl_drape_request *request, const tl_collider *collider)
{
    const double reach_m = 0.5;
    const tl_mesh *mesh = &request->garment->model.mesh;
    double deepest_m = 0;
    size_t count = 0;
    if (!request->avatar)
        return;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        const vec3s at = mesh->positions[i];
        const double point[3] = {(double)at.x, (double)at.y, (double)at.z};
        struct tl_contact contact;
        if (!tl_collider_query(collider, point, reach_m, &contact) || contact.distance_m > -NOTICED_DEPTH_M)
            continue;
        deepest_m = tl_max(deepest_m, -contact.distance_m);
        count++;
    }
    if (!((double)count > NOTICED_SHARE * (double)mesh->vertex_count))
        return;
    char *line =
        tl_format("%s: %zu of its %zu vertices lie inside %s, up to %.0f mm: it was made for another "
                  "body or pose; scene.drape=settle drapes it on this one",
                  request->garment->model.name, count, mesh->vertex_count, request->avatar->model.name,
                  1000 * deepest_m);
    tl_info("%s", line);
    if (request->inside)
        *request->inside = line;
    else
        free(line);
}

/* Seams whose sides something holds apart: the body, or a fold of the cloth between them. */
static void log_open_seams(const struct tl_cloth_params *params, const tl_cloth *cloth)
{
    size_t count = params->settle_s > 0 ? tl_cloth_measure(cloth, NULL).open_seams : 0;
    if (count > 0)
        tl_info("the seams are not closed: %zu pairs of stitches are still apart: is this the body that the "
                "garment was cut for?",
                count);
}

/* ---- Into the clip's first pose ---- */

static bool has_pose(const struct tl_drape_request *request)
{
    return request->avatar && request->clip >= 0;
}

/* Moves the avatar from the rest pose to the clip's first pose, each vertex along a straight line. Without a
 * cloth only the collider moves, to the state that a restored cloth requires. */
static bool pose_in(const struct tl_drape_request *request, tl_collider *collider, tl_cloth *cloth,
                    tl_error *error)
{
    size_t count = request->avatar->model.mesh.vertex_count;
    const vec3s *rest = request->avatar->model.mesh.positions;
    vec3s *first = TL_NEW_ARRAY(vec3s, count), *between = TL_NEW_ARRAY(vec3s, count);
    tl_model_pose(&request->avatar->model, request->clip, 0, first);
    int steps = (int)(POSE_IN_S * request->params->frame_rate) + 1;
    bool done = true;
    for (int step = 1; done && step <= steps && !tl_interrupted(); step++) {
        float part = (float)step / (float)steps;
        for (size_t i = 0; i < count; i++)
            between[i] = glms_vec3_lerp(rest[i], first[i], part);
        tl_collider_move(collider, between);
        done = !cloth || tl_cloth_step(cloth, collider, error);
    }
    free(between);
    free(first);
    return done;
}

/* ---- The key ---- */

#define ADD(key, array, count) tl_cache_key_add(key, array, (array) ? (count) * sizeof *(array) : 0)

static void add_mesh(struct tl_cache_key *key, const tl_mesh *mesh)
{
    ADD(key, mesh->positions, mesh->vertex_count);
    ADD(key, mesh->uvs, mesh->vertex_count);
    ADD(key, mesh->indices, mesh->index_count);
    for (size_t i = 0; i < mesh->part_count; i++) {
        tl_cache_key_add(key, &mesh->parts[i].first_index, sizeof mesh->parts[i].first_index);
        tl_cache_key_add(key, &mesh->parts[i].index_count, sizeof mesh->parts[i].index_count);
    }
}

/* Hashes all inputs of a drape: the sources of the code that computes it and their compilation, the options,
 * the garment, and the wearer in both of the poses that it has while it is dressed. */
static struct tl_cache_key key_of(const struct tl_drape_request *request)
{
    struct tl_cache_key key = tl_cache_key_begin();
    const tl_garment *garment = request->garment;
    size_t count = garment->model.mesh.vertex_count;
    tl_cache_key_add(&key, TL_DRAPE_VERSION, strlen(TL_DRAPE_VERSION));
    tl_cache_key_add(&key, &request->options, sizeof request->options);
    tl_cache_key_add(&key, &request->only_sewn, sizeof request->only_sewn);
    add_mesh(&key, &garment->model.mesh);
    ADD(&key, garment->pattern, count);
    ADD(&key, garment->modelled, garment->model.mesh.index_count / 3);
    ADD(&key, garment->model.colours, count);
    ADD(&key, garment->seams, garment->seam_count);
    ADD(&key, garment->pins, garment->pin_count);
    ADD(&key, garment->holds, garment->hold_count);
    tl_cache_key_add(&key, &garment->welds_seams_only, sizeof garment->welds_seams_only);
    if (request->avatar)
        add_mesh(&key, &request->avatar->model.mesh);
    if (has_pose(request)) {
        size_t body_count = request->avatar->model.mesh.vertex_count;
        vec3s *first = TL_NEW_ARRAY(vec3s, body_count);
        tl_model_pose(&request->avatar->model, request->clip, 0, first);
        ADD(&key, first, body_count);
        free(first);
    }
    return key;
}

/* ---- Making, storing, restoring ---- */

static bool settle(const struct tl_drape_request *request, tl_cloth *cloth, tl_collider *collider,
                   tl_error *error)
{
    return request->only_sewn ? tl_cloth_sew(cloth, collider, error)
                              : tl_cloth_settle(cloth, collider, error);
}

/* `strain`: as it hung before it was carried into a pose. */
static tl_cloth *make(const struct tl_drape_request *request, tl_collider *collider, double *strain,
                      tl_error *error)
{
    tl_cloth *cloth = tl_cloth_create(request->garment, request->fabric, request->params, error);
    if (!cloth || (request->settles && !settle(request, cloth, collider, error))) {
        tl_cloth_destroy(&cloth);
        return NULL;
    }
    *strain = request->settles ? tl_cloth_measure(cloth, NULL).rms_strain : 0;
    log_stretch(request->params, *strain);
    if (has_pose(request) && !pose_in(request, collider, cloth, error))
        tl_cloth_destroy(&cloth);
    else
        tl_cloth_mark_start(cloth);
    return cloth;
}

static void store(const struct tl_cache_key *key, const tl_cloth *cloth, double strain)
{
    void *state;
    size_t size;
    if (tl_interrupted() || !tl_cloth_save(cloth, &state, &size))
        return;
    char *record = tl_alloc(sizeof strain + size, 1);
    memcpy(record, &strain, sizeof strain);
    memcpy(record + sizeof strain, state, size);
    tl_cache_store(key, record, sizeof strain + size);
    free(record);
    free(state);
}

/* NULL when there is no such drape; the collider has not moved then. */
static tl_cloth *restore(const struct tl_drape_request *request, const struct tl_cache_key *key,
                         tl_collider *collider, tl_error *error)
{
    void *record;
    size_t size;
    double strain;
    if (!tl_cache_load(key, &record, &size))
        return NULL;
    tl_cloth *cloth = tl_cloth_create(request->garment, request->fabric, request->params, error);
    if (cloth && (size < sizeof strain ||
                  !tl_cloth_restore(cloth, (const char *)record + sizeof strain, size - sizeof strain)))
        tl_cloth_destroy(&cloth);
    if (cloth) {
        memcpy(&strain, record, sizeof strain);
        log_stretch(request->params, strain);
        if (has_pose(request))
            (void)pose_in(request, collider, NULL, error);
    }
    free(record);
    return cloth;
}

tl_cloth *tl_drape(const struct tl_drape_request *request, tl_collider *collider, tl_error *error)
{
    double strain;
    tl_cloth *cloth;
    if (!request->settles)
        log_depth(request, collider);
    if (tl_cache_is_used() && request->settles) {
        const struct tl_cache_key key = key_of(request);
        cloth = restore(request, &key, collider, error);
        if (!cloth && (cloth = make(request, collider, &strain, error)))
            store(&key, cloth, strain);
    } else
        cloth = make(request, collider, &strain, error);
    if (cloth && request->settles) {
        log_crossings(request->params, cloth);
        log_open_seams(request->params, cloth);
    }
    return cloth;
}
