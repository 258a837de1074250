/* The state of a cloth as bytes, and back: a cloth that is restored steps as the one that was saved, to the
 * bit.
 *
 * The bytes hold a marked start (tl_cloth_mark_start): positions, velocities, closed seams, the links of open
 * seams, pins with their attachments, caught vertices, and prestress. The garment, the fabric
 * and the params are not saved and must be the same on restoring. The program must be the same too: the bytes
 * are its structs. Contacts, warm starts and strain limits are not saved, because a marked start resets them.
 * Threads: one at a time per cloth. */
#ifndef TOILE_CLOTH_STEP_SNAPSHOT_H
#define TOILE_CLOTH_STEP_SNAPSHOT_H

#include "cloth/cloth.h"

/* The bytes of a cloth whose start was just marked; free(*data). False when its state cannot be saved,
 * because self_contact has sorted it into layers, whose surfaces remember where they were when they were
 * made. */
bool tl_cloth_save(const tl_cloth *cloth, void **data, size_t *size);

/* Restores a new cloth of the same garment, fabric and params. The collider that it is going to meet must
 * have made the moves that the saved one's had made. Logs what settling had logged. False, and the cloth as
 * it was, when the bytes are not of such a cloth. */
bool tl_cloth_restore(tl_cloth *cloth, const void *data, size_t size);

#endif
