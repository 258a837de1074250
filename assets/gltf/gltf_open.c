#include "assets/gltf/gltf_internal.h"

#include "config/base/file.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* ---- The container: a GLB's lengths are checked against the file before they are used ---- */

struct chunks {
    const uint8_t *json, *binary;
    size_t json_size, binary_size;
};

#define GLB_MAGIC      0x46546c67u /* "glTF" */
#define GLB_CHUNK_JSON 0x4e4f534au
#define GLB_CHUNK_BIN  0x004e4942u

static bool find_chunks(const char *path, const uint8_t *data, size_t size, struct chunks *chunks,
                        tl_error *error)
{
    if (size < 20)
        return tl_fail(error, TL_INPUT, "%s: is cut short: a GLB has at least 20 bytes: fetch it again",
                       path);
    uint32_t version = gltf_little_endian(data + 4), length = gltf_little_endian(data + 8);
    if (version != 2)
        return tl_fail(error, TL_INPUT, "%s: is GLB version %u: export it as glTF 2.0", path, version);
    if (length > size)
        return tl_fail(error, TL_INPUT, "%s: claims %u bytes but has %zu: it is cut short, fetch it again",
                       path, length, size);
    for (size_t at = 12; at + 8 <= length;) {
        size_t chunk = gltf_little_endian(data + at);
        uint32_t type = gltf_little_endian(data + at + 4);
        if (chunk > length - at - 8)
            return tl_fail(error, TL_INPUT,
                           "%s: a chunk claims %zu bytes but %zu are left: it is cut short, fetch it again",
                           path, chunk, length - at - 8);
        if (type == GLB_CHUNK_JSON && !chunks->json) {
            chunks->json = data + at + 8;
            chunks->json_size = chunk;
        } else if (type == GLB_CHUNK_BIN && !chunks->binary) {
            chunks->binary = data + at + 8;
            chunks->binary_size = chunk;
        }
        at += 8 + chunk;
    }
    if (!chunks->json)
        return tl_fail(error, TL_INPUT, "%s: has no JSON chunk: export it again", path);
    return true;
}

/* The cost of JSON text for the parser, which is recursive and makes a tree of all values. */
struct json_facts {
    int depth;
    size_t objects, commas;
};

static struct json_facts json_facts_of(const uint8_t *json, size_t size)
{
    struct json_facts facts = {0};
    int depth = 0;
    bool quoted = false;
    for (size_t i = 0; i < size; i++) {
        if (quoted) {
            if (json[i] == '\\')
                i++;
            else
                quoted = json[i] != '"';
        } else if (json[i] == '"')
            quoted = true;
        else if (json[i] == '{' || json[i] == '[') {
            depth++;
            facts.depth = depth > facts.depth ? depth : facts.depth;
            facts.objects += json[i] == '{';
        } else if (json[i] == '}' || json[i] == ']')
            depth--;
        else
            facts.commas += json[i] == ',';
    }
    return facts;
}

/* Real files are nested a dozen levels deep. The bytes are those that tinygltf was measured to take for an
 * element of a list and for a node, in both of its trees. */
static bool check_json(const char *path, const struct chunks *chunks, tl_error *error)
{
    const int deepest = 128;
    const uint64_t value_bytes = 192, object_bytes = 1024;
    struct json_facts facts = json_facts_of(chunks->json, chunks->json_size);
    if (facts.depth > deepest)
        return tl_fail(error, TL_INPUT, "%s: its JSON is nested more than %d deep: export it again", path,
                       deepest);
    return tl_memory_request_for_file(path, chunks->json_size,
                                      facts.commas * value_bytes + facts.objects * object_bytes, error);
}

bool gltf_open(const char *path, gltf_document *out, tl_error *error)
{
    *out = (gltf_document){0};
    char *data;
    size_t size;
    if (!tl_file_read(path, &data, &size, error))
        return false;
    const uint8_t *bytes = (const uint8_t *)data;
    struct chunks chunks = {0};
    bool binary = size >= 4 && gltf_little_endian(bytes) == GLB_MAGIC, opened = false;
    if (!binary)
        chunks = (struct chunks){.json = bytes, .json_size = size};
    else if (!find_chunks(path, bytes, size, &chunks, error))
        goto done;
    size_t start = 0;
    while (start < chunks.json_size && strchr(" \t\r\n", chunks.json[start]) && chunks.json[start])
        start++;
    if (start == chunks.json_size || chunks.json[start] != '{')
        tl_fail(error, TL_INPUT, "%s: is not glTF: neither a GLB nor a JSON object: export it as glTF 2.0",
                path);
    else if (check_json(path, &chunks, error)) {
        const char *json = (const char *)chunks.json;
        char *prepared = gltf_prepare_json(json, chunks.json_size);
        opened = gltf_parse(path, prepared ? prepared : json, prepared ? strlen(prepared) : chunks.json_size,
                            chunks.binary, chunks.binary_size, out, error) &&
                 gltf_unpack(out, error);
        free(prepared);
    }
done:
    free(data);
    if (!opened)
        gltf_close(out);
    return opened;
}

void gltf_close(gltf_document *document)
{
    gltf_unpack_release(document);
    gltf_parse_release(document);
}
