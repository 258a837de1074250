#!/usr/bin/env bash
# toile check over every scene and every preset of the repository, small and short: what a change breaks somewhere shows
# here. The same, whole, is toile check SCENE.
set -eu
folder=$(cd "$(dirname "$0")/../../../config" && pwd)
. "$(dirname "$0")/cli.sh"
small="--size 64x64 --set light.regions=48 --set cloth.edge_m=0.06 --set cloth.settle_s=0.3 --quiet"

sound() { # NAME ARGUMENTS...
    local name=$1
    shift
    if $TOILE check "$@" $small >table.txt; then echo "ok     $name"; else cat table.txt; fail "$name"; fi
}

for scene in "$folder"/scenes/*.yaml; do
    scene=$(basename "$scene" .yaml)
    solver=
    case $scene in # each solver has a scene
        trousers) solver="--set cloth.solver=reference" ;;
    esac
    sound "scene $scene" "$scene" --set light.pem_size=32 --set detail.angles=8 --set weave.texels_per_yarn=16 $solver --frames 2 --every 2
done
# With their own sizes of cubes: the bounds of light are tightest there.
for preset in "$folder"/presets/*.yaml; do
    preset=$(basename "$preset" .yaml)
    sound "preset $preset" gallery --preset "$preset" --frames 2 --every 2 --furnace
done
