#!/usr/bin/env bash
# The extremes of light, by the real executable: no cell is silent, none holds a NaN.
set -eu
out=$(mktemp)
trap 'rm -f "$out"' EXIT
status=0
$TOILE stability light --json --quiet >"$out" || status=$?
if [ $status -ne 0 ]; then
    grep -B3 -A3 -E 'SILENT|NaN' "$out" || true
    echo "FAILED stability light: status $status"
    exit 1
fi
value() { sed -n "s/^[[:space:]]*\"$1\":[[:space:]]*\([0-9]*\).*/\1/p" "$out" | head -1; }
[ "$(value silent)" -eq 0 ] && [ "$(value nan)" -eq 0 ]
[ $(($(value exact) + $(value bounded) + $(value refused))) -eq "$(value cells)" ]
# As many as TECHNIQUES.md lists, for two methods; refusals are promised for cameras that see nothing.
[ "$(value cells)" -ge 70 ] && [ "$(value refused)" -ge 2 ]
echo "ok     $(value cells) cells: $(value exact) exact, $(value bounded) bounded, $(value refused) refused"

# Detail: 6 fields x 6 views x 4 ways of seeing them.
$TOILE stability detail --json --quiet >"$out"
[ "$(value cells)" -eq 144 ] && [ "$(value silent)" -eq 0 ] && [ "$(value nan)" -eq 0 ] && [ "$(value exact)" -ge 24 ]
echo "ok     $(value cells) cells of detail: $(value exact) exact, $(value bounded) bounded"

# Shading: 10 extremes x 6 models x 5 glossinesses; four of the extremes send nothing back.
$TOILE stability shading --json --quiet >"$out"
[ "$(value cells)" -eq 300 ] && [ "$(value silent)" -eq 0 ] && [ "$(value nan)" -eq 0 ] && [ "$(value exact)" -ge 120 ]
echo "ok     $(value cells) cells of shading: $(value exact) exact, $(value bounded) bounded"
