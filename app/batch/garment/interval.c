#include "app/batch/garment/interval.h"

#include "config/base/log.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define MM 1e3

/* A start from which a garment is settled. */
struct start {
    const char *name;
    double lifted_m;
    double twist; /* rad for a metre of height, about the vertical through its middle */
};
static const struct start starts[TL_INTERVAL_STARTS] = {
    {"its own", 0, 0},
    {"lifted by 30 mm", 0.03, 0},
    {"lowered by 10 mm", -0.01, 0},
    {"twisted by 0.1 rad a metre", 0, 0.1},
    {"twisted by -0.1 rad a metre", 0, -0.1},
};

/* ---- Taking ---- */

static bool check(const tl_session *session, tl_error *error)
{
    const enum tl_garment_state state = tl_session_garment_state(session);
    if (tl_session_plays_clip(session))
        return tl_fail(error, TL_USAGE,
                       "--interval: is that of a body that stands: add --set scene.clip=none");
    if (state == TL_GARMENT_IS_NOT_CLOTH)
        return tl_fail(error, TL_USAGE, "--interval: the garment is not simulated, and so does not settle");
    if (!(tl_session_settings(session)->cloth.settle_s > 0))
        return tl_fail(error, TL_USAGE, "--interval: cloth.settle_s=0 lets nothing settle: leave it out");
    if (tl_session_is_undraped(session))
        return tl_fail(error, TL_USAGE,
                       "--interval: the garment is %s: add --set scene.drape=settle to let it come to rest",
                       tl_garment_state_names[state]);
    return true;
}

static void displace(const struct start *start, const tl_garment *garment, vec3s *positions)
{
    const tl_mesh *mesh = &garment->model.mesh;
    const struct tl_box box = tl_box_of(mesh->positions, mesh->vertex_count);
    const vec3s middle = glms_vec3_lerp(box.lower, box.upper, 0.5f);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        const vec3s from = glms_vec3_sub(mesh->positions[i], middle);
        const float angle = (float)start->twist * from.y, c = cosf(angle), s = sinf(angle);
        positions[i] =
            (vec3s){{middle.x + c * from.x + s * from.z, mesh->positions[i].y + (float)start->lifted_m,
                     middle.z + c * from.z - s * from.x}};
    }
}

static bool settle_from(const struct start *start, tl_session *session, const tl_collider *collider,
                        struct tl_measures *measures, struct tl_residual *residual, tl_error *error)
{
    const struct tl_settings *settings = tl_session_settings(session);
    const struct tl_cloth_fabric fabric = tl_settings_fabric(settings);
    const tl_garment *garment = tl_session_cut(session);
    const tl_model *body = tl_session_models(session).avatar;
    tl_cloth *cloth = tl_cloth_create(garment, &fabric, &settings->cloth, error);
    if (!cloth)
        return false;
    vec3s *positions = TL_NEW_ARRAY(vec3s, garment->model.mesh.vertex_count);
    displace(start, garment, positions);
    tl_cloth_start_at(cloth, positions);
    const bool good = tl_cloth_settle(cloth, collider, error);
    if (good) {
        tl_cloth_positions(cloth, positions);
        const struct tl_measures_source source = {.garment = garment,
                                                  .positions = positions,
                                                  .weld = tl_cloth_weld(cloth),
                                                  .body = body ? &body->mesh : NULL};
        *measures = tl_measures_take(&source);
        *residual = tl_cloth_balance(cloth).residual;
    }
    free(positions);
    tl_cloth_destroy(&cloth);
    return good;
}

bool tl_interval_take(tl_session *session, const struct tl_measures *own, struct tl_interval *out,
                      tl_error *error)
{
    const tl_model *body = tl_session_models(session).avatar;
    *out = (struct tl_interval){.measures = {*own}};
    if (!check(session, error))
        return false;
    tl_collider *collider =
        tl_collider_create(body ? &body->mesh : NULL, tl_session_settings(session)->image.ground, error);
    bool good = collider != NULL;
    out->residuals[0] = tl_session_balance(session).residual;
    for (int i = 1; good && i < TL_INTERVAL_STARTS; i++) {
        tl_info("start %d of %d: %s", i + 1, TL_INTERVAL_STARTS, starts[i].name);
        good = settle_from(&starts[i], session, collider, &out->measures[i], &out->residuals[i], error);
    }
    tl_collider_destroy(&collider);
    if (!good)
        tl_interval_release(out);
    return good;
}

void tl_interval_release(struct tl_interval *interval)
{
    for (int i = 1; i < TL_INTERVAL_STARTS; i++)
        tl_measures_release(&interval->measures[i]);
    *interval = (struct tl_interval){0};
}

/* ---- Figures ---- */

enum figure { OPENING_LENGTH, OPENING_HEIGHT, GIRTH };

static double figure_of(const struct tl_measures *measures, enum figure figure, size_t index)
{
    switch (figure) {
    case OPENING_LENGTH:
        return MM * measures->openings[index].worn_m;
    case OPENING_HEIGHT:
        return MM * measures->openings[index].height_m;
    case GIRTH:
        return MM * measures->girths[index].worn_m;
    }
    return 0;
}

struct interval_range {
    double min, max;
};

static struct interval_range range_of(const struct tl_interval *interval, enum figure figure, size_t index)
{
    struct interval_range range = {HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i < TL_INTERVAL_STARTS; i++) {
        const double value = figure_of(&interval->measures[i], figure, index);
        range.min = fmin(range.min, value);
        range.max = fmax(range.max, value);
    }
    return range;
}

static void print_line(const struct tl_interval *interval, const char *name, const char *what,
                       enum figure figure, size_t index)
{
    const struct interval_range range = range_of(interval, figure, index);
    char line[TL_OPENING_NAME + 16];
    snprintf(line, sizeof line, "%s%s", name, what);
    printf("%-24s %9.1f %9.1f %9.1f %9.1f\n", line, range.min,
           figure_of(&interval->measures[0], figure, index), range.max, range.max - range.min);
}

void tl_interval_print(const struct tl_interval *interval)
{
    const struct tl_measures *own = &interval->measures[0];
    printf("\n%-24s %9s %9s %9s %9s\n", "from five starts, mm", "min", "its own", "max", "interval");
    for (size_t i = 0; i < own->opening_count; i++)
        print_line(interval, own->openings[i].name, "", OPENING_LENGTH, i);
    for (size_t i = 0; i < own->opening_count; i++)
        print_line(interval, own->openings[i].name, ", height", OPENING_HEIGHT, i);
    for (size_t i = 0; i < TL_GIRTHS; i++)
        if (own->girths[i].rest_m > 0)
            print_line(interval, tl_girth_names[i], ", girth", GIRTH, i);
    for (int i = 0; i < TL_INTERVAL_STARTS; i++) {
        const struct tl_residual *residual = &interval->residuals[i];
        printf("%-7s%s: %s, out of balance by %.2g of its weight\n", i == 0 ? "starts" : "", starts[i].name,
               tl_residual_is_balance(residual) ? "at rest" : "not at rest", residual->bounded_rms);
    }
}

static cJSON *add_range(cJSON *object, const char *name, const struct tl_interval *interval,
                        enum figure figure, size_t index)
{
    const struct interval_range range = range_of(interval, figure, index);
    cJSON *item = cJSON_AddObjectToObject(object, name);
    cJSON_AddNumberToObject(item, "min", range.min);
    cJSON_AddNumberToObject(item, "own", figure_of(&interval->measures[0], figure, index));
    cJSON_AddNumberToObject(item, "max", range.max);
    return item;
}

cJSON *tl_interval_json(const struct tl_interval *interval)
{
    const struct tl_measures *own = &interval->measures[0];
    cJSON *object = cJSON_CreateObject();
    cJSON *openings = cJSON_AddObjectToObject(object, "openings"),
          *heights = cJSON_AddObjectToObject(object, "heights"),
          *girths = cJSON_AddObjectToObject(object, "girths"),
          *from = cJSON_AddArrayToObject(object, "starts");
    for (size_t i = 0; i < own->opening_count; i++) {
        add_range(openings, own->openings[i].name, interval, OPENING_LENGTH, i);
        add_range(heights, own->openings[i].name, interval, OPENING_HEIGHT, i);
    }
    for (size_t i = 0; i < TL_GIRTHS; i++)
        if (own->girths[i].rest_m > 0)
            add_range(girths, tl_girth_names[i], interval, GIRTH, i);
    for (int i = 0; i < TL_INTERVAL_STARTS; i++) {
        cJSON *item = cJSON_CreateObject();
        cJSON_AddStringToObject(item, "start", starts[i].name);
        cJSON_AddNumberToObject(item, "unbalanced_rms", interval->residuals[i].rms);
        cJSON_AddBoolToObject(item, "at_rest", tl_residual_is_balance(&interval->residuals[i]));
        cJSON_AddItemToArray(from, item);
    }
    return object;
}
