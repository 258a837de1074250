#!/usr/bin/env bash
# toile fabric: the maps it bakes are there and as large as it says; what it cannot do it refuses in one line, status 2.
set -u
. "$(dirname "$0")/cli.sh"

# A PNG of 2 x 2 texels of 16-bit grey: 0, 65535 / 32768, 256.
base64 -d >height.png <<'PNG' || exit 1
iVBORw0KGgoAAAANSUhEUgAAAAIAAAACEAAAAAAHTY67AAAAEklEQVR4nGNgYPj/n6GBgZEBAA7/AoBiWyn9AAAAAElFTkSuQmCC
PNG
head -c 40 height.png >cut.png
printf 'no picture at all' >words.png
: >empty.png

refuse "no input" 'expected one' fabric -o maps
refuse "two inputs" 'expected one' fabric height.png height.png -o maps
refuse "no output" 'output' fabric height.png
refuse "missing input" 'nowhere\.png.*no such file' fabric nowhere.png -o maps
refuse "cut input" 'cut\.png' fabric cut.png -o maps
refuse "input of words" 'words\.png.*PNG' fabric words.png -o maps
refuse "empty input" 'empty\.png.*empty' fabric empty.png -o maps
refuse "words as EXR" 'no\.exr' fabric no.exr -o maps
for bad in 0 -1 nan inf 1e9 ten 5mm; do
    refuse "repeat of $bad" '\-\-repeat-mm.*millimetres' fabric height.png -o maps --repeat-mm "$bad"
    refuse "height of $bad" '\-\-height-mm.*millimetres' fabric height.png -o maps --height-mm "$bad"
done
refuse "unknown option" 'no such option' fabric height.png -o maps --repeat 5
message=$("$TOILE" fabric height.png -o height.png/maps --quiet 2>&1)
[ $? -eq 2 ] || fail "output below a file: $message"

told=$("$TOILE" fabric height.png -o maps --repeat-mm 4 --height-mm 1 2>&1) || fail "baking: $told"
for map in height.exr normal.png offset.exr moments.exr gloss.png horizon_0_45_90_135.png horizon_180_225_270_315.png cones.png; do
    [ -s "maps/$map" ] || fail "$map is missing"
    printf '%s' "$told" | grep -q "$map: 2 x 2 texels" || fail "$map: its size is not told"
done
printf '%s' "$told" | grep -q '4 x 4 mm a repeat, 1 mm deep' || fail "the scale is not told: $told"
# The fabric can be worn, from another folder, and is the heights that were baked.
[ -s maps/height.yaml ] || fail "no fabric was written"
grep -q 'picture_mm: 4$' maps/height.yaml && grep -q 'depth_mm: 1 ' maps/height.yaml || fail "its scale: $(cat maps/height.yaml)"
wear() {
    "$TOILE" render -o "$1" --garment sphere --avatar none --size 32x32 --set light.method=unshadowed \
        $cheap_light --quiet "${@:2}" || fail "$1 is not drawn"
}
wear shape.png
"$TOILE" fabric shape.png -o shaped --repeat-mm 100 --height-mm 20 --quiet || fail "a picture is not baked"
wear worn.exr --fabric shaped/shape.yaml
wear flat.exr --fabric shaped/shape.yaml --set weave.depth_mm=0
cmp -s worn.exr flat.exr && fail "the heights do not show"
sed -i 's/picture: height/picture: nowhere/' maps/height.yaml
message=$("$TOILE" render -o lost.exr --fabric maps/height.yaml --size 8x8 --quiet 2>&1)
[ $? -eq 2 ] && printf '%s' "$message" | grep -q 'maps/nowhere\.exr' || fail "a lost picture: $message"
# What 8 bits would lose is there: 256 / 65535 of a millimetre.
"$TOILE" fabric maps/height.exr -o again --repeat-mm 4 --height-mm 1 2>&1 | grep -q '0.001 mm deep' ||
    fail "heights in metres are not read back"
"$TOILE" info maps/normal.png >/dev/null 2>&1 || "$TOILE" fabric maps/normal.png -o again --clamp --quiet || fail "normal.png is not read"
