#include "app/lab/gallery/gallery_times.h"

#include "app/lab/gallery/shots.h"
#include "app/report/report.h"
#include "config/memory.h"

#include <stdlib.h>

/* One entry on the plot. */
struct measurement {
    double regions, texels, time_ms;
};

static bool read_entry(const struct tl_gallery_entry *entry, struct measurement *out)
{
    struct tl_settings settings;
    tl_error error = {0};
    if (!tl_picture_settings(&entry->picture, TL_PICTURE_SOLID, tl_shots_side(entry->picture.experiment),
                             false, &settings, &error))
        return false;
    *out = (struct measurement){settings.light.regions, settings.light.map_size,
                                entry->figures.time_ms[TL_PICTURE_SOLID]};
    return true;
}

static int by_x(const void *a, const void *b)
{
    const struct tl_plot_point *left = a, *right = b;
    return (left->x > right->x) - (left->x < right->x);
}

/* The setting that most entries have. */
static double usual(const struct measurement *all, size_t count, bool is_texels)
{
    double best = 0;
    size_t most = 0;
    for (size_t i = 0; i < count; i++) {
        const double value = is_texels ? all[i].texels : all[i].regions;
        size_t same = 0;
        for (size_t k = 0; k < count; k++)
            same += (is_texels ? all[k].texels : all[k].regions) == value;
        if (same > most) {
            most = same;
            best = value;
        }
    }
    return best;
}

void tl_gallery_write_times(const struct tl_gallery_entry *first, const struct tl_gallery_entry *end,
                            FILE *out)
{
    static const char *const names[2] = {"by number of regions", "by texels of a map's side"};
    struct tl_plot_series series[2] = {0};
    size_t count = 0;
    struct measurement *all = TL_NEW_ARRAY(struct measurement, (size_t)(end - first));
    struct tl_plot_point *points = TL_NEW_ARRAY(struct tl_plot_point, 2 * (size_t)(end - first));
    for (const struct tl_gallery_entry *entry = first; entry < end; entry++)
        count += read_entry(entry, &all[count]);
    for (size_t s = 0; s < 2; s++) {
        struct tl_plot_point *own = points + s * (size_t)(end - first);
        const double kept = usual(all, count, s == 0);
        for (size_t i = 0; i < count; i++)
            if ((s == 0 ? all[i].texels : all[i].regions) == kept)
                own[series[s].count++] = (struct tl_plot_point){s == 0 ? all[i].regions : all[i].texels,
                                                                all[i].time_ms, names[s], false};
        qsort(own, series[s].count, sizeof *own, by_x);
        series[s].name = names[s];
        series[s].points = own;
        series[s].line = true;
    }
    if (count > 1)
        tl_report_plot(out,
                       &(struct tl_plot){"regions, or texels", "ms CPU a frame of the solid", true, true,
                                         series, TL_COUNT(series)},
                       "Time of a frame, as measured in this run: of 6 to 384 regions, each with a map of "
                       "the usual size; and of the usual number of regions with maps of several sizes.");
    free(points);
    free(all);
}
