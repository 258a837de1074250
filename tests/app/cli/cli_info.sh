#!/usr/bin/env bash
# What toile info says of a material that it can only come near to.
set -u
. "$(dirname "$0")/cli.sh"

# A triangle: (0 0 0) (1 0 0) (0 1 0).
positions=$(printf '\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\077\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\077\0\0\0\0' | base64 -w0)
write() {
    cat >"$1" <<END
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
 "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
 "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
 "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36}],
 "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,$positions"}],
 "extensionsUsed":[$2],
 "materials":[{"name":"satin","pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0.5},"extensions":{$3}}]}
END
}
write satin.gltf '"KHR_materials_anisotropy","KHR_materials_clearcoat"' \
    '"KHR_materials_anisotropy":{"anisotropyStrength":1,"anisotropyRotation":1.5707963},
     "KHR_materials_clearcoat":{"clearcoatFactor":0.5}'
check "the model's name" sh -c "$TOILE info satin.gltf | grep -Eq '^ +model +ward$'"
check "its wide direction" sh -c "$TOILE info satin.gltf | grep -Eq '^ +width_weft +1$'"
check "its narrow direction" sh -c "$TOILE info satin.gltf | grep -Eq '^ +width_warp +0.25$'"
check "its rotation" sh -c "$TOILE info satin.gltf | grep -Eq '^ +rotation_deg +90'"
check "its coat" sh -c "$TOILE info satin.gltf | grep -Eq '^ +coat +0.5$'"
check "words for what is not GGX" sh -c "$TOILE info satin.gltf | grep -q 'KHR_materials_anisotropy: shown by Ward'"
check "the same as JSON" sh -c "$TOILE info satin.gltf --json | tr -d '\\n' | grep -q '\"approximated\":.*shown by Ward'"
check "nothing is called ignored" sh -c "$TOILE info satin.gltf | grep -Eq '^ignored +none$'"
write odd.gltf '"KHR_materials_iridescence"' '"KHR_materials_iridescence":{"iridescenceFactor":1}'
check "what has no effect" sh -c "$TOILE info odd.gltf | grep -A1 '^ignored' | grep -q KHR_materials_iridescence"
# Its first and last vertex are pinned, the last one is painted red.
pins=$(printf '\0\0\200\077\0\0\0\0\0\0\200\077\377\377\377\377\0\377\377\377\377\0\0\377' | base64 -w0)
cat >pinned.gltf <<END
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
 "meshes":[{"primitives":[{"attributes":{"POSITION":0,"_PIN":1,"COLOR_0":2}}]}],
 "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
  {"bufferView":1,"componentType":5126,"count":3,"type":"SCALAR"},
  {"bufferView":2,"componentType":5121,"normalized":true,"count":3,"type":"VEC4"}],
 "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":1,"byteLength":12},{"buffer":1,"byteOffset":12,"byteLength":12}],
 "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,$positions"},
  {"byteLength":24,"uri":"data:application/octet-stream;base64,$pins"}]}
END
check "pinned vertices" sh -c "$TOILE info pinned.gltf | grep -Eq '^pins +2$'"
check "painted vertices" sh -c "$TOILE info pinned.gltf | grep -Eq '^ +red +1$'"
check "no pins" sh -c "$TOILE info satin.gltf | grep -Eq '^pins +0$'"

# A supplier's gate: 0 for a sound file, 1 for one with an error, and 0 again where nobody asked; the reason is in the JSON.
sed 's/"materials":\[{"name":"satin",/"textures":[{"source":0}],"images":[{"uri":"absent.png"}],"materials":[{"name":"satin","normalTexture":{"index":0},/' satin.gltf >textured.gltf
check "a sound file passes" $TOILE info satin.gltf --strict --json >strict.json
check "... without findings" sh -c "tr -d ' \n\t' <strict.json | grep -q '\"findings\":\[\],\"errors\":0,\"warnings\":0'"
status=0
$TOILE info textured.gltf --strict --json >strict.json 2>told || status=$?
check "a file with an error fails" test $status -eq 1
check "... without a message of its own" test ! -s told
check "... and names the picture" sh -c "tr -d ' \n\t' <strict.json | grep -q '\"code\":\"file-missing\",\"severity\":\"error\",\"place\":{\"file\":\"absent.png\"}'"
check "it passes where nobody is strict" sh -c "$TOILE info textured.gltf | grep -Eq '^  error   file-missing +absent.png: '"
printf 'scene:\n  garment: absent.glb\n' >scene.yaml
status=0
$TOILE info scene.yaml --strict >told || status=$?
check "a scene's missing garment" sh -c "test $status -eq 1 && grep -Eq 'file-missing +.*absent.glb: scene.garment' told"
check "the codes are listed" sh -c "$TOILE info findings | grep -Eq '^ +code +seam-open$'"
