#include "app/json.h"

#include <stdio.h>
#include <stdlib.h>

void tl_json_print(cJSON *object)
{
    char *text = cJSON_Print(object);
    puts(text);
    free(text);
    cJSON_Delete(object);
}
