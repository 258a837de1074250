#!/usr/bin/env bash
# Lamps on the command line, and what measures ways of shading under them: that every way is there and finite.
set -eu
. "$(dirname "$0")/cli.sh"
small="--size 48x48 --set scene.garment=sphere --set image.supersample=1 --fabric none $cheap_light --quiet"

$TOILE bench shading --size 48x48 --set cloth.edge_m=0.08 --quick --json --quiet >shading.json
check "bench shading" test -s shading.json
if command -v python3 >/dev/null; then
    check "ways of shading, finite" python3 - <<'PYTHON'
import json, math
bench = json.load(open("shading.json"))
assert bench["width"] == bench["height"] == 48 and 0.02 < bench["coverage"] < 1, bench
rows = bench["rows"]
names = [row["name"] for row in rows]
assert len(names) == len(set(names)) >= 3, names
for row in rows:
    assert row["look"] == rows[0]["look"] and row["state"] == "moving", row
    for key in ("cpu_ms", "wall_ms", "ratio", "memory_bytes"):
        assert math.isfinite(row[key]) and row[key] > 0, row
    assert abs(row["ratio"] * rows[0]["cpu_ms"] - row["cpu_ms"]) < 1e-6 * row["cpu_ms"], row
    assert math.isfinite(row["rel_rmse"]) and row["rel_rmse"] >= 0, row
exact = [row for row in rows if row["name"] == "Phong shading"]
assert len(exact) == 1 and exact[0]["rel_rmse"] == 0, exact
assert names[0] == "Gouraud" and rows[0]["rel_rmse"] > 0, rows[0]
PYTHON
fi

check "a picture without lamps" $TOILE render $small -o dark.exr
check "a picture with a lamp" $TOILE render $small -o lit.exr --set lamp.kind=directional
check "a lamp that is none changes nothing" $TOILE render $small -o none.exr --set lamp.irradiance=[9,9,9] \
    --set shading.frequency=gouraud
check "the same bytes" cmp dark.exr none.exr
check "other bytes" test "$(cmp -s dark.exr lit.exr; echo $?)" -eq 1
check "no lamp, no job" grep -q "lamps *drop .*no lamps here" <($TOILE plan $small)
check "a lamp, a job" grep -q "lamps *run" <($TOILE plan $small --set fill.kind=point)
refuse "no such lamp" "kind" render $small -o a.exr --set lamp.kind=candle

coarse="--fabric none --set cloth.edge_m=0.08 $cheap_light"
hidden="material.glossiness: has no effect on materials that the garment comes with"
check "a material that the garment's own hides is told" grep -q "$hidden" \
    <($TOILE plan $coarse --set material.glossiness=0.9 2>&1)
$TOILE plan $coarse --set material.use_file=false --set material.glossiness=0.9 >shown.txt 2>&1
check "... and not where it shows" test -z "$(grep "has no effect" shown.txt)"
