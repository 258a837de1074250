/* Draws the built-in dress three frames after its drape. cc example.c -o example $(pkg-config --cflags --libs
 * toile) */
#include <stdio.h>
#include <toile.h>

int main(int argc, char **argv)
{
    const char *const options[] = {"image.width=320", "image.height=400", "scene.preset=draft", NULL};
    toile_error error;
    toile_scene *scene = toile_load(argc > 2 ? argv[2] : NULL, options, &error);
    bool done = scene && toile_settle(scene, &error);
    for (int frame = 0; done && frame < 3; frame++)
        done = toile_step(scene, &error);
    done = done && toile_save(scene, argc > 1 ? argv[1] : "dress.png", &error);
    if (!done)
        fprintf(stderr, "example: %s\n", error.message);
    toile_destroy(&scene);
    return done ? 0 : 1;
}
