/* The built-in dress form: its shape as a distance function, for cutting garments around it, and as an
 * avatar. The figure is the same torso with arms, held away from it, legs and a head:
 * for shirts and trousers.
 *
 * The torso (with neck and shoulder stubs, without the stand) is the zero set of tl_form_distance, a smooth
 * union of lofted superellipses. Metres, +Y up, facing +Z, mirror-symmetric in x. Threads: pure. */
#ifndef TOILE_ASSETS_BODY_FORM_H
#define TOILE_ASSETS_BODY_FORM_H

#include "assets/base/avatar.h"

/* Landmarks, metres above the floor. */
#define TL_FORM_BOTTOM   0.70 /* lower edge of the torso */
#define TL_FORM_HIP      0.85
#define TL_FORM_WAIST    1.04
#define TL_FORM_BUST     1.205
#define TL_FORM_NECK_TOP 1.47

/* Roughly the distance to the torso's surface, negative inside: exact in sign, right to some 20 % near it. */
double tl_form_distance(const double point[3]);

/* Distance from the axis, m, at which the horizontal ray from the axis at height y leaves the torso. `angle`
 * is around +Y from the back: x = -r sin(angle), z = -r cos(angle). 0 where there is no torso. */
double tl_form_radius(double y, double angle);

/* Length of the torso's horizontal section at height y, as a tape measure takes it: of its convex hull. */
double tl_form_girth(double y);

/* The built-in dress form: a tailor's torso on a stand, 1.6 m high, feet of the stand
 * at y = 0, facing +Z, closed and manifold, covered in canvas. */
tl_avatar tl_avatar_form(void);

/* The cover of both. */
tl_material tl_form_canvas(void);

/* The same of the figure: 1.68 m high, its head an egg. Its feet stand on y = 0. */
double tl_figure_distance(const double point[3]);

/* Closed and manifold, of triangles of about 1.4 cm, which follow the distance function's zero set. */
tl_avatar tl_avatar_figure(void);

#endif
