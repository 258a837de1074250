#!/usr/bin/env bash
# The extremes of light, detail and shading, by the real executable: no cell is silent, none holds a NaN.
set -eu
. "$(dirname "$0")/cli.sh"

value() { sed -n "s/^[[:space:]]*\"$1\":[[:space:]]*\([0-9]*\).*/\1/p" found.json | head -1; }
# stability TOPIC CELLS EXACT REFUSED: at least so many of each, and every cell has an outcome that is allowed.
stability() {
    local status=0
    $TOILE stability "$1" --json --quiet >found.json || status=$?
    echo "$1: $(value cells) cells: $(value exact) exact, $(value bounded) bounded, $(value refused) refused"
    check "$1: the exit status" test $status -eq 0
    check "$1: none is silent, none holds a NaN" test "$(value silent)" -eq 0 -a "$(value nan)" -eq 0
    check "$1: every cell is told" test $(($(value exact) + $(value bounded) + $(value refused))) -eq "$(value cells)"
    check "$1: as many as promised" test "$(value cells)" -ge "$2" -a "$(value exact)" -ge "$3" -a "$(value refused)" -ge "$4"
    [ $failed -eq 0 ] || grep -B3 -A3 -E 'SILENT|NaN' found.json || true
}
stability light 70 0 2      # for two methods; cameras that see nothing are refused
stability detail 144 24 0   # 6 fields x 6 views x 4 ways of seeing them
stability shading 300 120 0 # 10 extremes x 6 models x 5 glossinesses; four of the extremes send nothing back
