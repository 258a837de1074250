/* JSON results, through cJSON: one object on stdout and nothing else. */
#ifndef TOILE_APP_CLI_JSON_H
#define TOILE_APP_CLI_JSON_H

#include <cjson/cJSON.h>

/* Prints and deletes. */
void tl_json_print(cJSON *object);

/* A number, or null: JSON knows neither NaN nor infinities. */
void tl_json_add_number(cJSON *object, const char *key, double value);

#endif
