# Sourced by the scripts that drive the review window: a folder of their own, a virtual display, keys and pointer, waiting for lines of the log.
# TOILE is the program.
for tool in Xvfb xdotool; do
    command -v "$tool" >/dev/null || { echo "skipped: $tool is absent"; exit 77; }
done
room=$(mktemp -d)
viewer= display=
finish() {
    [ -z "$viewer" ] || kill "$viewer" 2>/dev/null || true
    [ -z "$display" ] || kill "$display" 2>/dev/null || true
    wait 2>/dev/null || true
    rm -rf "$room"
}
trap finish EXIT
cd "$room"
export XDG_STATE_HOME=$room/state # nothing of the user's is read, or written
# Light, surfaces and samples for windows whose pictures are compared with one another only: on the CPU they are most of
# the cost.
cheap_light="--set light.regions=24 --set light.pem_size=16 --set light.rounds=4 --set light.bounce=off --set scene.smooth=false --set image.scale=0.5"

# first_size WIDTH HEIGHT: of the window, unless --fresh. The panel takes 380 pixels of the width.
first_size() {
    mkdir -p state/toile
    echo "window: {width: $1, height: $2}" >state/toile/review.yaml
}

fail() {
    echo "FAILED $*"
    echo "--- the log:"
    grep -v "debug:" log | tail -n 60
    exit 1
}

open_display() {
    exec 3>number
    Xvfb -displayfd 3 -screen 0 1280x800x24 -nolisten tcp >/dev/null 2>&1 &
    display=$!
    for _ in $(seq 600); do [ -s number ] && break; sleep 0.1; done
    [ -s number ] || { echo "skipped: Xvfb does not start here"; exit 77; }
    export DISPLAY=:$(cat number)
    unset WAYLAND_DISPLAY
}

# logged TEXT [TIMES]: waits until the log holds the text that many times. The five minutes are no performance bound: they
# end the wait for a window that hangs, on a machine under any load.
logged() {
    for _ in $(seq 1200); do
        [ "$(grep -c -e "$1" log)" -ge "${2:-1}" ] && { echo "ok     $1"; return; }
        kill -0 "$viewer" 2>/dev/null || fail "the window closed before it logged: $1"
        sleep 0.25
    done
    fail "never logged: $1"
}

# press KEY TEXT: the log then holds the text once more.
press() {
    local before
    before=$(grep -c -e "$2" log || true)
    xdotool key $1
    logged "$2" $((before + 1))
}

resident_kb() { awk '/^VmRSS/ { print $2 }' "/proc/$viewer/status"; }

# drag BUTTON X0 Y0 X1 Y1: eight steps, as a hand does.
drag() {
    local i
    xdotool mousemove "$2" "$3" mousedown "$1"
    for i in 1 2 3 4 5 6 7 8; do
        xdotool mousemove $(($2 + ($4 - $2) * i / 8)) $(($3 + ($5 - $3) * i / 8))
        sleep 0.03
    done
    xdotool mouseup "$1"
}

# The window must have closed by itself, with status 0 and without GL messages.
closed() {
    local status=0
    wait "$viewer" || status=$?
    viewer=
    [ "$status" = 0 ] || fail "closed with status $status"
    grep -q "view: closed after" log || fail "no closing line"
    grep -q ", 0 GL messages" log || fail "GL messages"
}
