#include "cloth/contact/sample.h"

#include "config/base/memory.h"

static double rest_length(const vec2s rest[3], int corner)
{
    return (double)glms_vec2_distance(rest[(corner + 1) % 3], rest[(corner + 2) % 3]);
}

/* The samples of one triangle; an edge is sampled by its first triangle only. */
static size_t probe_triangle(const struct tl_topology *topology, const vec2s (*rest)[3], uint32_t triangle,
                             double coarse_m, struct tl_contact_sample *out)
{
    size_t count = 0;
    const uint32_t *v = topology->triangles[triangle];
    double longest = 0;
    for (int corner = 0; corner < 3; corner++) {
        double length = rest_length(rest[triangle], corner);
        longest = fmax(longest, length);
        bool first = topology->neighbour[triangle][corner] > triangle; /* also if there is none */
        if (length > coarse_m && first)
            out[count++] = (struct tl_contact_sample){{v[(corner + 1) % 3], v[(corner + 2) % 3], v[corner]},
                                                      {0.5, 0.5, 0}};
    }
    if (longest > coarse_m)
        out[count++] = (struct tl_contact_sample){{v[0], v[1], v[2]}, {1.0 / 3, 1.0 / 3, 1.0 / 3}};
    return count;
}

struct tl_contact_sample *tl_contact_samples_create(const struct tl_topology *topology,
                                                    const vec2s (*rest)[3], double coarse_m, size_t *count)
{
    struct tl_contact_sample *samples = TL_NEW_ARRAY(struct tl_contact_sample, 4 * topology->triangle_count);
    *count = 0;
    for (size_t t = 0; t < topology->triangle_count; t++)
        *count += probe_triangle(topology, rest, (uint32_t)t, coarse_m, &samples[*count]);
    return samples;
}

vec3d tl_contact_sample_position(const struct tl_contact_sample *sample, const vec3d *x)
{
    vec3d sum = vec3d_scale(x[sample->vertices[0]], sample->weights[0]);
    sum = vec3d_muladd(sum, x[sample->vertices[1]], sample->weights[1]);
    return vec3d_muladd(sum, x[sample->vertices[2]], sample->weights[2]);
}

double tl_contact_sample_inverse_mass(const struct tl_contact_sample *sample, const double *w)
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += w[sample->vertices[i]] * sample->weights[i] * sample->weights[i];
    return sum;
}

void tl_contact_sample_push(const struct tl_contact_sample *sample, vec3d push, const double *w, vec3d *x)
{
    for (int i = 0; i < 3; i++) {
        uint32_t v = sample->vertices[i];
        x[v] = vec3d_muladd(x[v], push, w[v] * sample->weights[i]);
    }
}
