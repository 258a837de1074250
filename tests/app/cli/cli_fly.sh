#!/usr/bin/env bash
# Fly-throughs through the real executable: files, a replay to the bit at other numbers of threads, a comparison,
# a video, Ctrl-C, refusals. Times are not judged, only that they are there.
set -eu
. "$(dirname "$0")/cli.sh"
small="--size 64x48 --preset draft --set cloth.edge_m=0.08 --set cloth.settle_s=0.3 --fabric none $cheap_light"
small="$small --set reference.replicates=2 --quiet"

refuse "no folder" "add -o FOLDER" fly
refuse "no budget" "expected milliseconds" fly -o f --budget 0
refuse "no such path" "missing.yaml" fly -o f --path missing.yaml
printf 'keys:\n  - {time_s: 0, yaw_deg: 0}\n  - {time_s: 0.2, yaw: 90}\n' >bad.yaml
refuse "a bad path, by line and field" 'bad.yaml:3: key.yaw' fly -o f --path bad.yaml
refuse "a replay of nothing" "nowhere/frames.csv" fly -o f --replay nowhere
refuse "a replay with a budget" "leave --budget out" fly -o f --replay a --budget 5
refuse "an unknown kind of video" "unknown kind of video" fly -o f --video flight.gif

$TOILE fly $small --frames 24 --budget 10 --hash --oracle 11 -o a >said
check "it says what it came to" grep -q "within 1.1 x 10 ms" said
refuse "a trace in a missing folder" "nowhere/trace.json" fly -o a --trace nowhere/trace.json
check "the garment's error comes first" grep -q "FLIP of the garment 0\.[0-9]*, of its worst 5 % 0\.[0-9]*" said
check "four files" test "$(ls a | tr '\n' ' ')" = "frames.csv path.yaml report.html summary.json "
status=0
OMP_NUM_THREADS=1 $TOILE fly $small --no-cache --replay a --against a -o b >said || status=$?
check "a replay at one thread is the same to the bit" sh -c "[ $status -eq 0 ] && grep -q '24 of 24 images are the same' said"
check "it is compared job by job" grep -Eq '^ +frame +[0-9.]+ +[0-9.]+ +[0-9.]+ +[0-9.]+ to [0-9.]+' said
OMP_NUM_THREADS=2 $TOILE fly $small --no-cache --replay a --frames 6 -o b >said
check "and so is the beginning of one at two" grep -q "6 of 6 images are the same" said
sed -i '5s/[0-9a-f]*$/0123456789abcdef/' a/frames.csv
status=0
$TOILE fly $small --replay a --frames 6 -o b >/dev/null 2>said || status=$?
check "an image that differs is named: status 1" sh -c "[ $status -eq 1 ] && grep -q 'frame 3 ' said"
refuse "a replay of other work" "was flown with light.regions" fly $small --set light.regions=30 --replay a -o b
refuse "a comparison of other work" "was flown with image.width" fly $small --size 32x48 --against a -o b

printf 'keys:\n  - {time_s: 0, yaw_deg: 0}\n  - {time_s: 0.2, yaw_deg: 90}\n' >path.yaml
$TOILE fly $small --path path.yaml -o c --json --trace trace.json >said.json
check "a path of its own has its own length" test "$(wc -l <c/frames.csv)" -eq 8
refuse "another path is other work" "another path" fly $small --path path.yaml --against a -o b

if command -v python3 >/dev/null; then
    check "figures, and null where there are none" python3 - <<'PYTHON'
import csv, json, math
summary = json.load(open("b/summary.json"))
a = json.load(open("a/summary.json"))
c = json.load(open("said.json"))
assert a["frames"] == 24 and a["budget_ms"] == 10 and a["warm_up_frames"] == 12, a["frames"]
for key in ("p50_ms", "p95_ms", "p99_ms", "within_1_1x", "prediction_error_median"):
    assert math.isfinite(a[key]) and a[key] >= 0, key
assert a["p50_ms"] <= a["p95_ms"] <= a["p99_ms"] <= a["worst_ms"]
assert a["oracle"]["frames"] == 2 and 0 < a["oracle"]["covered_flip_mean"] < 1 and a["oracle"]["rel_rmse"] > 0
assert a["oracle"]["garment_frames"] == 2
assert 0 < a["oracle"]["garment_flip_mean"] < a["oracle"]["garment_flip_worst"] < 1
assert a["oracle"]["garment_flip_mean"] <= a["oracle"]["garment_flip_max"]
assert a["machine"]["cores"] >= 1 and a["machine"]["gl"] and a["settings"]["image.width"] == "64"
assert c["budget_ms"] is None and c["within_1_1x"] is None and c["frames"] == 7
assert c["path"] == "path.yaml" and c == json.load(open("c/summary.json"))
rows = list(csv.DictReader(open("a/frames.csv")))
judged = [row for row in rows if row["garment_flip"]]
assert [row["frame"] for row in judged] == ["11", "22"]
mean = sum(float(row["garment_flip"]) for row in judged) / 2
assert abs(mean - a["oracle"]["garment_flip_mean"]) < 1e-5 * mean, mean
assert all(float(row["garment_flip_worst"]) > float(row["garment_flip"]) for row in judged)
for row in rows:
    assert None not in row and None not in row.values(), row
    jobs = sum(float(row[key]) for key in row if key.startswith("job_"))
    assert 0 < jobs + float(row["cloth_ms"]) <= float(row["total_ms"]), row
    assert float(row["memory_bytes"]) > 0 and len(row["image_hash"]) == 16
assert len({row["image_hash"] for row in rows}) > 20, "images do not change"
PYTHON
else
    echo "skipped: files are not parsed: python3 is absent"
fi

if command -v python3 >/dev/null; then
    check "a trace: what a frame consists of, and busy threads" python3 - <<'PYTHON'
import csv, json, os
trace = json.load(open("trace.json"))["traceEvents"]
rows = list(csv.DictReader(open("c/frames.csv")))
names = {e["tid"]: e["args"]["name"] for e in trace if e["ph"] == "M"}
spans = [e for e in trace if e["ph"] == "X"]
jobs = [e for e in spans if e["tid"] == 1]
frames = sorted((e for e in jobs if e["name"] == "frame"), key=lambda e: e["ts"])
assert len(frames) == len(rows) == 7 and names[1] == "frames and their jobs", (len(frames), names)
for i, (frame, row) in enumerate(zip(frames, rows)):
    end = frame["ts"] + frame["dur"]
    assert abs(frame["dur"] - 1e3 * float(row["total_ms"])) < 1e3, frame
    assert i == 0 or frames[i - 1]["ts"] + frames[i - 1]["dur"] <= frame["ts"]
    inside = [e for e in jobs if e is not frame and frame["ts"] <= e["ts"] < end]
    want = {k[4:-3] for k in row if k.startswith("job_") and float(row[k]) > 0} | ({"cloth"} if i else set())
    assert want <= {e["name"] for e in inside} <= want | {"cloth"}, (want, inside)
    inside.sort(key=lambda e: e["ts"])
    for a, b in zip(inside, inside[1:] + [{"ts": end}]):
        assert a["ts"] + a["dur"] <= b["ts"] + 1, (a, b)
busy = [e for e in spans if e["tid"] != 1]
assert {e["name"] for e in busy} == {"busy"} and {e["tid"] for e in busy} <= set(names)
main = [e for e in busy if names[e["tid"]] == "main thread"]
assert main and all(e["dur"] > 900 for e in busy)
total = dict.fromkeys(set(names) - {1}, 0)
for thread in total:
    mine = sorted((e for e in busy if e["tid"] == thread), key=lambda e: e["ts"])
    assert all(a["ts"] + a["dur"] <= b["ts"] + 1 for a, b in zip(mine, mine[1:])), names[thread]
    total[thread] = sum(max(0, e["ts"] + e["dur"] - max(e["ts"], frames[0]["ts"])) for e in mine)
assert len(total) > 1 or os.cpu_count() == 1, "software GL has threads"
assert len(total) == 1 or min(total.values()) < 0.5 * max(total.values()), "each thread has a clock of its own"
PYTHON
fi
for folder in a b c; do check_report $folder/report.html 3; done

mkdir empty
TOILE="env PATH=$PWD/empty $TOILE" refuse "no ffmpeg: refused before anything is flown" "install the package ffmpeg" \
    fly -o e --video flight.mp4
cat >empty/ffmpeg <<'TEXT'
#!/bin/sh
[ "$1" = -version ] && exit 0
echo "it does not like this video" >&2
exit 3
TEXT
chmod +x empty/ffmpeg
check "an ffmpeg that dies is reported, with its message" sh -c \
    "! PATH=\"$PWD/empty:\$PATH\" $TOILE fly $small --frames 8 -o e --video flight.mp4 >/dev/null 2>said && grep -q 'status 3: it does not like' said"
check "the flight is kept all the same, and no video" test -s e/frames.csv -a "$(ls | grep -c flight.mp4)" -eq 0
if command -v ffmpeg >/dev/null && command -v ffprobe >/dev/null; then
    $TOILE fly $small --size 65x47 --frames 12 -o v --video flight.mp4 >/dev/null
    check "a video of every frame, with even sides" test \
        "$(ffprobe -v error -count_frames -show_entries stream=width,height,nb_read_frames -of csv=p=0 flight.mp4)" = 66,48,12
else
    echo "skipped: no video is made: ffmpeg is absent"
fi

# Ctrl-C: exit status 130, and what was flown is there.
interrupt "flying:" fly ${small% --quiet} --frames 100000 -o stopped
check "interrupted: status 130" test $status -eq 130
check "interrupted: what was flown is kept" test "$(wc -l <stopped/frames.csv)" -ge 2 -a -s stopped/report.html -a -s stopped/summary.json
