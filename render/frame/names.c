#include "render/frame/resource.h"

#define NAME(bit, name, ...) [bit] = (name),
const char *const tl_resource_names[] = {TL_INPUT_BITS(NAME) TL_MADE_BITS(NAME)[TL_RESOURCE_COUNT] = NULL};
const char *const tl_scene_fact_names[] = {TL_SCENE_FACTS(NAME)[TL_SCENE_FACT_COUNT] = NULL};
