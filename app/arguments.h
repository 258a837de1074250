/* The command line, parsed once into plain data. Each command says which flags it takes; the rest is refused
 * with the nearest flag that it knows. Strings are borrowed from argv. */
#ifndef TOILE_APP_ARGUMENTS_H
#define TOILE_APP_ARGUMENTS_H

#include "config/error.h"

#include <stddef.h>

#define TL_POSITIONALS_MAX 64

enum tl_flag_set { /* which groups of flags a command takes */
                   TL_FLAGS_SCENE =
                       1, /* --set --garment --units --motion --avatar --env --fabric --preset --size
                             --method */
                   TL_FLAGS_OUTPUT = 2,        /* -o */
                   TL_FLAGS_FRAME = 4,         /* --frame N */
                   TL_FLAGS_FRAMES = 8,        /* --frames A:B */
                   TL_FLAGS_JSON = 16,         /* --json */
                   TL_FLAGS_METRIC = 32,       /* --ldr --hdr */
                   TL_FLAGS_WINDOW = 64,       /* --screenshots DIR --max-frames N --fresh --budget MS */
                   TL_FLAGS_AXIS = 128,        /* --axis NAME */
                   TL_FLAGS_QUICK = 256,       /* --quick */
                   TL_FLAGS_FULL = 512,        /* --full */
                   TL_FLAGS_LAYOUT = 1024,     /* --layout NAME --from NAME --size N */
                   TL_FLAGS_FABRIC = 2048,     /* --repeat-mm MM --height-mm MM --clamp */
                   TL_FLAGS_CHECK = 1 << 12,   /* --frames --every --furnace --still --budget --keep */
                   TL_FLAGS_AOV = 1 << 17,     /* --aov */
                   TL_FLAGS_SHEET = 1 << 24,   /* lists of what a contact sheet shows, --same-drape */
                   TL_FLAGS_CAPTURE = 1 << 16, /* --capture, and those of the scene but the image's */
                   TL_FLAGS_FLY = 1 << 20,     /* --budget --frames --path --video --against --replay
                                                  --oracle --hash */
                   TL_FLAGS_BUDGET = 1 << 21,  /* --budget MS */
};

struct tl_arguments {
    const char *positionals[TL_POSITIONALS_MAX];
    size_t positional_count;
    char **assignments; /* "table.key=value", in order; owned */
    size_t assignment_count;
    /* NULL: not given */
    const char *output, *keep;
    const char *screenshots; /* folder for screenshots */
    const char *axis;
    const char *layout, *from;
    const char *path, *video, *against, *replay;
    struct { /* names with commas between them */
        const char *garments, *fabrics, *colourways, *environments, *views;
    } sheet;
    /* 0: not given */
    double budget_ms;
    double repeat_mm, height_mm;
    int first_frame, last_frame;
    int frame_count, every, oracle_every;
    int max_frames;
    int map_size;
    int hdr;           /* -1 by content, 0 --ldr, 1 --hdr */
    bool frames_given; /* --frames rather than --frame */
    bool json, quiet, verbose, help;
    bool fresh, quick, full, clamp, capture, furnace, still, aovs, hash, same_drape;
};

bool tl_arguments_parse(int argc, char **argv, unsigned flags, struct tl_arguments *out, tl_error *error);
void tl_arguments_release(struct tl_arguments *arguments);

/* The flags of a set, one a line, for --help. */
void tl_arguments_print_flags(unsigned flags);

#endif
