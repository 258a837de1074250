/* The rhythm of a review in motion: how fast the cloth plays, and when the panel's figures are renewed. Pure.
 * Seconds. */
#ifndef TOILE_APP_VIEW_WINDOW_RHYTHM_H
#define TOILE_APP_VIEW_WINDOW_RHYTHM_H

#include <math.h>
#include <stdbool.h>

/* The speed of the cloth, as a share of real time: a running mean over the last frames, of which the newest
 * began `late_s` after it was due and stands for `frame_s` of cloth. */
static inline double tl_play_speed(double before, double frame_s, double late_s)
{
    const double newest = 0.1; /* its weight */
    return before + newest * (frame_s / (frame_s + (late_s > 0 ? late_s : 0)) - before);
}

/* The next frame of a motion that is played back, whose last one began `late_s` after it was due: a slow
 * machine leaves frames out and keeps its rate. Past `last` it begins again, or stays there. */
static inline int tl_play_next(int frame, int last, double frame_s, double late_s, bool loops)
{
    double next = frame + 1 + (late_s > 0 ? floor(late_s / frame_s) : 0);
    if (next <= last)
        return (int)next;
    return loops && last > 0 ? (int)fmod(next - last - 1, last + 1.0) : last;
}

#define TL_PANEL_EVERY_S 0.25

/* Whether the panel is built for this image. In motion its figures need not be new in every frame, unless the
 * pointer or the keyboard is at it. */
static inline bool tl_panel_is_due(double now_s, double built_s, bool is_used, bool is_in_motion)
{
    return is_used || !is_in_motion || now_s >= built_s + TL_PANEL_EVERY_S;
}

#endif
