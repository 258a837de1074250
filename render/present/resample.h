/* An image of four channels in another size: along x, then along y. Pure.
 *
 * Upwards by Catmull and Rom's cubic through the samples' centres, kept between the two samples that it runs
 * between: edges do not ring, coverage stays in [0, 1] and light stays positive. Downwards by the area that
 * each pixel covers. Premultiplied light and its coverage go through the same weights, so that edges stay
 * edges of the figure. Results do not depend on the number of threads. */
#ifndef TOILE_RENDER_PRESENT_RESAMPLE_H
#define TOILE_RENDER_PRESENT_RESAMPLE_H

struct tl_resample {
    const float *from; /* [from_height][from_width][4] */
    int from_width, from_height;
    float *to; /* [to_height][to_width][4] */
    int to_width, to_height;
};
void tl_resample(const struct tl_resample *resample);

#endif
