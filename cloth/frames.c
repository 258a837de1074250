#include "cloth/frames.h"

#include "cloth/frames_lay.h"
#include "config/memory.h"
#include "config/simd.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#define LANES TL_FRAME_LANES

tl_frames *tl_frames_create(const tl_mesh *mesh, const uint32_t *weld)
{
    tl_frames *frames = TL_NEW(tl_frames);
    struct tl_frame_groups groups = tl_frame_groups_build(mesh, weld);
    tl_frames_lay(frames, &groups);
    tl_frame_groups_release(&groups);
    return frames;
}

void tl_frames_destroy(tl_frames **frames)
{
    tl_frames *f = *frames;
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

#define KEPT 16 /* spokes held at a time: few vertices have more */

/* Edges from each lane's vertex, metres. */
struct spokes {
    float x[KEPT][LANES], y[KEPT][LANES], z[KEPT][LANES];
};

TL_INLINE void fetch_spokes(const uint32_t (*rows)[LANES], const vec3s centres[LANES], size_t count,
                            const vec3s *positions, struct spokes *out)
{
    vec3s places[KEPT][LANES];
    for (size_t k = 0; k < count; k++)
        for (int i = 0; i < LANES; i++)
            places[k][i] = positions[rows[k][i]];
    for (size_t k = 0; k < count; k++)
        for (int i = 0; i < LANES; i++) {
            out->x[k][i] = places[k][i].x - centres[i].x;
            out->y[k][i] = places[k][i].y - centres[i].y;
            out->z[k][i] = places[k][i].z - centres[i].z;
        }
}

/* ---- Sums over corners ---- */

/* Below this, squared, an edge or an area has no direction; products of two stay normal numbers. */
#define NO_LENGTH 1e-18f

/* atan2(sine, cosine) / length, for sine >= 0 and length >= NO_LENGTH, with one division: the angle at a
 * corner over the length of what it weighs. The angle is within 3e-6 rad: the polynomial meets atan at
 * Chebyshev's nodes of x^2. */
TL_INLINE float angle_over(float sine, float cosine, float length)
{
    float beside = fabsf(cosine);
    float low = tl_lesser(sine, beside), high = tl_greater(sine, beside) + NO_LENGTH;
    float inverse = 1 / (high * length);
    float x = low * length * inverse, y = x * x;
    float series = 0.19534659f + y * (-0.120448585f + y * (0.0565899852f - 0.0131303821f * y));
    float angle = x * (0.999994835f + y * (-0.33295711f + y * series));
    angle = sine > beside ? (float)M_PI_2 - angle : angle;
    angle = cosine < 0 ? (float)M_PI - angle : angle;
    return angle * high * inverse;
}

/* Unit normals of triangles, times their angles. */
TL_INLINE void add_normals(const struct spokes *spokes, size_t count, float sum[3][LANES])
{
    for (size_t k = 0; k + 1 < count; k++)
        for (int i = 0; i < LANES; i++) {
            float ax = spokes->x[k][i], ay = spokes->y[k][i], az = spokes->z[k][i];
            float bx = spokes->x[k + 1][i], by = spokes->y[k + 1][i], bz = spokes->z[k + 1][i];
            float x = ay * bz - az * by, y = az * bx - ax * bz, z = ax * by - ay * bx;
            float area = sqrtf(x * x + y * y + z * z + NO_LENGTH * NO_LENGTH);
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
TL_INLINE void add_tangents(const struct spokes *spokes, size_t count, const float (*gradients)[2][LANES],
                            const struct planes *planes, float sum[2][LANES])
{
    float across[2][LANES];
    for (size_t k = 0; k < count; k++)
        for (int i = 0; i < LANES; i++) {
            float x = spokes->x[k][i], y = spokes->y[k][i], z = spokes->z[k][i];
            float bu = x * planes->u[0][i] + y * planes->u[1][i] + z * planes->u[2][i];
            float bv = x * planes->v[0][i] + y * planes->v[1][i] + z * planes->v[2][i];
            if (k > 0) {
                float au = across[0][i], av = across[1][i];
                float first = gradients[k - 1][0][i], second = gradients[k - 1][1][i];
                float u = au * first + bu * second, v = av * first + bv * second;
                float length = sqrtf(u * u + v * v + NO_LENGTH * NO_LENGTH);
                float weight = angle_over(fabsf(au * bv - av * bu), au * bu + av * bv, length);
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

TL_INLINE bool has_direction(float squared)
{
    return squared > OPPOSING && squared < FLT_MAX; /* neither for NaN */
}

TL_INLINE void finish_normals(const float sum[3][LANES], float normal[3][LANES])
{
    for (int i = 0; i < LANES; i++) {
        float squared = sum[0][i] * sum[0][i] + sum[1][i] * sum[1][i] + sum[2][i] * sum[2][i];
        float inverse = 1 / sqrtf(squared);
        for (int c = 0; c < 3; c++)
            normal[c][i] = has_direction(squared) ? sum[c][i] * inverse : normal[c][i];
    }
}

/* Duff et al. 2017, "Building an Orthonormal Basis, Revisited". */
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
        float u = sum[0][i], v = sum[1][i];
        float last_u = tangent[0][i] * planes->u[0][i] + tangent[1][i] * planes->u[1][i] +
                       tangent[2][i] * planes->u[2][i];
        float last_v = tangent[0][i] * planes->v[0][i] + tangent[1][i] * planes->v[1][i] +
                       tangent[2][i] * planes->v[2][i];
        bool summed = has_direction(u * u + v * v), kept = has_direction(last_u * last_u + last_v * last_v);
        u = summed ? u : kept ? last_u : 1;
        v = summed ? v : kept ? last_v : 0;
        float inverse = 1 / sqrtf(u * u + v * v);
        u *= inverse;
        v *= inverse;
        for (int c = 0; c < 3; c++)
            tangent[c][i] = planes->u[c][i] * u + planes->v[c][i] * v;
    }
}

TL_INLINE void write_outputs(const tl_frames *frames, size_t index, vec3s *normals, vec4s *tangents)
{
    const struct tl_frame_state *state = &frames->states[index];
    for (uint32_t o = frames->blocks[index].first_output; o < frames->blocks[index + 1].first_output; o++) {
        uint32_t vertex = frames->outputs[o].vertex, i = frames->outputs[o].lane;
        normals[vertex] = (vec3s){{state->normal[0][i], state->normal[1][i], state->normal[2][i]}};
        tangents[vertex] =
            (vec4s){{state->tangent[0][i], state->tangent[1][i], state->tangent[2][i], state->sign[i]}};
    }
}

TL_INLINE void borrow_normals(const tl_frames *frames, const uint32_t lenders[LANES], float normal[3][LANES])
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < LANES; i++)
            normal[c][i] = frames->states[lenders[i] / LANES].normal[c][lenders[i] % LANES];
}

/* One block. Fans of more than KEPT spokes are fetched piece by piece, each piece from the last spoke of the
 * one before. */
TL_CLONES static void update_block(tl_frames *frames, size_t index, const vec3s *positions, vec3s *normals,
                                   vec4s *tangents)
{
    const struct tl_frame_block *block = &frames->blocks[index];
    struct tl_frame_state *state = &frames->states[index];
    const uint32_t(*rows)[LANES] = (const uint32_t(*)[LANES])frames->rows + block->first_row;
    const float(*gradients)[2][LANES] = (const float(*)[2][LANES])frames->gradients + block->first_gradient;
    size_t lending = frames->block_count - frames->borrower_count, count = block->spoke_count;
    size_t piece = count < KEPT ? count : KEPT;
    vec3s centres[LANES];
    for (int i = 0; i < LANES; i++)
        centres[i] = positions[rows[0][i]];
    struct spokes spokes;
    fetch_spokes(rows + 1, centres, piece, positions, &spokes);
    if (index < lending) {
        float sum[3][LANES] = {{0}};
        add_normals(&spokes, piece, sum);
        for (size_t first = KEPT - 1; first + 1 < count; first += KEPT - 1) {
            size_t more = count - first < KEPT ? count - first : KEPT;
            fetch_spokes(rows + 1 + first, centres, more, positions, &spokes);
            add_normals(&spokes, more, sum);
        }
        finish_normals(sum, state->normal);
        if (count > KEPT)
            fetch_spokes(rows + 1, centres, piece, positions, &spokes);
    } else {
        borrow_normals(frames, frames->lenders[index - lending], state->normal);
    }
    struct planes planes;
    find_planes(state->normal, &planes);
    float sum[2][LANES] = {{0}};
    add_tangents(&spokes, piece, gradients, &planes, sum);
    for (size_t first = KEPT - 1; first + 1 < count; first += KEPT - 1) {
        size_t more = count - first < KEPT ? count - first : KEPT;
        fetch_spokes(rows + 1 + first, centres, more, positions, &spokes);
        add_tangents(&spokes, more, gradients + first, &planes, sum);
    }
    finish_tangents(sum, &planes, state->tangent);
    write_outputs(frames, index, normals, tangents);
}

void tl_frames_update(tl_frames *frames, const vec3s *positions, vec3s *normals, vec4s *tangents)
{
    size_t lending = frames->block_count - frames->borrower_count;
#pragma omp parallel for schedule(static)
    for (size_t b = 0; b < lending; b++)
        update_block(frames, b, positions, normals, tangents);
#pragma omp parallel for schedule(static)
    for (size_t b = lending; b < frames->block_count; b++)
        update_block(frames, b, positions, normals, tangents);
}
