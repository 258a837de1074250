#include "cloth/balance/residual.h"

#include "config/base/memory.h"

#include <stdlib.h>

#define STANDARD_GRAVITY 9.81
/* Surfaces are in contact where their distance exceeds what contact keeps by less than this: the plane that
 * stands for the avatar is off its surface by up to 0.07 mm (contact.c). */
#define WITHIN_M 1e-4
/* The residual of a dress of 3,020 vertices changes by less than a hundredth from 100 to 200 sweeps. */
#define SWEEPS 100

/* The acceleration of sum of weights[i] x[v[i]] along `normal` must not be negative. */
struct contact_row {
    uint32_t v[4];
    int count;
    double weights[4];
    vec3d normal;
    double inverse; /* 1/kg, of the point */
    double pressed; /* N, along the normal */
    vec3d friction; /* N, across the normal */
};

struct row_list {
    size_t count, capacity;
    struct contact_row *all;
};

static void add_row(struct row_list *rows, struct contact_row row, const double *w)
{
    for (int i = 0; i < row.count; i++)
        row.inverse += w[row.v[i]] * row.weights[i] * row.weights[i];
    if (!(row.inverse > 0))
        return;
    if (rows->count == rows->capacity) {
        rows->capacity = 2 * rows->capacity + 256;
        rows->all = tl_resize(rows->all, rows->capacity, sizeof *rows->all);
    }
    rows->all[rows->count++] = row;
}

static void add_body(const struct tl_residual_source *source, struct row_list *rows)
{
    const struct tl_contacts *body = source->body;
    const size_t count = source->particles->count;
    for (size_t i = 0; body->collider && i < count + body->sample_count; i++) {
        struct contact_row row = {.v = {(uint32_t)i}, .count = 1, .weights = {1}};
        vec3d x = i < count ? source->particles->x[i] : (vec3d){0};
        struct tl_contact_height height;
        if (i >= count) {
            const struct tl_contact_sample *sample = &body->samples[i - count];
            row.count = 3;
            for (int k = 0; k < 3; k++) {
                row.v[k] = sample->vertices[k];
                row.weights[k] = sample->weights[k];
            }
            x = tl_contact_sample_position(sample, source->particles->x);
        }
        if (!tl_contacts_height(body, i, x, 1, &height) ||
            height.height_m > tl_contacts_share(body, i) * source->thickness_m + WITHIN_M)
            continue;
        row.normal = height.up;
        add_row(rows, row, source->particles->w);
    }
}

static void add_self(const struct tl_residual_source *source, struct row_list *rows)
{
    for (size_t i = 0; source->self && i < source->self->count; i++) {
        const struct tl_self_contact_pair *contact = &source->self->pairs[i];
        struct contact_row row = {.count = 4, .normal = contact->normal};
        vec3d gap = tl_self_contact_between(contact, source->particles->x);
        if (vec3d_dot(gap, contact->normal) > contact->kept + WITHIN_M)
            continue;
        for (int k = 0; k < 4; k++) {
            row.v[k] = contact->v[k];
            row.weights[k] = contact->weights[k];
        }
        add_row(rows, row, source->particles->w);
    }
}

/* One contact of a sweep: the forces it had are corrected by what its point still accelerates, and bounded
 * again. */
static void solve_row(struct contact_row *row, double friction, const double *w, vec3d *accelerations)
{
    vec3d at = {0};
    for (int i = 0; i < row->count; i++)
        at = vec3d_muladd(at, accelerations[row->v[i]], row->weights[i]);
    double along = vec3d_dot(at, row->normal);
    double pressed = fmax(row->pressed - along / row->inverse, 0);
    vec3d slip = vec3d_muladd(at, row->normal, -along);
    vec3d along_surface = vec3d_muladd(row->friction, slip, -1 / row->inverse);
    double length = vec3d_norm(along_surface), bound = friction * pressed;
    if (length > bound)
        along_surface = vec3d_scale(along_surface, bound / length);
    vec3d change = vec3d_sub(along_surface, row->friction);
    change = vec3d_muladd(change, row->normal, pressed - row->pressed);
    row->pressed = pressed;
    row->friction = along_surface;
    for (int i = 0; i < row->count; i++)
        accelerations[row->v[i]] =
            vec3d_muladd(accelerations[row->v[i]], change, w[row->v[i]] * row->weights[i]);
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Summarises free particles, as shares of `gravity`. */
static struct tl_residual summarise(const struct tl_particles *particles, const vec3d *accelerations,
                                    double gravity)
{
    struct tl_residual residual = {0};
    double *sizes = TL_NEW_ARRAY(double, particles->count), squares = 0, bounded = 0;
    size_t count = 0;
    for (size_t i = 0; i < particles->count; i++) {
        if (!(particles->w[i] > 0))
            continue;
        sizes[count] = vec3d_norm(accelerations[i]) / gravity;
        squares += sizes[count] * sizes[count];
        bounded += fmin(sizes[count] * sizes[count], 1);
        count++;
    }
    qsort(sizes, count, sizeof *sizes, compare);
    if (count > 0)
        residual = (struct tl_residual){.rms = sqrt(squares / (double)count),
                                        .high = sizes[(count - 1) * 99 / 100],
                                        .largest = sizes[count - 1],
                                        .bounded_rms = sqrt(bounded / (double)count)};
    free(sizes);
    return residual;
}

struct tl_residual tl_residual_measure(const struct tl_residual_source *source)
{
    const struct tl_particles *particles = source->particles;
    const double gravity = source->gravity;
    struct row_list rows = {0};
    vec3d *accelerations = TL_NEW_ARRAY(vec3d, particles->count);
    for (size_t i = 0; i < particles->count; i++)
        if (particles->w[i] > 0)
            accelerations[i] = vec3d_muladd((vec3d){0, -gravity, 0}, source->forces[i], particles->w[i]);
    add_body(source, &rows);
    add_self(source, &rows);
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (size_t i = 0; i < rows.count; i++)
            solve_row(&rows.all[i], source->friction, particles->w, accelerations);
    struct tl_residual residual =
        summarise(particles, accelerations, gravity != 0 ? fabs(gravity) : STANDARD_GRAVITY);
    free(rows.all);
    free(accelerations);
    return residual;
}
