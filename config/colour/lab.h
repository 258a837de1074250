/* Colours as CIELAB of the standard observer of 1931 under D65, the white of Rec. 709, and their difference
 * CIEDE2000 [Sharma et al. 2005]. Pure; threads: any. */
#ifndef TOILE_CONFIG_COLOUR_LAB_H
#define TOILE_CONFIG_COLOUR_LAB_H

struct tl_lab {
    double l, a, b; /* l: 0 black to 100 white */
};

/* Converts linear Rec. 709; 1, 1, 1 is white. */
struct tl_lab tl_lab_of(const float rgb[3]);

/* Linear Rec. 709 of a colour whose l is in [0, 100]. One that Rec. 709 cannot show, because a channel would
 * leave [0, 1], becomes the most saturated of its lightness and hue that it can: a and b are scaled. Returns
 * the scale, 1 for a colour that is shown as it is. */
double tl_lab_to_rgb(struct tl_lab lab, float rgb[3]);

/* About 1 is the smallest difference that is seen side by side; under 2 few buyers object. */
double tl_lab_difference(struct tl_lab p, struct tl_lab q);

#endif
