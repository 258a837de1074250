#!/bin/bash
# Files of strangers: what they name outside their folder is not read, what they are called reaches no terminal, and the
# user's own files are not replaced by mistake.
. "$(dirname "$0")/cli.sh"

# A triangle whose positions lie in the file that $1 names, with material name $2.
triangle() {
    printf '{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"materials":[{"name":"%s"}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"uri":"%s","byteLength":36}]}' "$2" "$1"
}
mkdir -p model/deep secret
printf '\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\077\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\077\0\0\0\0' >secret/data.bin
cp secret/data.bin model/deep/data.bin
ln -s ../secret/data.bin model/link.bin
triangle deep/data.bin plain >model/inside.gltf
triangle ../secret/data.bin plain >model/above.gltf
triangle "$PWD/secret/data.bin" plain >model/absolute.gltf
triangle link.bin plain >model/link.gltf
check "a buffer below the folder is read" $TOILE info model/inside.gltf --json --quiet >inside.json
refuse "glTF, absolute" "File not found" info model/absolute.gltf # tinygltf takes it for a relative one
for kind in above link; do
    refuse "glTF, $kind" "lies outside the folder" info model/$kind.gltf
    check "glTF, $kind, allowed" $TOILE info model/$kind.gltf --allow-outside --quiet >/dev/null
done
printf 'newmtl red\nKd 1 0 0\nmap_Kd ../secret/red.png\n' >model/own.mtl
printf 'newmtl red\nKd 1 0 0\n' >secret/red.mtl
printf 'mtllib own.mtl\nmtllib ../secret/red.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >model/names.obj
printf 'no picture' >secret/red.png
$TOILE info model/names.obj --quiet >names.txt
check "OBJ: a picture outside is noted" grep -q 'red.png: lies outside the folder' names.txt
check "OBJ: so are materials" grep -q 'red.mtl: lies outside the folder' names.txt

# Names with commands for a terminal: escape, the second set in UTF-8, a carriage return. Text of any script stays.
triangle deep/data.bin 'bad\u001b[31m\u009b2J\u000dname 한글 été' >model/names.gltf
LC_ALL=C.UTF-8 $TOILE info model/names.gltf --quiet >shown.txt
check "text stays" grep -q '한글 été' shown.txt
check "no control characters in results" bash -c '! LC_ALL=C grep -qP "[\x00-\x08\x0b-\x1f\x7f]|\xc2[\x80-\x9f]" shown.txt'
mkdir "$(printf 'odd\033[2Jname')"
$TOILE info "$(printf 'odd\033[2Jname')/absent.glb" 2>message.txt
check "no control characters in messages" bash -c '! LC_ALL=C grep -qP "[\x00-\x08\x0b-\x1f\x7f]" message.txt'
# Longer than a buffer, with characters of three bytes at every place of it.
for i in $(seq 3000); do printf 'mtllib x.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl 한글%d\n' $i; done | head -900 >many.obj
$TOILE info many.obj --quiet >many.txt
check "characters are whole at the ends of buffers" iconv -f UTF-8 -t UTF-8 many.txt -o /dev/null

# Radiance.
printf '#?RADIANCE\n\n-Y 1 +X 2\n\1\2\3\376\1\2\3\200' >absurd.hdr
$TOILE env absurd.hdr -o out.exr --layout latlong --size 2 2>message.txt
check "absurd radiance is reported" grep -q 'brightest texel is' message.txt

# Outputs.
triangle deep/data.bin kept >model/input.gltf
cp model/input.gltf before.gltf
mv model/input.gltf model/input.glb
cp model/input.glb before.glb
refuse "an input as output" "is read by this command" export model/input.glb -o model/input.glb $cheap_light
check "it is as it was" cmp model/input.glb before.glb
printf '#?RADIANCE\n\n-Y 1 +X 2\n\1\2\3\200\1\2\3\200' >small.hdr
$TOILE env small.hdr -o first.exr --layout latlong --size 2 --quiet
refuse "an input by another name" "is read by this command" env first.exr -o ./first.exr --layout sphere
check "by force" $TOILE env first.exr -o first.exr --layout sphere --force --quiet
mkdir elsewhere
echo old >elsewhere/target.exr
ln -s elsewhere/target.exr link.exr
$TOILE env small.hdr -o link.exr --layout latlong --size 2 --quiet
check "a symbolic link stays one" test -L link.exr
check "what it names is written" cmp link.exr elsewhere/target.exr
check "with the picture" $TOILE info elsewhere/target.exr --quiet >/dev/null
