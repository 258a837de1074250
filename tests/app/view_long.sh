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
fabric() {
    printf 'material: {diffuse: [0.0%d, 0.1, 0.2], glossiness: 0.%d}\n' $((RANDOM % 90 + 10)) $((RANDOM % 8 + 1)) >new.yaml
    mv new.yaml fabric.yaml
}

open_display
$TOILE render --preset draft --set cloth.edge_m=0.05 --size 256x128 --quiet -o light.exr
fabric
scene dress light.exr
: >log
$TOILE view scene.yaml --budget 50 --screenshots shots --verbose 2>log &
viewer=$!
said "view: ready"
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
    9) fabric ;;
    10) [ $((RANDOM % 6)) -gt 0 ] || scene dress light.exr ;;
    11) [ $((RANDOM % 6)) -gt 0 ] || scene skirt studio ;;
    12) [ $((RANDOM % 8)) -gt 0 ] || xdotool windowsize "$window" $((800 + RANDOM % 480)) $((600 + RANDOM % 200)) ;;
    13) [ $((RANDOM % 12)) -gt 0 ] || xdotool key s ;;
    14) xdotool mousemove $((1000 + RANDOM % 250)) $((140 + RANDOM % 400)) mousedown 1 mousemove_relative -- $((RANDOM % 40 - 20)) 0 mouseup 1 ;;
    *) xdotool key "${keys[RANDOM % ${#keys[@]}]}" ;;
    esac
}

started=$SECONDS sampled=-10
: >resident
while [ $((SECONDS - started)) -lt $((minutes * 60)) ]; do
    kill -0 "$viewer" 2>/dev/null || fail "the window closed"
    step
    sleep 0.$((RANDOM % 4 + 1))
    if [ $((SECONDS - sampled)) -ge 10 ]; then
        sampled=$SECONDS
        echo "$((SECONDS - started)) $(resident_kb)" >>resident
    fi
done
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
# Memory plays by some 100 MB as scenes, levels and comparisons come and go and idle pages are given back; the least of
# each minute plays less, and what is never freed lifts it all the same. Least squares over the second half: what a start
# allocates once is no growth. What is certain of the slope may be 1 MB a minute at most: a review of a working day then
# stays within half a gigabyte of where it began.
awk '{ minute = int($1 / 60); last = minute; if (!(minute in least) || $2 < least[minute]) least[minute] = $2; if ($2 > top) top = $2 }
    END { for (m = int((last + 1) / 2); m <= last; m++) {
              if (!(m in least)) continue
              c++; x += m; y += least[m]; xx += m * m; xy += m * least[m]; yy += least[m] * least[m]
          }
          printf "resident: %d minutes in the second half, mean of their least %.0f MB, most ever %.0f MB\n", c, y / c / 1024, top / 1024
          if (c < 4) { print "resident: too short a run to tell its slope"; exit }
          spread = xx - x * x / c; slope = (xy - x * y / c) / spread
          error = sqrt(((yy - y * y / c) - slope * slope * spread) / (c - 2) / spread)
          printf "resident: slope %+.2f MB a minute, standard error %.2f\n", slope / 1024, error / 1024
          exit slope - 2 * error > 1024 }' resident || grows=yes
echo "warnings: $(grep -c "warning" log || true)"
grep "warning" log | sort | uniq -c | sort -rn | head -n 5
[ -z "${grows:-}" ] || fail "memory grows"
echo "ok     all"
