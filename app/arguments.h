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
<<<<<<< HEAD
    const char *axis;
    const char *layout, *from;
    const char *path, *video, *against, *replay;
    struct { /* names with commas between them */
=======
    int max_frames;          /* 0: no limit */
    bool fresh;
    double budget_ms; /* 0: not given */
    const char *axis; /* NULL: not given */
    bool quick, full, clamp, furnace, still, aovs, hash;
    double repeat_mm, height_mm; /* 0: not given */
    const char *layout, *from;   /* NULL: not given */
    int map_size;                /* 0: not given */
    bool capture;
    struct { /* NULL: not given; else names with commas between them */
>>>>>>> room/fly
        const char *garments, *fabrics, *colourways, *environments, *views;
    } sheet;
<<<<<<< HEAD
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
=======
    int frame_count, every;                      /* 0: not given */
    const char *keep;                            /* NULL: not given */
    int oracle_every;                            /* 0: not given */
    const char *path, *video, *against, *replay; /* NULL: not given */
>>>>>>> room/fly
};

bool tl_arguments_parse(int argc, char **argv, unsigned flags, struct tl_arguments *out, tl_error *error);
void tl_arguments_release(struct tl_arguments *arguments);

/* The flags of a set, one a line, for --help. */
void tl_arguments_print_flags(unsigned flags);

#endif
