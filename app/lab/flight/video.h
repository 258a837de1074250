/* A video file, made by the command `ffmpeg`, which is found when the program runs.
 *
 * Nothing is encoded while frames are added, so that a measured flight pays for a copy only: frames are kept
 * in an unlinked temporary file in the video's folder. H.264, 4:2:0, Rec. 709. Writes atomically, like
 * tl_writer. Failure: TL_USAGE when there is no ffmpeg, TL_OUTPUT with ffmpeg's message otherwise. Threads:
 * one at a time. */
#ifndef TOILE_APP_LAB_FLIGHT_VIDEO_H
#define TOILE_APP_LAB_FLIGHT_VIDEO_H

#include "assets/base/image.h"

typedef struct tl_video tl_video;

/* Fails when ffmpeg is missing or `path` does not end in .mp4, .mkv or .mov. */
bool tl_video_check(const char *path, tl_error *error);

/* Begins a video file. `path` has been checked. Fails when the file cannot be written. */
tl_video *tl_video_begin(const char *path, double frame_rate, tl_error *error);
/* U8 RGB; all of the first one's size. */
bool tl_video_add(tl_video *video, const tl_image *image, tl_error *error);
/* Encodes what was added, shows progress, releases. With no image it makes no file. */
bool tl_video_commit(tl_video **handle, tl_error *error);
void tl_video_abandon(tl_video **handle); /* leaves no file; null is fine */

#endif
