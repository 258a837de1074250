#!/usr/bin/env bash
# Frames do not depend on where a run begins, nor on how many runs share them: --frames 4:5 are those of 0:5 in every
# preset and method that keeps something from frame to frame; shards of render, sheet and fly make the bytes of one run.
set -eu
. "$(dirname "$0")/cli.sh"
small="--size 48x48 $cheap_cloth --set cloth.settle_s=0.05 --set light.regions=24 --set light.pem_size=16 --quiet"

# What a frame keeps from those before it: visibility at points, bounced light, ratios at vertices, captures, a sequence
# of environments, a clip. The sheet falls on a ball: frames differ.
same_frames() { # NAME ARGUMENTS...
    local name=$1 frame
    shift
    $TOILE render $small "$@" --frames 0:5 -o a.exr
    $TOILE render $small "$@" --frames 4:5 -o b.exr
    cmp -s a.0004.exr a.0005.exr && fail "$name: frames 4 and 5 are one picture: nothing is tested"
    for frame in 4 5; do
        check "$name: frame $frame is that of a run from 0" cmp a.000$frame.exr b.000$frame.exr
    done
    rm -f [ab].*.exr
}
for preset in paper draft review; do same_frames "$preset" --preset $preset; done
same_frames "ratios at samples" --preset review --set light.ratio_at=samples
same_frames "shadow maps" --preset draft --set light.visibility=vsm
same_frames "captures" --preset draft --method maps --set maps.capture_every=3

frames() { cat "$1".*.exr | md5sum; }
$TOILE render $small --preset draft --frames 2:6 -o one.exr # shards of two, two and one
for i in 0 1 2; do $TOILE render $small --preset draft --frames 2:6 --shard $i/3 -o shard.exr; done
check "render in 3 shards" test "$(frames shard)" = "$(frames one)"
$TOILE render $small --preset draft --frames 2:4 --shard 5/7 -o none.exr
check "a shard may have no frame" sh -c "! ls none.* 2>/dev/null"
refuse "shards need a range" "add --frames" render $small --shard 0/2 -o a.exr
refuse "shards count from 0" "I from 0 to N - 1" render $small --frames 0:3 --shard 2/2 -o a.exr
refuse "no shards" "expected I/N" render $small --frames 0:3 --shard 1 -o a.exr

sheet="--garments torus --avatar none --preset draft --size 48x48 --set light.rounds=1 $cheap_light --fabrics satin,denim --views front,side"
$TOILE sheet $sheet -o one.png --quiet
for i in 0 1 2; do $TOILE sheet $sheet --shard $i/3 -o shards.png --quiet & done # at the same time
wait
$TOILE sheet $sheet -o shards.png 2>said
check "3 shards drew all cells of a sheet" grep -q "0 cells drawn, 4 kept" said
check "... and it is the same" cmp one.png shards.png
check "... and nothing is left" test ! -e shards.png.cells
$TOILE sheet $sheet --shard 0/2 -o half --quiet
$TOILE sheet $sheet -o half 2>said
check "what no shard drew is drawn" grep -q "2 cells drawn, 2 kept" said

fly="--garment sheet --avatar ball --fabric none $cheap_light --set cloth.settle_s=0.2 --preset draft --size 48x48 --frames 7 --quiet"
$TOILE fly $fly --hash -o flown >/dev/null
errors() { # FOLDER...: of every frame that a shard compared: its number and errors, and every frame's hash
    python3 - "$@" <<'PYTHON'
import csv, sys
rows = {}
for folder in sys.argv[1:]:
    for row in csv.DictReader(open(folder + "/frames.csv")):
        rows.setdefault(row["frame"], set()).update(
            (key, row[key]) for key in ("covered_flip", "relative_rmse", "garment_flip", "image_hash") if row[key])
print(*sorted((int(k), sorted(v)) for k, v in rows.items()), sep="\n")
PYTHON
}
if command -v python3 >/dev/null; then
    $TOILE fly $fly --replay flown --oracle 2 -o whole >/dev/null
    errors whole >whole.txt
    check "three frames are compared" test "$(grep -c relative_rmse whole.txt)" -eq 3
    for i in 0 1; do $TOILE fly $fly --replay flown --oracle 2 --shard $i/2 -o fly.$i >/dev/null; done
    errors fly.0 fly.1 >shards.txt
    check "fly in 2 shards" cmp whole.txt shards.txt
fi
refuse "a flight's shards compare" "add --oracle" fly $fly --shard 0/2 -o a
refuse "a budget chooses by time" "replay" fly $fly --oracle 2 --budget 50 --shard 0/2 -o a
