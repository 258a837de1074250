/* UV charts of a mesh, and whether they are its flat pattern.
 *
 * Programs that make garments from patterns (CLO, Marvelous Designer, GarmentCode, toile itself) write each
 * panel as a chart whose UVs are the panel as it was cut, all charts at one scale. GarmentCode then fits the
 * atlas into [0, 1] along u and v apart, so that it has two. Other programs unwrap a shape that was modelled:
 * such charts are stretched here and there, or each has a scale of its own. A chart is a set of triangles
 * that are connected across edges on which they agree about positions and UVs.
 *
 * With s metres per unit of UV and the singular values a, b of the map from UVs to space over a triangle
 * ([Sander et al. 2001] measure the stretch of charts by them), the residual of the triangle is ln(a/s),
 * ln(b/s): 0 for cloth at rest, and nearly the principal strains of cloth that is worn.
 *
 * Metres and units of UV. Lifetime: plain structs that own their arrays. Threads: pure. */
#ifndef TOILE_ASSETS_SEWING_CHARTS_H
#define TOILE_ASSETS_SEWING_CHARTS_H

#include "assets/base/mesh.h"

#include <stdbool.h>

/* Why a chart, or most of a garment, is a pattern or is none; the first that applies. */
enum tl_chart_verdict {
    TL_CHART_IS_PATTERN,
    TL_CHART_IS_UNMAPPED, /* without UVs, or with UVs on a line */
    TL_CHART_IS_RESCALED, /* it has a scale of its own */
    TL_CHART_IS_FOLDED,   /* it lies upon itself */
    TL_CHART_IS_STRETCHED /* unevenly: its residual is too large */
};
/* The bounds. */
#define TL_CHART_UNMAPPED  0.02 /* of the area */
#define TL_CHART_RESCALED  0.1  /* mean of the residual's logarithms */
#define TL_CHART_FOLDED    0.02 /* of the area */
#define TL_CHART_RESIDUAL  0.07 /* worn patterns have 0.01 to 0.03, unwrapped suits 0.08 to 0.22 */
#define TL_CHART_STRETCHED 0.1  /* a logarithm that is counted as stretched; reported, not judged */

struct tl_chart {
    double area;            /* m^2, in space */
    double residual;        /* root mean square of both logarithms, weighted by area; each at most ln 2 */
    double log_scale;       /* mean of both logarithms */
    double stretched_share; /* of the area: with a logarithm beyond TL_CHART_STRETCHED */
    double folded_share;    /* of the area: faces the other way than most of the chart */
    double unmapped_share;  /* of the area */
    bool mirrored;          /* shows the cloth's back */
    enum tl_chart_verdict verdict;
};

struct tl_charts {
    size_t count, triangle_count;
    struct tl_chart *items;    /* [count], in order of their first triangle */
    uint32_t *of_triangle;     /* [triangle_count] chart of each */
    double metres_per_unit[2]; /* of u and v; 0: nothing is mapped */
    struct tl_chart whole;     /* the same measures of all together; `mirrored` has no meaning */
    double pattern_share;      /* of the area: charts that are a pattern; the whole is one from a half on */
    double pattern_residual;   /* of those charts together */
    size_t pattern_count, mirrored_count;
};

/* Finds the charts, fits the scale of all of them, and judges each. */
struct tl_charts tl_charts_find(const tl_mesh *mesh);
void tl_charts_release(struct tl_charts *charts);

#endif
