/* Fabrics of other programs: U3M 1.0 and 1.1 (a .u3m file with its pictures, or a .u3ma archive of both), raw
 * measurements of the FAB tester (.json, u3m's physics_schema), and folders or .zip archives of texture maps.
 *
 * What a file states is kept here in its own terms, in the units below; app/settings/imported.h makes options
 * of it. Every field of a U3M or physics file, and every picture of a folder, becomes a row of `fields`,
 * which says what it is used for or why it is not. The sections of other companies ("custom") are not read,
 * as U3M's specification asks.
 *
 * Errors: false with one line (TL_INPUT) that names the file and the field. Lifetime: tl_fabric_file_release.
 * Threads: pure, but for reading files; a value is used by one thread at a time. */
#ifndef TOILE_ASSETS_FABRIC_FABRIC_FILE_H
#define TOILE_ASSETS_FABRIC_FABRIC_FILE_H

#include "assets/base/image.h"
#include "assets/fabric/store.h"

enum tl_picture_use {
    TL_PICTURE_COLOUR,
    TL_PICTURE_NORMAL,
    TL_PICTURE_ROUGHNESS,
    TL_PICTURE_METALNESS,
    TL_PICTURE_SPECULAR,
    TL_PICTURE_OPACITY,
    TL_PICTURE_OCCLUSION,
    TL_PICTURE_HEIGHT,
    TL_PICTURE_USES
};
extern const char *const tl_picture_names[]; /* "colour", ..., NULL-terminated */

/* The blending of a colour picture with its factor, in linear light (U3M's texture.mode). */
enum tl_picture_mode {
    TL_PICTURE_MULTIPLY,
    TL_PICTURE_ADD,
    TL_PICTURE_SUBTRACT,
    TL_PICTURE_DIVIDE,
    TL_PICTURE_MAX,
    TL_PICTURE_MIN,
    TL_PICTURE_OVERLAY
};

struct tl_fabric_picture {
    char *file;       /* in the store; NULL: none */
    int channel;      /* of numbers: 0 to 2; -1: the mean of the first three */
    bool is_inverted; /* 1 - value: a picture of gloss */
    bool is_y_down;   /* normals of DirectX */
    int mode;         /* enum tl_picture_mode, of colours */
    float factor[3];  /* of numbers and normals the first */
    float offset;     /* of numbers: value = offset + factor * picture */
};

/* The surface, in the terms of the principled model; what a picture varies is 1, or what the picture
 * multiplies. */
struct tl_fabric_surface {
    float colour[3]; /* linear */
    float roughness, metalness;
    float specular; /* reflectance at normal incidence of what is no metal */
    float alpha, transmission;
    float coat, coat_roughness;
    float sheen, sheen_tint;
    float anisotropy, rotation_deg; /* of 1: lobes as long as the model has them; counter-clockwise */
};

/* NaN: not stated. Strips of unit width; weft: the file's width, warp: its length. */
struct tl_fabric_physics {
    double weight_kg_m2, thickness_m;
    double stretch_weft, stretch_warp, shear; /* N/m */
    double bend_weft, bend_warp;              /* N m */
};

struct tl_fabric_field {
    char *name;  /* "material.front.roughness" */
    char *value; /* as the file has it, in short */
    char *use;   /* what becomes of it */
    bool is_used;
};

enum tl_fabric_pattern {
    TL_FABRIC_PATTERN_NONE,
    TL_FABRIC_PATTERN_PLAIN,
    TL_FABRIC_PATTERN_TWILL,
    TL_FABRIC_PATTERN_SATIN
};

typedef struct tl_fabric_file {
    tl_store store; /* of the pictures */
    char name[64];
    bool has_surface;
    struct tl_fabric_surface surface;
    struct tl_fabric_picture pictures[TL_PICTURE_USES];
    float width_mm, length_mm; /* of the pictures on the cloth; 0: not stated */
    bool mirrors_u, mirrors_v; /* every other repeat is to be mirrored */
    bool has_back;
    float back[3];                         /* linear; multiplies ... */
    struct tl_fabric_picture back_picture; /* ... the mean of this one, if there is one */
    enum tl_fabric_pattern pattern;        /* how its yarns interlace, as stated */
    struct tl_fabric_physics physics;
    struct tl_fabric_field *fields;
    size_t field_count;
    size_t missing_count;
    char **missing; /* pictures and files that are named but are not there, a name for each time */
} tl_fabric_file;

/* Whether a path is one of the above: by its extension, or a folder. Pure, but for asking whether it is a
 * folder. */
bool tl_fabric_file_is(const char *path);

/* Reads everything but the pictures. */
bool tl_fabric_file_open(const char *path, tl_fabric_file *out, tl_error *error);
void tl_fabric_file_release(tl_fabric_file *file); /* frees and zeroes */

/* Whether a file has pictures of any use. */
bool tl_fabric_file_has_pictures(const tl_fabric_file *file);

#endif
