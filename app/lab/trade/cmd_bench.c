/* toile bench: ratios measured side by side in one run. */
#include "app/cli/topic.h"
#include "app/lab/cloth/bench_cloth.h"
#include "app/lab/trade/bench.h"
#include "app/lab/trade/commands.h"

bool tl_command_bench(const struct tl_arguments *arguments, tl_error *error)
{
    enum { LIGHT, CLOTH, SHADING };
    static const char *const topics[] = {[LIGHT] = "light", [CLOTH] = "cloth", [SHADING] = "shading", NULL};
    struct tl_arguments scene;
    int topic;
    if (!tl_topic_take("bench", arguments, topics, false, &scene, &topic, error))
        return false;
    if (topic == CLOTH)
        return tl_bench_cloth(&scene, error);
    if (topic == SHADING)
        return tl_bench_shading(&scene, error);
    return tl_bench_light(&scene, error);
}
