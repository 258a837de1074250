#!/usr/bin/env bash
# toile bake: a coarse sheet with the maps of a finer one looks more like it; what cannot be baked is refused.
set -u
. "$(dirname "$0")/cli.sh"

# sheet CELLS BUMP_M U_SCALE: an upright square of 60 cm with bumps, as OBJ with texture coordinates.
sheet() {
    awk -v n="$1" -v bump="$2" -v scale="$3" 'BEGIN {
        k = 2 * 3.14159265 * 5
        for (j = 0; j <= n; j++) for (i = 0; i <= n; i++) {
            u = i / n; v = j / n
            printf "v %.6f %.6f %.6f\nvt %.6f %.6f\n", 0.6 * u - 0.3, 0.6 * v + 0.5, bump * sin(k * u) * sin(k * v), scale * u, v
        }
        for (j = 0; j < n; j++) for (i = 0; i < n; i++) {
            a = j * (n + 1) + i + 1; b = a + 1; c = b + n + 1; d = a + n + 1
            printf "f %d/%d %d/%d %d/%d %d/%d\n", a, a, b, b, c, c, d, d
        }
    }'
}

sheet 6 0 1 >coarse.obj
sheet 160 0.006 1 >fine.obj
sheet 6 0 2 >tiled.obj
awk '/^v / { $4 += 1 } 1' fine.obj >far.obj
grep -v '^vt' coarse.obj | sed 's#/[0-9]*##g' >plain.obj
$TOILE bake coarse.obj fine.obj -o normals.png --size 256 2>log || fail "normals: $(cat log)"
$TOILE bake coarse.obj fine.obj -o heights.exr --size 256 --reach-mm 50 2>log || fail "heights: $(cat log)"
grep -q '65536 texels in its charts, 0 of them without' log || fail "report: $(cat log)"

draw() { # GARMENT OUT OPTIONS...
    $TOILE render -o "$2" --garment "$1" --avatar none --set scene.drape=authored --set scene.smooth=false --size 96x96 \
        --env none --set light.method=unshadowed --set lamp.kind=directional --set lamp.yaw_deg=60 --set image.ground=false \
        --set camera.target=[0,0.8,0] --set camera.distance_m=1.2 --quiet "${@:3}" || fail "render $1"
}
error() { $TOILE compare "$1" fine.exr --json | sed -n 's/.*"rel_rmse":[[:space:]]*\([0-9.e-]*\).*/\1/p'; }
draw fine.obj fine.exr
draw coarse.obj without.exr
draw coarse.obj with.exr --set detail.normals=normals.png
draw coarse.obj relief.exr --set detail.normals=normals.png --set detail.heights=heights.exr --set detail.mode=relief
without=$(error without.exr) with=$(error with.exr) relief=$(error relief.exr)
echo "relative RMSE to the finer sheet: $without without maps, $with with normals, $relief with heights too"
check "normals bring the finer sheet" awk "BEGIN { exit !($with < $without / 5) }"
check "heights do not undo it" awk "BEGIN { exit !($relief < $without / 3) }"

refuse "one mesh" 'two meshes' bake coarse.obj -o a.png
refuse "no output" '\.png for normals' bake coarse.obj fine.obj
refuse "unknown kind" 'a\.tif' bake coarse.obj fine.obj -o a.tif
refuse "too large" '\-\-size.*8192' bake coarse.obj fine.obj -o a.png --size 10000
refuse "tiled texture coordinates" 'tiled\.obj.*unit square' bake tiled.obj fine.obj -o a.png
refuse "no texture coordinates" 'plain\.obj.*no texture coordinates' bake plain.obj fine.obj -o a.png
refuse "nothing within reach" 'far\.obj.*nowhere within reach' bake coarse.obj far.obj -o a.png
refuse "missing mesh" 'nowhere\.obj' bake coarse.obj nowhere.obj -o a.png
refuse "missing normals" 'nowhere\.png' render -o a.png --set detail.normals=nowhere.png
refuse "heights that are no EXR" 'normals\.png.*\.exr' render -o a.png --set detail.heights=normals.png
