/* A text field that is driven without a window. */
#ifndef TOILE_TESTS_APP_VIEW_PANEL_FIELDS_SHIM_H
#define TOILE_TESTS_APP_VIEW_PANEL_FIELDS_SHIM_H

#ifdef __cplusplus
extern "C" {
#endif

/* Enters the field `rounds` times, types, undoes and redoes at random, leaves it, and gives it another text.
 */
void fields_drive(int rounds);

#ifdef __cplusplus
}
#endif

#endif
