// Places in a table of lobe sets (lobe_set_table.h), for GLSL and C.
#ifndef TERM
#define TERM
#endif

#define TL_LOBE_SET_AZIMUTHS 49 // over half a turn: the fit is the same seen from the other side, mirrored
#define TL_LOBE_SET_COSINES 49
#define TL_LOBE_SET_GLOSSES 9
#define TL_LOBE_SET_ROWS  48.02f // TL_LOBE_SET_COSINES - .98
#define TL_LOBE_SET_FIRST 0.02f
// Schlick's term is affine in F0 from here on; below, a reflectance is in proportion to this one (facets_terms.glsl).
#define TL_LOBE_SET_LOW_F0 0.02f

// atan2 over [0, pi], y >= 0, within 2e-5 rad: a minimax polynomial of atan over [0, 1].
TERM float lobe_set_angle(float x, float y)
{
    float along = abs(x), maximum = max(max(along, y), 1e-30f);
    float q = min(along, y) / maximum, square = q * q;
    float series = -0.11643287f + square * (0.05265332f - 0.01172120f * square);
    float angle = q * (0.99997726f + square * (-0.33262347f + square * (0.19354346f + square * series)));
    angle = y > along ? 1.57079633f - angle : angle;
    return x < 0.0f ? 3.14159265f - angle : angle;
}

// The column of a viewer (x, y >= 0) in the frame of the threads.
TERM float lobe_set_column(float x, float y)
{
    return lobe_set_angle(x, y) * ((float(TL_LOBE_SET_AZIMUTHS) - 1.0f) / 3.14159265f);
}

// The row by the cosine to the normal. Towards a grazing viewer the fit changes quickly: elevations, as shares of a right
// angle, are squared distances from there.
TERM float lobe_set_row(float cosine)
{
    float sine = sqrt(max(1.0f - cosine * cosine, 0.0f)), elevation = lobe_set_angle(sine, cosine) * (2.0f / 3.14159265f);
    return sqrt(elevation) * TL_LOBE_SET_ROWS - TL_LOBE_SET_FIRST;
}

// The shares of a lobe's weights at the low and at the high F0.
TERM float lobe_set_high_share(float f0)
{
    return max((f0 - TL_LOBE_SET_LOW_F0) * (1.0f / (1.0f - TL_LOBE_SET_LOW_F0)), 0.0f);
}

TERM float lobe_set_low_share(float f0)
{
    return f0 < TL_LOBE_SET_LOW_F0 ? f0 * (1.0f / TL_LOBE_SET_LOW_F0) : 1.0f - lobe_set_high_share(f0);
}

// A place between nodes: the first of two, and the share of the second.
struct LobeSetBetween {
    int first;
    float share;
};

TERM LobeSetBetween lobe_set_between(float at, int count)
{
    float within = min(max(at, 0.0f), float(count - 1));
    int first = int(within), last = count > 1 ? count - 2 : 0;
    LobeSetBetween between;
    between.first = first < last ? first : last;
    between.share = within - float(between.first);
    return between;
}

// The place at which a table is read.
struct LobeSetPlace {
    LobeSetBetween row, column, gloss;
    float side; // 1 or -1, a factor on the x and y of directions: the frame is turned where y < 0
};

// The place of a viewer (x, y, cosine > 0) in the frame of the threads. `low`, `high`: glossiness at both ends of `count`.
TERM LobeSetPlace lobe_set_place(float x, float y, float cosine, float glossiness, float low, float high, int count)
{
    float along = count > 1 ? (glossiness - low) / (high - low) * float(count - 1) : 0.0f;
    LobeSetPlace at;
    at.side = y < 0.0f ? -1.0f : 1.0f;
    at.column = lobe_set_between(lobe_set_column(at.side * x, at.side * y), TL_LOBE_SET_AZIMUTHS);
    at.row = lobe_set_between(lobe_set_row(cosine), TL_LOBE_SET_COSINES);
    at.gloss = lobe_set_between(along, count);
    return at;
}
