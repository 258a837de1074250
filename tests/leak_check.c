/* Preloaded into the tests by `./dev asan`, so that LeakSanitizer does not report memory that libraries keep
 * by design until the process ends. No suppression is needed, which would also hide leaks of toile's own
 * through these libraries. */
#include <dlfcn.h>
#include <stddef.h>

int dlclose(void *library);

/* Keeps libraries loaded. Mesa's driver holds memory in its own variables; once the driver is unloaded,
 * LeakSanitizer can neither reach that memory nor name its owner. */
int dlclose(void *library)
{
    (void)library;
    return 0;
}

/* Releases the font caches of Pango and fontconfig, in that order, before LeakSanitizer looks for leaks.
 * fontconfig refers to much of its memory by offsets instead of pointers, which LeakSanitizer cannot follow.
 */
__attribute__((destructor)) static void release_fonts(void)
{
    void (*set_font_map)(void *) =
        (void (*)(void *))(size_t)dlsym(RTLD_DEFAULT, "pango_cairo_font_map_set_default");
    void (*end_fontconfig)(void) = (void (*)(void))(size_t)dlsym(RTLD_DEFAULT, "FcFini");
    if (set_font_map)
        set_font_map(NULL);
    if (end_fontconfig)
        end_fontconfig();
}
