#!/usr/bin/env bash
# toile gallery: a run that Ctrl-C stops leaves pictures, a table with a row for each of them, and a page that shows them;
# the same command again keeps what was drawn; wrong use exits 2. That a picture which is missing or has other settings is
# drawn again is tested with the record (tests/app/lab/test_gallery.c).
set -u
. "$(dirname "$0")/cli.sh"

refuse "no folder" 'folder' gallery
refuse "no such section" 'd9' gallery d99 -o out
refuse "two sections" 'one section' gallery d9 a1 -o out

# Ctrl-C after the first picture of several; a machine that has drawn all of them by then ends with 0.
"$TOILE" gallery b8 --quiet -o out 2>log &
job=$!
until grep -qs 'b8-01.png' out/gallery.json || ! kill -0 $job 2>/dev/null; do sleep 0.1; done
kill -INT $job 2>/dev/null
wait $job
status=$?
rows=$(($(wc -l <out/gallery.csv) - 1))
[ $status -eq 130 ] || [ $status -eq 0 -a "$rows" -ge 2 ] || fail "stopped: exit $status: $(cat log)"
[ "$(head -1 out/gallery.csv)" = "id,technique,setting,error,error_metric,time_ms,image" ] || fail "heads of gallery.csv"
[ "$rows" -ge 1 ] || fail "no rows"
[ "$(grep -o '"file":"b8-[0-9]*.png"' out/gallery.html | wc -l)" -eq "$rows" ] || fail "$rows pictures on the page"
! grep -q 'base64' out/gallery.html || fail "the page loads its pictures from the folder alone"
check_report out/gallery.html 0
# Every error is a number, every time positive, every picture there.
awk -F, 'NR > 1 { if ($(NF-3) !~ /^[0-9.e+-]+$/ || $(NF-1) <= 0) { print "row " NR ": " $0; bad = 1 } } END { exit bad }' \
    out/gallery.csv || fail "figures"
awk -F, 'NR > 1 { print $NF }' out/gallery.csv | while read -r image; do [ -s "out/$image" ] || echo missing; done >missing
[ ! -s missing ] || fail "pictures"

# The first picture again: it is the earlier run's.
cp out/gallery.csv before.csv && cp -p out/b8-01.png before.png
"$TOILE" gallery b8 --quick --quiet -o out || fail "second run: exit status $?"
cmp -s <(head -2 before.csv) out/gallery.csv || fail "the second run measured again"
[ ! out/b8-01.png -nt before.png ] || fail "the second run drew again"
grep -q '"kept":true' out/gallery.html || fail "the page does not state that the figures are of an earlier run"
check_report out/gallery.html 0

echo '{"other": 1}' >out/gallery.json
refuse "the record of something else" 'gallery.json' gallery b8 --quick --quiet -o out
