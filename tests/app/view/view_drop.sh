#!/usr/bin/env bash
# Files dropped on the real window, as a file manager drops them (drop_files.c): each is opened, asked about or refused
# with one line. TOILE is the program, DROP the source of the drops; empty where X11's headers are absent.
set -eu
. "$(dirname "$0")/view_room.sh"
[ -n "${DROP:-}" ] || { echo "skipped: built without X11's headers (libx11-dev), there is nothing to drop with"; exit 77; }

fast="--preset draft --set cloth.edge_m=0.08 $cheap_light"
$TOILE render $fast --size 64x32 --quiet -o light.exr # any picture is an environment
$TOILE export $fast --set image.ground=false --avatar none --garment skirt --quiet -o skirt.obj
$TOILE export $fast --set image.ground=false --avatar none --garment skirt.obj --set cloth.substeps=4 --set cloth.longest_edge_m=0 --frames 0:1 --quiet -o skirt.pc2
printf 'material: {diffuse: [0.1, 0.2, 0.3], glossiness: 0.4}\n' >"bleu é 100%.yaml"
printf 'scene: {garment: dress, preset: draft}\ncloth: {edge_m: 0.08}\nlight: {regions: 24, pem_size: 16, rounds: 4, bounce: off}\n' >scene.yaml
echo "material: [" >broken.yaml
echo "no light" >broken.exr
echo "no model" >broken.glb
echo "a letter" >letter.txt

mkdir maps own nothing
$TOILE render $fast --garment sphere --avatar none --size 16x16 --quiet -o maps/cloth_basecolor.png
cp maps/cloth_basecolor.png maps/notes_on_it.png
strip='{"S2": {"width": 5, "samplesTree": [[8, 0, 8.1, 10, 8.2, 60]]}}'
printf '{"raw_data": {"M": 200, "L": %s, "W": %s, "B": %s}}' "$strip" "$strip" "$strip" >strips.json
printf '{"schema": "1.1"' >cut.u3m
echo '{"pattern": {"panels": {}}}' >panels.json # is read as a pattern, not as measurements
$TOILE fabric satin -o own/ --quiet

first_size 780 400
open_display
: >log
PATH=$PWD/bin:/nonexistent $(command -v "$TOILE" || echo "$TOILE") view $fast >out 2>log &
viewer=$!
logged "view: ready"
window=$(xdotool search --pid "$viewer" | tail -n 1)

drop() { $DROP "$window" 200 200 "$@" || fail "not taken: $*"; }
# drops FILE TEXT: dropped, the log holds the text once more. answers FILE NUMBER TEXT: ... after that answer.
drops() {
    local before
    before=$(grep -c -e "$2" log || true)
    drop "$1"
    logged "$2" $((before + 1))
}
answers() {
    drop "$1"
    press "$2" "$3"
}

drops light.exr "view: environment .*/light.exr"
answers "bleu é 100%.yaml" 2 "view: fabric .*/bleu é 100%.yaml"
answers skirt.obj 1 "view: garment .*/skirt.obj"
press d "view: loads .*/skirt.obj"
# A file in millimetres with Z up: how it is read is changed by keys, it is moved by the pointer, and accepted.
awk '/^v / { print "v", 1000 * $2, -1000 * $4, 1000 * $3; next } /^vn / { print "vn", $2, -$4, $3; next } { print }' skirt.obj >lying.obj
answers lying.obj 1 "view: garment .*/lying.obj"
logged "lying.obj: .* taken as millimetres"
press a "view: reads it with Z up"
press u "view: reads it in centimetres"
press shift+u "view: reads it in millimetres"
xdotool keydown ctrl keydown shift; drag 1 200 200 240 200; xdotool keyup shift keyup ctrl
logged "view: --move 0.*,0,.* --turn 0 --scale 1"
xdotool keydown ctrl keydown shift; drag 3 200 200 240 200; xdotool keyup shift keyup ctrl
logged "view: --move .* --turn [1-9].* --scale 1"
press Return "view: keeps --units mm --up z"
answers scene.yaml 1 "view: garment dress"

# Fabrics of other programs are used at once, and what of them is said.
drops maps "view: fabric maps: 1 of 2 fields are used, 100 mm wide (assumed.*); not used: notes_on_it.png"
drops strips.json "view: fabric strips: 4 of [0-9]* fields are used; not used: raw_data.L.D1"
drops own "view: fabric: .*/own"
drops panels.json "warning: view: .*panels.json: pattern.panels: "
drops cut.u3m "warning: view: .*cut.u3m:1: "
drops nothing "warning: view: .*nothing.*no texture maps"

drops letter.txt "warning: view: .*letter.txt: cannot be used here"
drops broken.exr "warning: view: .*broken.exr"
answers broken.glb 1 "warning: view: .*broken.glb"
answers broken.yaml 2 "warning: view: .*broken.yaml"
answers broken.yaml 1 "warning: view: .*broken.yaml"

# The file dialog: a zenity that answers with a file, one that is cancelled, and none.
mkdir bin
choose() {
    printf '#!/bin/sh\n%s\n' "$1" >bin/zenity.new
    chmod +x bin/zenity.new
    mv bin/zenity.new bin/zenity
}
choose "echo '$PWD/light.exr'"
press ctrl+o "view: environment .*/light.exr"
choose "exit 1"
xdotool key ctrl+o
sleep 1
choose "echo '$PWD/letter.txt'"
press ctrl+o "warning: view: .*letter.txt: cannot be used here"
rm bin/zenity
press ctrl+o "warning: view: .*install the package zenity"

# Several at once: each in its turn.
drop skirt.obj light.exr "bleu é 100%.yaml"
logged "view: environment .*/light.exr" 2
press 1 "view: garment .*/skirt.obj"
press 2 "view: fabric .*/bleu é 100%.yaml"

# The garments that were opened, the last one first.
xdotool key ctrl+r
press 2 "view: garment .*/lying.obj"
logged "lying.obj: .* taken as millimetres" 2 # the units that were kept for it went with it

# A motion brings the mesh of its name with it.
drops skirt.pc2 "view: motion .*/skirt.pc2"
logged "view: garment .*/skirt.obj" 3

# It goes on, shows what could be opened, and closes.
press t "turntable turns"
press t "turntable stands"
xdotool key q
closed
[ "$(grep -c "warning" log)" = 10 ] || fail "not one line for each file that is refused"
[ ! -s out ] || fail "something on standard output"
echo "ok     all"
