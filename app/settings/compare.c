#include "app/settings/settings.h"

#include "config/base/hash.h"

void tl_settings_bind_const(const struct tl_settings *settings,
                            struct tl_binding bindings[TL_SETTINGS_TABLES])
{
    tl_settings_bind((struct tl_settings *)settings, bindings);
}

bool tl_settings_differ(const struct tl_settings *a, const struct tl_settings *b,
                        struct tl_option_filter filter)
{
    struct tl_binding first[TL_SETTINGS_TABLES], second[TL_SETTINGS_TABLES];
    tl_settings_bind_const(a, first);
    tl_settings_bind_const(b, second);
    return a != b && tl_options_differ(first, second, TL_SETTINGS_TABLES, filter);
}

uint64_t tl_settings_changes(const struct tl_settings *a, const struct tl_settings *b)
{
    struct tl_binding first[TL_SETTINGS_TABLES], second[TL_SETTINGS_TABLES];
    tl_settings_bind_const(a, first);
    tl_settings_bind_const(b, second);
    return (a->colourways != b->colourways ? TL_AFFECTS_MATERIALS : 0) |
           tl_options_changes(first, second, TL_SETTINGS_TABLES);
}

void tl_settings_take(const struct tl_settings *from, struct tl_settings *to, struct tl_option_filter filter)
{
    struct tl_binding source[TL_SETTINGS_TABLES], target[TL_SETTINGS_TABLES];
    tl_settings_bind_const(from, source);
    tl_settings_bind(to, target);
    tl_options_take(source, target, TL_SETTINGS_TABLES, filter);
}

uint64_t tl_settings_hash(const struct tl_settings *settings, struct tl_option_filter filter)
{
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind_const(settings, bindings);
    return tl_options_hash(bindings, TL_SETTINGS_TABLES, filter, TL_HASH_START);
}

bool tl_settings_equal(const struct tl_settings *a, const struct tl_settings *b)
{
    return a->colourways == b->colourways &&
           !tl_settings_differ(a, b, (struct tl_option_filter){.any_of = UINT64_MAX});
}

bool tl_settings_differ_slowly(const struct tl_settings *a, const struct tl_settings *b)
{
    return a->colourways != b->colourways ||
           tl_settings_differ(a, b,
                              (struct tl_option_filter){.any_of = UINT64_MAX, .none_of = TL_AFFECTS_AT_ONCE});
}
