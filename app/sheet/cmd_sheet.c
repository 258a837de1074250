/* toile sheet: renders a contact sheet cell by cell, as a folder of pictures or as one image. */
#include "app/report/report.h"
#include "app/scene/camera.h"
#include "app/scene/headless.h"
#include "app/scene/orbit.h"
#include "app/scene/session.h"
#include "app/sheet/commands.h"
#include "app/sheet/contact_plan.h"
#include "app/sheet/contact_store.h"
#include "assets/image/image_file.h"
#include "config/base/file.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "config/embedded.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

extern const struct tl_embedded tl_embedded_sheet[]; /* sheet.js */

/* The state of one run. */
struct work {
    const struct tl_arguments *arguments;
    struct tl_contact_plan plan;
    tl_contact_store *store;
    char *folder;
    bool is_image; /* the output is a PNG: the folder is removed once the image is complete */
    /* The device and renderer are made for the first cell, the session for the first row. */
    struct tl_headless headless;
    bool *refused; /* [cells] */
    size_t drawn, kept, refused_count;
};

static size_t cell_of(const struct work *work, size_t row, size_t column)
{
    return row * work->plan.column_count + column;
}

static bool is_done(const struct work *work, size_t row, size_t column)
{
    char *name = tl_contact_cell_name(&work->plan, row, column);
    bool done = tl_contact_store_has(work->store, name, tl_contact_cell_hash(&work->plan, row, column));
    free(name);
    return done;
}

/* Whether this run is to draw it: shards have blocks of cells, so that a row is draped by few of them. */
static bool is_wanted(const struct work *work, size_t row, size_t column)
{
    size_t cells = work->plan.row_count * work->plan.column_count;
    size_t shards = work->arguments->shards ? (size_t)work->arguments->shards : 1;
    bool mine = cell_of(work, row, column) * shards / cells == (size_t)work->arguments->shard;
    return mine && !is_done(work, row, column);
}

/* ---- Drawing ---- */

/* Whether the drape can be kept: only the appearance differs. */
static bool keeps_drape(const struct tl_settings *draped, const struct tl_settings *settings)
{
    return tl_options_equal(&tl_cloth_fabric_options, &draped->fabric, &settings->fabric) &&
           tl_options_equal(&tl_cloth_options, &draped->cloth, &settings->cloth) &&
           strcmp(draped->scene.garment, settings->scene.garment) == 0;
}

static bool begin_row(struct work *work, const struct tl_settings *settings, tl_error *error)
{
    struct tl_headless *headless = &work->headless;
    if (headless->session && keeps_drape(tl_session_settings(headless->session), settings))
        return tl_session_apply(headless->session, settings, error);
    bool draped = true;
    if (headless->session)
        draped = tl_session_restart(headless->session, settings, error);
    else
        draped = (headless->session = tl_session_create(settings, error)) != NULL;
    return draped && tl_session_go_to(headless->session, work->arguments->first_frame, error);
}

/* The box that the camera frames: where the garment hangs, but with the size of the cloth before it fell, a
 * little longer for the fall, so that all fabrics are seen from the same distance. It is square from above,
 * for any turn. */
static struct tl_box worn_box(const struct tl_box *before, const struct tl_box *worn)
{
    const float fall = 1.08f, corner = 0.70710678f; /* the camera makes room for the box's corners */
    vec3s size = glms_vec3_sub(before->upper, before->lower);
    float half_m = 0.5f * fmaxf(size.x, size.z) * corner;
    vec3s middle = glms_vec3_scale(glms_vec3_add(worn->lower, worn->upper), 0.5f);
    return (struct tl_box){{{middle.x - half_m, worn->upper.y - fall * size.y, middle.z - half_m}},
                           {{middle.x + half_m, worn->upper.y, middle.z + half_m}}};
}

/* Extends the box to the avatar's head and feet where they nearly fit, so that they are not cut off. */
static void add_avatar(const tl_surface *avatar, struct tl_box *box)
{
    const float above = 0.3f, below = 0.15f; /* of the garment's height */
    struct tl_box body = tl_box_of(avatar->positions, avatar->vertex_count);
    float height_m = box->upper.y - box->lower.y;
    float over_m = body.upper.y - box->upper.y, under_m = box->lower.y - body.lower.y;
    if (over_m > 0 && over_m <= above * height_m)
        box->upper.y = body.upper.y;
    if (under_m > 0 && under_m <= below * height_m)
        box->lower.y = body.lower.y;
}

/* Places the camera so that it frames the garment, unless the scene has placed it. */
static void frame_garment(tl_session *session, struct tl_settings *settings)
{
    const tl_model *garment = tl_session_garment(session);
    if (!garment || tl_camera_is_placed(&settings->camera))
        return;
    tl_frame frame = tl_session_frame(session);
    const tl_surface *surface = &frame.surfaces[frame.surface_count - 1]; /* the avatar's comes before it */
    struct tl_box worn = tl_box_of(surface->positions, surface->vertex_count);
    struct tl_box before = tl_box_of(garment->mesh.positions, garment->mesh.vertex_count);
    if (!tl_session_cloth(session))
        before = worn; /* recorded motion may begin with flat panels, whose size means nothing */
    float aspect = (float)settings->image.width / (float)settings->image.height;
    struct tl_box box = worn_box(&before, &worn);
    if (tl_session_models(session).avatar)
        add_avatar(&frame.surfaces[0], &box);
    const struct tl_framing framing = tl_framing_of_box(box, TL_CAMERA_BODY);
    struct tl_camera camera = tl_camera_frame(&settings->camera, &framing, aspect);
    tl_orbit_take(&settings->camera, &camera);
}

static bool draw_cell(struct work *work, size_t row, size_t column, tl_image *out, tl_error *error)
{
    struct tl_headless *headless = &work->headless;
    if (!tl_contact_cell_settings(&work->plan, row, column, &headless->settings, error))
        return false;
    tl_renderer_forget(headless->renderer); /* so that a cell does not depend on those drawn before it */
    if (work->plan.columns[column].view.camera == TL_CONTACT_ORBIT)
        frame_garment(headless->session, &headless->settings);
    return tl_session_apply(headless->session, &headless->settings, error) &&
           tl_headless_draw_still(headless, error) && tl_renderer_show_image(headless->renderer, out, error);
}

static bool concerns_one_cell(const tl_error *error)
{
    return error->code == TL_USAGE || error->code == TL_INPUT || error->code == TL_UNSTABLE;
}

/* Leaves a cell empty that cannot be rendered. Returns false where the error concerns the whole run. */
static bool refuse(struct work *work, size_t row, size_t column, const tl_error *error)
{
    if (!concerns_one_cell(error))
        return false;
    work->refused[cell_of(work, row, column)] = true;
    work->refused_count++;
    return true;
}

static bool refuse_row(struct work *work, size_t row, const tl_error *error)
{
    tl_warn("sheet: %s: %s", work->plan.rows[row].slug, error->message);
    for (size_t column = 0; column < work->plan.column_count; column++)
        if (is_wanted(work, row, column) && !refuse(work, row, column, error))
            return false;
    return concerns_one_cell(error);
}

static bool make_cell(struct work *work, size_t row, size_t column, tl_error *error)
{
    tl_image picture = {0};
    char *name = tl_contact_cell_name(&work->plan, row, column);
    bool made = draw_cell(work, row, column, &picture, error);
    if (made && tl_interrupted()) /* the picture may be an average of too few frames */
        made = tl_fail(error, TL_INTERRUPTED, "stopped");
    if (made) {
        uint64_t hash = tl_contact_cell_hash(&work->plan, row, column);
        made = tl_contact_store_put(work->store, name, hash, &picture, error);
        work->drawn += made;
    } else if (refuse(work, row, column, error)) {
        tl_warn("sheet: %s: %s", name, error->message);
        made = true;
    }
    tl_image_release(&picture);
    free(name);
    return made;
}

static bool make_row(struct work *work, size_t row, struct tl_progress *progress, size_t wanted,
                     tl_error *error)
{
    bool begun = false;
    for (size_t column = 0; column < work->plan.column_count; column++) {
        if (!is_wanted(work, row, column)) {
            work->kept += is_done(work, row, column);
            continue;
        }
        if (tl_interrupted())
            return tl_fail(error, TL_INTERRUPTED, "stopped");
        if (!begun && !begin_row(work, &work->plan.rows[row].settings, error))
            return refuse_row(work, row, error);
        begun = true;
        if (!make_cell(work, row, column, error))
            return false;
        tl_progress_update(progress, (double)(work->drawn + work->refused_count), (double)wanted);
    }
    return true;
}

static size_t count_wanted(const struct work *work)
{
    size_t wanted = 0;
    for (size_t row = 0; row < work->plan.row_count; row++)
        for (size_t column = 0; column < work->plan.column_count; column++)
            wanted += is_wanted(work, row, column);
    return wanted;
}

static bool make_cells(struct work *work, tl_error *error)
{
    size_t wanted = count_wanted(work);
    if (wanted > 0) {
        work->headless.gpu = tl_gpu_create_headless(error);
        work->headless.renderer = work->headless.gpu ? tl_renderer_create(work->headless.gpu, error) : NULL;
        if (!work->headless.renderer)
            return false;
    }
    struct tl_progress progress = tl_progress_begin("drawing the sheet");
    bool made = true;
    for (size_t row = 0; made && row < work->plan.row_count; row++)
        made = make_row(work, row, &progress, wanted, error);
    tl_progress_end(&progress);
    if (!made && error->code == TL_INTERRUPTED)
        tl_fail(error, TL_INTERRUPTED,
                "sheet: stopped with %zu of %zu cells done, in %s: the same command continues from there",
                work->kept + work->drawn, work->plan.row_count * work->plan.column_count, work->folder);
    return made;
}

/* ---- One image ---- */

static bool compose(const struct work *work, const char *path, tl_error *error)
{
    const struct tl_contact_grid *grid = &work->plan.grid;
    tl_image sheet = tl_contact_draw(grid);
    bool composed = true;
    for (size_t i = 0; composed && i < grid->row_count * grid->column_count; i++) {
        size_t row = i / grid->column_count, column = i % grid->column_count;
        if (work->refused[i]) {
            tl_contact_mark_empty(grid, row, column, &sheet);
            continue;
        }
        char *name = tl_contact_cell_name(&work->plan, row, column);
        char *cell = tl_format("%s/%s", work->folder, name);
        tl_image picture = {0};
        composed = tl_image_load(cell, &picture, error);
        if (composed)
            tl_contact_paste(grid, row, column, &picture, &sheet);
        tl_image_release(&picture);
        free(cell);
        free(name);
    }
    composed = composed && tl_image_save_png(path, &sheet, error);
    tl_image_release(&sheet);
    return composed;
}

/* ---- A page ---- */

static cJSON *describe_row(const struct work *work, size_t row)
{
    const struct tl_contact_plan *plan = &work->plan;
    cJSON *object = cJSON_CreateObject();
    char *title = tl_format("%s%s%s", plan->rows[row].garment, plan->rows[row].name[0] ? ": " : "",
                            plan->rows[row].name);
    cJSON_AddStringToObject(object, "title", title);
    free(title);
    cJSON *pictures = cJSON_AddArrayToObject(object, "pictures");
    for (size_t column = 0; column < plan->column_count; column++) {
        if (work->refused[cell_of(work, row, column)])
            continue;
        char *file = tl_contact_cell_name(plan, row, column);
        cJSON *picture = cJSON_CreateObject();
        cJSON_AddStringToObject(picture, "file", file);
        cJSON_AddStringToObject(picture, "name", plan->columns[column].view.name);
        cJSON_AddStringToObject(picture, "group", plan->columns[column].group);
        cJSON_AddItemToArray(pictures, picture);
        free(file);
    }
    cJSON_AddBoolToObject(object, "refused", cJSON_GetArraySize(pictures) < (int)plan->column_count);
    return object;
}

static bool write_page(const struct work *work, tl_error *error)
{
    cJSON *data = cJSON_CreateObject();
    cJSON_AddStringToObject(data, "title", work->plan.title);
    cJSON_AddStringToObject(data, "note", work->plan.note);
    cJSON *rows = cJSON_AddArrayToObject(data, "rows");
    for (size_t row = 0; row < work->plan.row_count; row++)
        cJSON_AddItemToArray(rows, describe_row(work, row));
    return tl_report_write(work->folder, "index.html", tl_embedded_sheet[0].data, data, error);
}

/* ---- The command ---- */

static bool check_size(const struct tl_contact_plan *plan, const char *output, tl_error *error)
{
    int64_t width, height;
    tl_contact_size(&plan->grid, &width, &height);
    tl_error why;
    if (tl_image_size_check("sheet", width, height, &why))
        return true;
    return tl_fail(
        error, TL_USAGE,
        "%s: would be %lld x %lld pixels, too many for one image: name a folder, or ask for a smaller "
        "--size or fewer cells",
        output, (long long)width, (long long)height);
}

static bool begin(struct work *work, tl_error *error)
{
    const char *output = work->arguments->output;
    if (!output)
        return tl_fail(error, TL_USAGE, "sheet: no output named: add -o OUT.png or -o FOLDER");
    work->is_image = tl_path_has_extension(output, "png");
    if (!work->is_image && (tl_path_has_extension(output, "exr") || tl_path_has_extension(output, "jpg")))
        return tl_fail(error, TL_USAGE, "%s: a sheet is a .png or a folder: name one of them", output);
    if (!tl_contact_plan_make(work->arguments, &work->plan, error) ||
        (work->is_image && !check_size(&work->plan, output, error)))
        return false;
    work->refused = TL_NEW_ARRAY(bool, work->plan.row_count * work->plan.column_count);
    work->folder = tl_format("%s%s", output, work->is_image ? ".cells" : "");
    work->store = tl_contact_store_open(work->folder, work->arguments->shard, work->arguments->shards, error);
    return work->store != NULL;
}

static bool finish(struct work *work, tl_error *error)
{
    const char *output = work->arguments->output;
    if (work->arguments->shards) {
        tl_info(
            "sheet: shard %d of %d: %zu cells drawn, %zu kept, %zu refused: the same command without --shard "
            "puts the sheet together",
            work->arguments->shard, work->arguments->shards, work->drawn, work->kept, work->refused_count);
        return work->refused_count == 0 ||
               tl_fail(error, TL_UNSTABLE, "sheet: %zu cells were refused: repair what is named above",
                       work->refused_count);
    }
    if (!(work->is_image ? compose(work, output, error) : write_page(work, error)))
        return false;
    tl_info("sheet: %s: %zu cells drawn, %zu kept, %zu refused", output, work->drawn, work->kept,
            work->refused_count);
    if (work->refused_count > 0)
        return tl_fail(error, TL_UNSTABLE,
                       "sheet: %zu of %zu cells were refused: repair what is named above; the "
                       "same command then draws only these",
                       work->refused_count, work->plan.row_count * work->plan.column_count);
    if (work->is_image)
        tl_contact_store_remove(&work->store);
    return true;
}

bool tl_command_sheet(const struct tl_arguments *arguments, tl_error *error)
{
    struct work work = {.arguments = arguments};
    bool done = begin(&work, error) && make_cells(&work, error) && finish(&work, error);
    tl_headless_release(&work.headless);
    tl_contact_store_close(&work.store);
    tl_contact_plan_release(&work.plan);
    free(work.folder);
    free(work.refused);
    return done;
}
