#include "app/view/review/review_hand.h"

#include "app/scene/orbit.h"
#include "app/view/review/review.h"
#include "config/base/log.h"

static struct tl_ray ray_under(const struct tl_review *review, const struct tl_camera *camera, float x,
                               float y)
{
    int width, height;
    tl_review_size(review, &width, &height);
    return tl_orbit_ray(camera, x, y, (float)width, (float)height);
}

static float depth_of(const struct tl_camera *camera, vec3s point)
{
    vec3s forward = glms_vec3_normalize(glms_vec3_sub(camera->target, camera->eye));
    return glms_vec3_dot(glms_vec3_sub(point, camera->eye), forward);
}

bool tl_review_pick(const struct tl_review *review, float x, float y, uint32_t *vertex, vec3s *point)
{
    const struct tl_camera camera = tl_session_frame(review->session).camera;
    struct tl_ray ray = ray_under(review, &camera, x, y);
    float distance_m;
    if (!tl_session_pick(review->session, ray.origin, ray.direction, vertex, &distance_m))
        return false;
    *point = glms_vec3_muladds(ray.direction, distance_m, ray.origin);
    return true;
}

bool tl_review_hand_begin(struct tl_review *review, float x, float y)
{
    vec3s point;
    if (!tl_review_pick(review, x, y, &review->hand.vertex, &point)) {
        tl_review_report(review, "nothing to pull here: hold Ctrl and drag on the garment");
        return false;
    }
    if (!tl_session_cloth(review->session)) {
        tl_review_report(review, "the garment is played back, not simulated: it cannot be pulled");
        return false;
    }
    const struct tl_camera camera = tl_session_frame(review->session).camera;
    tl_review_set_drag(review, TL_DRAG_CLOTH);
    review->hand.depth_m = depth_of(&camera, point);
    review->hand.target = review->hand.at = point;
    if (!review->play.is_on)
        tl_review_set_playing(review, true); /* paused cloth cannot follow */
    tl_info("view: pulls on vertex %u", (unsigned)review->hand.vertex);
    return true;
}

/* The pointer's ray meets the plane that is parallel to the image and as deep as the point that was grabbed.
 * A ray's depth grows linearly: depth_per_m metres of depth for each metre along it. */
void tl_review_hand_aim(struct tl_review *review, float x, float y)
{
    const struct tl_camera camera = tl_session_frame(review->session).camera;
    struct tl_ray ray = ray_under(review, &camera, x, y);
    float depth_per_m = depth_of(&camera, glms_vec3_add(camera.eye, ray.direction));
    review->hand.target = glms_vec3_muladds(ray.direction, review->hand.depth_m / depth_per_m, ray.origin);
}

/* The hand's speed is limited: when images take long, the pointer moves far in little simulated time, and a
 * hand that followed at once would pull the cloth at many metres a second. */
void tl_review_hand_step(struct tl_review *review)
{
    const float max_speed_m_s = 1.5f;
    tl_cloth *cloth = tl_session_cloth(review->session);
    if (review->input.drag != TL_DRAG_CLOTH || !cloth)
        return;
    float reach_m = max_speed_m_s / (float)review->good.cloth.frame_rate;
    vec3s offset = glms_vec3_sub(review->hand.target, review->hand.at);
    float length_m = glms_vec3_norm(offset);
    float share = length_m > reach_m ? reach_m / length_m : 1;
    review->hand.at = glms_vec3_muladds(offset, share, review->hand.at);
    tl_cloth_grab(cloth, review->hand.vertex, review->hand.at);
}

void tl_review_hand_release(struct tl_review *review)
{
    tl_cloth *cloth = tl_session_cloth(review->session);
    if (review->input.drag == TL_DRAG_CLOTH && cloth)
        tl_cloth_release(cloth);
    tl_review_set_drag(review, TL_DRAG_NONE);
}
