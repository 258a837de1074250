/* Vectors of three doubles, since the cloth's state is double and cglm's structs are float. Threads: pure. */
#ifndef TOILE_CLOTH_MESH_VEC3D_H
#define TOILE_CLOTH_MESH_VEC3D_H

#include <cglm/struct.h>

#include <math.h>

typedef struct vec3d {
    double x, y, z;
} vec3d;

/* fmin and fmax follow rules for NaN that make them calls; these are one instruction. */
static inline double tl_min(double a, double b)
{
    return a < b ? a : b;
}
static inline double tl_max(double a, double b)
{
    return a > b ? a : b;
}

static inline vec3d vec3d_from(vec3s v)
{
    return (vec3d){(double)v.x, (double)v.y, (double)v.z};
}
static inline vec3s vec3d_to_float(vec3d v)
{
    return (vec3s){{(float)v.x, (float)v.y, (float)v.z}};
}
/* Rounds to single precision, as vertices are drawn. Volatile, because GCC 12 leaves out the conversion to
 * float and back where it vectorises two of them. */
static inline vec3d vec3d_as_drawn(vec3d v)
{
    volatile float x = (float)v.x, y = (float)v.y, z = (float)v.z;
    return (vec3d){(double)x, (double)y, (double)z};
}
static inline vec3d vec3d_add(vec3d a, vec3d b)
{
    return (vec3d){a.x + b.x, a.y + b.y, a.z + b.z};
}
static inline vec3d vec3d_sub(vec3d a, vec3d b)
{
    return (vec3d){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline vec3d vec3d_scale(vec3d a, double s)
{
    return (vec3d){a.x * s, a.y * s, a.z * s};
}
/* a + b s */
static inline vec3d vec3d_muladd(vec3d a, vec3d b, double s)
{
    return (vec3d){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}
static inline double vec3d_dot(vec3d a, vec3d b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline vec3d vec3d_cross(vec3d a, vec3d b)
{
    return (vec3d){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline double vec3d_norm(vec3d a)
{
    return sqrt(vec3d_dot(a, a));
}
static inline double vec3d_distance(vec3d a, vec3d b)
{
    return vec3d_norm(vec3d_sub(a, b));
}
/* `fallback` for a vector too short to have a direction. */
static inline vec3d vec3d_unit_or(vec3d a, vec3d fallback)
{
    double length = vec3d_norm(a);
    return length > 1e-150 ? vec3d_scale(a, 1 / length) : fallback;
}
static inline vec3d vec3d_mix(vec3d a, vec3d b, double t)
{
    return vec3d_muladd(a, vec3d_sub(b, a), t);
}
static inline bool vec3d_finite(vec3d a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

#endif
