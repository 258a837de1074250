/* Actions of the review window's commands (review_commands.h). Each reports what it did or why it could not.
 *
 * `argument` is a direction (-1, 1), an index, or without meaning, as noted. Threads: the window's. */
#ifndef TOILE_APP_VIEW_COMMAND_REVIEW_ACT_H
#define TOILE_APP_VIEW_COMMAND_REVIEW_ACT_H

struct tl_review;

typedef void tl_review_action(struct tl_review *review, int argument);

/* Cloth. */
tl_review_action tl_act_play; /* or pause */
tl_review_action tl_act_step; /* one frame, paused: 1 further, -1 back, which a motion can and cloth cannot */
tl_review_action tl_act_end;  /* -1: first frame; 1: last frame of a motion */
tl_review_action tl_act_drape; /* settles a garment that was authored; else as tl_act_reset */
tl_review_action tl_act_reset; /* to the start: settled, or as authored */
tl_review_action tl_act_pin;   /* pins the vertex that is pulled; takes all pins out when none is pulled */

/* The reading of the garment's or the body's file. */
tl_review_action tl_act_next_units; /* 1: the next unit, -1: the one before */
tl_review_action tl_act_next_up;
tl_review_action tl_act_keep_reading;
tl_review_action tl_act_place; /* shows or hides the handles that place the garment */

/* Camera. */
enum tl_act_direction { TL_ACT_LEFT, TL_ACT_RIGHT, TL_ACT_UP, TL_ACT_DOWN };
tl_review_action tl_act_turn_camera; /* enum tl_act_direction */
tl_review_action tl_act_zoom;        /* 1: nearer, -1: farther */
tl_review_action tl_act_frame_all;
tl_review_action tl_act_turntable;
tl_review_action tl_act_view;      /* index of a saved view */
tl_review_action tl_act_save_view; /* index */
tl_review_action tl_act_path_key;
tl_review_action tl_act_path_record;
tl_review_action tl_act_path_play;

/* Light. */
tl_review_action tl_act_next_environment;
tl_review_action tl_act_turn_environment; /* 1 or -1 steps */
tl_review_action tl_act_environment_turntable;

/* Opens the file dialog. */
tl_review_action tl_act_open;
/* Offers the files that were opened last. */
tl_review_action tl_act_recent;

/* Fabric: the next one, the one before; index into tl_embedded_fabrics_names. */
tl_review_action tl_act_next_fabric;
tl_review_action tl_act_fabric;
tl_review_action tl_act_next_colourway;

/* Comparison. */
tl_review_action tl_act_compare;
tl_review_action tl_act_swap;
tl_review_action tl_act_move_wipe; /* 1 or -1 steps */

/* View modes of the image. */
tl_review_action tl_act_next_view;
tl_review_action tl_act_light_view;
tl_review_action tl_act_pattern; /* the flat pieces beside the garment */
tl_review_action tl_act_read_out;

/* Window. */
tl_review_action tl_act_undo;
tl_review_action tl_act_redo;
tl_review_action tl_act_budget;     /* 1: more time for a frame, -1: less */
tl_review_action tl_act_screenshot; /* 0: PNG, 1: EXR */
tl_review_action tl_act_options;    /* the panel is used by keys */
tl_review_action tl_act_panel;
tl_review_action tl_act_help;
tl_review_action tl_act_back; /* closes what is open, or the window */
tl_review_action tl_act_quit;

#endif
