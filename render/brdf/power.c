#include "render/brdf/power.h"

#include "config/base/memory.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

const char *const tl_power_names[] = {"pow", "fixed8", "table", NULL};

static float clamp01(float x)
{
    return x > 0 ? fminf(x, 1) : 0;
}

void tl_power_table_make(float exponent, int size, uint8_t *out)
{
    for (int i = 0; i < size; i++)
        out[i] = (uint8_t)roundf(powf((float)i / (float)(size - 1), exponent) * 255);
}

float tl_power_table_at(const uint8_t *table, int size, float cosine)
{
    float place = clamp01(cosine) * (float)(size - 1);
    int i = place < (float)(size - 2) ? (int)place : size - 2;
    float part = place - (float)i;
    return ((float)table[i] + part * (float)(table[i + 1] - table[i])) / 255;
}

static int squarings_of(int exponent)
{
    int count = 0;
    while (exponent >> (count + 1) > 0)
        count++;
    assert(1 << count == exponent);
    return count;
}

#define STEPS 8192

struct tl_power_error tl_power_error(int method, int exponent, int table_size)
{
    assert(table_size >= 2);
    uint8_t *table = TL_NEW_ARRAY(uint8_t, (size_t)table_size);
    tl_power_table_make((float)exponent, table_size, table);
    double end = acos(pow(0.5 / 255, 1.0 / exponent)), last_cell = 1 - 1.0 / (table_size - 1), before = 1;
    bool shown[256] = {false};
    struct tl_power_error error = {0};
    for (int i = 0; i < STEPS; i++) {
        double cosine = cos(end * i / STEPS), exact = pow(cosine, exponent), value = exact;
        if (method == TL_POWER_FIXED8)
            value = (double)register_power((float)cosine, squarings_of(exponent));
        else if (method == TL_POWER_TABLE)
            value = (double)tl_power_table_at(table, table_size, (float)cosine);
        double difference = fabs(value - exact), level = round(value * 255) / 255;
        error.rms += difference * difference / STEPS;
        error.max = fmax(error.max, difference);
        if (cosine >= last_cell)
            error.max_near_one = fmax(error.max_near_one, difference);
        error.band = fmax(error.band, fabs(level - before));
        before = level;
        shown[(int)round(value * 255)] = true;
    }
    error.rms = sqrt(error.rms);
    for (int i = 0; i < 256; i++)
        error.levels += shown[i];
    free(table);
    return error;
}
