/* An audit as JSON. Errors: none. Threads: pure. */
#ifndef TOILE_APP_AUDIT_AUDIT_JSON_H
#define TOILE_APP_AUDIT_AUDIT_JSON_H

#include "app/audit/audit.h"

#include <cjson/cJSON.h>

/* Adds "findings" [{code, severity, place, message, remedy}], "errors" and "warnings", which count those
 * beyond TL_AUDIT_LISTED too. Members of `place`, as far as there are: file; part, material, triangle,
 * points, position_mm. */
void tl_audit_add_json(const tl_audit *audit, cJSON *object);

/* A new list of the codes: {code, severity, meaning, remedy}. */
cJSON *tl_audit_codes_json(void);

#endif
