#include "cloth/step/snapshot.h"

#include "cloth/build.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Followed by the arrays in the order of `visit`. */
struct head {
    size_t render_count, particle_count, pin_count, seam_count, membrane_count, edge_count;
    double seams_elapsed_s, seams_firm_s, seams_welded_s;
    struct tl_balance balance;
    uint64_t jump_followed, collider_revision;
    bool settled, is_prestressed;
};

/* The saved arrays, of a cloth or of memory that is to become part of one. */
struct arrays {
    uint32_t *weld; /* [render_count] */
    struct tl_particles particles;
    bool *pinched;                       /* [particle_count] */
    struct tl_pin *pins;                 /* [pin_count] */
    struct tl_link *links;               /* [seam_count] */
    double (*rest_strains)[3][TL_BATCH]; /* [membrane_count] */
    double *prestress;                   /* [edge_count] */
};

enum { ARRAYS = 10 };
struct span {
    void *bytes;
    size_t size;
};

static void list_spans(const struct head *head, const struct arrays *arrays, struct span out[ARRAYS])
{
    const struct tl_particles *p = &arrays->particles;
    size_t count = head->particle_count, all = count + 1; /* one more, for the empty lanes of batches */
    const struct span spans[ARRAYS] = {
        {arrays->weld, head->render_count * sizeof *arrays->weld},
        {p->x, all * sizeof *p->x},
        {p->previous, all * sizeof *p->previous},
        {p->v, all * sizeof *p->v},
        {p->driven, count * sizeof *p->driven},
        {arrays->pinched, count * sizeof *arrays->pinched},
        {arrays->pins, head->pin_count * sizeof *arrays->pins},
        {arrays->links, head->seam_count * sizeof *arrays->links},
        {arrays->rest_strains, head->membrane_count * sizeof *arrays->rest_strains},
        {arrays->prestress, head->edge_count * sizeof *arrays->prestress},
    };
    memcpy(out, spans, sizeof spans);
}

static size_t size_of(const struct span spans[ARRAYS])
{
    size_t size = sizeof(struct head);
    for (int i = 0; i < ARRAYS; i++)
        size += spans[i].size;
    return size;
}

bool tl_cloth_save(const tl_cloth *cloth, void **data, size_t *size)
{
    if (cloth->layers.layer_count > 0)
        return false;
    struct head head;
    memset(&head, 0, sizeof head); /* its padding is saved, too */
    head.render_count = cloth->topology.render_count;
    head.particle_count = cloth->particles.count;
    head.pin_count = cloth->pin_count;
    head.seam_count = cloth->seams.pair_count;
    head.membrane_count = cloth->energy.membrane_count;
    head.edge_count = cloth->energy.pairs.edge_count;
    head.seams_elapsed_s = cloth->seams.elapsed_s;
    head.seams_firm_s = cloth->seams.firm_s;
    head.seams_welded_s = cloth->seams.welded_s;
    head.balance = cloth->balance;
    head.jump_followed = cloth->jump_followed;
    head.collider_revision = cloth->collider_revision;
    head.settled = cloth->settled;
    head.is_prestressed = cloth->energy.is_prestressed;
    const struct arrays arrays = {.weld = cloth->topology.weld,
                                  .particles = cloth->particles,
                                  .pinched = cloth->contacts.pinched,
                                  .pins = cloth->pins,
                                  .links = cloth->seams.links,
                                  .rest_strains = tl_alloc(head.membrane_count, sizeof *arrays.rest_strains),
                                  .prestress = cloth->energy.pairs.prestress};
    for (size_t i = 0; i < head.membrane_count; i++)
        memcpy(arrays.rest_strains[i], cloth->energy.previewed[i].rest_strain, sizeof *arrays.rest_strains);
    struct span spans[ARRAYS];
    list_spans(&head, &arrays, spans);
    *size = size_of(spans);
    char *at = *data = tl_alloc(*size, 1);
    memcpy(at, &head, sizeof head);
    at += sizeof head;
    for (int i = 0; i < ARRAYS; at += spans[i].size, i++)
        if (spans[i].size > 0)
            memcpy(at, spans[i].bytes, spans[i].size);
    free(arrays.rest_strains);
    return true;
}

/* ---- Restoring ---- */

static struct arrays make_arrays(const struct head *head)
{
    return (struct arrays){.weld = TL_NEW_ARRAY(uint32_t, head->render_count),
                           .particles = tl_particles_create(head->particle_count),
                           .pinched = TL_NEW_ARRAY(bool, head->particle_count),
                           .pins = TL_NEW_ARRAY(struct tl_pin, head->pin_count),
                           .links = TL_NEW_ARRAY(struct tl_link, head->seam_count),
                           .rest_strains = tl_alloc(head->membrane_count, sizeof(double[3][TL_BATCH])),
                           .prestress = TL_NEW_ARRAY(double, head->edge_count)};
}

static void release_arrays(struct arrays *arrays)
{
    free(arrays->weld);
    tl_particles_release(&arrays->particles);
    free(arrays->pinched);
    free(arrays->pins);
    free(arrays->links);
    free(arrays->rest_strains);
    free(arrays->prestress);
}

/* Sizes are bounded by the garment's before anything is allocated by them. */
static bool is_plausible(const struct head *head, const tl_cloth *cloth, size_t size)
{
    size_t count = cloth->topology.render_count;
    if (head->render_count != count || head->particle_count > cloth->particles.count ||
        head->particle_count == 0 || head->pin_count > count + cloth->pin_count ||
        head->seam_count > cloth->seams.pair_count || head->membrane_count > cloth->topology.triangle_count ||
        head->edge_count > 3 * cloth->topology.triangle_count)
        return false;
    const struct arrays none = {0};
    struct span spans[ARRAYS];
    list_spans(head, &none, spans);
    return size == size_of(spans);
}

/* Every index is that of a particle there is, and every particle has a vertex. */
static bool are_indices_valid(const struct head *head, const struct arrays *arrays)
{
    size_t count = head->particle_count, used_count = 0;
    bool *used = TL_NEW_ARRAY(bool, count), valid = true;
    for (size_t i = 0; valid && i < head->render_count; i++) {
        valid = arrays->weld[i] < count;
        if (valid && !used[arrays->weld[i]]) {
            used[arrays->weld[i]] = true;
            used_count++;
        }
    }
    for (size_t i = 0; valid && i < head->pin_count; i++)
        valid = arrays->pins[i].particle < count;
    for (size_t i = 0; valid && i < head->seam_count; i++)
        valid = arrays->links[i].a < count && arrays->links[i].b < count;
    free(used);
    return valid && used_count == count;
}

static void take_prestress(struct tl_energy *energy, const struct head *head, const struct arrays *arrays)
{
    struct tl_pair_forces *pairs = &energy->pairs;
    if (head->membrane_count != energy->membrane_count || head->edge_count != pairs->edge_count)
        return;
    for (size_t i = 0; i < head->membrane_count; i++)
        memcpy(energy->previewed[i].rest_strain, arrays->rest_strains[i], sizeof *arrays->rest_strains);
    memcpy(pairs->prestress, arrays->prestress, head->edge_count * sizeof *arrays->prestress);
    tl_pair_forces_set_packs(pairs, energy->bending_is_force);
}

/* In the order of tl_cloth_build_state: the mesh, particles, seams, pins, and then what follows from them.
 * The constants come before the particles' last values, because they do not depend on them but reset
 * contacts. */
static void take_arrays(tl_cloth *cloth, const struct head *head, struct arrays *arrays)
{
    tl_cloth_build_mesh(cloth, arrays->weld, head->particle_count);
    tl_particles_release(&cloth->particles);
    cloth->particles = arrays->particles;
    arrays->particles = (struct tl_particles){0};
    tl_seams_release(&cloth->seams);
    cloth->seams = (struct tl_seams){.pair_count = head->seam_count,
                                     .links = arrays->links,
                                     .elapsed_s = head->seams_elapsed_s,
                                     .firm_s = head->seams_firm_s,
                                     .welded_s = head->seams_welded_s};
    free(cloth->pins);
    cloth->pins = arrays->pins;
    cloth->pin_count = head->pin_count;
    cloth->energy.is_prestressed = head->is_prestressed;
    arrays->links = NULL;
    arrays->pins = NULL;
    tl_cloth_set_constants(cloth);
    memcpy(cloth->contacts.pinched, arrays->pinched, head->particle_count * sizeof(bool));
    take_prestress(&cloth->energy, head, arrays);
}

bool tl_cloth_restore(tl_cloth *cloth, const void *data, size_t size)
{
    struct head head;
    if (size < sizeof head)
        return false;
    memcpy(&head, data, sizeof head);
    if (!is_plausible(&head, cloth, size))
        return false;
    struct arrays arrays = make_arrays(&head);
    struct span spans[ARRAYS];
    list_spans(&head, &arrays, spans);
    const char *at = (const char *)data + sizeof head;
    for (int i = 0; i < ARRAYS; at += spans[i].size, i++)
        if (spans[i].size > 0)
            memcpy(spans[i].bytes, at, spans[i].size);
    bool valid = are_indices_valid(&head, &arrays);
    if (valid) {
        take_arrays(cloth, &head, &arrays);
        cloth->balance = head.balance;
        cloth->jump_followed = head.jump_followed;
        cloth->collider_revision = head.collider_revision;
        cloth->settled = head.settled;
        tl_cloth_mark_start(cloth);
        if (!cloth->settled && cloth->balance.residual.rms > 0)
            tl_cloth_log_unsettled(cloth);
    }
    release_arrays(&arrays);
    return valid;
}
