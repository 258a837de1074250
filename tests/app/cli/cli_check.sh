#!/usr/bin/env bash
# toile check through the real executable: a clean scene, a broken one that is kept and opened again, messages.
set -eu
. "$(dirname "$0")/cli.sh"
quick="--set cloth.edge_m=0.06 --set cloth.settle_s=0.3 --fabric none --size 60x80 --set image.supersample=1 --set light.regions=48 --set light.pem_size=32"

$TOILE check $quick --frames 4 --every 4 --furnace --json --quiet >clean.json
check "a clean scene has its keys" sh -c 'grep -q "\"frames\":.*4" clean.json && grep -q "\"failed\":.*0" clean.json &&
    grep -q "\"name\":.*\"image.oracle\"" clean.json && grep -q "\"worst\":" clean.json && grep -q "\"bound\":" clean.json &&
    ! grep -q "\"ok\":.*false" clean.json'
hash_of() { sed -n 's/.*"hash":[^"]*"\([0-9a-f]*\)".*/\1/p' "$1"; }
for threads in 1 3; do
    OMP_NUM_THREADS=$threads $TOILE check $quick --no-cache --frames 4 --every 100 --json --quiet >again.json
    check "its frames are the same at $threads threads" [ "$(hash_of clean.json)" = "$(hash_of again.json)" ]
done

# Rubber instead of cloth: a skirt hangs down to twice its length from its waist, which is pinned. On the floor its few
# vertices are too far apart for light that bounces, which another row would name first.
status=0
$TOILE check $quick --garment skirt --frames 1 --keep kept --set light.bounce=off --set fabric.stretch_warp=0.28 --set fabric.stretch_weft=0.28 \
    --set cloth.pin_above_m=1 --set cloth.strain_limit=0 --set cloth.self_contact=false --set cloth.settle_s=1.5 >table.txt 2>message.txt || status=$?
check "what breaks is named, and fails" sh -c "[ $status = 1 ] && grep -q 'cloth.strain breaks at frame 0' message.txt &&
    grep -Eq '^cloth.strain +FAIL' table.txt && grep -q 'toile view kept/scene.yaml' message.txt"
$TOILE render kept/scene.yaml -o opened.exr --quiet
# A still picture averages what a moving one does not; the drape is the same to the bit.
check "what was kept opens as it was" sh -c "$TOILE compare opened.exr kept/image.exr --json |
    grep -Eq '\"rel_rmse\":[^0-9]*0\.0[0-9]'"
status=0
$TOILE check kept/run.yaml --frames 1 --quiet >table.txt 2>message.txt || status=$?
check "and its run breaks again" sh -c "[ $status = 1 ] && grep -q 'cloth.strain breaks at frame 0' message.txt"

interrupt "checking:" check $quick --frames 100000
check "Ctrl-C shows what was found until then" sh -c "[ $status = 130 ] && grep -Eq '^surface.finite +ok' said &&
    grep -q 'check: stopped at frame' told"

# Fewer samples than pixels: white light is looked at in the samples.
$TOILE check $quick --set image.scale=0.5 --frames 2 --every 2 --furnace --json --quiet >coarse.json
check "a furnace at half the samples" sh -c "! grep -q '\"ok\":.*false' coarse.json &&
    grep -A6 '\"name\":.*\"furnace.albedo\"' coarse.json | grep -q '\"measured\":.*true'"

refuse "no frames" '--frames: "0"' check --frames 0
refuse "too many frames" '--frames: 2000000' check --frames 2000000
refuse "a folder that cannot be" '/dev/null/kept' check --keep /dev/null/kept
