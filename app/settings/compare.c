#include "app/settings/settings.h"

#include "config/base/hash.h"

/* Bindings can be written through, so constant settings are bound as a copy. */
struct bound {
    struct tl_settings settings;
    struct tl_binding bindings[TL_SETTINGS_TABLES];
};

static void bind_copy(const struct tl_settings *settings, struct bound *out)
{
    out->settings = *settings;
    tl_settings_bind(&out->settings, out->bindings);
}

bool tl_settings_differ(const struct tl_settings *a, const struct tl_settings *b,
                        struct tl_option_filter filter)
{
    struct bound first, second;
    bind_copy(a, &first);
    bind_copy(b, &second);
    return tl_options_differ(first.bindings, second.bindings, TL_SETTINGS_TABLES, filter);
}

void tl_settings_take(const struct tl_settings *from, struct tl_settings *to, struct tl_option_filter filter)
{
    struct bound source;
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    bind_copy(from, &source);
    tl_settings_bind(to, bindings);
    tl_options_take(source.bindings, bindings, TL_SETTINGS_TABLES, filter);
}

uint64_t tl_settings_hash(const struct tl_settings *settings, struct tl_option_filter filter)
{
    struct bound source;
    bind_copy(settings, &source);
    return tl_options_hash(source.bindings, TL_SETTINGS_TABLES, filter, TL_HASH_START);
}

bool tl_settings_equal(const struct tl_settings *a, const struct tl_settings *b)
{
    return !tl_settings_differ(a, b, (struct tl_option_filter){.any_of = UINT64_MAX}) &&
           tl_colourways_equal(&a->colourways, &b->colourways);
}

bool tl_settings_differ_slowly(const struct tl_settings *a, const struct tl_settings *b)
{
    return tl_settings_differ(
               a, b, (struct tl_option_filter){.any_of = UINT64_MAX, .none_of = TL_AFFECTS_AT_ONCE}) ||
           !tl_colourways_equal(&a->colourways, &b->colourways);
}
