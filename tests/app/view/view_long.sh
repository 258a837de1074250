#!/usr/bin/env bash
# Not a test: the review window under a virtual display, driven at random for MINUTES (first argument, default 30)
# through every feature, with a fixed SEED (second argument, default 1). Prints frame times, GL messages, and how
# memory grew. TOILE is the program. Fails when the window dies or hangs, memory grows, or GL complains.
set -eu
minutes=${1:-30}
RANDOM=${2:-1}
. "$(dirname "$0")/view_room.sh"

scene() {
    printf 'scene: {garment: %s, environment: %s, fabric: fabric.yaml, preset: draft}\ncloth: {edge_m: 0.04}\n' \
        "$1" "$2" >new.yaml
    mv new.yaml scene.yaml
}
# fabric HUE GLOSS
fabric() {
    printf 'material: {diffuse: [0.0%d, 0.1, 0.2], glossiness: 0.%d}\n' "$1" "$2" >new.yaml
    mv new.yaml fabric.yaml
}
any_fabric() { fabric $((RANDOM % 90 + 10)) $((RANDOM % 8 + 1)); }

open_display
$TOILE render --preset draft --set cloth.edge_m=0.05 --size 256x128 --quiet -o light.exr
any_fabric
scene dress light.exr
: >log
$TOILE view scene.yaml --budget 50 --screenshots shots --verbose 2>log &
viewer=$!
logged "view: ready"
window=$(xdotool search --pid "$viewer" | tail -n 1)

point() { xdotool mousemove $((100 + RANDOM % 700)) $((100 + RANDOM % 600)); }
drag_anywhere() {
    local x=$((200 + RANDOM % 500)) y=$((200 + RANDOM % 400))
    drag "$1" $x $y $((x + RANDOM % 200 - 100)) $((y + RANDOM % 200 - 100))
}
# Keys that neither close the window nor answer questions.
keys=(space space period r p f t t shift+t shift+t e bracketleft bracketright g shift+g c shift+c w w x comma slash
    v v shift+v b i k shift+k shift+k l 1 2 3 shift+1 shift+2 shift+3 ctrl+1 ctrl+3 ctrl+5 ctrl+z ctrl+z
    ctrl+shift+z minus equal Left Right Up Down Page_Up Page_Down h h Tab Tab)
step() {
    case $((RANDOM % 24)) in
    0 | 1 | 2) drag_anywhere 1 ;;
    3) drag_anywhere 3 ;;
    4) xdotool keydown shift; drag_anywhere 1; xdotool keyup shift ;;
    5 | 6) xdotool keydown ctrl; drag_anywhere 1; xdotool keyup ctrl ;;
    7) point; xdotool click --repeat $((RANDOM % 4 + 1)) $((RANDOM % 2 + 4)) ;;
    8) point; xdotool click --repeat 2 --delay 50 1 ;;
    9) any_fabric ;;
    10) [ $((RANDOM % 6)) -gt 0 ] || scene dress light.exr ;;
    11) [ $((RANDOM % 6)) -gt 0 ] || scene skirt studio ;;
    12) [ $((RANDOM % 8)) -gt 0 ] || xdotool windowsize "$window" $((800 + RANDOM % 480)) $((600 + RANDOM % 200)) ;;
    13) [ $((RANDOM % 12)) -gt 0 ] || xdotool key s ;;
    14) xdotool mousemove $((1000 + RANDOM % 250)) $((140 + RANDOM % 400)) mousedown 1 mousemove_relative -- $((RANDOM % 40 - 20)) 0 mouseup 1 ;;
    *) xdotool key "${keys[RANDOM % ${#keys[@]}]}" ;;
    esac
}

# ends KEY BEGUN ENDED: presses KEY when the last of the two texts in the log is BEGUN, and waits for ENDED.
ends() { grep -e "$2" -e "$3" log | tail -n 1 | grep -q -e "$2" && press "$1" "$3" || true; }

# Brings the window to one fixed state: at rest, with the same scene loaded again. Sets `memory` to the megabytes in use and
# resident.
come_to_rest() {
    xdotool mousemove 300 300 click 1 # keys go to the picture, not to a field of the panel
    sleep 2
    ends shift+k "records the camera path" "path of .* saved"
    ends l "plays the path" "path played"
    ends t "turntable turns" "turntable stands"
    ends shift+t "the environment turns" "the environment stands"
    ends w "compares: A" "comparison ended"
    xdotool windowsize "$window" 1280 800
    rm scene.yaml # so that it counts as edited
    sleep 3
    fabric 50 5
    scene dress light.exr
    press period "view: frame" # pauses it
    press r "view: reset"
    sleep 45 # images at rest, and two measurements of memory
    memory=$(sed -n 's/.*memory: \([0-9]*\) MB in use, \([0-9]*\) MB resident.*/\1 \2/p' log | tail -n 1)
    echo "memory at rest after $(((SECONDS - started) / 60)) minutes: ${memory% *} MB in use, ${memory#* } MB resident"
}

warm_up=2 # minutes
started=$SECONDS sampled=-10 at_first=
: >resident
while [ $((SECONDS - started)) -lt $((minutes * 60)) ]; do
    kill -0 "$viewer" 2>/dev/null || fail "the window closed"
    if [ -z "$at_first" ] && [ $((SECONDS - started)) -ge $((warm_up * 60)) ]; then
        come_to_rest
        at_first=$memory
    fi
    step
    sleep 0.$((RANDOM % 4 + 1))
    if [ $((SECONDS - sampled)) -ge 10 ]; then
        sampled=$SECONDS
        echo "$((SECONDS - started)) $(resident_kb)" >>resident
    fi
done
come_to_rest
xdotool key Escape Escape Escape Escape 2>/dev/null || true
for _ in $(seq 300); do kill -0 "$viewer" 2>/dev/null || break; xdotool key q; sleep 0.2; done
! kill -0 "$viewer" 2>/dev/null || fail "it hangs: it does not close within a minute"
closed
grep -e "images in motion" -e "images at rest" -e "closed after" log
slow=$(grep -c "slow image.*in motion" log || true)
echo "slow images in motion: $slow; the slowest, and what took them:"
grep -A3 "slow image.*in motion" log | grep -e "slow image" -e "view:   " | sed 's/.*debug: view: *//' |
    awk '/slow image/ { if (line) print line; line = ""; ms = $0; sub(/.*motion: /, "", ms); sub(/ .*/, "", ms); line = ms " ms " $0; next }
        { line = line "; " $0 } END { print line }' | sort -rn | head -n 8
# Memory plays by 200 MB as scenes, levels and comparisons come and go: what tells is the same state, early and late. A
# megabyte more a minute would be half a gigabyte in a working day; freed pages lie about in pieces, so 64 MB more may be
# resident at any time.
awk -v first="$at_first" -v last="$memory" -v minutes=$((minutes - warm_up)) 'BEGIN {
    split(first, a); split(last, b)
    printf "memory: %+d MB in use, %+d MB resident in %d minutes\n", b[1] - a[1], b[2] - a[2], minutes
    exit b[1] - a[1] > minutes || b[2] - a[2] > 64 + minutes }' || grows=yes
awk '{ if ($2 > top) top = $2 } END { printf "resident: most ever %.0f MB\n", top / 1024 }' resident
echo "warnings: $(grep -c "warning" log || true)"
grep "warning" log | sort | uniq -c | sort -rn | head -n 5
[ -z "${grows:-}" ] || fail "memory grows"
echo "ok     all"
