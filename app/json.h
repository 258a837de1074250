/* JSON results, through cJSON: one object on stdout and nothing else. */
#ifndef TOILE_APP_JSON_H
#define TOILE_APP_JSON_H

#include <cjson/cJSON.h>

/* Prints and deletes. */
void tl_json_print(cJSON *object);

#endif
