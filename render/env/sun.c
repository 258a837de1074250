#include "render/env/sun.h"

#include "config/base/memory.h"
#include "config/colour/luminance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The smallest share of all light. A sun that stays in the regions is shadowed by interpolation from vertex
 * to vertex, which cost 13 % of the image where the sun held 65 % of the light (docs/notes/visibility.md, 3).
 * At this share it costs 1 %, compared with about 3 % that interpolated visibility costs anyway. Its own rays
 * take a tenth of the time of a frame. */
#define SHARE_MIN 0.05
/* Largest radius (rad): half of that of the smallest regions (with 384 regions 5.9 degrees). A larger light,
 * such as a soft box, is divided into regions and gets its penumbra from them. */
#define RADIUS_MAX (2.5 * M_PI / 180)
/* Largest angle (rad) between a texel of a sun and its brightest texel. */
#define REACH_MAX (2 * RADIUS_MAX)
/* A patch consists of the texels brighter than its brightest texel divided by one of these depths. The first
 * depth that makes the patch compact is used, so that a glow is left out but the whole disc is included. */
static const float depths[] = {256, 64, 16, 4};
/* Number of points by which a sun's disc is sampled before it is divided into samples. */
#define POINTS_WANTED 4096
/* Largest number of points along a side of a texel, where texels are large. */
#define POINTS_SIDE_MAX 64

struct search {
    tl_cube *cube;
    const tl_environment *environment;
    float *luminance;    /* [6][size][size] */
    float *solid_angles; /* [size][size] */
    double total;        /* integral of the luminance at the start */
    bool *inside;        /* [6][size][size]: of the patch */
    int *patch;          /* its texels */
    int count;
};

/* A point of light within a sun. */
struct sun_point {
    vec3s direction; /* unit */
    float weight;    /* luminance above the surroundings of the sun x solid angle */
    float along;     /* coordinate along the axis of the part that is being divided */
};

struct sun_points {
    struct sun_point *items;
    size_t count, capacity;
};

static double solid_angle(const struct search *search, int texel)
{
    return (double)search->solid_angles[texel % (search->cube->size * search->cube->size)];
}

/* The i-th of the eight texels around one, over the borders of faces too. */
static int neighbour(int size, int texel, int i)
{
    static const int steps[8][2] = {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};
    int line = texel / size;
    return tl_cube_texel_across(size, line / size, texel % size + steps[i][0], line % size + steps[i][1]);
}

static void add_to_patch(struct search *search, int texel)
{
    search->inside[texel] = true;
    search->patch[search->count++] = texel;
}

static void clear_patch(struct search *search)
{
    for (int i = 0; i < search->count; i++)
        search->inside[search->patch[i]] = false;
    search->count = 0;
}

/* Flood fill: the texels connected with `peak` that are at least `min` bright, and one texel around them,
 * into which the averaging of the cube may have spread their light. False when the patch extends too far. */
static bool flood(struct search *search, int peak, float min)
{
    int size = search->cube->size;
    vec3s centre = tl_cube_texel_direction(size, peak);
    clear_patch(search);
    add_to_patch(search, peak);
    for (int next = 0; next < search->count; next++) {
        if (glms_vec3_distance(tl_cube_texel_direction(size, search->patch[next]), centre) > (float)REACH_MAX)
            return false;
        for (int i = 0; i < 8; i++) {
            int texel = neighbour(size, search->patch[next], i);
            if (!search->inside[texel] && search->luminance[texel] >= min)
                add_to_patch(search, texel);
        }
    }
    int bright = search->count;
    for (int next = 0; next < bright; next++)
        for (int i = 0; i < 8; i++) {
            int texel = neighbour(size, search->patch[next], i);
            if (!search->inside[texel])
                add_to_patch(search, texel);
        }
    return true;
}

/* Mean colour of the texels adjacent to the patch. */
static vec3s surroundings(const struct search *search)
{
    double sum[3] = {0};
    int count = 0, size = search->cube->size;
    for (int k = 0; k < search->count; k++) {
        for (int i = 0; i < 8; i++) {
            int texel = neighbour(size, search->patch[k], i);
            if (search->inside[texel])
                continue;
            for (size_t c = 0; c < 3; c++)
                sum[c] += (double)search->cube->texels[3 * (size_t)texel + c];
            count++;
        }
    }
    double share = count > 0 ? 1.0 / count : 0; /* the patch may cover the whole of a small cube */
    return (vec3s){{(float)(sum[0] * share), (float)(sum[1] * share), (float)(sum[2] * share)}};
}

/* Power of the patch above its surroundings. */
static void sum_power(const struct search *search, vec3s around, double power[3])
{
    power[0] = power[1] = power[2] = 0;
    for (int k = 0; k < search->count; k++) {
        const float *colour = search->cube->texels + 3 * (size_t)search->patch[k];
        double area = solid_angle(search, search->patch[k]);
        for (int c = 0; c < 3; c++)
            power[c] += area * ((double)colour[c] - (double)fminf(colour[c], around.raw[c]));
    }
}

/* Direction of the point (x, y) of the environment's image, in texels from the top left corner. `density` is
 * the solid angle (sr) per texel there. */
static vec3s environment_direction(const tl_environment *environment, double x, double y, double *density)
{
    int width = environment->image.width, height = environment->image.height;
    if (environment->layout == TL_ENV_CUBE) {
        int face = (int)(y / width);
        vec3s direction =
            tl_cube_direction(face, (float)(x / width), (float)((y - (double)face * width) / width));
        double length = (double)glms_vec3_norm(direction);
        *density = 4.0 / width / width / (length * length * length);
        return glms_vec3_scale(direction, (float)(1 / length));
    }
    double phi = (x / width - 0.5) * 2 * M_PI, theta = y / height * M_PI;
    *density = 2 * M_PI / width * M_PI / height * sin(theta);
    return (vec3s){{(float)(sin(theta) * sin(phi)), (float)cos(theta), (float)(-sin(theta) * cos(phi))}};
}

static void add_point(struct sun_points *points, vec3s direction, double weight)
{
    if (points->count == points->capacity) {
        points->capacity = points->capacity ? 2 * points->capacity : POINTS_WANTED;
        points->items = tl_resize(points->items, points->capacity, sizeof *points->items);
    }
    points->items[points->count++] = (struct sun_point){.direction = direction, .weight = (float)weight};
}

static double texel_side(const tl_environment *environment)
{
    return environment->layout == TL_ENV_CUBE ? 2.0 / environment->image.width
                                              : M_PI / environment->image.height;
}

static void add_texel(const struct search *search, int x, int y, int side, float excess,
                      struct sun_points *points)
{
    for (int row = 0; row < side; row++) {
        for (int column = 0; column < side; column++) {
            double density;
            vec3s direction = environment_direction(search->environment, x + (column + 0.5) / side,
                                                    y + (row + 0.5) / side, &density);
            if (search->inside[tl_cube_texel(search->cube->size, direction)])
                add_point(points, direction, (double)excess * density / (side * side));
        }
    }
}

/* The range of rows of a lat-long map that may contain the patch around `peak`; all rows of a cube. */
static void find_rows(const tl_environment *environment, vec3s peak, int rows[2])
{
    int height = environment->image.height;
    rows[0] = 0;
    rows[1] = height;
    if (environment->layout == TL_ENV_CUBE)
        return;
    double theta = acos(fmin(fmax((double)peak.y, -1), 1)), reach = REACH_MAX + texel_side(environment);
    rows[0] = (int)fmax((theta - reach) / M_PI * height, 0);
    rows[1] = (int)fmin((theta + reach) / M_PI * height + 1, height);
}

/* Samples the patch in the environment at points that are brighter than the surroundings. */
static struct sun_points collect_points(const struct search *search, vec3s peak, float around)
{
    const tl_environment *environment = search->environment;
    double area = 0, texel = texel_side(environment);
    for (int k = 0; k < search->count; k++)
        area += solid_angle(search, search->patch[k]);
    int side = (int)fmin(ceil(texel / sqrt(area / POINTS_WANTED)), POINTS_SIDE_MAX);
    float reach = (float)(REACH_MAX + 2.0 * 2 / search->cube->size + texel);
    struct sun_points points = {0};
    int rows[2];
    find_rows(environment, peak, rows);
    for (int y = rows[0]; y < rows[1]; y++) {
        const float *row =
            tl_image_floats(&environment->image) + 3 * (size_t)y * (size_t)environment->image.width;
        for (int x = 0; x < environment->image.width; x++) {
            double density;
            float excess = tl_luminance(row + 3 * (size_t)x) - around;
            if (excess > 0 &&
                glms_vec3_distance(environment_direction(environment, x + 0.5, y + 0.5, &density), peak) <
                    reach)
                add_texel(search, x, y, side, excess, &points);
        }
    }
    return points;
}

static vec3s centroid(const struct sun_point *points, size_t count)
{
    double sum[3] = {0};
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            sum[c] += (double)points[i].weight * (double)points[i].direction.raw[c];
    double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    if (!(length > 0))
        return points[0].direction;
    return (vec3s){{(float)(sum[0] / length), (float)(sum[1] / length), (float)(sum[2] / length)}};
}

/* A disc of radius R has a mean square distance of R^2 / 2 from its centre. */
static double radius_of(const struct sun_points *points, vec3s centre)
{
    double squares = 0, weights = 0;
    for (size_t i = 0; i < points->count; i++) {
        double weight = (double)points->items[i].weight;
        squares += weight * (double)glms_vec3_distance2(points->items[i].direction, centre);
        weights += weight;
    }
    return sqrt(2 * squares / weights);
}

static int compare_along(const void *a, const void *b)
{
    float first = ((const struct sun_point *)a)->along, second = ((const struct sun_point *)b)->along;
    return (first > second) - (first < second);
}

/* Sorts the points along the tangent of their largest variance. */
static void sort_along(struct sun_point *points, size_t count)
{
    vec3s centre = centroid(points, count);
    vec3s right = glms_vec3_normalize(glms_vec3_ortho(centre)), up = glms_vec3_cross(centre, right);
    double xx = 0, xy = 0, yy = 0;
    for (size_t i = 0; i < count; i++) {
        vec3s offset = glms_vec3_sub(points[i].direction, centre);
        double x = (double)glms_vec3_dot(offset, right), y = (double)glms_vec3_dot(offset, up);
        double weight = (double)points[i].weight;
        xx += weight * x * x;
        xy += weight * x * y;
        yy += weight * y * y;
    }
    double turn = 0.5 * atan2(2 * xy, xx - yy);
    vec3s axis =
        glms_vec3_add(glms_vec3_scale(right, (float)cos(turn)), glms_vec3_scale(up, (float)sin(turn)));
    for (size_t i = 0; i < count; i++)
        points[i].along = glms_vec3_dot(glms_vec3_sub(points[i].direction, centre), axis);
    qsort(points, count, sizeof *points, compare_along);
}

/* Divides the points into halves of equal weight, recursively, until there are `samples` parts, and returns
 * the centroid of each. The samples of the two halves are interleaved, so that the first few are spread all
 * over the disc. */
static void part(struct sun_point *points, size_t count, int samples, int stride, vec3s *out)
{
    if (samples == 1 || count < 2) {
        for (int i = 0; i < samples; i++)
            out[(size_t)i * (size_t)stride] = centroid(points, count);
        return;
    }
    double total = 0, before = 0;
    sort_along(points, count);
    for (size_t i = 0; i < count; i++)
        total += (double)points[i].weight;
    size_t half = 0;
    while (half + 1 < count && before + 0.5 * (double)points[half].weight < 0.5 * total)
        before += (double)points[half++].weight;
    if (half == 0)
        half = 1;
    part(points, half, samples / 2, 2 * stride, out);
    part(points + half, count - half, samples / 2, 2 * stride, out + stride);
}

static void place_samples(struct sun_points *points, struct tl_sun *sun)
{
    int nearest = 0;
    sun->sample_count = TL_SUN_SAMPLES_MAX;
    part(points->items, points->count, TL_SUN_SAMPLES_MAX, 1, sun->samples);
    for (int i = 1; i < sun->sample_count; i++)
        if (glms_vec3_distance2(sun->samples[i], sun->direction) <
            glms_vec3_distance2(sun->samples[nearest], sun->direction))
            nearest = i;
    vec3s first = sun->samples[0];
    sun->samples[0] = sun->samples[nearest];
    sun->samples[nearest] = first;
}

/* Replaces the patch in the cube by its surroundings. */
static void remove_patch(struct search *search, vec3s around)
{
    for (int k = 0; k < search->count; k++) {
        float *colour = search->cube->texels + 3 * (size_t)search->patch[k];
        for (int c = 0; c < 3; c++)
            colour[c] = fminf(colour[c], around.raw[c]);
        search->luminance[search->patch[k]] = tl_luminance(colour);
    }
}

/* Extracts the patch around `peak` as a sun. False when it is not a sun at this depth. */
static bool extract_sun(struct search *search, int peak, float depth, struct tl_sun *out)
{
    if (!flood(search, peak, search->luminance[peak] / depth))
        return false;
    double power[3];
    vec3s around = surroundings(search);
    sum_power(search, around, power);
    struct tl_sun sun = {.power = {{(float)power[0], (float)power[1], (float)power[2]}}};
    if ((double)tl_luminance(sun.power.raw) < SHARE_MIN * search->total)
        return false;
    struct sun_points points =
        collect_points(search, tl_cube_texel_direction(search->cube->size, peak), tl_luminance(around.raw));
    if (points.count > 0) {
        sun.direction = centroid(points.items, points.count);
        sun.radius = (float)radius_of(&points, sun.direction);
    }
    bool compact = points.count > 0 && (double)sun.radius <= RADIUS_MAX;
    if (compact) {
        place_samples(&points, &sun);
        remove_patch(search, around);
        *out = sun;
    }
    free(points.items);
    return compact;
}

static struct search search_begin(tl_cube *cube, const tl_environment *environment)
{
    size_t count = 6 * (size_t)cube->size * (size_t)cube->size;
    struct search search = {.cube = cube,
                            .environment = environment,
                            .luminance = TL_NEW_ARRAY(float, count),
                            .solid_angles = TL_NEW_ARRAY(float, count / 6),
                            .inside = TL_NEW_ARRAY(bool, count),
                            .patch = TL_NEW_ARRAY(int, count)};
    tl_cube_solid_angles(cube->size, search.solid_angles);
    for (size_t i = 0; i < count; i++) {
        search.luminance[i] = tl_luminance(cube->texels + 3 * i);
        search.total += (double)search.luminance[i] * solid_angle(&search, (int)i);
    }
    return search;
}

static void search_end(struct search *search)
{
    free(search->luminance);
    free(search->solid_angles);
    free(search->inside);
    free(search->patch);
}

/* The brightest texel that was not visited; -1 when no patch of that brightness can hold enough light. */
static int next_peak(const struct search *search, const bool *visited)
{
    int best = -1, count = 6 * search->cube->size * search->cube->size;
    for (int i = 0; i < count; i++)
        if (!visited[i] && (best < 0 || search->luminance[i] > search->luminance[best]))
            best = i;
    if (best < 0 || !(search->total > 0))
        return -1;
    double max = (double)search->luminance[best] * M_PI * REACH_MAX * REACH_MAX;
    return max < SHARE_MIN * search->total ? -1 : best;
}

void tl_suns_extract(tl_cube *cube, const tl_environment *environment, struct tl_suns *out)
{
    struct search search = search_begin(cube, environment);
    bool *visited = TL_NEW_ARRAY(bool, 6 * (size_t)cube->size * (size_t)cube->size);
    *out = (struct tl_suns){0};
    int peak;
    while (out->count < TL_SUNS_MAX && (peak = next_peak(&search, visited)) >= 0) {
        bool taken = false;
        for (size_t i = 0; i < TL_COUNT(depths) && !taken; i++)
            taken = extract_sun(&search, peak, depths[i], &out->items[out->count]);
        out->count += taken;
        /* The patch of the last flood fill is either not a sun or has been extracted. */
        for (int k = 0; k < search.count; k++)
            visited[search.patch[k]] = true;
    }
    free(visited);
    search_end(&search);
}
