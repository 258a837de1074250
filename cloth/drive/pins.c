#include "cloth/drive/pins.h"

#include "cloth/mesh/topology.h"

#include <string.h>

/* The reach within which pins find the avatar. */
#define REACH_M 0.1

/* Point and axes of the avatar's triangle that carries a pin, at a phase of the motion. */
struct carrier {
    vec3d origin, axes[3];
};

static vec3d carrier_point(const tl_collider *collider, const struct tl_pin *pin, const double b[3],
                           double phase)
{
    double before[3], after[3];
    tl_collider_path(collider, pin->triangle, b, before, after);
    return vec3d_mix((vec3d){before[0], before[1], before[2]}, (vec3d){after[0], after[1], after[2]}, phase);
}

static struct carrier carrier_at(const tl_collider *collider, const struct tl_pin *pin, double phase)
{
    const double corners[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    vec3d a = carrier_point(collider, pin, corners[0], phase);
    vec3d side = vec3d_sub(carrier_point(collider, pin, corners[1], phase), a);
    vec3d other = vec3d_sub(carrier_point(collider, pin, corners[2], phase), a);
    vec3d normal = vec3d_unit_or(vec3d_cross(side, other), (vec3d){0, 1, 0});
    vec3d along = vec3d_unit_or(side, (vec3d){1, 0, 0});
    return (struct carrier){carrier_point(collider, pin, pin->barycentric, phase),
                            {along, vec3d_cross(normal, along), normal}};
}

void tl_pins_bind(struct tl_pin *pins, size_t count, const tl_collider *collider, double thickness_m)
{
    for (size_t i = 0; i < count; i++) {
        struct tl_pin *pin = &pins[i];
        const double point[3] = {pin->at.x, pin->at.y, pin->at.z};
        struct tl_contact contact;
        if (pin->bound)
            continue;
        pin->bound = true;
        if (!tl_collider_query_at(collider, point, 0, REACH_M, &contact))
            continue;
        pin->triangle = contact.triangle;
        memcpy(pin->barycentric, contact.barycentric, sizeof pin->barycentric);
        struct carrier carrier = carrier_at(collider, pin, 0);
        vec3d normal = {contact.normal[0], contact.normal[1], contact.normal[2]};
        double sunk = fmax(thickness_m - contact.distance_m, 0);
        vec3d offset = vec3d_sub(vec3d_muladd(pin->at, normal, sunk), carrier.origin);
        pin->offset = (vec3d){vec3d_dot(offset, carrier.axes[0]), vec3d_dot(offset, carrier.axes[1]),
                              vec3d_dot(offset, carrier.axes[2])};
    }
}

void tl_pins_place(const struct tl_pin *pins, size_t count, const tl_collider *collider, double phase,
                   struct tl_particles *particles)
{
    for (size_t i = 0; i < count; i++) {
        const struct tl_pin *pin = &pins[i];
        vec3d at = pin->at;
        if (pin->triangle != TL_NONE && collider) {
            struct carrier carrier = carrier_at(collider, pin, phase);
            at = vec3d_muladd(carrier.origin, carrier.axes[0], pin->offset.x);
            at = vec3d_muladd(at, carrier.axes[1], pin->offset.y);
            at = vec3d_muladd(at, carrier.axes[2], pin->offset.z);
        }
        particles->x[pin->particle] = at;
        particles->driven[pin->particle] = pin->triangle != TL_NONE;
    }
}
