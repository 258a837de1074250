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
for map in height.exr normal.png moments.exr gloss.png horizon_0_45_90_135.png horizon_180_225_270_315.png cones.png; do
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

# ---- Photographs under known lamps ----

# A weave is drawn under six lamps, from above, two repeats wide. The fabric that follows looks the same under a seventh.
over="--garment disc --avatar none --set cloth.settle_s=0 --set scene.environment=none --set light.method=unshadowed
    --set image.ground=false --set camera.pitch_deg=90 --set camera.yaw_deg=0 --set camera.distance_m=1.8333 --set camera.fov_deg=1
    --size 64x64 --set construction.show=never --quiet"
woven="--fabric none --set weave.pattern=plain --set weave.warp_pitch_mm=8 --set weave.weft_pitch_mm=8 --set weave.crimp_mm=1
    --set weave.warp_tint=[1,0.8,0.6] --set material.use_file=false --set material.diffuse=[0.5,0.3,0.2] --set material.glossiness=0.9
    --set material.specular=[0.06,0.06,0.06]"
under() { # azimuth and elevation in the picture
    echo "--set lamp.kind=directional --set lamp.yaw_deg=$(($1 + 90)) --set lamp.pitch_deg=$2 --set lamp.irradiance=[3.1416,3.1416,3.1416]"
}
printf 'swatch: {width_mm: 32}\nlamps:\n' >lights.yaml
for k in 0 1 2 3 4 5; do
    azimuth=$((60 * k + 10)) elevation=$((k % 2 ? 60 : 40))
    "$TOILE" render $over $woven $(under $azimuth $elevation) -o lit$k.exr || fail "no picture under lamp $k"
    echo "  - {azimuth_deg: $azimuth, elevation_deg: $elevation}" >>lights.yaml
done
printed=$("$TOILE" fabric lit?.exr --lights lights.yaml -o swatch --json --quiet) || fail "no fabric of photographs"
printf '%s' "$printed" | tr -d '\n\t' | grep -qE '"has_gloss":true,"glossiness":0\.(89|90|91)' || fail "its gloss: $printed"
[ -s swatch/normal.png ] && [ -s swatch/colour.png ] || fail "a picture of the swatch is missing"
grep -q 'picture_mm: 32$' swatch/fabric.yaml || fail "its scale: $(cat swatch/fabric.yaml)"
"$TOILE" render $over $woven $(under 200 35) -o seventh.exr || fail "no picture under a seventh lamp"
"$TOILE" render $over --fabric swatch/ --set weave.picture_mirror=none $(under 200 35) -o worn_swatch.exr || fail "it is not worn"
off=$("$TOILE" compare worn_swatch.exr seventh.exr | sed -n 's/^relative RMSE *//p')
awk -v off="$off" 'BEGIN { exit !(off < 0.08) }' || fail "the photographed weave looks different: $off"
# Measured so, texel by texel, it is what an environment's regions light: the weave itself is traced.
room="--set scene.environment=studio --set light.regions=24"
"$TOILE" render $over $woven $room --set light.method=reference -o traced.exr || fail "no traced weave"
"$TOILE" render $over --fabric swatch/ --set weave.picture_mirror=none $room --set light.method=pem -o roomed.exr || fail "no swatch in a room"
off=$("$TOILE" compare roomed.exr traced.exr | sed -n 's/^relative RMSE *//p')
awk -v off="$off" 'BEGIN { exit !(off < 0.05) }' || fail "the photographed weave looks different in a room: $off"
refuse "pictures without lamps enough" '6 lamps for 4 pictures' fabric lit[0-3].exr --lights lights.yaml -o swatch
refuse "photographs without an output" 'add -o' fabric lit?.exr --lights lights.yaml
refuse "lamps that are missing" 'nowhere\.yaml.*no such file' fabric lit?.exr --lights nowhere.yaml -o swatch
refuse "pictures of two sizes" 'worn\.exr: 32 x 32 texels, but lit0\.exr has 64 x 64' fabric lit[0-4].exr worn.exr --lights lights.yaml -o swatch
head -5 lights.yaml >few.yaml
refuse "three lamps" 'few\.yaml: lamps: 3 given: at least 4' fabric lit[0-2].exr --lights few.yaml -o swatch

# ---- Measured reflectance ----

# Even light is fitted exactly; light that goes back to where it came from is not, and a warning says so.
samples() { # of 0.1 and an amount of that
    awk -v amount="$1" 'BEGIN { print "theta_l phi_l theta_v phi_v value"; pi = atan2(0, -1) / 180
        for (a = 0; a < 80; a += 16) for (b = 0; b < 360; b += 60) for (c = 0; c < 80; c += 16) for (d = 0; d < 360; d += 60) {
            cosine = sin(a * pi) * sin(c * pi) * cos((b - d) * pi) + cos(a * pi) * cos(c * pi)
            print a, b, c, d, 0.1 + amount * (cosine > 0 ? cosine ^ 20 : 0) } }'
}
for amount in 0 1; do
    samples $amount >samples.txt
    printed=$("$TOILE" render --garment sphere --avatar none --size 16x16 --set light.method=unshadowed $cheap_light \
        --set material.samples=samples.txt -o samples.png 2>&1) || fail "samples are not drawn: $printed"
    [ $amount = 1 ] || printf '%s' "$printed" | grep -q 'material of lobes, 0.0 %' || fail "even light is not even: $printed"
    [ "$(printf '%s' "$printed" | grep -c 'no material of lobes')" = $amount ] || fail "warnings of a fit: $printed"
done

# ---- Fabrics of other programs ----

# A folder of texture maps: two texels, red and blue; the drape and the look are of one argument.
mkdir -p set && cp shape.png set/cloth_basecolor.png
listed=$("$TOILE" fabric set) || fail "a folder is not listed"
printf '%s' "$listed" | grep -q '^cloth_basecolor.png .*colour' || fail "its picture is not named: $listed"
"$TOILE" fabric set --json | grep -q '"used":\s*true' || fail "no JSON of a folder"
told=$("$TOILE" render -o set.png --garment sphere --avatar none --size 16x16 --set light.method=unshadowed \
    $cheap_light --fabric set/ 2>&1) || fail "a folder is not worn: $told"
printf '%s' "$told" | grep -q 'states no width: 100 mm are assumed' || fail "its width is not told: $told"
"$TOILE" render -o set.png --garment sphere --avatar none --size 16x16 --set light.method=unshadowed \
    $cheap_light --fabric set/ --set weave.picture_mm=40 2>&1 | grep -q assumed && fail "a given width is assumed"

# toile's own form is read back to the same: the same options, the same image to the bit, and it writes itself again.
"$TOILE" fabric set -o own --quiet || fail "a folder is not written"
cmp -s set/cloth_basecolor.png own/colour.png || fail "its picture is not copied as it is"
wear from_set.exr --fabric set/ --set weave.picture_mm=40
wear from_own.exr --fabric own/ --set weave.picture_mm=40
cmp -s from_set.exr from_own.exr || fail "toile's own form looks different"
"$TOILE" fabric own -o own2.yaml --quiet || fail "toile's own form is not written"
wear from_own2.exr --fabric own2.yaml --set weave.picture_mm=40
cmp -s from_own.exr from_own2.exr || fail "the second copy looks different"
for name in denim satin; do
    "$TOILE" fabric $name -o "$name.yaml" --quiet || fail "$name is not written"
    cmp -s <("$TOILE" fabric $name | tail -n +2) <("$TOILE" fabric "$name.yaml" | tail -n +2) || fail "$name is read back as another"
done
find . -name '*.tmp' | grep -q . && fail "a temporary file is left"

# Measurements alone change how cloth falls, and leave the garment its look.
strip='{"S2": {"width": 5, "samplesTree": [[8, 0, 8.1, 10, 8.2, 60]]}}'
printf '{"raw_data": {"M": 200, "L": %s, "W": %s, "B": %s}}' "$strip" "$strip" "$strip" >strips.json
"$TOILE" fabric strips.json | grep -q '^  areal_density: 0.2$' || fail "the weight is not used"
"$TOILE" fabric strips.json | grep -q '^  use_file: true$' || fail "measurements change the look"

# Bad input: one line, status 2.
printf '{"schema": "1.1"' >cut.u3m
printf 'no archive' >words.u3ma
mkdir -p nothing
refuse "cut U3M" 'cut\.u3m:1: .*JSON' fabric cut.u3m
refuse "cut U3M as a fabric" 'cut\.u3m:1: .*JSON' render -o x.png --fabric cut.u3m
refuse "words as an archive" 'words\.u3ma.*zip' fabric words.u3ma
refuse "a folder of nothing" 'nothing.*no texture maps' render -o x.png --fabric nothing/
refuse "a lost file" 'lost\.u3m.*no such file' fabric lost.u3m
refuse "an unknown name" 'denin.*did you mean denim' fabric denin

# ---- The card ----

cheap_card="--set cloth.edge_m=0.03 --set cloth.settle_s=2 --set light.method=unshadowed --set light.rounds=1
    --set image.supersample=1 $cheap_light"
# Cloth without gloss and yarns sends back its base colour under light from everywhere: CIELAB of 0.2, 0.1, 0.05 is 40.8,
# 10.8, 20.5. Its figures are the file's, and what follows from them: (6e-6 / (0.2 * 9.81))^(1/3) is 14.5 mm.
printf 'fabric: {areal_density: 0.2, bend_weft: 6e-6}\nweave: {pattern: none}\nmaterial: {use_file: false, diffuse: [0.2, 0.1, 0.05], specular: [0, 0, 0], glossiness: 0}\n' >plain.yaml
sed -i '1i # Woven by nobody.' plain.yaml
"$TOILE" fabric plain.yaml --card card.json $cheap_card --quiet || fail "no card as JSON"
has() { tr -d '\n\t' <card.json | grep -qE "$1" || fail "card.json: no $1: $(tr -d '\n\t' <card.json | head -c 4000)"; }
has '"notes":"Woven by nobody\.'
has '"Weight","value":200,"unit":"g/m[^"]*","source":"plain.yaml: fabric.areal_density"'
has '"Bending rigidity, weft","value":6,"unit":"[^"]*m","source":"plain.yaml'
has '"Bending rigidity, warp","value":10,"unit":"[^"]*m","source":"not stated'
has '"Bending length, weft","value":14\.5'
has '"coefficient_percent":[0-9]'
has '"base":\{"lab_d65":\[40\.8[0-9]*, *10\.7[0-9]*, *20\.5'
has '"ciede2000":0\.[0-3]'
# A picture's mean is in the base colour; what is set is named, a file's field too, and those that are not used are listed.
"$TOILE" fabric strips.json --card card.json $cheap_card --set fabric.shear=50 --quiet || fail "no card of measurements"
has '"Weight","value":200,"unit":"g/m[^"]*","source":"raw_data.M"'
has '"Shear stiffness","value":50,"unit":"N/m","source":"set: fabric.shear"'
has '"used":false'
tr -d '\n\t' <card.json | grep -q '"colour"' && fail "measurements have a colour"
"$TOILE" fabric plain.yaml --card card.pdf $cheap_card --quiet || fail "no card as PDF"
head -c 8 card.pdf | grep -q '%PDF-1' && grep -aq '/MediaBox \[ 0 0 595.27[0-9]* 841.88' card.pdf || fail "the card is no A4 page"
refuse "a card of no kind" 'card\.txt.*\.png, \.pdf or \.json' fabric denim --card card.txt
refuse "a card and a copy" 'leave out -o' fabric denim --card card.png -o copy
refuse "a card into nothing" 'nowhere/card\.png' fabric denim --card nowhere/card.png
refuse "a card of heights" 'height map alone' fabric height.png --card card.png
refuse "an option of no fabric" 'light: no such table' fabric denim --set light.rounds=2
