#include "cloth/tangents/tangent_frames.h"

#include "cloth/tangents/tangent_layout.h"
#include "config/base/memory.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LANES TL_LANES

tl_tangent_frames *tl_tangent_frames_create(const tl_mesh *mesh, const uint32_t *weld)
{
    tl_tangent_frames *frames = TL_NEW(tl_tangent_frames);
    struct tl_tangent_groups groups = tl_tangent_groups_build(mesh, weld);
    tl_tangent_frames_lay_out(frames, &groups);
    tl_tangent_groups_release(&groups);
    return frames;
}

void tl_tangent_frames_destroy(tl_tangent_frames **frames)
{
    tl_tangent_frames *f = *frames;
    if (!f)
        return;
    free(f->blocks);
    free(f->rows);
    free(f->gradients);
    free(f->outputs);
    free(f->lenders);
    free(f->states);
    free(f);
    *frames = NULL;
}

/* ---- Spokes ---- */

#define KEPT 16 /* spokes in registers and cache at a time: few vertices have more */

/* One block of fans, and the positions of all vertices. */
struct fans {
    const uint32_t (*centres)[LANES], (*spokes)[LANES];
    const float (*gradients)[2][LANES];
    size_t spoke_count;
    const vec3s *positions;
};

TL_INLINE struct fans fans_of(const tl_tangent_frames *frames, size_t block, const vec3s *positions)
{
    const struct tl_tangent_block *b = &frames->blocks[block];
    const uint32_t(*rows)[LANES] = (const uint32_t(*)[LANES])frames->rows + b->first_row;
    const float(*gradients)[2][LANES] = (const float(*)[2][LANES])frames->gradients + b->first_gradient;
    return (struct fans){rows, rows + 1, gradients, b->spoke_count, positions};
}

/* Edges from each lane's vertex, metres: LANES of one spoke, then those of the next. */
struct edges {
    float x[KEPT * LANES], y[KEPT * LANES], z[KEPT * LANES];
};

/* Fetches the edges to spokes `first` to first + KEPT - 1; returns how many there are. Copying whole vertices
 * and then separating coordinates in one long loop is twice as fast as hardware gathers. */
TL_INLINE size_t fetch_edges(const struct fans *fans, size_t first, struct edges *out)
{
    size_t count = fans->spoke_count - first < KEPT ? fans->spoke_count - first : KEPT;
    vec3s places[KEPT * LANES];
    for (size_t k = 0; k < count; k++)
        for (size_t i = 0; i < LANES; i++)
            places[k * LANES + i] = fans->positions[fans->spokes[first + k][i]];
    for (size_t i = 0; i < count * LANES; i++) {
        /* cppcheck-suppress uninitvar; the loop above has filled count * LANES places */
        out->x[i] = places[i].x;
        out->y[i] = places[i].y;
        out->z[i] = places[i].z;
    }
    float centres[3][LANES];
    for (int i = 0; i < LANES; i++)
        for (int c = 0; c < 3; c++)
            centres[c][i] = fans->positions[fans->centres[0][i]].raw[c];
    for (size_t k = 0; k < count; k++)
        for (size_t i = 0; i < LANES; i++) {
            out->x[k * LANES + i] -= centres[0][i];
            out->y[k * LANES + i] -= centres[1][i];
            out->z[k * LANES + i] -= centres[2][i];
        }
    return count;
}

/* ---- Sums over corners ---- */

/* m^2, far below the rounding error of a garment triangle's area: keeps divisors above 0. */
#define NOTHING 1e-18f

/* atan2(sine, cosine) / length for sine > 0: the angle at a corner over the length of the vector that it
 * weights. The angle is within 2e-7 rad: the polynomial interpolates atan(x) / x at the Chebyshev nodes of
 * x^2. */
TL_INLINE float angle_over(float sine, float cosine, float length)
{
    float adjacent = fabsf(cosine);
    float low = tl_minf(sine, adjacent), high = tl_maxf(sine, adjacent);
    float x = low / high, y = x * x;
    float series = 0.0986886546f + y * (-0.0588297531f + y * (0.0237805186f - 0.00455979199f * y));
    series = -0.333318127f + y * (0.199669618f + y * (-0.140032902f + y * series));
    float angle = x * (0.999999882f + y * series);
    angle = sine > adjacent ? (float)M_PI_2 - angle : angle;
    angle = cosine < 0 ? (float)M_PI - angle : angle;
    return angle / length;
}

/* Unit normals of triangles, times their angles. */
TL_INLINE void add_normals(const struct edges *edges, size_t count, float sum[3][LANES])
{
    for (size_t k = 0; k + 1 < count; k++)
        for (int i = 0; i < LANES; i++) {
            const size_t a = k * LANES + (size_t)i, b = a + LANES;
            float ax = edges->x[a], ay = edges->y[a], az = edges->z[a];
            float bx = edges->x[b], by = edges->y[b], bz = edges->z[b];
            float x = ay * bz - az * by, y = az * bx - ax * bz, z = ax * by - ay * bx;
            float area = sqrtf(x * x + y * y + z * z + NOTHING * NOTHING);
            float weight = angle_over(area, ax * bx + ay * by + az * bz, area);
            sum[0][i] += x * weight;
            sum[1][i] += y * weight;
            sum[2][i] += z * weight;
        }
}

/* Two directions across a normal. */
struct planes {
    float u[3][LANES], v[3][LANES];
};

/* In coordinates of the plane: unit tangents of triangles, times the angles between their edges. */
TL_INLINE void add_tangents(const struct edges *edges, size_t count, const float (*gradients)[2][LANES],
                            const struct planes *planes, float sum[2][LANES])
{
    float across[2][LANES];
    for (size_t k = 0; k < count; k++)
        for (int i = 0; i < LANES; i++) {
            const size_t b = k * LANES + (size_t)i;
            float x = edges->x[b], y = edges->y[b], z = edges->z[b];
            float bu = x * planes->u[0][i] + y * planes->u[1][i] + z * planes->u[2][i];
            float bv = x * planes->v[0][i] + y * planes->v[1][i] + z * planes->v[2][i];
            if (k > 0) {
                float au = across[0][i], av = across[1][i];
                float first = gradients[k - 1][0][i], second = gradients[k - 1][1][i];
                float u = au * first + bu * second, v = av * first + bv * second;
                float length = sqrtf(u * u + v * v + NOTHING * NOTHING);
                float weight = angle_over(fabsf(au * bv - av * bu) + NOTHING, au * bu + av * bv, length);
                sum[0][i] += u * weight;
                sum[1][i] += v * weight;
            }
            across[0][i] = bu;
            across[1][i] = bv;
        }
}

/* ---- Blocks ---- */

/* Squared sums of unit vectors that cancel to their rounding. */
#define OPPOSING 1e-8f

/* 1 if a sum has a direction (NaN has none), else 0: a number, because a branch would prevent vectorisation.
 */
TL_INLINE float has_direction(float squared)
{
    float above = squared > OPPOSING ? 1.0f : 0.0f;
    return squared < FLT_MAX ? above : 0.0f;
}

/* Normals without a direction stay as they were. */
TL_INLINE void finish_normals(const float sum[3][LANES], float normal[3][LANES])
{
    float last[3][LANES]; /* a copy: lanes stay together only if nothing overlaps */
    memcpy(last, normal, sizeof last);
    for (int i = 0; i < LANES; i++) {
        float squared = sum[0][i] * sum[0][i] + sum[1][i] * sum[1][i] + sum[2][i] * sum[2][i];
        float inverse = 1 / sqrtf(squared), summed = has_direction(squared);
        normal[0][i] = summed > 0 ? sum[0][i] * inverse : last[0][i];
        normal[1][i] = summed > 0 ? sum[1][i] * inverse : last[1][i];
        normal[2][i] = summed > 0 ? sum[2][i] * inverse : last[2][i];
    }
}

/* Completes a unit vector to a basis [Duff et al. 2017]. */
TL_INLINE void find_planes(const float normal[3][LANES], struct planes *planes)
{
    for (int i = 0; i < LANES; i++) {
        float x = normal[0][i], y = normal[1][i], z = normal[2][i];
        float sign = z < 0 ? -1.0f : 1.0f, a = -1 / (sign + z), b = x * y * a;
        planes->u[0][i] = 1 + sign * x * x * a;
        planes->u[1][i] = sign * b;
        planes->u[2][i] = -sign * x;
        planes->v[0][i] = b;
        planes->v[1][i] = sign + y * y * a;
        planes->v[2][i] = -y;
    }
}

/* Tangents without a direction keep the last one, as far as it lies across the normal, or take any. */
TL_INLINE void finish_tangents(const float sum[2][LANES], const struct planes *planes,
                               float tangent[3][LANES])
{
    for (int i = 0; i < LANES; i++) {
        float last_u = tangent[0][i] * planes->u[0][i] + tangent[1][i] * planes->u[1][i] +
                       tangent[2][i] * planes->u[2][i];
        float last_v = tangent[0][i] * planes->v[0][i] + tangent[1][i] * planes->v[1][i] +
                       tangent[2][i] * planes->v[2][i];
        float kept = has_direction(last_u * last_u + last_v * last_v);
        last_u = kept > 0 ? last_u : 1.0f;
        last_v = kept > 0 ? last_v : 0.0f;
        float summed = has_direction(sum[0][i] * sum[0][i] + sum[1][i] * sum[1][i]);
        float u = summed > 0 ? sum[0][i] : last_u, v = summed > 0 ? sum[1][i] : last_v;
        float inverse = 1 / sqrtf(u * u + v * v);
        u *= inverse;
        v *= inverse;
        tangent[0][i] = planes->u[0][i] * u + planes->v[0][i] * v;
        tangent[1][i] = planes->u[1][i] * u + planes->v[1][i] * v;
        tangent[2][i] = planes->u[2][i] * u + planes->v[2][i] * v;
    }
}

TL_INLINE void write_outputs(const tl_tangent_frames *frames, size_t index, vec3s *normals, vec4s *tangents)
{
    const struct tl_tangent_state *state = &frames->states[index];
    for (uint32_t o = frames->blocks[index].first_output; o < frames->blocks[index + 1].first_output; o++) {
        uint32_t vertex = frames->outputs[o].vertex, i = frames->outputs[o].lane;
        normals[vertex] = (vec3s){{state->normal[0][i], state->normal[1][i], state->normal[2][i]}};
        tangents[vertex] =
            (vec4s){{state->tangent[0][i], state->tangent[1][i], state->tangent[2][i], state->sign[i]}};
    }
}

TL_INLINE void borrow_normals(const tl_tangent_frames *frames, const uint32_t lenders[LANES],
                              float normal[3][LANES])
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++)
            normal[c][i] = frames->states[lenders[i] / LANES].normal[c][lenders[i] % LANES];
}

/* Prefetches what the next block reads in sequence; large meshes would otherwise wait for memory a third of
 * the time. */
TL_INLINE void prefetch_block(const tl_tangent_frames *frames, size_t index)
{
    if (index >= frames->block_count)
        return;
    struct fans fans = fans_of(frames, index, NULL);
    size_t count = fans.spoke_count < KEPT ? fans.spoke_count : KEPT;
    for (size_t k = 0; k < count; k++) {
        __builtin_prefetch(fans.spokes[k]);
        if (k + 1 < fans.spoke_count) {
            __builtin_prefetch(fans.gradients[k][0]);
            __builtin_prefetch(fans.gradients[k][1]);
        }
    }
    for (int c = 0; c < 3; c++) {
        __builtin_prefetch(frames->states[index].normal[c]);
        __builtin_prefetch(frames->states[index].tangent[c]);
    }
}

/* Updates one block: normals first, since tangents are projected on their planes. Fans of more than KEPT
 * spokes are processed in pieces, each beginning with the last spoke of the one before. */
TL_CLONES static void update_block(tl_tangent_frames *frames, size_t index, const vec3s *positions,
                                   vec3s *normals, vec4s *tangents)
{
    struct fans fans = fans_of(frames, index, positions);
    struct tl_tangent_state *state = &frames->states[index];
    struct edges edges;
    size_t normal_blocks = frames->block_count - frames->borrower_count, count = 0;
    prefetch_block(frames, index + 1);
    if (index < normal_blocks) {
        float sum[3][LANES] = {{0}};
        for (size_t first = 0; first + 1 < fans.spoke_count; first += KEPT - 1) {
            count = fetch_edges(&fans, first, &edges);
            add_normals(&edges, count, sum);
        }
        finish_normals(sum, state->normal);
    } else {
        borrow_normals(frames, frames->lenders[index - normal_blocks], state->normal);
    }
    struct planes planes;
    find_planes(state->normal, &planes);
    float sum[2][LANES] = {{0}};
    for (size_t first = 0; first + 1 < fans.spoke_count; first += KEPT - 1) {
        if (count != fans.spoke_count) /* what is left there is not the whole fan */
            count = fetch_edges(&fans, first, &edges);
        add_tangents(&edges, count, fans.gradients + first, &planes, sum);
    }
    finish_tangents(sum, &planes, state->tangent);
    write_outputs(frames, index, normals, tangents);
}

void tl_tangent_frames_reset(tl_tangent_frames *frames)
{
    for (size_t b = 0; b < frames->block_count; b++) {
        struct tl_tangent_state *state = &frames->states[b];
        memset(state->normal, 0, sizeof state->normal);
        memset(state->tangent, 0, sizeof state->tangent);
        for (size_t lane = 0; lane < LANES; lane++)
            state->normal[1][lane] = 1;
    }
}

#define WORTH_THREADS 256 /* blocks: fewer are done before another thread wakes */

/* Borrowers last: their normals must be there. Blocks write what no other block reads or writes. */
void tl_tangent_frames_update(tl_tangent_frames *frames, const vec3s *positions, vec3s *normals,
                              vec4s *tangents)
{
    size_t normal_blocks = frames->block_count - frames->borrower_count;
#pragma omp parallel for schedule(static) if (normal_blocks > WORTH_THREADS)
    for (size_t b = 0; b < normal_blocks; b++)
        update_block(frames, b, positions, normals, tangents);
#pragma omp parallel for schedule(static) if (frames->borrower_count > WORTH_THREADS)
    for (size_t b = normal_blocks; b < frames->block_count; b++)
        update_block(frames, b, positions, normals, tangents);
}
