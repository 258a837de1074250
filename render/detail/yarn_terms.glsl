// How bright yarns are that differ from one another, written once for GLSL and C (yarns.h): the common subset of both.
// Tables hold the sums of the deviations of yarns 0, 1, ..., which return to 0 at their end; yarn_sum reads one.
#ifndef TERM
#define TERM
#endif
#ifndef YARN_TABLES
#define YARN_TABLES
#define YARN_TABLES_IN
#endif

// The sum up to position x, in yarns, of a table that repeats after `count`.
TERM float yarn_up_to(YARN_TABLES_IN float first, float count, float x)
{
    float at = x - count * floor(x / count), entry = min(floor(at), count - 1.0f);
    float low = yarn_sum(YARN_TABLES first + entry);
    return low + (at - entry) * (yarn_sum(YARN_TABLES first + entry + 1.0f) - low);
}

// The mean over `width` yarns about x, at least one.
TERM float yarn_mean(YARN_TABLES_IN float first, float count, float x, float width)
{
    float wide = max(width, 1.0f);
    return (yarn_up_to(YARN_TABLES first, count, x + 0.5f * wide) - yarn_up_to(YARN_TABLES first, count, x - 0.5f * wide)) /
           wide;
}

// The factor on a cloth's colour at warp yarn x, weft yarn y, both in yarns, averaged over a sample.
TERM float yarn_factor(YARN_TABLES_IN float warps, float wefts, float x, float y, float across_x, float across_y)
{
    return (1.0f + yarn_mean(YARN_TABLES 0.0f, warps, x, across_x)) *
           (1.0f + yarn_mean(YARN_TABLES warps + 1.0f, wefts, y, across_y));
}
