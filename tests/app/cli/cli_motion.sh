#!/usr/bin/env bash
# Motion out of the program and in again, through the real executable; what info and the log say of files.
set -eu
. "$(dirname "$0")/cli.sh"
quick="--set cloth.edge_m=0.08 --set cloth.settle_s=0.3 --set cloth.substeps=8"

$TOILE export $quick --garment skirt -o skirt.pc2 --frames 2:6 --quiet
$TOILE export $quick --garment skirt -o skirt.mdd --frames 2:6 --quiet
$TOILE export $quick --garment skirt -o skirt.obj --frame 2 --quiet
played="--garment skirt.obj --motion"
$TOILE export $played skirt.pc2 -o again.pc2 --frames 0:4 --quiet
check "a PC2 played and written again differs in its first frame only" sh -c \
    '[ "$(cmp -l skirt.pc2 again.pc2 | awk "\$1 < 21 || \$1 > 24" | wc -l)" = 0 ] && [ -s again.pc2 ]'
$TOILE export $played skirt.mdd -o again.pc2 --frames 0:4 --quiet
check "... and by way of MDD" sh -c '[ "$(cmp -l skirt.pc2 again.pc2 | awk "\$1 < 21 || \$1 > 24" | wc -l)" = 0 ]'
for n in 0 1 2 3 4; do $TOILE export $played skirt.pc2 -o frame.$n.obj --frame $n --quiet; done
$TOILE export $played 'frame.#.obj' -o again.pc2 --frames 0:4 --quiet
check "... and by way of OBJ files" sh -c '[ "$(cmp -l skirt.pc2 again.pc2 | awk "\$1 < 21 || \$1 > 24" | wc -l)" = 0 ]'
mkdir sub && cp skirt.obj frame.?.obj sub
printf 'scene:\n  garment: skirt.obj\n  motion: frame.#.obj\n  avatar: none\n' >sub/scene.yaml
$TOILE export sub/scene.yaml -o scene.pc2 --frames 0:4 --quiet
check "a scene file names its motion beside itself" cmp scene.pc2 again.pc2
$TOILE export $played skirt.pc2 -o played.glb --frame 3 --quiet
check "a played frame as GLB" $TOILE info played.glb

check "info of a PC2" sh -c "$TOILE info skirt.pc2 | grep -Eq '^samples +5$' && $TOILE info skirt.pc2 | grep -Eq '^first_frame +2$'"
check "info of an MDD" sh -c "$TOILE info skirt.mdd | grep -Eq '^rate +30$' && $TOILE info skirt.mdd | grep -Eq '^rate_per +second$'"
check "info of a sequence" sh -c "$TOILE info 'frame.#.obj' | grep -Eq '^format +OBJ sequence$'"
check "info of an OBJ" sh -c "$TOILE info skirt.obj | grep -Eq '^units +m$'"

printf 'v 0 0 0\nv 400 812 0\nv 0 812 10\nf 1 2 3\n' >mm.obj
cat >scene.yaml <<'TEXT'
scene:
  garment: mm.obj
  avatar: none
  units: cm
TEXT
export="export --set cloth.settle_s=0 --set cloth.longest_edge_m=0 -o mm.glb"
check "units are guessed and said" sh -c "$TOILE $export --garment mm.obj --avatar none 2>&1 | grep -q 'mm.obj: 812 units at its longest: taken as millimetres'"
check "units are told" sh -c "[ -z \"\$($TOILE $export --garment mm.obj --avatar none --units mm 2>&1)\" ]"
check "units in a scene file" sh -c "$TOILE $export scene.yaml && $TOILE info mm.glb | grep -A2 upper_m | grep -q '^ *4$'"

printf 'v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n' >sheet.obj
sheet="--garment sheet.obj --avatar none --units m --set cloth.settle_s=0"
$TOILE export $sheet -o fine.obj 2>said.txt
check "edges that cannot fold are split, and it is said" grep -Eq 'sheet.obj: edges of up to 2.83 m .* 2 triangles were split into [0-9]{4} ' said.txt
check "so is what lies below the ground" grep -q 'sheet.obj: reached 1 m below the ground: lifted onto it' said.txt
check "they are fine, and exported where the file has them" awk '/^v / { lowest = $3 < lowest ? $3 : lowest } END { exit !(NR > 1000 && lowest == -1) }' fine.obj
check "nothing is split or lifted where that is asked" sh -c "[ -z \"\$($TOILE export $sheet --set cloth.longest_edge_m=0 --set image.ground=false -o as_is.obj 2>&1)\" ] && [ \"\$(grep -c '^v ' as_is.obj)\" = 4 ]"
$TOILE export $sheet --frames 0:2 --quiet -o sheet.pc2
check "what was split is played on what was split" $TOILE render --garment fine.obj --motion sheet.pc2 --avatar none --fabric none --preset draft --size 32x32 $cheap_light --quiet -o sheet.exr

fast="--preset draft --size 96x96 --avatar none --fabric none --set image.ground=false $cheap_light --quiet"
$TOILE render $fast $played skirt.pc2 --frames 0:4 -o seen.exr
check "playback is rendered, frame by frame" sh -c '[ "$(md5sum seen.*.exr | cut -d" " -f1 | sort -u | wc -l)" = 5 ]'

shirt=$data/sequences/tshirt_iter0
if [ -d "$shirt" ]; then
    # Tangents of OBJ files are their own, and rays of bounced light lie by them.
    fast="$fast --set light.bounce=off"
    $TOILE render $fast --garment "$shirt/000.obj" --motion "$shirt/tshirt.pc2" --frame 120 -o pc2.exr
    $TOILE render $fast --garment "$shirt/000.obj" --motion "$shirt/###.obj" --frame 120 -o obj.exr
    $TOILE render $fast --garment "$shirt/000.obj" --motion "$shirt/tshirt.mdd" --frame 40 -o mdd.exr
    check "PC2 and OBJ files look the same" cmp pc2.exr obj.exr
    # 40 frames of 1/30 s are 120 of the 90 frames a second that were simulated.
    check "so does MDD" cmp mdd.exr pc2.exr
else
    echo "skipped: a real sequence: $data is absent"
fi
