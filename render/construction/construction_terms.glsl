// Seams, hems and stitches as heights over border coordinates, in the common subset of GLSL and C; terms.h includes
// them in C. Metres, tangent space: x along u, y along minus v. Slopes are means over the footprint of a sample, which
// follow exactly from sums: of a profile h(d) over the distance d to a border, [h(d + w/2) - h(d - w/2)] / w; and
// likewise for squares of slopes, for shade, and for stitches, which are products of a bump across the row and one
// along it. So nothing has to be faded by hand: what is smaller than a sample becomes spread of normals.
//
// GLSL and C each provide: `construction_profile(CONSTRUCTION_TABLES kind, d)`, which reads the tables of tables.h, and the
// vectors construction_sizes and construction_rows.
#ifndef TERM
#define TERM
#endif
#ifndef CONSTRUCTION_TABLES_IN
#define CONSTRUCTION_TABLES
#define CONSTRUCTION_TABLES_IN
#endif

#define CONSTRUCTION_STEP 0.000125f // metres between two entries of a profile
#define CONSTRUCTION_LAST 256       // number of the last entry
#define CONSTRUCTION_HEM 2.0f       // enum tl_border_kind
#define CONSTRUCTION_DART 3.0f
#define CONSTRUCTION_REACH 0.032f   // as TL_BORDER_REACH_M
#define CONSTRUCTION_THREAD_F0 0.04f // of a sewing thread on glossier cloth

// A border seen from a point: the distance to it, the length along it there, and the direction away from it.
struct ConstructionPlace {
    float distance, along, away_x, away_y;
    float kind, widest;
    float near; // 1: there is one within reach
};

// Sums from the border to a distance: height (no sum), squared slopes, shade; and the envelope of pucker (no sum).
struct ConstructionProfile {
    float height, squares, shade, pucker;
};
TERM ConstructionProfile construction_profile(CONSTRUCTION_TABLES_IN float kind, float d);

// What a sample sees: mean slopes, their variance along x and y, shade (0: none) and the share that is thread.
struct ConstructionLook {
    float slope_x, slope_y, spread_x, spread_y, shade, thread;
};

TERM ConstructionLook construction_none(void)
{
    ConstructionLook none;
    none.slope_x = none.slope_y = 0.0f;
    none.spread_x = none.spread_y = 0.0f;
    none.shade = none.thread = 0.0f;
    return none;
}

// The place of a point (x, y) before a straight border, if that is nearer than `best`. `scale` is metres per UV unit.
TERM ConstructionPlace construction_nearer(ConstructionPlace best, float x, float y, float from_x, float from_y, float to_x,
                                           float to_y, float start, float widest, float kind)
{
    float along_x = to_x - from_x, along_y = to_y - from_y, square = along_x * along_x + along_y * along_y;
    float share = clamp(((x - from_x) * along_x + (y - from_y) * along_y) / max(square, 1e-20f), 0.0f, 1.0f);
    float off_x = x - from_x - share * along_x, off_y = y - from_y - share * along_y;
    float distance = sqrt(off_x * off_x + off_y * off_y);
    if (distance < best.distance) {
        best.distance = distance;
        best.along = start + share * sqrt(square);
        best.away_x = distance > 1e-7f ? off_x / distance : 0.0f;
        best.away_y = distance > 1e-7f ? off_y / distance : 0.0f;
        best.kind = kind;
        best.widest = widest;
        best.near = 1.0f;
    }
    return best;
}

TERM ConstructionPlace construction_far(float reach)
{
    ConstructionPlace place;
    place.distance = reach;
    place.along = place.away_x = place.away_y = 0.0f;
    place.kind = place.widest = place.near = 0.0f;
    return place;
}

// A bump 1 - (x / r)^2 within r: its integral from 0, and that of its squared slope.
TERM float construction_bump(float x, float r)
{
    return max(1.0f - x * x / (r * r), 0.0f);
}
TERM float construction_bump_sum(float x, float r)
{
    float c = clamp(x, -r, r);
    return c - c * c * c / (3.0f * r * r);
}
TERM float construction_bump_squares(float x, float r)
{
    float c = clamp(x, -r, r);
    return 4.0f * c * c * c / (3.0f * r * r * r * r);
}

// Stitches along a row: of every period the share STITCH shows thread, which rises and sinks over the length RISE.
#define CONSTRUCTION_STITCH 0.8f
#define CONSTRUCTION_RISE 0.18f
TERM float construction_rise_sum(float x, float rise)
{
    float c = clamp(x, -0.5f * rise, 0.5f * rise) + 0.5f * rise;
    return 0.5f * c * c / rise + max(x - 0.5f * rise, 0.0f);
}
TERM float construction_stitch(float turns)
{
    float x = turns - floor(turns), edge = 0.5f * (1.0f - CONSTRUCTION_STITCH);
    return clamp((x - edge) / CONSTRUCTION_RISE + 0.5f, 0.0f, 1.0f) -
           clamp((x - 1.0f + edge) / CONSTRUCTION_RISE + 0.5f, 0.0f, 1.0f);
}
TERM float construction_stitch_sum(float turns)
{
    float whole = floor(turns), x = turns - whole, edge = 0.5f * (1.0f - CONSTRUCTION_STITCH);
    return whole * CONSTRUCTION_STITCH + construction_rise_sum(x - edge, CONSTRUCTION_RISE) -
           construction_rise_sum(x - 1.0f + edge, CONSTRUCTION_RISE);
}

// The needle's holes between the stitches.
#define CONSTRUCTION_HOLE 0.11f
TERM float construction_hole(float turns)
{
    float x = turns - floor(turns + 0.5f);
    return construction_bump(x, CONSTRUCTION_HOLE);
}
TERM float construction_hole_sum(float turns)
{
    float whole = floor(turns + 0.5f);
    return whole * 4.0f * CONSTRUCTION_HOLE / 3.0f + construction_bump_sum(turns - whole, CONSTRUCTION_HOLE);
}

// A row of thread or of holes: `height` times a bump across, from `low` to `high` about its middle, times one along,
// whose mean and slope are given. `per_wide` is the reciprocal of the footprint across.
TERM ConstructionLook construction_add_row(ConstructionLook look, ConstructionPlace place, float low, float high,
                                           float per_wide, float height, float radius, float bump, float bump_slope,
                                           float period)
{
    float level = (construction_bump_sum(high, radius) - construction_bump_sum(low, radius)) * per_wide;
    float slope = (construction_bump(high, radius) - construction_bump(low, radius)) * per_wide;
    float squares = (construction_bump_squares(high, radius) - construction_bump_squares(low, radius)) * per_wide;
    float across = height * slope * bump, along = height * level * bump_slope / period;
    look.slope_x += across * place.away_x - along * place.away_y;
    look.slope_y += across * place.away_y + along * place.away_x;
    float lost = height * height * max(squares * bump - slope * slope * bump * bump, 0.0f);
    look.spread_x += lost * place.away_x * place.away_x;
    look.spread_y += lost * place.away_y * place.away_y;
    return look;
}

// One row of stitches; `low` to `high` is the footprint across about the row, `beside` that along it.
TERM ConstructionLook construction_add_stitches(ConstructionLook look, ConstructionPlace place, float low, float high,
                                                float per_wide, float beside, float period, float radius)
{
    float from = (place.along - 0.5f * beside) / period, to = (place.along + 0.5f * beside) / period;
    float turns = 1.0f / (to - from);
    float stitch = (construction_stitch_sum(to) - construction_stitch_sum(from)) * turns;
    float stitch_slope = (construction_stitch(to) - construction_stitch(from)) * turns;
    float hole = (construction_hole_sum(to) - construction_hole_sum(from)) * turns;
    float hole_slope = (construction_hole(to) - construction_hole(from)) * turns;
    look = construction_add_row(look, place, low, high, per_wide, radius, radius, stitch, stitch_slope, period);
    look = construction_add_row(look, place, low, high, per_wide, -radius, 1.2f * radius, hole, hole_slope, period);
    float covered = (clamp(high, -radius, radius) - clamp(low, -radius, radius)) * per_wide;
    look.thread += covered * stitch;
    look.shade += 0.6f * covered * hole;
    return look;
}

// Pucker along a border: waves of lengths without a common measure, damped where a sample is longer than they are.
TERM ConstructionLook construction_add_pucker(ConstructionLook look, ConstructionPlace place, float along, float wide, float height,
                                              float height_slope, float shear)
{
    float value = 0.0f, slope = 0.0f, lost = 0.0f;
    for (int i = 0; i < 4; i++) {
        float number = i == 0 ? 290.0f : i == 1 ? 556.0f : i == 2 ? 757.0f : 1030.0f; // radians a metre
        float share = i == 0 ? 0.34f : i == 1 ? 0.3f : i == 2 ? 0.22f : 0.14f;
        float phase = number * (along + 0.013f * place.kind);
        float kept = exp(-number * number * wide * wide / 24.0f);
        value += share * kept * sin(phase);
        slope += share * kept * number * cos(phase);
        lost += 0.5f * share * share * number * number * (1.0f - kept * kept);
    }
    float across = height_slope * value + height * slope * shear, beside = height * slope;
    look.slope_x += across * place.away_x - beside * place.away_y;
    look.slope_y += across * place.away_y + beside * place.away_x;
    look.spread_x += height * height * lost * place.away_y * place.away_y;
    look.spread_y += height * height * lost * place.away_x * place.away_x;
    return look;
}

// A hem slants as it is sewn: its upper layer is pushed ahead of the lower one, which gives waves across it a shear.
#define CONSTRUCTION_ROPING 0.7f
#define CONSTRUCTION_NARROWEST 0.004f // of a hem, metres
// Hems narrower than their table, where the border is curved: the flat of the fold is shorter.
TERM float construction_folded(float d, float width, float table_width)
{
    return d < 0.5f * width ? d : d - width + table_width;
}

// Adds a border. (across, down): change of the place to the next sample across and down, metres.
// construction_sizes: width of the hem's table, period of stitches, amplitude of pucker, radius of the thread.
// construction_rows: two rows of the seam's upper side, two of the hem, metres from the border in the table; 0: none.
TERM ConstructionLook construction_add(CONSTRUCTION_TABLES_IN ConstructionLook look, ConstructionPlace place, float across_x,
                                       float across_y, float down_x, float down_y)
{
    float away = abs(across_x * place.away_x + across_y * place.away_y) +
                 abs(down_x * place.away_x + down_y * place.away_y);
    float beside = abs(across_y * place.away_x - across_x * place.away_y) +
                   abs(down_y * place.away_x - down_x * place.away_y);
    float wide = max(away, 2.0f * CONSTRUCTION_STEP), per_wide = 1.0f / wide;
    beside = max(beside, CONSTRUCTION_STEP);
    float low = place.distance - 0.5f * wide, high = place.distance + 0.5f * wide;
    float turned = low < 0.0f ? -1.0f : 1.0f; // beyond the border lies its mirror image
    low *= turned;
    bool is_hem = place.kind == CONSTRUCTION_HEM, is_over = place.kind == 0.0f;
    if (is_hem) {
        float table_width = construction_sizes.x, width = clamp(place.widest, CONSTRUCTION_NARROWEST, table_width);
        low = construction_folded(low, width, table_width);
        high = construction_folded(high, width, table_width);
    }
    ConstructionProfile a = construction_profile(CONSTRUCTION_TABLES place.kind, low);
    ConstructionProfile b = construction_profile(CONSTRUCTION_TABLES place.kind, high);
    float slope = (b.height - a.height) * per_wide;
    float lost = max((b.squares - turned * a.squares) * per_wide - slope * slope, 0.0f);
    look.shade += (b.shade - turned * a.shade) * per_wide;
    look.slope_x += slope * place.away_x;
    look.slope_y += slope * place.away_y;
    look.spread_x += lost * place.away_x * place.away_x;
    look.spread_y += lost * place.away_y * place.away_y;
    float pucker = construction_sizes.z, shear = is_hem ? CONSTRUCTION_ROPING : 0.0f;
    look = construction_add_pucker(look, place, place.along + shear * place.distance, beside + shear * wide,
                                   0.5f * pucker * (a.pucker + b.pucker), pucker * (b.pucker - a.pucker) * per_wide,
                                   shear);
    low *= turned;
    for (int i = 0; i < 2; i++) {
        float of_hem = i == 0 ? construction_rows.z : construction_rows.w;
        float of_seam = i == 0 ? construction_rows.x : construction_rows.y;
        float row = is_hem ? of_hem : is_over ? of_seam : 0.0f;
        if (row > 0.0f && high > row - 2.0f * construction_sizes.w && low < row + 2.0f * construction_sizes.w)
            look = construction_add_stitches(look, place, low - row, high - row, per_wide, beside, construction_sizes.y,
                                             construction_sizes.w);
    }
    return look;
}
