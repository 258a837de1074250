#!/usr/bin/env bash
# toile sheet: a picture a cell, kept by a second run and redrawn when something changes; one image of them all; what
# cannot be rendered is reported and left empty; wrong use exits 2.
set -u
. "$(dirname "$0")/cli.sh"
fast="--garment sphere --avatar none --preset draft --size 64x64 --set light.rounds=1 --set image.supersample=1 $cheap_light"

refuse "no output" 'OUT.png or -o FOLDER' sheet
refuse "another kind of output" 'a\.exr.*\.png or a folder' sheet -o a.exr
refuse "no such fabric" 'satn.*satin' sheet -o out --fabrics satn
refuse "no such view" 'bck.*back' sheet -o out --views bck
refuse "too large" 'would be .* pixels' sheet -o a.png --size 8192x8192 --fabrics all

# A folder, and the same again: nothing is drawn twice.
draw() { "$TOILE" sheet -o out $fast --fabrics satin,denim --views front,back "$@" 2>log || fail "exit $?: $(cat log)"; }
draw
[ "$(ls out/*.png | wc -l)" -eq 4 ] || fail "four cells: $(ls out)"
grep -q '4 cells drawn, 0 kept, 0 refused' log || fail "counts: $(cat log)"
check_report out/index.html 0
[ "$(grep -o '"file":"[^"]*"' out/index.html | wc -l)" -eq 4 ] || fail "four pictures on the page"
cp -rp out before
draw
grep -q '0 cells drawn, 4 kept' log || fail "kept: $(cat log)"
for cell in out/*.png; do
    [ "$cell" -nt "before/${cell#out/}" ] && fail "$cell was written again"
done

# A cell that is missing is drawn as it was, by a run that drapes only for it; a changed one is drawn anew.
rm out/sphere_denim_studio_back.png
draw
grep -q '1 cells drawn, 3 kept' log || fail "one missing: $(cat log)"
for cell in out/*.png; do cmp -s "$cell" "before/${cell#out/}" || fail "$cell differs after going on"; done
draw --set material.glossiness=0.9
grep -q '4 cells drawn, 0 kept' log || fail "all changed: $(cat log)"
draw --views front,3/4
grep -q '2 cells drawn, 2 kept' log && fail "the back has no place in the 3/4 column"

# One image; its cells are kept for the next run until it is complete.
"$TOILE" sheet -o one.png $fast --fabrics satin,nowhere.yaml --quiet 2>log && fail "a fabric that is not there"
grep -q 'nowhere.yaml' log || fail "names the fabric: $(cat log)"
"$TOILE" sheet -o one.png $fast --views front --envs studio,nowhere.hdr 2>log
[ $? -eq 1 ] || fail "a refused cell exits 1: $(cat log)"
grep -q 'nowhere.hdr: no such file' log || fail "says why: $(cat log)"
[ -s one.png ] && [ -d one.png.cells ] || fail "the image and its cells: $(ls)"
"$TOILE" sheet -o one.png $fast --views front --envs studio,white 2>log || fail "repaired: $(cat log)"
grep -q '1 cells drawn, 1 kept, 0 refused' log || fail "only the new one: $(cat log)"
[ -s one.png ] && [ ! -e one.png.cells ] || fail "complete: $(ls)"

# Stopped, it goes on.
"$TOILE" sheet -o later $fast --fabrics satin,denim --views front,back 2>log &
job=$!
for _ in $(seq 300); do [ -e later/manifest.json ] && break; sleep 0.1; done
kill -INT $job
wait $job
status=$?
done_before=$(ls later/*.png | wc -l)
[ $status -eq 130 ] || [ "$done_before" -eq 4 ] || fail "stopped: exit $status: $(cat log)"
"$TOILE" sheet -o later $fast --fabrics satin,denim --views front,back 2>log || fail "goes on: $(cat log)"
grep -q "$((4 - done_before)) cells drawn, $done_before kept" log || fail "goes on where it was ($done_before): $(cat log)"
for cell in before/*.png; do cmp -s "$cell" "later/${cell#before/}" || fail "$cell differs from an uninterrupted run"; done
