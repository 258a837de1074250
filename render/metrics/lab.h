/* Colours as CIELAB under D65, and their difference CIEDE2000.
 *
 * Sharma, Wu, Dalal: "The CIEDE2000 color-difference formula: implementation notes, supplementary test data,
 * and mathematical observations", Color Research and Application 30(1), 2005. Pure; threads: any. */
#ifndef TOILE_RENDER_METRICS_LAB_H
#define TOILE_RENDER_METRICS_LAB_H

struct tl_lab {
    double l, a, b; /* l: 0 black to 100 white */
};

/* Of linear Rec. 709; 1, 1, 1 is white. */
struct tl_lab tl_lab_of(const float rgb[3]);

/* About 1 is the smallest difference that is seen side by side; under 2 few buyers object. */
double tl_lab_difference(struct tl_lab p, struct tl_lab q);

#endif
