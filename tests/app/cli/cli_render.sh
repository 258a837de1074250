#!/usr/bin/env bash
# Rendered frames: the same frame twice gives the same bytes, at any number of threads; every command that writes JSON
# writes an object; compare knows equal from different; export reads back.
set -eu
. "$(dirname "$0")/cli.sh"
fast="--preset draft --size 160x120 $cheap_cloth $cheap_light --quiet"

# The whole of a frame: the dress on its body, a woven fabric, all regions. Each run drapes: a drape from the cache would
# be that of another number of threads.
whole="--no-cache --preset draft --size 96x72 --set cloth.edge_m=0.06 --set cloth.settle_s=0.2 --set light.pem_size=16 --quiet --frame 2"
OMP_NUM_THREADS=1 $TOILE render $whole -o one.exr
OMP_NUM_THREADS=2 $TOILE render $whole -o two.exr
OMP_NUM_THREADS=3 $TOILE render $whole -o three.exr
check "one thread and two give the same bytes" cmp one.exr two.exr
check "... and three" cmp one.exr three.exr
check "compare equal images" sh -c "$TOILE compare one.exr two.exr --json | grep -q '\"rel_rmse\":[[:space:]]*0,'"

$TOILE render $fast -o plain.exr --set light.rounds=1

interrupt "averaging:" render -o average.exr --size 640x480 $cheap_cloth $cheap_light --set light.rounds=256
check "Ctrl-C keeps the picture as far as it was averaged, and says so: status 130" sh -c "[ $status = 130 ] &&
    grep -q 'render: stopped at frame 0' told && $TOILE compare average.exr average.exr >/dev/null"
$TOILE render $fast -o layers.exr --set light.rounds=1 --aov
check "layers leave the image as it is" sh -c "$TOILE compare plain.exr layers.exr --json | grep -q '\"max_abs\":[[:space:]]*0[,}[:space:]]'"
$TOILE render $fast -o other.exr --set light.rounds=1 --set light.method=unshadowed
check "compare different images" sh -c "! $TOILE compare other.exr plain.exr --json | grep -q '\"rel_rmse\":[[:space:]]*0,'"
$TOILE render $fast -o picture.png --set image.view=smooth
check "compare knows the garment by the reference's layer" sh -c "$TOILE compare plain.exr layers.exr | grep -q 'garment FLIP     0 ' && ! $TOILE compare layers.exr plain.exr | grep -q garment"
check "... or by a mask, here the reference's own" test "$($TOILE compare other.exr layers.exr --json | grep garment_)" = "$($TOILE compare other.exr plain.exr --mask layers.exr --json | grep garment_)"
check "... or by the bright part of a picture" sh -c "$TOILE compare other.exr plain.exr --mask picture.png | grep -Eq 'garment FLIP +0\.[0-9]'"
check "layers are there" test "$(stat -c %s layers.exr)" -gt "$(stat -c %s plain.exr)"
check "layers want an .exr" sh -c "$TOILE render $fast --aov -o layers.png 2>said; test \$? = 2 && grep -q exr said"
OMP_NUM_THREADS=1 $TOILE render $fast --no-cache --size 400x400 -o one.png --set image.view=strain_warp
OMP_NUM_THREADS=2 $TOILE render $fast --no-cache --size 400x400 -o two.png --set image.view=strain_warp
$TOILE render $fast --size 400x400 -o bare.png --set image.view=strain_warp --set image.legend=false
refuse "a mask of another size" "the mask is 400 x 400" compare plain.exr plain.exr --mask bare.png
check "a view is the same at any number of threads" cmp one.png two.png
check "a view has a legend" sh -c "! cmp -s one.png bare.png"
check "plan tells what a view runs" sh -c "$TOILE plan $fast --set image.view=strain_warp | grep inspect | grep -q run && $TOILE plan $fast | grep inspect | grep -q drop"

$TOILE render $fast -o range.png --frames 0:2
check "a range of frames" test -s range.0000.png -a -s range.0001.png -a -s range.0002.png -a ! -e range.png

$TOILE export -o draped.glb $cheap_cloth --quiet --frame 1
check "export reads back" $TOILE info draped.glb
check "exported garment renders" $TOILE render draped.glb --preset draft --size 160x120 --avatar ball $cheap_light --quiet -o again.png

if command -v python3 >/dev/null; then
    check "plan --json" sh -c "$TOILE plan $fast --json | python3 -c 'import json,sys; p=json.load(sys.stdin); assert p[\"jobs\"] and p[\"memory_bytes\"][\"total\"] > 0'"
    check "info --json" sh -c "$TOILE info draped.glb --json | python3 -c 'import json,sys; assert json.load(sys.stdin)[\"triangles\"] > 100'"
else
    echo "skipped: JSON is not parsed: python3 is absent"
fi
check "help of every command" sh -c "for c in view render plan compare export info; do $TOILE \$c --help | grep -q usage || exit 1; done"
