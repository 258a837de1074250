#!/usr/bin/env bash
# Every garment file of the test data opens as authored by one argument: the picture shows it upright and where its file
# has it, on the ground where it reached below, and exported it is where it was. The oracle reads the files by itself.
set -eu
. "$(dirname "$0")/cli.sh"
[ -d "$data/garments" ] || { echo "skipped: $data/garments is absent: there are no garments to open"; exit 77; }
command -v python3 >/dev/null || { echo "skipped: files are compared by python3, which is absent"; exit 77; }
small="--preset draft --size 192x192 $cheap_light --quiet"

cat >points.py <<'PYTHON'
"""Compares what toile draws and exports with the points of a garment's file."""
import json, math, struct, sys

def turn(q, p):
    x, y, z, w = q
    u = (y * p[2] - z * p[1], z * p[0] - x * p[2], x * p[1] - y * p[0])
    return tuple(p[i] + 2 * (w * u[i] + (q[(i + 1) % 3] * u[(i + 2) % 3] - q[(i + 2) % 3] * u[(i + 1) % 3])) for i in range(3))

def points_of_glb(path):
    blob = open(path, "rb").read()
    length = struct.unpack_from("<I", blob, 12)[0]
    tree, start = json.loads(blob[20:20 + length]), 28 + length
    for node in tree["nodes"]:
        if "mesh" not in node:
            continue
        assert "children" not in node and "matrix" not in node
        scale, move = node.get("scale", [1, 1, 1]), node.get("translation", [0, 0, 0])
        for part in tree["meshes"][node["mesh"]]["primitives"]:
            accessor = tree["accessors"][part["attributes"]["POSITION"]]
            view = tree["bufferViews"][accessor["bufferView"]]
            first = start + view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
            for i in range(accessor["count"]):
                p = struct.unpack_from("<3f", blob, first + i * view.get("byteStride", 12))
                p = turn(node.get("rotation", [0, 0, 0, 1]), [a * b for a, b in zip(p, scale)])
                yield tuple(a + b for a, b in zip(p, move))

def points_of_obj(path):
    return [tuple(map(float, line.split()[1:4])) for line in open(path) if line.startswith("v ")]

def points_of(path, unit_m=1.0, z_up=False):
    points = points_of_glb(path) if path.endswith(".glb") else points_of_obj(path)
    return [tuple(unit_m * c for c in ((p[0], p[2], -p[1]) if z_up else p)) for p in points]

TOLERANCE_M = 1e-5
def farthest(some, others):
    cell = lambda p: tuple(math.floor(c / TOLERANCE_M) for c in p)
    near = {}
    for p in others:
        near.setdefault(cell(p), []).append(p)
    worst = 0
    for p in some:
        x, y, z = cell(p)
        found = [math.dist(p, q) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)
                 for q in near.get((x + i, y + j, z + k), [])]
        worst = max(worst, min(found, default=math.inf))
    return worst

mode, source, unit, up, other = sys.argv[1:]
inside = points_of(source, float(unit), up == "z")
if mode in ("exported", "kept"):  # kept: with points besides its own
    outside = points_of(other)
    worst = max(farthest(inside, outside), 0 if mode == "kept" else farthest(outside, inside))
    print("%.5f mm" % (1e3 * worst))
    sys.exit(not worst <= TOLERANCE_M)
# The box of the pixels' points: each side of it lies within the garment's, and no more than some pixels short.
drawn = [float(word) for word in other.split()]
lower, upper = ([end(p[c] for p in inside) for c in range(3)] for end in (min, max))
lift = max(0, -lower[1])
lower[1] += lift
upper[1] += lift
pixel = 2.5 * max(b - a for a, b in zip(lower, upper)) / 192
print("drawn from %s to %s m, in the file from %s to %s, lifted %.3f" % (
    *(" ".join("%.3f" % c for c in corner) for corner in (drawn[:3], drawn[3:], lower, upper)), lift))
for c in (0, 1):  # the far side of z is hidden
    assert lower[c] - 1e-3 < drawn[c] < lower[c] + 4 * pixel and upper[c] - 4 * pixel < drawn[3 + c] < upper[c] + 1e-3
assert lower[2] - 1e-3 < drawn[2] and upper[2] - 2 * pixel < drawn[5] < upper[2] + 1e-3
PYTHON

# compared TEXT ARGUMENTS...: a check by points.py, named by TEXT and its first line.
compared() {
    local text=$1 line right=true
    shift
    line=$(python3 points.py "$@" 2>&1 | head -n 1; exit "${PIPESTATUS[0]}") || right=false
    check "$text$line" $right
}

# stands FILE METRES_PER_UNIT UP HOW OPTIONS...
stands() {
    local file=$data/$1 unit=$2 up=$3 how=$4
    shift 4
    $TOILE render "$file" $small "$@" --aov -o seen.exr
    compared "${file##*/}: " drawn "$file" "$unit" "$up" "$("$FORMAT_FILES" box seen.exr)"
    $TOILE export "$file" --quiet "$@" -o again.obj
    compared "${file##*/}: exported where it was: " $how "$file" 1 "$up" again.obj # in the file's own unit
}

stands garments/bjs_clothFolds.glb 1 y exported
stands garments/diffcloth_dress-handsup-drape.obj 0.0254 y exported
stands garments/diffcloth_dress-v5k-f10k.obj 0.0254 y exported
stands garments/diffcloth_skirt3448.obj 1 y exported
stands garments/diffcloth_tshirt1000-tri.obj 0.1 y exported
stands garments/mh_female_sportsuit01.glb 1 y exported
stands garments/mh_male_casualsuit06.glb 1 y exported
stands sequences/tshirt_iter0/000.obj 0.1 y exported
stands sequences/tshirt_iter0/120.obj 0.1 y exported
stands sequences/tshirt_iter0/250.obj 0.1 y exported
# Panels with stitches are sewn unless they are to stand as authored; what closes their seams adds vertices.
stands garments/cipc_dress_knife_stage.obj 1 z kept --set scene.drape=authored
