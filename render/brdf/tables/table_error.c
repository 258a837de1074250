#include "render/brdf/tables/table_error.h"

#include <math.h>

#define VIEWERS 64 /* cosines, each with 8 azimuths */
#define LIGHTS  16 /* LIGHTS^2 for each viewer: half of them importance sampled, half even */

static struct tl_brdf_frame upright(void)
{
    return tl_brdf_frame_make((vec3s){{0, 0, 1}}, (vec3s){{1, 0, 0}}, 1, 0);
}

static vec3s direction(float cosine, float turns)
{
    float sine = sqrtf(1 - cosine * cosine), azimuth = turns * (float)(2 * M_PI);
    return (vec3s){{sine * cosf(azimuth), sine * sinf(azimuth), cosine}};
}

/* Light i of a viewer. The azimuth is shifted by the golden ratio from viewer to viewer, so that no two
 * viewers use the same lights. */
static vec3s light_of(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v, int i,
                      int viewer)
{
    int row = i / LIGHTS;
    float u1 = ((float)(i % LIGHTS) + 0.5f) / LIGHTS, shift = fmodf((float)viewer * 0.61803399f, 1);
    float u2 = fmodf(((float)row + 0.5f) / LIGHTS + shift, 1), pdf;
    return i % 2 ? direction(u1, u2) : tl_brdf_sample(brdf, frame, v, u1, u2, &pdf);
}

struct error_sums {
    double difference, square; /* sums of squares */
    double table, direct;
};

static void add(struct error_sums *sums, vec3s table, vec3s direct)
{
    sums->difference += (double)glms_vec3_distance2(table, direct);
    sums->square += (double)glms_vec3_norm2(direct);
    sums->table += (double)(table.x + table.y + table.z);
    sums->direct += (double)(direct.x + direct.y + direct.z);
}

static double relative(const struct error_sums *sums)
{
    return sums->square > 0 ? sqrt(sums->difference / sums->square) : 0;
}

static vec3s direct_gloss(const struct tl_brdf *brdf, const struct tl_brdf_table_params *params,
                          const struct tl_brdf_frame *frame, vec3s l, vec3s v)
{
    if (!params->folded)
        return tl_brdf_gloss(brdf, frame, l, v);
    struct tl_brdf white = *brdf;
    white.f0 = (vec3s){{1, 1, 1}};
    white.gloss.fresnel = TL_FRESNEL_SCHLICK; /* Schlick's term is 1 at every angle for f0 = 1 */
    vec3s lobe = tl_brdf_gloss(&white, frame, l, v);
    vec3s diffuse = glms_vec3_scale(params->diffuse, fmaxf(glms_vec3_dot(frame->normal, l), 0) / (float)M_PI);
    return glms_vec3_add(params->ambient,
                         glms_vec3_add(diffuse, glms_vec3_mul(tl_brdf_fresnel(brdf, 1), lobe)));
}

struct tl_table_error tl_brdf_table_error(const struct tl_brdf *brdf,
                                          const struct tl_brdf_table_params *params)
{
    struct tl_brdf_tables tables = tl_brdf_tables_make(brdf, params);
    struct tl_brdf_frame frame = upright();
    struct error_sums steep = {0}, grazing = {0};
    for (int viewer = 0; viewer < VIEWERS * 8; viewer++) {
        int turn = viewer / VIEWERS;
        vec3s v = direction(((float)(viewer % VIEWERS) + 0.5f) / VIEWERS, ((float)turn + 0.3f) / 8);
        for (int i = 0; i < LIGHTS * LIGHTS; i++) {
            vec3s l = light_of(brdf, &frame, v, i, viewer);
            float inputs[TL_AXIS_COUNT];
            tl_brdf_inputs(&frame, l, v, inputs);
            bool low = inputs[TL_AXIS_N_DOT_L] < TL_GRAZING_COSINE || v.z < TL_GRAZING_COSINE;
            if (inputs[TL_AXIS_N_DOT_L] > 0)
                add(low ? &grazing : &steep, tl_brdf_tables_gloss(&tables, inputs),
                    direct_gloss(brdf, params, &frame, l, v));
        }
    }
    struct tl_table_error error = {.steep = relative(&steep),
                                   .grazing = relative(&grazing),
                                   .darkening = grazing.direct > 0 ? 1 - grazing.table / grazing.direct : 0,
                                   .bytes = tl_brdf_tables_bytes(&tables)};
    tl_brdf_tables_release(&tables);
    return error;
}

double tl_brdf_table_ratio(const struct tl_brdf *brdf, const struct tl_brdf_tables *tables, float n_dot_v)
{
    struct tl_brdf_frame frame = upright();
    struct error_sums sums = {0};
    for (int viewer = 0; viewer < 16; viewer++) {
        vec3s v = direction(n_dot_v, ((float)viewer + 0.3f) / 16);
        for (int i = 0; i < LIGHTS * LIGHTS; i++) {
            vec3s l = light_of(brdf, &frame, v, i, viewer);
            float inputs[TL_AXIS_COUNT];
            tl_brdf_inputs(&frame, l, v, inputs);
            add(&sums, tl_brdf_tables_gloss(tables, inputs), tl_brdf_gloss(brdf, &frame, l, v));
        }
    }
    return sums.direct > 0 ? sums.table / sums.direct : 1;
}
