#!/usr/bin/env bash
# The extremes by `toile stability`, which executes toile-stability: no cell is silent, none holds a NaN, each states its
# error, and none above 25 % is called exact or bounded. A program alone names what it lacks.
set -eu
. "$(dirname "$0")/cli.sh"

value() { sed -n "s/^[[:space:]]*\"$1\":[[:space:]]*\([0-9]*\).*/\1/p" found.json | head -1; }
# stability TOPIC CELLS EXACT REFUSED COARSE: at least so many of the first three, at most so many coarse, and every
# cell has an outcome that is allowed.
stability() {
    local status=0
    $TOILE stability "$1" --quick --json --quiet >found.json || status=$?
    echo "$1: $(value cells) cells: $(value exact) exact, $(value bounded) bounded, $(value coarse) coarse, $(value refused) refused"
    check "$1: the exit status" test $status -eq 0
    check "$1: none is silent, none holds a NaN" test "$(value silent)" -eq 0 -a "$(value nan)" -eq 0
    check "$1: every cell is counted" test $(($(value exact) + $(value bounded) + $(value coarse) + $(value refused))) -eq "$(value cells)"
    check "$1: as many as promised" test "$(value cells)" -ge "$2" -a "$(value exact)" -ge "$3" -a "$(value refused)" -ge "$4"
    check "$1: as few coarse as promised" test "$(value coarse)" -le "$5"
    check "$1: the errors" awk -v cells="$(value cells)" '
        { gsub(/[",]/, "") }
        $1 == "outcome:" { outcome = $2 }
        $1 == "error_percent:" { rows++; wrong += (outcome == "exact" || outcome == "bounded") && !($2 <= 25 && $2 != "null")
                                 wrong += outcome == "coarse" && !($2 > 25) }
        $1 == "unit:" { wrong += $2 == "" && outcome != "refused" }
        $1 == "remedy:" { remedies++ }
        outcome == "coarse" && $1 == "outcome:" { coarse++ }
        END { exit wrong > 0 || rows != cells || remedies != coarse }' found.json
    [ $failed -eq 0 ] || grep -B3 -A3 -E 'SILENT|NaN' found.json || true
}
stability light 76 0 2 16      # for two methods; cameras that see nothing are refused
stability detail 180 24 0 45   # 6 fields x 6 views x 5 ways of seeing them; parallax is coarse where it slants
stability shading 300 120 0 0  # 10 extremes x 6 models x 5 glossinesses; four of the extremes send nothing back

$TOILE stability shading --quiet >table
check "a table: a line a cell, then the counts" test "$(grep -c '^shading ' table)" = "$(value cells)" -a "$(tail -1 table | cut -d ' ' -f 1)" = "$(value cells)"
refuse "a topic that is none" "expected a topic: toile stability cloth|light|detail|shading" stability wind
cp "$TOILE" alone
TOILE=./alone refuse "a program without the tests" "^toile: .*/toile-stability: cannot be executed: it is built with the tests" stability detail
