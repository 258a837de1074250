#!/usr/bin/env bash
# What measures cloth writes what it says: bench, trade, stability and their refusals, in small.
# Times are not judged here; the outcomes of the extremes are.
set -eu
. "$(dirname "$0")/cli.sh"

refuse "trade of cloth takes no scene" "name no scene" trade scene.yaml --axis cloth -o measured
refuse "bench cloth takes no scene" "name no scene" bench cloth scene.yaml

check "trade" $TOILE trade --axis cloth --quick --quiet -o measured
check "its files" test -s measured/trade.csv -a -s measured/fit.csv -a -s measured/report.html
check "nothing else" test "$(ls measured | wc -l)" -eq 3

status=0
$TOILE stability cloth --quick --json --quiet >extremes.json || status=$?

if ! command -v python3 >/dev/null; then
    echo "skipped: files are not parsed: python3 is absent"
    exit 0
fi
check "finite numbers; shorter steps and the better solver are nearer to the truth" python3 - <<'PYTHON'
import csv, math
rows = list(csv.DictReader(open("measured/trade.csv")))
for row in rows:
    assert None not in row and None not in row.values(), row
    for key in ("cpu_ms_per_s", "rms_error_m", "rms_total_error_m", "rest_cpu_ms", "rest_rms_error_m"):
        assert math.isfinite(float(row[key])) and float(row[key]) >= 0, (key, row)
sides = {row["side"] for row in rows}
assert len(sides) == 2 and {"preview", "reference"} == {row["solver"] for row in rows}
for side in sides:
    error = {row["name"]: float(row["rms_error_m"]) for row in rows if row["side"] == side}
    assert error["preview 16"] < 0.5 * error["preview 4"]
    assert error["reference"] < 0.01 * error["preview 16"]
PYTHON
check "what settings do to a fit: few substeps stretch, and the hem hangs lower" python3 - <<'PYTHON'
import csv
rows = {row["name"]: row for row in csv.DictReader(open("measured/fit.csv"))}
assert rows.keys() == {"reference", "default", "preview 8"}, rows.keys()
off = {name: {key[:-7]: float(row[key]) for key in row if key.endswith("_off_mm") and row[key]} for name, row in rows.items()}
for name, row in rows.items():
    assert None not in row and None not in row.values() and row["garment"] == "dress" and row["waist_mm"] == "", row
    assert set(off[name]) == {"hem_height", "neck", "bust_ease", "waist_ease", "hip_ease"}, row
    assert 300 < float(row["hem_height_mm"]) < 900 and 500 < float(row["neck_mm"]) < 800, row
    assert 0 < float(row["waist_ease_mm"]) < float(row["hip_ease_mm"]), row
assert not any(off["reference"].values()), off
assert abs(off["default"]["hem_height"]) < 5 and abs(off["default"]["neck"]) < 3, off
assert float(rows["preview 8"]["rms_strain"]) > 1.5 * float(rows["reference"]["rms_strain"])
PYTHON
check_report measured/report.html 5
check "bench --json" sh -c "$TOILE bench cloth --quick --quiet --json | python3 -c '
import json, math, sys
bench = json.load(sys.stdin)
names = [solver[\"name\"] for solver in bench[\"solvers\"]]
assert names == [\"preview\", \"reference\", \"plain loop\"], names
for solver in bench[\"solvers\"]:
    assert math.isfinite(solver[\"steps_per_s_core\"]) and solver[\"steps_per_s_core\"] > 0
    assert math.isfinite(solver[\"ratio\"]) and solver[\"ratio\"] > 0 and solver[\"runs\"]
assert all(row[\"ms\"] > 0 for row in bench[\"frames\"]) and bench[\"dress\"]'"
check "extremes: never NaN, never silent" python3 - <<'PYTHON'
import json
found = json.load(open("extremes.json"))
outcomes = ("exact", "bounded", "refused", "silent", "nan")
assert sum(found[key] for key in outcomes) == found["cells"] == len(found["rows"]) and found["cells"] > 145
assert found["nan"] == 0 and found["refused"] >= 30 and found["exact"] >= 56
for row in found["rows"]:
    assert row["outcome"] != "SILENT", row
    assert row["outcome"] != "refused" or row["why"], row
PYTHON
check "the exit status tells" test $status -eq 0

for substeps in 4 30; do
    $TOILE export dress --no-cache --set cloth.edge_m=0.03 --set cloth.settle_s=1 --set cloth.substeps=$substeps -o dress.obj 2>"said$substeps"
done
check "cloth that hangs too long is reported" grep -q "the cloth is stretched by .* cloth.substeps=4 are too few" said4
check "and nothing else is" sh -c "! grep -q stretched said30"

# Two sheets that cross, which a hundredth of a second is too short to take apart.
cat >crossed.obj <<'OBJ'
v -0.2 1 -0.2
v 0.2 1 -0.2
v 0.2 1 0.2
v -0.2 1 0.2
v 0.013 0.81 -0.107
v 0.013 0.81 0.093
v 0.013 1.21 0.093
v 0.013 1.21 -0.107
f 1 2 3
f 1 3 4
f 5 6 7
f 5 7 8
OBJ
$TOILE export --garment crossed.obj --units m --avatar none --no-cache --set scene.drape=settle --set cloth.settle_s=0.01 -o apart.obj 2>said_crossed
check "cloth that is still crossed is reported" grep -q "still passes through itself: [1-9][0-9]* pairs" said_crossed
check "and no other is" sh -c "! grep -q 'passes through itself' said30"
