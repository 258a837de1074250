#include "cloth/self_contact/affine.h"

/* Points of a fit. */
#define SAMPLES 256
/* Added to the covariance, relative to its trace: flat cloth has no extent across. */
#define REGULARISATION 1e-3
/* Bound of the determinant. */
#define INVERTIBLE 0.1

/* The rows of a symmetric or any other 3x3 matrix's inverse; false if its determinant is below `minimum`. */
static bool invert(const vec3d rows[3], double minimum, vec3d out[3])
{
    vec3d columns[3] = {vec3d_cross(rows[1], rows[2]), vec3d_cross(rows[2], rows[0]),
                        vec3d_cross(rows[0], rows[1])};
    double determinant = vec3d_dot(rows[0], columns[0]);
    if (!(determinant > minimum))
        return false;
    double per = 1 / determinant;
    out[0] = (vec3d){columns[0].x * per, columns[1].x * per, columns[2].x * per};
    out[1] = (vec3d){columns[0].y * per, columns[1].y * per, columns[2].y * per};
    out[2] = (vec3d){columns[0].z * per, columns[1].z * per, columns[2].z * per};
    return true;
}

static vec3d times(const vec3d rows[3], vec3d v)
{
    return (vec3d){vec3d_dot(rows[0], v), vec3d_dot(rows[1], v), vec3d_dot(rows[2], v)};
}

struct tl_affine tl_affine_fit(const vec3d *points, const vec3d *displacements, size_t count)
{
    struct tl_affine affine = {0};
    size_t stride = count / SAMPLES + 1;
    double samples = 0;
    vec3d covariance[3] = {0}, mixed[3] = {0}, inverse[3];
    for (size_t i = 0; i < count; i += stride) {
        affine.centre = vec3d_add(affine.centre, points[i]);
        affine.mean = vec3d_add(affine.mean, displacements[i]);
        samples++;
    }
    if (!(samples > 0))
        return affine;
    affine.centre = vec3d_scale(affine.centre, 1 / samples);
    affine.mean = vec3d_scale(affine.mean, 1 / samples);
    for (size_t i = 0; i < count; i += stride) {
        vec3d at = vec3d_sub(points[i], affine.centre), by = vec3d_sub(displacements[i], affine.mean);
        const double from[3] = {at.x, at.y, at.z}, to[3] = {by.x, by.y, by.z};
        for (int row = 0; row < 3; row++) {
            covariance[row] = vec3d_muladd(covariance[row], at, from[row]);
            mixed[row] = vec3d_muladd(mixed[row], at, to[row]);
        }
    }
    double shift = REGULARISATION * (covariance[0].x + covariance[1].y + covariance[2].z);
    covariance[0].x += shift;
    covariance[1].y += shift;
    covariance[2].z += shift;
    if (!invert(covariance, 0, inverse))
        return affine;
    for (int row = 0; row < 3; row++) /* the inverse is symmetric */
        affine.gradient[row] = times(inverse, mixed[row]);
    return affine;
}

double tl_affine_gradient_norm(const struct tl_affine *affine)
{
    double sum = 0;
    for (int row = 0; row < 3; row++)
        sum += vec3d_dot(affine->gradient[row], affine->gradient[row]);
    return sqrt(sum);
}

struct tl_affine tl_affine_scaled(const struct tl_affine *affine, double t)
{
    struct tl_affine scaled = {.centre = affine->centre, .mean = vec3d_scale(affine->mean, t)};
    for (int row = 0; row < 3; row++)
        scaled.gradient[row] = vec3d_scale(affine->gradient[row], t);
    return scaled;
}

vec3d tl_affine_at(const struct tl_affine *affine, vec3d p)
{
    return vec3d_add(affine->mean, times(affine->gradient, vec3d_sub(p, affine->centre)));
}

vec3d tl_affine_apply(const struct tl_affine *affine, vec3d p)
{
    return vec3d_add(p, tl_affine_at(affine, p));
}

bool tl_affine_invert(const struct tl_affine *affine, struct tl_affine_inverse *inverse)
{
    vec3d rows[3] = {affine->gradient[0], affine->gradient[1], affine->gradient[2]};
    rows[0].x += 1;
    rows[1].y += 1;
    rows[2].z += 1;
    inverse->centre = affine->centre;
    inverse->moved = vec3d_add(affine->centre, affine->mean);
    if (!invert(rows, INVERTIBLE, inverse->rows))
        return false;
    /* The largest eigenvalue of B^T B is at most its largest sum of a row's magnitudes (Gershgorin). */
    const vec3d *b = inverse->rows;
    vec3d columns[3] = {{b[0].x, b[1].x, b[2].x}, {b[0].y, b[1].y, b[2].y}, {b[0].z, b[1].z, b[2].z}};
    double most = 0;
    for (int i = 0; i < 3; i++) {
        double sum = 0;
        for (int k = 0; k < 3; k++)
            sum += fabs(vec3d_dot(columns[i], columns[k]));
        most = tl_max(most, sum);
    }
    inverse->norm = sqrt(most);
    return true;
}
