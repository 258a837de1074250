#include "tests/hygiene/house_drawing.h"

#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Pixels. */
enum {
    WIDTH = 1500,
    MARGIN = 20,
    HEAD = 34, /* the floor's name, above its rooms */
    ROW = 74,  /* from one row of rooms to the next */
    BOX = 30,
    LETTER = 8,
    BOX_SPACE = 14,
};

struct box {
    size_t room;        /* node of the graph of rooms */
    int row;            /* 0: the lowest */
    double x, width, y; /* of the left upper corner */
    double aim;         /* mean x of what it uses */
};

struct floor {
    const char *name, *says;
    double x, y, width, height;
    struct box *boxes;
    size_t count;
    int rows;
};

/* The text in a room's box: its path within the floor, or the floor's name for the top folder. */
static const char *label_of(const char *room)
{
    const char *slash = strchr(room, '/');
    return slash ? slash + 1 : room;
}

static bool is_of_floor(const char *room, const char *floor)
{
    return strcmp(room, floor) == 0 || house_starts_with_folder(room, floor);
}

/* Is there a way from -> ... -> to of more than one arrow? */
static bool is_implied(const struct graph *graph, size_t from, size_t to)
{
    for (size_t via = 0; via < graph->count; via++)
        if (via != to && graph->arrows[from * graph->count + via] && graph_reaches(graph, via, to))
            return true;
    return false;
}

/* The floor's own part of the graph of rooms: all nodes, arrows within the floor. */
static void inner_graph(const struct graph *rooms, const char *floor, struct graph *inner)
{
    graph_create(inner, rooms->names, rooms->count);
    for (size_t i = 0; i < rooms->count; i++)
        for (size_t j = 0; j < rooms->count; j++)
            if (rooms->arrows[i * rooms->count + j] && is_of_floor(rooms->names[i], floor) &&
                is_of_floor(rooms->names[j], floor))
                graph_add(inner, i, j, "");
}

static int by_row_and_aim(const void *a, const void *b)
{
    const struct box *x = a, *y = b;
    if (x->row != y->row)
        return x->row < y->row ? -1 : 1;
    if (x->aim < y->aim || x->aim > y->aim)
        return x->aim < y->aim ? -1 : 1;
    return x->room < y->room ? -1 : 1;
}

/* Sets the boxes of each row side by side, in the middle of the floor, those that use the same rooms beside
 * each other: row by row from below, each box is put in the order of the mean place of what it uses. */
static void lay_out(struct floor *floor, const struct graph *inner)
{
    int *height = tl_alloc(inner->count + 1, sizeof *height);
    graph_heights(inner, height);
    floor->boxes = tl_alloc(inner->count + 1, sizeof *floor->boxes);
    for (size_t i = 0; i < inner->count; i++)
        if (is_of_floor(inner->names[i], floor->name)) {
            struct box *box = &floor->boxes[floor->count++];
            *box = (struct box){.room = i, .row = height[i]};
            box->width = (double)(LETTER * strlen(label_of(inner->names[i])) + 20);
            floor->rows = box->row + 1 > floor->rows ? box->row + 1 : floor->rows;
        }
    free(height);
    for (int row = 0; row < floor->rows; row++) {
        double used = -BOX_SPACE;
        for (size_t i = 0; i < floor->count; i++) {
            struct box *box = &floor->boxes[i];
            if (box->row != row)
                continue;
            double sum = 0, weight = 0;
            for (size_t j = 0; j < floor->count; j++)
                if (floor->boxes[j].row < row &&
                    inner->arrows[box->room * inner->count + floor->boxes[j].room]) {
                    sum += floor->boxes[j].x + floor->boxes[j].width / 2;
                    weight++;
                }
            box->aim = weight > 0 ? sum / weight : (double)i;
            used += box->width + BOX_SPACE;
        }
        qsort(floor->boxes, floor->count, sizeof *floor->boxes, by_row_and_aim);
        double x = floor->x + (floor->width - used) / 2;
        for (size_t i = 0; i < floor->count; i++) {
            struct box *box = &floor->boxes[i];
            if (box->row != row)
                continue;
            box->x = x;
            x += box->width + BOX_SPACE;
        }
    }
    floor->height = HEAD + ROW * floor->rows;
}

static void draw_arrows(const struct floor *floor, const struct graph *inner, FILE *out)
{
    for (size_t i = 0; i < floor->count; i++)
        for (size_t j = 0; j < floor->count; j++) {
            const struct box *from = &floor->boxes[i], *to = &floor->boxes[j];
            if (!inner->arrows[from->room * inner->count + to->room] ||
                is_implied(inner, from->room, to->room))
                continue;
            double x0 = from->x + from->width / 2, y0 = from->y + BOX;
            double x1 = to->x + to->width / 2, y1 = to->y - 4, bend = (y1 - y0) * 0.5;
            fprintf(out,
                    "<path d=\"M%.0f %.0f C%.0f %.0f %.0f %.0f %.0f %.0f\" class=\"arrow\" "
                    "marker-end=\"url(#head)\"/>\n",
                    x0, y0, x0, y0 + bend, x1, y1 - bend, x1, y1);
        }
}

static void draw_floor(struct floor *floor, const struct graph *inner, FILE *out)
{
    fprintf(out, "<rect x=\"%.0f\" y=\"%.0f\" width=\"%.0f\" height=\"%.0f\" class=\"floor\"/>\n", floor->x,
            floor->y, floor->width, floor->height);
    fprintf(out, "<text x=\"%.0f\" y=\"%.0f\" class=\"name\">%s</text>\n", floor->x + 12, floor->y + 22,
            floor->name);
    fprintf(out, "<text x=\"%.0f\" y=\"%.0f\" class=\"says\">%s</text>\n",
            floor->x + 26 + 10.0 * (double)strlen(floor->name), floor->y + 22, floor->says);
    for (size_t i = 0; i < floor->count; i++)
        floor->boxes[i].y = floor->y + HEAD + 8 + ROW * (floor->rows - 1 - floor->boxes[i].row);
    draw_arrows(floor, inner, out);
    for (size_t i = 0; i < floor->count; i++) {
        const struct box *box = &floor->boxes[i];
        fprintf(out, "<rect x=\"%.0f\" y=\"%.0f\" width=\"%.0f\" height=\"%d\" rx=\"5\" class=\"room\"/>\n",
                box->x, box->y, box->width, BOX);
        fprintf(out, "<text x=\"%.0f\" y=\"%.0f\" class=\"label\">%s</text>\n", box->x + box->width / 2,
                box->y + 20, label_of(inner->names[box->room]));
    }
}

void house_draw(const struct house *house, FILE *out)
{
    const double all = WIDTH - 2 * MARGIN, left = 0.6 * all;
    struct floor floors[] = {
        {.name = "app",
         .says = "commands, window, reports, and the lab: knows all below",
         .x = MARGIN,
         .width = all},
        {.name = "render",
         .says = "environment to image; never sees cloth",
         .x = MARGIN,
         .width = left - MARGIN / 2.0},
        {.name = "cloth",
         .says = "garment to positions, normals, tangents",
         .x = MARGIN + left + MARGIN / 2.0,
         .width = all - left - MARGIN / 2.0},
        {.name = "assets", .says = "what comes from files or is generated", .x = MARGIN, .width = all},
        {.name = "config",
         .says = "option tables, errors, log, files: the ground",
         .x = MARGIN,
         .width = all},
    };
    struct graph inner[TL_COUNT(floors)];
    for (size_t i = 0; i < TL_COUNT(floors); i++) {
        inner_graph(&house->rooms, floors[i].name, &inner[i]);
        lay_out(&floors[i], &inner[i]);
    }
    double y = MARGIN;
    for (size_t i = 0; i < TL_COUNT(floors); i++) {
        floors[i].y = y;
        if (i == 1) { /* render and cloth stand side by side, equally high */
            double height = floors[1].height > floors[2].height ? floors[1].height : floors[2].height;
            floors[1].height = floors[2].height = height;
            continue;
        }
        y += floors[i].height + MARGIN;
    }
    fprintf(out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %.0f\" font-family=\"sans-serif\">\n"
            "<style>.floor{fill:#f4f1ea;stroke:#b9b09c}.room{fill:#fff;stroke:#5b6770}.arrow{fill:none;"
            "stroke:#8a96a3}"
            ".name{font-size:18px;font-weight:bold;fill:#333}.says{font-size:14px;fill:#777}"
            ".label{font-size:14px;text-anchor:middle;fill:#222}</style>\n"
            "<defs><marker id=\"head\" viewBox=\"0 0 8 8\" refX=\"6\" refY=\"4\" markerWidth=\"7\" "
            "markerHeight=\"7\" "
            "orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" fill=\"#8a96a3\"/></marker></defs>\n"
            "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
            WIDTH, y);
    for (size_t i = 0; i < TL_COUNT(floors); i++) {
        draw_floor(&floors[i], &inner[i], out);
        free(floors[i].boxes);
        graph_release(&inner[i]);
    }
    fprintf(out, "</svg>\n");
}
