/* Writes the drawing of ARCHITECTURE.md to stdout, from the source tree and the object files of a build. */
#include "tests/hygiene/house_drawing.h"

int main(void)
{
    struct house house;
    house_read(&house, TOILE_SOURCE_DIR);
    house_read_objects(&house, TOILE_OBJECTS, TOILE_BINARY_DIR);
    house_draw(&house, stdout);
    house_release(&house);
    return 0;
}
