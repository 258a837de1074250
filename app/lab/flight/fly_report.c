/* report.html of a flight: what its files hold, and pictures. flight.js shows it. */
#include "app/lab/flight/fly_account.h"
#include "app/report/report.h"
#include "assets/image/image_file.h"
#include "config/base/memory.h"
#include "config/embedded.h"

#include <stdlib.h>

extern const struct tl_embedded tl_embedded_flight[]; /* flight.js */

static void write_frames(const void *flight, FILE *out)
{
    tl_flight_write_csv(flight, out);
}

static cJSON *encode(const struct tl_flight_picture *picture)
{
    void *png = NULL;
    size_t size = 0;
    cJSON *encoded = tl_image_encode_png("a picture of the report", &picture->image, &png, &size, NULL)
                         ? tl_report_png(png, size)
                         : cJSON_CreateNull();
    free(png);
    return encoded;
}

static void add_pictures(cJSON *data, const struct tl_flight *flight)
{
    cJSON *stops = cJSON_AddArrayToObject(data, "stops"), *worst = cJSON_AddArrayToObject(data, "worst");
    for (int i = 0; i < flight->stop_count; i++) {
        cJSON *stop = cJSON_CreateObject();
        cJSON_AddNumberToObject(stop, "frame", flight->stops[i].frame);
        cJSON_AddItemToObject(stop, "png", encode(&flight->stops[i]));
        cJSON_AddItemToArray(stops, stop);
    }
    for (int i = 0; i < flight->worst_count; i++) /* in the order of the summary's worst_frames */
        cJSON_AddItemToArray(worst, encode(&flight->worst[i]));
}

static void add_units(cJSON *data, const struct tl_settings *settings)
{
    cJSON *units = cJSON_AddObjectToObject(data, "units");
    struct tl_settings copy = *settings;
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind(&copy, bindings);
    for (size_t t = 0; t < TL_SETTINGS_TABLES; t++)
        for (size_t r = 0; r < bindings[t].table->row_count; r++) {
            const struct tl_option *row = &bindings[t].table->rows[r];
            char *key = tl_format("%s.%s", bindings[t].table->name, row->name);
            if (row->unit[0])
                cJSON_AddStringToObject(units, key, row->unit);
            free(key);
        }
}

bool tl_flight_write_report(const struct tl_flight_account *account, const char *folder, tl_error *error)
{
    cJSON *data = cJSON_CreateObject();
    cJSON_AddItemToObject(data, "summary", tl_flight_summary(account));
    tl_report_add_text(data, "frames", account->flight, write_frames);
    add_units(data, account->settings);
    add_pictures(data, account->flight);
    return tl_report_write(folder, "report.html", tl_embedded_flight[0].data, data, error);
}
