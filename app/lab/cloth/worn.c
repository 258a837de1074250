#include "app/lab/cloth/worn.h"

bool tl_worn_settle(const tl_garment *garment, const struct tl_cloth_params *params, struct tl_worn *out,
                    tl_error *error)
{
    const struct tl_cloth_fabric *fabric = tl_cloth_fabric_options.defaults;
    *out = (struct tl_worn){.form = tl_avatar_form()};
    out->collider = tl_collider_create(&out->form.model.mesh, true, error);
    out->cloth = out->collider ? tl_cloth_create(garment, fabric, params, error) : NULL;
    struct tl_stopwatch watch = tl_stopwatch_start();
    bool done = out->cloth && tl_cloth_settle(out->cloth, out->collider, error);
    out->taken = tl_stopwatch_read(&watch);
    return done;
}

void tl_worn_release(struct tl_worn *worn)
{
    tl_cloth_destroy(&worn->cloth);
    tl_collider_destroy(&worn->collider);
    tl_avatar_release(&worn->form);
}
