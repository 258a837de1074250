#include "app/lab/check/finding.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

bool tl_finding_add(struct tl_finding *finding, double worst)
{
    bool is_first = !finding->is_measured;
    finding->is_measured = true;
    /* A NaN is worse than anything, and stays. */
    if (!is_first && (isnan(finding->worst) || worst <= finding->worst))
        return false;
    finding->worst = worst;
    return true;
}

void tl_finding_place(struct tl_finding *finding, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    vsnprintf(finding->place, sizeof finding->place, format, values);
    va_end(values);
}

void tl_finding_pixel(struct tl_finding *finding, int x, int y)
{
    finding->x = x;
    finding->y = y;
    tl_finding_place(finding, "pixel %d, %d", x, y);
}

void tl_finding_vertex(struct tl_finding *finding, const tl_frame *frame, size_t surface, size_t vertex)
{
    finding->surface = (int)surface;
    finding->vertex = vertex;
    tl_finding_place(finding, "%s: vertex %zu", frame->surfaces[surface].name, vertex);
}
