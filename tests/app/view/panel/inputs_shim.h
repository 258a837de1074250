/* A text field that gets events of the window. */
#ifndef TOILE_TESTS_APP_VIEW_PANEL_INPUTS_SHIM_H
#define TOILE_TESTS_APP_VIEW_PANEL_INPUTS_SHIM_H

#ifdef __cplusplus
extern "C" {
#endif

/* Presses 3 over the field "#301020", clicks into the field, selects all, types "navx", deletes the x, types
 * "y" and Enter; `events_a_frame` of these events lie between two frames. Writes what the field holds when it
 * is entered,
 * "" if it is not. */
void inputs_type(int events_a_frame, char entered[16]);

#ifdef __cplusplus
}
#endif

#endif
