#!/usr/bin/env bash
# toile gallery: pictures, a table with a row for each of them, and a page that shows them; the same command again
# keeps what was drawn; wrong use exits 2.
set -u
. "$(dirname "$0")/cli.sh"

refuse "no folder" 'folder' gallery
refuse "no such section" 'd9' gallery d99 -o out
refuse "two sections" 'one section' gallery d9 a1 -o out

"$TOILE" gallery a9 --quick --quiet -o out || fail "exit status $?"
[ "$(head -1 out/gallery.csv)" = "id,technique,setting,error,error_metric,time_ms,image" ] || fail "heads of gallery.csv"
rows=$(($(wc -l <out/gallery.csv) - 1))
[ "$rows" -ge 1 ] || fail "no rows"
[ "$(find out -name '*.png' | wc -l)" -eq "$rows" ] || fail "a picture for each of $rows rows: $(ls out)"
[ "$(grep -o '<img loading="lazy" width="1792" height="[0-9]*"' out/gallery.html | wc -l)" -eq "$rows" ] ||
    fail "$rows pictures on the page"
! grep -q 'https\?://\|base64' out/gallery.html || fail "the page loads its pieces from the folder alone"
# Every error is a number, every time positive, every picture there.
awk -F, 'NR > 1 { if ($(NF-3) !~ /^[0-9.e+-]+$/ || $(NF-1) <= 0) { print "row " NR ": " $0; bad = 1 } } END { exit bad }' \
    out/gallery.csv || fail "figures"
awk -F, 'NR > 1 { print $NF }' out/gallery.csv | while read -r image; do [ -s "out/$image" ] || echo missing; done >missing
[ ! -s missing ] || fail "pictures"

# Ctrl-C after the second picture: the page has what was drawn, the first picture is the earlier run's. The section
# has four pictures; a machine that has drawn all of them by then ends with 0.
cp out/gallery.csv before.csv && cp -p out/a9-01.png before.png
"$TOILE" gallery a9 --quiet -o out 2>log &
job=$!
until grep -qs 'a9-02.png' out/gallery.json || ! kill -0 $job 2>/dev/null; do sleep 0.1; done
kill -INT $job 2>/dev/null
wait $job
status=$?
[ $status -eq 130 ] || [ "$(wc -l <out/gallery.csv)" -eq 5 ] || fail "stopped: exit $status: $(cat log)"
[ "$(grep -o '<img ' out/gallery.html | wc -l)" -ge 2 ] || fail "the page of a stopped run"
[ "$(sed -n 2p out/gallery.csv)" = "$(sed -n 2p before.csv)" ] || fail "the second run measured again"
[ ! out/a9-01.png -nt before.png ] || fail "the second run drew again"
# What is missing is drawn again.
rm out/a9-01.png
"$TOILE" gallery a9 --quick --quiet -o out || fail "third run: exit status $?"
[ -s out/a9-01.png ] || fail "a missing picture was not drawn again"
echo '{"other": 1}' >out/gallery.json
refuse "the record of something else" 'gallery.json' gallery a9 --quick --quiet -o out
