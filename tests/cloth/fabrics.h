/* Fabrics that ship, by name, for tests linked with app. */
#ifndef TOILE_TESTS_CLOTH_FABRICS_H
#define TOILE_TESTS_CLOTH_FABRICS_H

#include "app/settings/settings.h"
#include "tests/testing.h"

#include <string.h>

static inline struct tl_cloth_fabric fabric_read(const char *name)
{
    static struct tl_settings settings; /* large */
    tl_error error = {0};
    const struct tl_settings_source source = {NULL, NULL, 0};
    memset(&settings, 0, sizeof settings);
    assert_ok(tl_settings_load(&settings, &source, &error), error);
    assert_ok(tl_settings_apply_fabric(&settings, name, &error), error);
    return settings.fabric;
}

#endif
