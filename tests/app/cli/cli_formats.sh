#!/usr/bin/env bash
# Every kind of file that garment programs write, opened by one argument and otherwise by default: it is read, named, and
# drawn. Files are made here; format_files makes those that take an encoder.
set -eu
. "$(dirname "$0")/cli.sh"
command -v python3 >/dev/null || { echo "skipped: files are made by python3, which is absent"; exit 77; }
small="--preset draft --size 64x64 $cheap_light --quiet"

"$FORMAT_FILES" write .
python3 - <<'PYTHON'
import json, math, struct
# A GLB in two files.
blob = open("plain.glb", "rb").read()
length = struct.unpack_from("<I", blob, 12)[0]
tree = json.loads(blob[20:20 + length])
tree["buffers"][0]["uri"] = "parts.bin"
open("parts.gltf", "w").write(json.dumps(tree))
open("parts.bin", "wb").write(blob[28 + length:])

# A cloth of 0.4 m, upright and curved, with a material; and its motion, 0.2 m upwards.
n = 8
points = [(0.4 * i / n - 0.2, 1 - 0.4 * j / n, 0.1 * (i / n) ** 2) for j in range(n + 1) for i in range(n + 1)]
faces = [(j * (n + 1) + i, (j + 1) * (n + 1) + i, (j + 1) * (n + 1) + i + 1, j * (n + 1) + i + 1)
         for j in range(n) for i in range(n)]
def obj(name, points, faces, more=""):
    with open(name, "w") as out:
        out.write(more)
        out.writelines("v %.6f %.6f %.6f\n" % p for p in points)
        out.writelines("f " + " ".join(str(i + 1) for i in f) + "\n" for f in faces)
obj("dyed.obj", points, faces, "mtllib dyed.mtl\nusemtl red\n")
open("dyed.mtl", "w").write("newmtl red\nKd 0.8 0.1 0.1\n")
obj("moved.obj", points, faces)
with open("moved.pc2", "wb") as out:
    out.write(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(points), 0, 1, 3))
    for sample in range(3):
        for x, y, z in points:
            out.write(struct.pack("<3f", x, y + 0.1 * sample, z))

# Two panels that hang before and behind a waist, in units of a metre, sewn at their sides: the vertices of the one to
# points of the edges of the other.
across, up = 12, 10
def panel(z, flip):
    first = 0 if z > 0 else (across + 1) * (up + 1)
    points = [(0.5 * i / across - 0.25, 0.7 + 0.4 * j / up, z) for j in range(up + 1) for i in range(across + 1)]
    quads = []
    for j in range(up):
        for i in range(across):
            a = first + j * (across + 1) + i
            quad = (a, a + 1, a + across + 2, a + across + 1)
            quads.append(quad[::-1] if flip else quad)
    return points, quads
front, back = panel(0.2, False), panel(-0.2, True)
with open("panels.obj", "w") as out:
    for points, shift in ((front[0], 0), (back[0], 1)):
        out.writelines("v %.6f %.6f %.6f\n" % p for p in points)
        out.writelines("vt %.6f %.6f\n" % (p[0] + shift, p[1]) for p in points)
    for _, quads in (front, back):
        out.writelines("f " + " ".join("%d/%d" % (i + 1, i + 1) for i in q) + "\n" for q in quads)
    half = len(front[0])
    for i in (0, across):
        for j in range(up + 1):
            a = j * (across + 1) + i
            below = half + max(j - 1, 0) * (across + 1) + i
            out.write("stitch %d %d %d %.3f\n" % (a, below, below + across + 1, 1 if j else 0))

# The same as a pattern: a tube of two panels, in centimetres.
def side(z, turn):
    return {"vertices": [[-25, 0], [25, 0], [25, 40], [-25, 40]], "translation": [0, 70, z], "rotation": [0, turn, 0],
            "edges": [{"endpoints": [i, (i + 1) % 4]} for i in range(4)]}
stitch = lambda a, b: [{"panel": "front", "edge": a}, {"panel": "back", "edge": b}]
json.dump({"pattern": {"panels": {"front": side(20, 0), "back": side(-20, 180)}, "stitches": [stitch(1, 3), stitch(3, 1)]},
           "properties": {"units_in_meter": 100, "curvature_coords": "relative"}}, open("tube.json", "w"))

# A ball as a scan in millimetres.
rings, steps = 8, 16
points = [(400 * math.sin(math.pi * r / rings) * math.cos(2 * math.pi * s / steps), 400 - 400 * math.cos(math.pi * r / rings),
           400 * math.sin(math.pi * r / rings) * math.sin(2 * math.pi * s / steps)) for r in range(rings + 1) for s in range(steps)]
quads = [(r * steps + s, r * steps + (s + 1) % steps, (r + 1) * steps + (s + 1) % steps, (r + 1) * steps + s)
         for r in range(rings) for s in range(steps)]
with open("scan.ply", "w") as out:
    out.write("ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
              "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % (len(points), len(quads)))
    out.writelines("%.4f %.4f %.4f\n" % p for p in points)
    out.writelines("4 %d %d %d %d\n" % q[::-1] for q in quads)
PYTHON

# A picture of which the garment covers no part is blank; one without a ground shows nothing else.
open_file() { # NAME PATTERN OPTIONS...: info's words about the file, and a picture of it
    local name=$1 pattern=$2 covered
    shift 2
    check "$name: info" sh -c "$TOILE info $name | tr -s ' ' | grep -Eq '$pattern'"
    if ! $TOILE render "$name" $small --set image.ground=false "$@" -o seen.exr; then
        fail "$name: not drawn"
        return
    fi
    covered=$("$FORMAT_FILES" coverage seen.exr)
    check "$name: covers $covered of the picture" awk "BEGIN { exit !($covered > 0.05 && $covered < 0.95) }"
}

open_file plain.glb '^triangles 768$'
open_file parts.gltf '^triangles 768$'
open_file draco.glb '^triangles 768$'
open_file meshopt.glb '^triangles 768$'
open_file morph.glb '^ *name bend$'
mv seen.exr start.exr
$TOILE render morph.glb $small --set image.ground=false --frame 30 -o seen.exr
check "morph.glb: its clip bends it" sh -c "! cmp -s start.exr seen.exr"
open_file dyed.obj '^ *name red$'
open_file panels.obj '^stitches 22$'
$TOILE export panels.obj --set image.ground=false --quiet -o sewn.obj
check "panels.obj: its sides are sewn" sh -c "$TOILE info sewn.obj --json | tr -d ' \n\t' | grep -Eq '\"openings_mm\":\{[^,]*,[^,]*\}'"
open_file tube.json '^stitches 2$' --set cloth.settle_s=0.2
open_file scan.ply '^units mm$'
open_file moved.pc2 '^points 81$'
mv seen.exr start.exr
$TOILE render moved.pc2 $small --set image.ground=false --frame 2 -o seen.exr
check "moved.pc2: moves the mesh beside it" sh -c "! cmp -s start.exr seen.exr"
$TOILE render moved.obj --motion moved.pc2 $small --set image.ground=false --frame 2 -o named.exr
check "moved.pc2: as the mesh with the motion" cmp named.exr seen.exr
cp moved.pc2 alone.pc2
refuse "a point cache without its mesh" 'alone.pc2: moves a mesh, and there is no .obj.* --motion alone.pc2' render alone.pc2 -o no.exr
check "scan.ply: is a body" $TOILE render --garment sheet --fabric none --avatar scan.ply $small --set cloth.settle_s=0.2 -o seen.exr
