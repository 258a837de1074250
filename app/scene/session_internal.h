/* The content of a session, for session.c and session_change.c. */
#ifndef TOILE_APP_SCENE_SESSION_INTERNAL_H
#define TOILE_APP_SCENE_SESSION_INTERNAL_H

#include "app/display/moving.h"
#include "app/display/smoothed.h"
#include "app/scene/ahead_internal.h"
#include "app/scene/camera.h"
#include "app/scene/load.h"
#include "app/scene/playback.h"
#include "app/scene/session.h"
#include "assets/avatar.h"
#include "cloth/energy/strain.h"

struct tl_session {
    struct tl_settings settings;

    struct tl_moving_light light;

    /* On the heap, because the cloth, the meshes that move and the materials point to them, and a session's
     * contents move when it takes over another's. */
    tl_avatar *avatar;   /* NULL: none */
    tl_garment *garment; /* NULL: none */

    int clip; /* -1: rest pose */
    struct tl_moving body;
    float *inset; /* by how much the drawn body is moved inwards, under a garment as authored; or NULL */

    tl_cloth *cloth; /* NULL: no garment, or one that is played back */
    bool authored;   /* the cloth starts as the garment's file has it */
    bool only_sewn;  /* it starts as it is when its seams have closed */
    struct tl_scene_standing standing;
    tl_collider *collider;
    struct tl_ahead *ahead; /* the next frame's step of the cloth, begun and not yet taken; or NULL */
    tl_playback *playback;  /* NULL: the garment is simulated */
    struct tl_moving dress;
    struct tl_placing shown_placed; /* tl_session_show_placed; a scale of 0: as loaded */
    struct tl_moving board;         /* made when first asked for; empty: not yet, or there is no pattern */

    struct {
        bool wanted;        /* whatever the image shows */
        tl_strains *rest;   /* made when first asked for */
        vec3s *of_vertices; /* of the garment */
        uint64_t revision;  /* dress.motion_revision that they are of; 0: none */
    } strain;

    struct {
        bool *triangles;   /* of the garment, those that cross others; made when first asked for */
        uint64_t revision; /* dress.motion_revision that they are of; 0: none */
    } crossed;
    struct tl_smoothed smoothed; /* made when it is first shown */

    struct {
        struct tl_light_mesh light_mesh;
        uint64_t revision; /* tl_cloth_cage that it is of; 0: none */
    } cage;

    struct tl_appearance appearance;
    uint64_t appearance_revision; /* of meshes and materials; the renderer sees another one as new */
    uint64_t appearances_made;    /* the highest revision so far */
    struct tl_spare_appearance spares[TL_SPARE_APPEARANCES];

    int frame;
    struct tl_framing framed; /* what the camera frames, at frame 0 */
    tl_surface surfaces[TL_SESSION_SURFACES];
    size_t surface_count;
    struct tl_lamp lamps[2];
};

#endif
