#!/usr/bin/env bash
# What measures light writes what it says: bench, trade and their refusals, on a scene small enough for seconds.
# Figures are not judged here (time never is; errors have their own tests), only that they are there and finite.
set -eu
. "$(dirname "$0")/cli.sh"
# Few rays and regions: noise and error are nothing that is looked at. The presets of bench differ by their light.
coarse="--size 48x48 --set light.pem_size=16 --set cloth.edge_m=0.08 --set weave.texels_per_yarn=16 --set reference.replicates=2 --set reference.strata=16 --set reference.bounce_samples=1 --set reference.lobe_samples=8"
small="$coarse $cheap_light"

refuse "trade without a folder" "add -o FOLDER" trade --quick
refuse "trade along nothing known" "expected overall, light" trade --axis wind -o measured
refuse "bench of nothing" "expected a topic" bench
refuse "stability of nothing known" "expected a topic" stability wind

check "trade" $TOILE trade --axis light $small --quiet --quick -o measured
check "both files" test -s measured/trade.csv -a -s measured/report.html
check "nothing else" test "$(ls measured | wc -l)" -eq 2
if command -v python3 >/dev/null; then
    check "finite numbers in every row" python3 - <<'PYTHON'
import csv, math
rows = list(csv.DictReader(open("measured/trade.csv")))
assert len(rows) >= 10, len(rows)
for row in rows:
    assert None not in row and None not in row.values(), row
    for key in ("cpu_ms_per_frame", "total_bytes", "relative_rmse", "mean_flip", "covered_pixels"):
        assert math.isfinite(float(row[key])) and float(row[key]) >= 0, (key, row)
    assert float(row["total_bytes"]) > 0 and int(row["covered_pixels"]) > 125, row
assert {"moving", "rest"} == {row["state"] for row in rows}
PYTHON
    check_report measured/report.html 3
    for axis in overall resolution detail levels; do # cli_shading measures shading
        check "trade, $axis" $TOILE trade --axis $axis $small --quiet --quick -o "$axis"
        check "finite numbers, $axis" python3 - "$axis/trade.csv" <<'PYTHON'
import csv, math, sys
rows = list(csv.DictReader(open(sys.argv[1])))
assert len(rows) >= 2, len(rows)
for row in rows:
    for key in ("cpu_ms_per_frame", "wall_ms_per_frame", "relative_rmse", "mean_flip"):
        assert math.isfinite(float(row[key])) and float(row[key]) >= 0, (key, row)
    assert row["width"] == row["height"] == "48", "an appearance's size overrode the command line's"
    if sys.argv[1] in ("overall/trade.csv", "levels/trade.csv"):
        assert 0 < float(row["garment_flip"]) < float(row["garment_flip_worst"]) < 1, row
        assert 25 < int(row["garment_pixels"]) < int(row["covered_pixels"]), row
    else:
        assert row["garment_flip"] == "" and row["garment_pixels"] == "", row
PYTHON
        check_report $axis/report.html 1
    done
    check "bench --json" sh -c "$TOILE bench light $coarse --quiet --quick --json | python3 -c '
import json, math, sys
bench = json.load(sys.stdin)
for key in (\"time_ratio\", \"error_ratio\", \"flip_ratio\"):
    assert math.isfinite(bench[key]) and bench[key] > 0, key
assert bench[\"mean_step_m\"] > 5e-4, \"the cloth stands still\"
rows = {(row[\"name\"], row[\"state\"]): row for row in bench[\"rows\"]}
assert len(rows) == 8, rows.keys()
paper, review = rows[\"paper\", \"moving\"], rows[\"review\", \"moving\"]
assert abs(bench[\"time_ratio\"] - paper[\"cpu_ms\"] / review[\"cpu_ms\"]) < 1e-6 * bench[\"time_ratio\"]
assert abs(bench[\"error_ratio\"] - review[\"rel_rmse\"] / paper[\"rel_rmse\"]) < 1e-6 * bench[\"error_ratio\"]'"
else
    echo "skipped: files are not parsed: python3 is absent"
fi

# Ctrl-C once the first of some hundred choices of settings is measured: exit status 130, and what was measured
# is there.
interrupt 'measuring the trade of detail: *\([2-9]\|[1-9][0-9]\) %' trade --axis detail $small -o stopped
check "interrupted: status 130" test $status -eq 130
check "interrupted: what was measured is kept" test "$(wc -l <stopped/trade.csv)" -ge 2 -a -s stopped/report.html
