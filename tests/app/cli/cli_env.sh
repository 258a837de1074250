#!/usr/bin/env bash
# toile env: what it writes is read back as what it is, and what it cannot do it refuses in one line with status 2.
set -u
. "$(dirname "$0")/cli.sh"

# shape FILE: "WIDTH HEIGHT" as toile reads it.
shape() { "$TOILE" info "$1" --json | tr -d '\n\t' | sed 's/.*"width":[[:space:]]*\([0-9]*\).*"height":[[:space:]]*\([0-9]*\).*/\1 \2/'; }

# Two texels of light, one of them bright.
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\200\200\200\201\200\100\040\205' >light.hdr

refuse "no input" 'expected one' env -o a.exr --layout cube
refuse "missing input" 'nowhere\.exr.*no such file' env nowhere.exr -o a.exr --layout cube
refuse "no output" 'output' env light.hdr --layout cube
refuse "output of another kind" 'a\.png.*\.exr' env light.hdr -o a.png --layout cube
refuse "no layout" 'layout' env light.hdr -o a.exr
refuse "unknown layout" 'cub.*cube, sphere' env light.hdr -o a.exr --layout cub
refuse "unknown --from" '\-\-from.*ball.*sphere' env light.hdr -o a.exr --layout cube --from ball
refuse "--from against the shape" 'light\.hdr.*sphere' env light.hdr -o a.exr --layout cube --from sphere
refuse "size 0" '\-\-size' env light.hdr -o a.exr --layout cube --size 0
refuse "size in words" '\-\-size' env light.hdr -o a.exr --layout cube --size big
refuse "size too large" 'a\.exr.*32768' env light.hdr -o a.exr --layout cube --size 6000
refuse "size beyond an int" '\-\-size' env light.hdr -o a.exr --layout latlong --size 99999999999
refuse "size near the largest int" 'a\.exr.*32768' env light.hdr -o a.exr --layout latlong --size 2147483647
refuse "a scene for a file" 'maps\.size=8.*--capture' env light.hdr -o a.exr --layout cube --set maps.size=8
refuse "--from for a capture" '\-\-from.*cube' env --capture -o a.exr --layout cube --from cube
refuse "a capture too large" 'a\.exr.*32768' env --capture -o a.exr --layout cube --size 6000
refuse "a capture of two scenes" 'one scene' env --capture one.yaml two.yaml -o a.exr --layout cube
refuse "output in no folder" 'nowhere/a\.exr' env light.hdr -o nowhere/a.exr --layout cube

expect() { [ "$(shape "$1")" = "$2" ] || fail "$1: $(shape "$1"), expected $2"; }
for layout in cube sphere paraboloid latlong octahedral; do
    "$TOILE" env light.hdr -o $layout.exr --layout $layout --size 16 --quiet || fail "$layout"
    "$TOILE" env $layout.exr -o back.exr --layout latlong --size 1 --quiet || fail "$layout and back"
    "$TOILE" env light.hdr -o same.exr --layout latlong --quiet
    # Halves of the sphere, which meet at borders of texels in every layout of an even size: what is left is the
    # stated error, twice.
    rmse=$("$TOILE" compare back.exr same.exr --json | sed -n 's/.*"rel_rmse":[[:space:]]*\([0-9.e-]*\).*/\1/p')
    awk -v e="$rmse" 'BEGIN { exit !(e != "" && e < 0.002) }' || fail "$layout and back: relative RMSE $rmse"
done
# A scene reads what this command wrote: the same light in any layout. Octahedral maps have the shape of spheres, and
# paraboloids that of lat-long maps: the file states which it is.
ball="--garment none --avatar ball --preset draft --size 32x32 $cheap_light --set light.rounds=16 --quiet"
for layout in latlong cube sphere paraboloid octahedral; do
    "$TOILE" env studio -o studio.exr --layout $layout --size 64 --quiet || fail "env studio --layout $layout"
    "$TOILE" info studio.exr | grep -q "layout  *${layout/latlong/lat-long}$" || fail "$layout: info names another layout"
    "$TOILE" render $ball --env studio.exr -o lit.$layout.exr || fail "--env of a map, $layout"
    rmse=$("$TOILE" compare lit.$layout.exr lit.latlong.exr --json | sed -n 's/.*"rel_rmse":[[:space:]]*\([0-9.e-]*\).*/\1/p')
    awk -v e="$rmse" 'BEGIN { exit !(e != "" && e < 0.02) }' || fail "lit by a map, $layout: relative RMSE $rmse"
done
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n\200\200\200\201\200\100\040\205\200\200\200\201\200\100\040\205' >square.hdr
"$TOILE" render ${ball/--quiet/} --env square.hdr -o lit.exr 2>&1 | grep -q 'square\.hdr: 2 x 2 texels are taken for lat-long' ||
    fail "a square picture is taken for lat-long without a word"

expect cube.exr "16 96"
expect sphere.exr "16 16"
expect paraboloid.exr "32 16"
expect latlong.exr "32 16"
grep -q 'faces +X -X' cube.exr || fail "cube.exr does not say how it is laid out"
"$TOILE" env square.hdr -o guess.exr --layout cube 2>&1 | grep -q 'taken for sphere' || fail "a guess is not said aloud"
"$TOILE" env cube.exr -o guess.exr --layout latlong 2>&1 | grep -q 'taken for cube' || fail "a cube is not guessed"

# A figure without a garment, in a file of the studio: the capture shows both.
"$TOILE" env --capture --garment none $cheap_light -o captured.exr --layout paraboloid --size 16 --quiet || fail "--capture"
[ "$(shape captured.exr)" = "32 16" ] || fail "captured.exr: $(shape captured.exr)"
"$TOILE" env --capture --garment none $cheap_light --set maps.capture_at='[0,0,2]' -o aside.exr --layout paraboloid --size 16 \
    --quiet || fail "--capture from aside"
"$TOILE" compare aside.exr captured.exr --json | grep -q '"rel_rmse":[[:space:]]*0[,.]0*[,}]' &&
    fail "the figure is not seen from aside"

if [ -r "$data/exr-features/BrightRingsNanInf.exr" ]; then
    message=$("$TOILE" env "$data/exr-features/BrightRingsNanInf.exr" -o clean.exr --from latlong --layout cube --size 32 2>&1)
    printf '%s' "$message" | grep -q 'cleaned' || fail "NaN and Inf are not told"
    "$TOILE" info clean.exr --json | grep -q '"nan_cleaned":[[:space:]]*0' || fail "NaN went through"
else
    echo "skipped: NaN and Inf: $data is absent"
fi
