/* The fabric card: what a buyer or a mill judges a fabric by, on one page. Its swatch at true scale, a
 * close-up, a sheet over a ball and Cusick's drape test; its colour; its physical figures with their sources;
 * and the fields of its file that are not used.
 *
 * Errors: TL_USAGE for arguments, TL_INPUT for the fabric, TL_OUTPUT, and the errors of a session and a
 * renderer. Threads: the main thread. */
#ifndef TOILE_APP_FABRIC_CARD_H
#define TOILE_APP_FABRIC_CARD_H

#include "app/cli/arguments.h"

/* Writes the card of the fabric `source` to arguments->card: .png, .pdf (A4, to scale) or .json. The options
 * --set are taken over the fabric's own. */
bool tl_fabric_card(const char *source, const struct tl_arguments *arguments, tl_error *error);

#endif
