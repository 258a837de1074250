#!/usr/bin/env bash
# Every bad input: exit status 2, exactly one line on stderr that names what is wrong, and no file left behind.
set -u
. "$(dirname "$0")/cli.sh"

# le32 N: four bytes, little endian.
le32() { printf "\\x$(printf %02x $(($1 & 255)))\\x$(printf %02x $(($1 >> 8 & 255)))\\x$(printf %02x $(($1 >> 16 & 255)))\\x$(printf %02x $(($1 >> 24 & 255)))"; }

# glb FILE JSON [BINARY_FILE]: a well-formed GLB around some JSON.
glb() {
    local json=$2 binary=${3:-} length
    while [ $((${#json} % 4)) -ne 0 ]; do json="$json "; done
    length=$((20 + ${#json}))
    [ -n "$binary" ] && length=$((length + 8 + $(stat -c %s "$binary")))
    { printf glTF; le32 2; le32 $length; le32 ${#json}; printf JSON; printf '%s' "$json"
      [ -n "$binary" ] && { le32 "$(stat -c %s "$binary")"; printf 'BIN\0'; cat "$binary"; }; } >"$1"
}

mkdir folder.glb
: >empty.glb
echo "this is not a model" >text.glb
# A triangle: three positions (36 bytes), three 16-bit indices, two bytes of padding.
{ head -c 12 /dev/zero; printf '\0\0\200\77\0\0\0\0\0\0\0\0'; printf '\0\0\0\0\0\0\200\77\0\0\0\0'; printf '\0\0\1\0\2\0\0\0'; } >good.bin
{ head -c 36 good.bin; printf '\0\0\1\0\7\0\0\0'; } >index.bin
{ printf '\0\0\300\177'; tail -c +5 good.bin; } >nan.bin
mesh='{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],"buffers":[{"byteLength":44}]}'
glb good.glb "$mesh" good.bin
glb index.glb "$mesh" index.bin
glb nan.glb "$mesh" nan.bin
glb nomesh.glb '{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[]}]}'
glb lies.glb "${mesh//\"count\":3/\"count\":357913941}" good.bin
head -c 60 good.glb >truncated.glb
{ printf glTF; le32 2; printf '\377\377\377\377'; tail -c +13 good.glb; } >huge.glb
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 0\n' >zero.hdr
light='#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\200\200\200\201\200\200\200\201'
for name in gap.1 gap.3 torn.1; do printf "$light" >$name.hdr; done
printf 'no light\n' >torn.2.hdr
# A triangle as OBJ, and as point caches of one sample: an MDD is big endian.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >good.obj
points=$(printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\n')
printf '%s\nf 1 2 4\n' "$points" >index.obj
printf '%s\nv 0 0 nan\nf 1 2 3\n' "$points" >nan.obj
printf '%s\nv 0 abc 0\nf 1 2 3\n' "$points" >words.obj
printf '%s\n' "$points" >nomesh.obj
cp text.glb text.obj
head -c 20 good.obj >truncated.obj
# pc2 POINTS SAMPLES FILE_OF_NUMBERS: rate 1.
pc2() { printf 'POINTCACHE2\0'; le32 1; le32 "$1"; printf '\0\0\0\0\0\0\200\77'; le32 "$2"; cat "$3"; }
head -c 36 good.bin >numbers.bin
head -c 36 nan.bin >nan_numbers.bin
pc2 3 1 numbers.bin >good.pc2
pc2 3 1 nan_numbers.bin >nan.pc2
pc2 1 3 numbers.bin >count.pc2
pc2 3 0 numbers.bin >zero.pc2
pc2 -1 1 numbers.bin >negative.pc2
pc2 2147483647 2147483647 numbers.bin >lies.pc2
head -c 60 good.pc2 >truncated.pc2
{ printf 'pointcache2\0'; tail -c +13 good.pc2; } >magic.pc2
{ head -c 24 good.pc2; printf '\0\0\300\177'; tail -c +29 good.pc2; } >rate.pc2
{ printf '\0\0\0\2\0\0\0\3'; printf '\77\200\0\0\0\0\0\0'; cat numbers.bin numbers.bin; } >falling.mdd
{ printf '\0\0\0\1\0\0\0\3\0\0\0\0'; head -c 35 numbers.bin; } >truncated.mdd
cp good.obj pose.1.obj
printf 'v 0 0 0\n' >pose.2.obj
printf 'light:\n  regionz: 24\n' >key.yaml
printf 'light:\n  regions: 7000\n' >range.yaml
printf 'light:\n  regions: many\n' >type.yaml
printf 'light: [1\n' >broken.yaml

for file in good.glb good.obj good.pc2; do
    "$TOILE" info $file >/dev/null || fail "$file must load, or the tests below prove nothing"
done
"$TOILE" export -o played.glb --env white --avatar ball --garment good.obj --motion good.pc2 --quiet && rm played.glb ||
    fail "good.pc2 must play"

# other_GARMENT_OR_AVATAR: the rest of a scene that names one file, made in no time.
other_garment="--env white --avatar ball"
other_avatar="--env white --garment none"
for kind in garment avatar; do
    other=other_$kind other=${!other}
    refuse "missing $kind" 'nowhere\.glb.*no such file' export -o a.glb $other --$kind nowhere.glb
    refuse "folder as $kind" 'folder\.glb.*folder' export -o a.glb $other --$kind folder.glb
    refuse "empty $kind" 'empty\.glb.*empty' export -o a.glb $other --$kind empty.glb
    refuse "text as $kind" 'text\.glb' export -o a.glb $other --$kind text.glb
    refuse "truncated $kind" 'truncated\.glb' export -o a.glb $other --$kind truncated.glb
    refuse "$kind whose length lies" 'huge\.glb' export -o a.glb $other --$kind huge.glb
    refuse "$kind whose counts lie" 'lies\.glb' export -o a.glb $other --$kind lies.glb
    refuse "$kind with an index out of range" 'index\.glb.*(index|vertex|range)' export -o a.glb $other --$kind index.glb
    refuse "$kind with NaN positions" 'nan\.glb.*(NaN|finite|number)' export -o a.glb $other --$kind nan.glb
    refuse "$kind without a mesh" 'nomesh\.glb.*(mesh|triangle)' export -o a.glb $other --$kind nomesh.glb
done
for kind in garment avatar; do
    other=other_$kind other=${!other}
    refuse "missing OBJ $kind" 'nowhere\.obj.*no such file' export -o a.glb $other --$kind nowhere.obj
    refuse "text as OBJ $kind" 'text\.obj.*triangles' export -o a.glb $other --$kind text.obj
    refuse "truncated OBJ $kind" 'truncated\.obj.*line' export -o a.glb $other --$kind truncated.obj
    refuse "OBJ $kind with an index out of range" 'index\.obj.*out of range' export -o a.glb $other --$kind index.obj
    refuse "OBJ $kind with NaN" 'nan\.obj: line 4.*nan' export -o a.glb $other --$kind nan.obj
    refuse "OBJ $kind with words for numbers" 'words\.obj: line 4.*abc' export -o a.glb $other --$kind words.obj
    refuse "OBJ $kind without faces" 'nomesh\.obj.*triangles' export -o a.glb $other --$kind nomesh.obj
done
play="export -o a.glb $other_garment --garment good.obj --motion"
refuse "missing motion" 'nowhere\.pc2.*no such file' $play nowhere.pc2
refuse "motion of no known kind" 'good\.glb.*motion' $play good.glb
refuse "motion without a garment" 'scene\.motion.*garment' export -o a.glb --garment none --avatar ball --motion good.pc2
refuse "truncated PC2" 'truncated\.pc2.*cut short' $play truncated.pc2
refuse "PC2 of other points" 'count\.pc2.*1 points.*good\.obj has 3' $play count.pc2
refuse "PC2 with NaN" 'nan\.pc2.*not finite' $play nan.pc2
refuse "PC2 whose counts lie" 'lies\.pc2.*points' $play lies.pc2
refuse "PC2 without samples" 'zero\.pc2.*samples' $play zero.pc2
refuse "PC2 of negative points" 'negative\.pc2.*-1 points' $play negative.pc2
refuse "PC2 with a rate of NaN" 'rate\.pc2.*nan' $play rate.pc2
refuse "no PC2 at all" 'magic\.pc2.*no PC2' $play magic.pc2
refuse "truncated MDD" 'truncated\.mdd.*cut short' $play truncated.mdd
refuse "MDD whose times fall" 'falling\.mdd.*rise' $play falling.mdd
refuse "sequence of poses without files" 'pos\.#\.obj.*no file' $play 'pos.#.obj'
refuse "sequence of other points" 'pose\.2\.obj.*1 vertices' $play 'pose.#.obj' --frame 1
refuse "unknown units" 'units.*feet.*auto, m' render -o a.png --units feet
refuse "export of no known kind" 'a\.fbx.*\.glb' export -o a.fbx
refuse "frames as OBJ" 'a\.obj.*one frame' export -o a.obj --frames 0:3
refuse "motion of no garment" 'a\.pc2.*garment' export -o a.pc2 --garment none --avatar ball --frames 0:3
refuse "info of a broken PC2" 'lies\.pc2' info lies.pc2
refuse "missing environment" 'nowhere\.exr.*no such file' render -o a.png --env nowhere.exr
refuse "text as environment" 'text\.glb' render -o a.png --env text.glb
refuse "zero-sized image" 'zero\.hdr' render -o a.png --env zero.hdr
refuse "sequence without frames" 'sky\.##\.exr.*no file' render -o a.png --env 'sky.##.exr'
refuse "live light where frames are drawn twice" 'check.*light from stdin' check --env - </dev/null
if command -v ffmpeg >/dev/null; then
    refuse "no film on stdin" 'stdin is no film.*ffmpeg' render -o a.png --env - </dev/null
else
    echo "skipped: no film on stdin: ffmpeg is absent"
fi
refuse "sequence with a gap" 'gap\.2\.hdr.*missing' render -o a.png --env 'gap.#.hdr'
refuse "sequence with a broken frame" 'torn\.2\.hdr' render -o a.png --env 'torn.#.hdr' --garment none --avatar ball $cheap_light --frame 1
printf 'theta_l,phi_l,theta_v,phi_v,r,g,b\n1,2,3,4,5,6\n' >short.csv
refuse "samples without a number" 'short\.csv.*line 2.*6 numbers, not 7' render -o a.png --set material.samples=short.csv
refuse "samples that are a model" 'good\.obj.*columns' render -o a.png --set material.samples=good.obj
refuse "missing samples" 'nowhere\.csv' render -o a.png --set material.samples=nowhere.csv
refuse "unknown key" 'key\.yaml:2.*regionz.*regions' render key.yaml -o a.png
refuse "value out of range" 'range\.yaml:2.*light\.regions' render range.yaml -o a.png
refuse "wrong type" 'type\.yaml:2.*light\.regions' render type.yaml -o a.png
refuse "broken YAML" 'broken\.yaml' render broken.yaml -o a.png
refuse "missing scene" 'nowhere\.yaml.*no such file' render nowhere.yaml -o a.png
refuse "unknown --set" 'light\.regionz.*regions' render -o a.png --set light.regionz=24
refuse "unknown fabric" 'satinn.*satin' render -o a.png --fabric satinn
refuse "unknown preset" 'papr.*paper' render -o a.png --preset papr
refuse "unknown flag" '\-\-fabrik.*--fabric' render -o a.png --fabrik satin
refuse "unknown command" 'rendr.*render' rendr
refuse "no output" 'output' render
refuse "unknown image kind" 'a\.bmp' render -o a.bmp
refuse "output in no folder" 'nowhere/a\.png' render -o nowhere/a.png
refuse "output is a folder" 'folder\.glb' render -o folder.glb/../folder.glb/x/../../folder.glb/a.png/b.png
refuse "size without height" '\-\-size' render -o a.png --size 960
refuse "compare without files" 'compare' compare
refuse "compare a missing file" 'nowhere\.png' compare nowhere.png nowhere.png
refuse "info without a file" 'info' info
refuse "info of a broken file" 'text\.glb' info text.glb

# Memory: refused before it is taken; and where the system refuses, one line, and nothing is left.
refuse "memory without a unit" '\-\-memory: "5": expected' info dress.glb --memory 5
refuse "memory that is too little" 'needs .* of 50 MiB allowed' render -o a.png --size 4096x4096 --memory 50M
printf '#?RADIANCE\n\n-Y 1 +X 2\n\1\2\3\200\1\2\3\200' >small.hdr
refuse "a converted map that is too large" 'needs .* of 1.0 GiB allowed' env small.hdr -o a.exr --layout cube --size 4000 --memory 1000M
for kib in 350000 450000 600000; do
    (ulimit -v $kib && refuse "out of memory at $kib KiB" 'out of memory|too little memory' render -o a.png --preset draft --size 64x64) || failed=1
done

full=$(mktemp -d)
if mount -t tmpfs -o size=8k tmpfs "$full" 2>/dev/null; then
    fast="--preset draft --garment none --avatar ball $cheap_light --size 256x256"
    refuse "full disk, PNG" 'written' render -o "$full/a.png" $fast
    refuse "full disk, EXR" 'written' render -o "$full/a.exr" $fast
    [ -z "$(ls -A "$full")" ] || fail "full disk: files left: $(ls -A "$full")"
    umount "$full"
else
    echo "skipped: full disk: a tmpfs cannot be mounted here"
fi
rmdir "$full"

if [ -d "$data/broken" ]; then
    for file in "$data"/broken/exr/openexr_comp_short_decode_piz.exr "$data"/broken/exr/openexr_comp_early_eof_piz.exr; do
        refuse "damaged $(basename "$file")" "$(basename "$file")" render -o a.png --env "$file"
    done
    head -c 100000 "$data/envmaps/exr/brown_photostudio_02_1k_half_piz_rgba.exr" >cut.exr
    refuse "truncated EXR" 'cut\.exr' render -o a.png --env cut.exr
else
    echo "skipped: damaged EXR files: $data is absent"
fi
