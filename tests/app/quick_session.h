/* Sessions that are coarse and quick to settle: for tests of what is done with a session, not of its cloth.
 */
#ifndef TOILE_TESTS_QUICK_SESSION_H
#define TOILE_TESTS_QUICK_SESSION_H

#include "tests/testing.h"

#include "app/scene/session.h"
#include "config/base/memory.h"

/* `scene`: NULL is the built-in one. */
static inline struct tl_settings quick_settings(const char *scene)
{
    static const char *const assignments[] = {"cloth.edge_m=0.08", "cloth.settle_s=0.3", "cloth.substeps=8"};
    const struct tl_settings_source source = {scene, assignments, TL_COUNT(assignments)};
    struct tl_settings settings;
    tl_error error = {0};
    assert_ok(tl_settings_load(&settings, &source, &error), error);
    return settings;
}

static inline tl_session *quick_session(const char *scene)
{
    struct tl_settings settings = quick_settings(scene);
    tl_error error = {0};
    tl_session *session = tl_session_create(&settings, &error);
    assert_ok(session != NULL, error);
    return session;
}

#endif
