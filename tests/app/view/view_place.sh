#!/usr/bin/env bash
# Placing a garment in the real window. The handles: a drag of the X arrow moves the garment by the closed form of its
# camera, Esc and undo take a drag back. The question about a file whose units are in doubt: it is asked once, and its
# answer is a part of the scene. TOILE is the program.
set -eu
. "$(dirname "$0")/view_room.sh"

# A sheet of 1 x 1 m, upright about (0, 1, 0), seen from 3 m: its middle is the middle of the view.
awk 'BEGIN {
    for (y = 0; y <= 20; y++) for (x = 0; x <= 20; x++) print "v", x / 20 - 0.5, y / 20 + 0.5, 0
    for (y = 0; y < 20; y++) for (x = 0; x < 20; x++) { i = 21 * y + x + 1; print "f", i, i + 1, i + 22, i + 21 }
}' >sheet.obj

open_display
: >log
$TOILE view --fresh --preset draft --garment sheet.obj $cheap_light \
    --set camera.yaw_deg=0 --set camera.pitch_deg=0 --set camera.distance_m=3 --set camera.target=0,1,0 >out 2>log &
viewer=$!
logged "view: ready"
window=$(xdotool search --pid "$viewer" | tail -n 1)
eval "$(xdotool getwindowgeometry --shell "$window")" # X Y WIDTH HEIGHT
x=$((X + (WIDTH - 380) / 2)) y=$((Y + HEIGHT / 2))    # the panel takes 380

# place NUMBER: the moves, or else the turn and the size, of the last report.
place() { grep "view: --move" log | tail -n 1 | sed "s/.*--move \([^,]*\),\([^,]*\),\([^ ]*\) --turn \([^ ]*\) --scale \(.*\)/\\$1/"; }
# near A B WITHIN
near() { awk -v a="$1" -v b="$2" -v within="$3" 'BEGIN { d = a - b; exit !(d <= within && -d <= within) }'; }
# is NUMBER EXPECTED WITHIN TIMES: the report of that many drags.
is() {
    logged "view: --move" "$4"
    near "$(place "$1")" "$2" "$3" || fail "$(grep "view: --move" log | tail -n 1): number $1 is not $2"
}

press m "view: arrows move the garment"
# 120 pixels at 3 m with 30 degrees over the view's height; options are in steps of 0.1 mm.
expected=$(awk -v h="$HEIGHT" 'BEGIN { a = 15 * atan2(0, -1) / 180; print 120 * 2 * 3 * sin(a) / cos(a) / h }')
drag 1 $((x + 90)) $y $((x + 210)) $((y + 60))
is 1 "$expected" 0.0001 1
is 2 0 0 1
press ctrl+z "view: undone: scene.move_m"
drag 1 $x $((y - 80)) $x $((y - 200)) # up: from where it was before
is 1 0 0 2
is 2 "$expected" 0.0001 2
press ctrl+z "view: undone: scene.move_m"

xdotool keydown shift; drag 1 $((x + 90)) $y $((x + 210)) $y; xdotool keyup shift
is 1 "$(awk -v e="$expected" 'BEGIN { print e / 10 }')" 0.0001 3
press ctrl+z "view: undone: scene.move_m"
xdotool keydown ctrl; drag 1 $((x + 90)) $y $((x + 210)) $y; xdotool keyup ctrl
is 1 "$(awk -v e="$expected" 'BEGIN { print int(100 * e + 0.5) / 100 }')" 0.00001 4
press ctrl+z "view: undone: scene.move_m"

drag 1 $((x + 78)) $((y - 78)) $((x + 117)) $((y - 117)) # the box: half as far again; the middle stays
is 5 1.5 0.001 5
is 2 -0.5 0.002 5
press ctrl+z "view: undone: scene.scale"
drag 1 $((x - 40)) $y $x $y # the ring, seen flat: half a radian
is 4 28.6 0.2 6
press ctrl+z "view: undone: scene.turn_deg"

xdotool mousemove $((x + 90)) $y mousedown 1 mousemove $((x + 150)) $y
sleep 0.5
press Escape "view: the garment stays where it was"
xdotool mouseup 1
press Escape "view: loading was stopped\|view: hides the handles" # what was undone may still load
grep -q "view: hides the handles" log || press Escape "view: hides the handles"
drag 1 $((x + 90)) $y $((x + 110)) $y # turns the view
press m "view: arrows move the garment"
[ "$(grep -c "view: --move" log)" = 6 ] || fail "a drag that was not of a handle placed the garment"
xdotool key q
closed

# 36 units are 36 cm, or 0.91 m in inches.
awk '/^v / { print "v", 36 * $2, 36 * $3, 0; next } { print }' sheet.obj >doubt.obj
ask() { $TOILE view --preset draft --garment doubt.obj $cheap_light >>out 2>log & viewer=$!; logged "view: ready"; }
: >log
ask
grep -q "view: asks how doubt.obj is to be read: --units in --up y so far" log || fail "nothing is asked"
press Return "view: keeps --units in --up y"
press ctrl+z "view: undone: scene.units auto -> in" # what was kept is a part of the scene
press u "view: reads it in decimetres" # asks again, and shows its answers
logged "view: asks how doubt.obj" 2
# Its row of units, by clicks from the left: each reads the file otherwise, and the text above and the gaps do nothing.
for x in $(seq 60 20 460); do
    for y in 90 100 110; do
        xdotool mousemove $x $y click 1
        sleep 0.1
        ! grep -q "view: reads it in centimetres" log || break 2
    done
done
logged "view: reads it in centimetres"
sleep 1
press Return "view: keeps --units cm --up y"
press ctrl+z "view: undone: scene.units"
press ctrl+y "view: redone: scene.units"
sleep 2 # the journal is written
kill -KILL "$viewer"
wait "$viewer" 2>/dev/null || true
: >log
ask
logged "view: recovered"
! grep -q "view: asks" log || fail "asked again"
xdotool key q
closed
[ ! -s out ] || fail "something on standard output"
echo "ok     all"
