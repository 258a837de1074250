#include "app/cli/json.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void tl_json_print(cJSON *object)
{
    char *text = cJSON_Print(object);
    puts(text);
    free(text);
    cJSON_Delete(object);
}

void tl_json_add_number(cJSON *object, const char *key, double value)
{
    cJSON_AddItemToObject(object, key, isfinite(value) ? cJSON_CreateNumber(value) : cJSON_CreateNull());
}
