#!/usr/bin/env bash
# A review cannot be lost: the window is ended in five ways while it is used, and comes back with every step, which can
# be undone, and with its camera. TOILE is the program.
set -eu
. "$(dirname "$0")/view_room.sh"

small="--preset draft --set image.scale=0.5 --garment sheet --avatar ball --fabric none --set cloth.settle_s=0.2 $cheap_light"
start() {
    : >log
    $TOILE view $small --verbose --screenshots shots >out 2>log &
    viewer=$!
    logged "view: ready"
}

# Waits for the end of a window that was ended; leaves its status.
ended() {
    status=0
    wait "$viewer" 2>/dev/null || status=$?
    viewer=
}

first_size 780 400
open_display
start
! grep -q recovered log || fail "recovered without a reason"
steps=0
for way in KILL HUP TERM INT display; do
    for i in 1 2; do # each is a step, once its gesture is over
        press v "view: shows"
        sleep 1.5
    done
    steps=$((steps + 2))
    drag 1 200 200 $((250 + steps)) 220 # the camera: no step, but kept
    sleep 1.5
    if [ $way = display ]; then
        kill -9 $display
        ended
        display=
        [ $status -eq 2 ] || fail "the display's loss: status $status"
        [ "$(grep -c "the display was lost" log)" = 1 ] || fail "no line about the display"
        ! grep -qi "XIO\|fatal IO" log || fail "Xlib's own lines"
        rm number
        open_display
    else
        kill -$way $viewer
        ended
        case $way in KILL) expected=137 ;; *) expected=130 ;; esac
        [ $status -eq $expected ] || fail "$way: status $status, expected $expected"
    fi
    turned=$(grep -h "^camera.yaw_deg=" state/toile/journal/* | tail -n 1)
    start
    logged "recovered, $steps steps"
    echo "       after $way: $(grep -o 'recovered, .*' log | tail -n 1), $turned"
done

# All steps are there to be undone, one by one; a window that is closed leaves no journal, and its next one recovers nothing.
for i in $(seq $steps); do press ctrl+z "view: undone: image.view"; done
press ctrl+z "view: nothing to undo"
xdotool key q
closed
[ -z "$(ls state/toile/journal)" ] || fail "a journal is left: $(ls state/toile/journal)"
start
! grep -q recovered log || fail "recovered what was closed"
xdotool key q
closed

# Another scene does not get this one's steps.
start
press v "view: shows"
sleep 1.5
kill -9 $viewer
ended
small="$small --set material.glossiness=0.5"
start
! grep -q recovered log || fail "another command line recovered it"
xdotool key q
closed
echo "ok     all"
