/* A flight's results: summary.json for programs, report.html for people, a few lines on stdout; and the
 * results of an earlier flight, read back. */
#ifndef TOILE_APP_LAB_FLIGHT_FLY_ACCOUNT_H
#define TOILE_APP_LAB_FLIGHT_FLY_ACCOUNT_H

#include "app/lab/flight/fly_figures.h"

#include <cjson/cJSON.h>

struct tl_flight_account { /* strings are borrowed */
    const struct tl_flight *flight;
    struct tl_flight_figures figures;
    const struct tl_settings *settings; /* as they were read: a camera that frames itself is still marked */
    const char *scene, *path;           /* files, or "built-in" */
    const char *gl;                     /* what drew */
    int cores;
    const char *stopped; /* why it ended early; NULL: it did not */

    const char *replay;                       /* the folder whose levels were replayed; NULL: none */
    int compared, different, first_different; /* images with a hash in both; the frame, -1: none */

    const char *against; /* the folder that it is compared with; NULL: none */
    struct tl_flight_ratio ratios[TL_FLIGHT_RATIOS_MAX];
    int ratio_count;
};

/* New object. Numbers that are not known are null. */
cJSON *tl_flight_summary(const struct tl_flight_account *account);
void tl_flight_write_summary(const struct tl_flight_account *account, FILE *out);
/* FOLDER/report.html. */
bool tl_flight_write_report(const struct tl_flight_account *account, const char *folder, tl_error *error);
void tl_flight_print(const struct tl_flight_account *account, FILE *out);

/* A flight's folder: its frames, its path, its budget, and the text of its settings. */
struct tl_flight_record {
    struct tl_flight flight;
    cJSON *settings; /* "table.key": "value" */
};
bool tl_flight_record_load(const char *folder, const struct tl_settings *settings,
                           struct tl_flight_record *out, tl_error *error);
void tl_flight_record_release(struct tl_flight_record *record);

/* Whether times (or, with `whole`, images of a replay) of the record can be compared with a flight under
 * `settings`; else the error names the first option that differs. */
bool tl_flight_record_suits(const struct tl_flight_record *record, const char *folder,
                            const struct tl_settings *settings, bool whole, tl_error *error);

#endif
