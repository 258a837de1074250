#include "app/audit/audit_json.h"

static void add_severity(cJSON *object, const struct tl_audit_kind *kind)
{
    cJSON_AddStringToObject(object, "code", kind->code);
    cJSON_AddStringToObject(object, "severity", kind->is_error ? "error" : "warning");
}

static cJSON *place_json(const struct tl_audit_place *place)
{
    cJSON *object = cJSON_CreateObject();
    if (place->file)
        cJSON_AddStringToObject(object, "file", place->file);
    if (place->part == TL_AUDIT_NOWHERE)
        return object;
    cJSON_AddNumberToObject(object, "part", (double)place->part);
    cJSON_AddStringToObject(object, "material", place->name);
    cJSON_AddNumberToObject(object, "triangle", (double)place->triangle);
    cJSON *points = cJSON_AddArrayToObject(object, "points");
    for (int k = 0; k < 3; k++)
        cJSON_AddItemToArray(points, cJSON_CreateNumber((double)place->points[k]));
    cJSON_AddItemToObject(object, "position_mm", cJSON_CreateDoubleArray(place->position_mm, 3));
    return object;
}

void tl_audit_add_json(const tl_audit *audit, cJSON *object)
{
    cJSON *findings = cJSON_AddArrayToObject(object, "findings");
    for (size_t i = 0; i < audit->finding_count; i++) {
        const struct tl_audit_finding *finding = &audit->findings[i];
        cJSON *item = cJSON_CreateObject();
        add_severity(item, &tl_audit_kinds[finding->code]);
        cJSON_AddItemToObject(item, "place", place_json(&finding->place));
        cJSON_AddStringToObject(item, "message", finding->message);
        cJSON_AddStringToObject(item, "remedy", tl_audit_kinds[finding->code].remedy);
        cJSON_AddItemToArray(findings, item);
    }
    cJSON_AddNumberToObject(object, "errors", (double)tl_audit_count(audit, true));
    cJSON_AddNumberToObject(object, "warnings", (double)tl_audit_count(audit, false));
}

cJSON *tl_audit_codes_json(void)
{
    cJSON *list = cJSON_CreateArray();
    for (int code = 0; code < TL_AUDIT_CODES; code++) {
        cJSON *item = cJSON_CreateObject();
        add_severity(item, &tl_audit_kinds[code]);
        cJSON_AddStringToObject(item, "meaning", tl_audit_kinds[code].meaning);
        cJSON_AddStringToObject(item, "remedy", tl_audit_kinds[code].remedy);
        cJSON_AddItemToArray(list, item);
    }
    return list;
}
