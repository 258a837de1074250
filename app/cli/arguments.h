/* The command line, parsed once into plain data. Each command states which flags it takes; the rest is
 * refused with the nearest flag that it knows. Strings are borrowed from argv. */
#ifndef TOILE_APP_CLI_ARGUMENTS_H
#define TOILE_APP_CLI_ARGUMENTS_H

#include "config/base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define TL_POSITIONALS_MAX 64

/* Groups of flags that a command takes. */
enum tl_flag_set {
    TL_FLAGS_SCENE = 1 << 0,    /* --garment to --set */
    TL_FLAGS_OUTPUT = 1 << 1,   /* -o */
    TL_FLAGS_FRAME = 1 << 2,    /* --frame N */
    TL_FLAGS_FRAMES = 1 << 3,   /* --frames A:B */
    TL_FLAGS_JSON = 1 << 4,     /* --json */
    TL_FLAGS_METRIC = 1 << 5,   /* --mask FILE --ldr --hdr */
    TL_FLAGS_WINDOW = 1 << 6,   /* --screenshots DIR --max-frames N --fresh */
    TL_FLAGS_AXIS = 1 << 7,     /* --axis NAME */
    TL_FLAGS_QUICK = 1 << 8,    /* --quick */
    TL_FLAGS_FULL = 1 << 9,     /* --full */
    TL_FLAGS_LAYOUT = 1 << 10,  /* --layout NAME --from NAME --size N */
    TL_FLAGS_FABRIC = 1 << 11,  /* --card FILE --lights FILE --set --repeat-mm MM --height-mm MM --clamp */
    TL_FLAGS_CHECK = 1 << 12,   /* --frames N --every --furnace --still --keep */
    TL_FLAGS_AOV = 1 << 13,     /* --aov */
    TL_FLAGS_SHEET = 1 << 14,   /* lists of what a contact sheet shows, --same-drape */
    TL_FLAGS_CAPTURE = 1 << 15, /* --capture, and those of the scene but the image's */
    TL_FLAGS_FLY = 1 << 16,     /* --frames N --path --video --trace --against --replay --oracle --hash */
    TL_FLAGS_BUDGET = 1 << 17,  /* --budget MS */
    TL_FLAGS_CLEAR = 1 << 18,   /* --clear */
    TL_FLAGS_SHARD = 1 << 19,   /* --shard I/N */
    TL_FLAGS_STRICT = 1 << 20,  /* --strict */
    TL_FLAGS_BAKE = 1 << 21,    /* --size N --reach-mm MM */
    TL_FLAGS_PLAN = 1 << 22,    /* --calibrate */
    TL_FLAGS_MEASURE = 1 << 23, /* --interval */
};

struct tl_arguments {
    const char *positionals[TL_POSITIONALS_MAX];
    size_t positional_count;
    char **assignments; /* "table.key=value", in order; owned */
    size_t assignment_count;
    /* NULL: not given */
    const char *output, *keep, *baseline;
    const char *screenshots; /* folder for screenshots */
    const char *axis;
    const char *layout, *from;
    const char *path, *video, *trace, *against, *replay;
    const char *mask;
    const char *card, *lights;
    struct { /* names with commas between them */
        const char *garments, *fabrics, *colourways, *environments, *views;
    } sheet;
    /* 0: not given */
    uint64_t memory_bytes;
    int device; /* --device, from 1; 0: any */
    double budget_ms;
    bool calibrate;
    double repeat_mm, height_mm, reach_mm;
    int first_frame, last_frame;
    int frame_count, every, oracle_every;
    int shard, shards; /* this run does the parts shard, shard + shards, ... */
    int max_frames;
    int map_size;
    int hdr;           /* -1 by content, 0 --ldr, 1 --hdr */
    bool frames_given; /* --frames rather than --frame */
    bool json, quiet, verbose, help;
    bool fresh, quick, full, clamp, capture, furnace, still, aovs, hash, same_drape, no_cache, clear;
    bool allow_outside, force, strict, interval;
    char **command_line; /* the command's name and what follows it, as given; NULL-terminated; borrowed */
};

bool tl_arguments_parse(int argc, char **argv, unsigned flags, struct tl_arguments *out, tl_error *error);
void tl_arguments_release(struct tl_arguments *arguments);

/* Applies the flags that every command takes to the whole process: how much is logged, the limit of memory,
 * whether paths may leave a scene's folder, and where results are kept between runs. */
void tl_arguments_apply(const struct tl_arguments *arguments);

/* A flag as it is documented; strings are static. */
struct tl_flag_text {
    const char *name;  /* "--garment" */
    const char *value; /* name of its value; NULL: it takes none */
    const char *key;   /* the option that it sets, "scene.garment"; NULL: none */
    const char *help;
};
/* The flags of a set in the order of --help; false after the last. Pure. */
bool tl_arguments_flag(unsigned flags, size_t index, struct tl_flag_text *out);

/* The flags of a set, one a line, for --help. */
void tl_arguments_print_flags(unsigned flags);

#endif
