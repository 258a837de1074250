/* The garment's point under the pointer, and the hand that pulls it. Owns `hand`. */
#ifndef TOILE_APP_VIEW_REVIEW_REVIEW_HAND_H
#define TOILE_APP_VIEW_REVIEW_REVIEW_HAND_H

#include <cglm/struct.h>
#include <stdbool.h>
#include <stdint.h>

struct tl_review;

struct tl_review_hand {
    float depth_m; /* of the plane, parallel to the image, in which the cloth is pulled */
    uint32_t vertex;
    vec3s target, at; /* metres: the pointer's point in that plane, and the hand, which follows it */
};

/* Starts to pull on the garment at a pixel of the view; reports why it cannot. */
bool tl_review_hand_begin(struct tl_review *review, float x, float y);
/* Sets the target of the hand: the pointer has moved to this pixel. */
void tl_review_hand_aim(struct tl_review *review, float x, float y);
/* Before each simulated frame: moves the hand towards the pointer. */
void tl_review_hand_step(struct tl_review *review);
void tl_review_hand_release(struct tl_review *review);

/* The garment's point under a pixel of the view: render vertex and place, metres. False when it is missed. */
bool tl_review_pick(const struct tl_review *review, float x, float y, uint32_t *vertex, vec3s *point);

#endif
