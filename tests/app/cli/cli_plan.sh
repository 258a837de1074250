#!/usr/bin/env bash
# What a frame is planned to do: each feature that leaves a scene takes its jobs, its memory and its work with it; a budget
# tells its levels. Work is what jobs have to do, by the table of costs: no clock is asked.
set -eu
command -v python3 >/dev/null || { echo "skipped: JSON is not parsed: python3 is absent"; exit 77; }
. "$(dirname "$0")/cli.sh"
fast="--preset draft --size 64x48 $cheap_cloth $cheap_light --quiet --frame 1 --json"

cat >less.py <<'END'
import json, sys
name, dropped = sys.argv[1], sys.argv[4].split()
more, less = (json.load(open(f)) for f in sys.argv[2:4])
def running(plan): return {j["name"]: j for j in plan["jobs"] if j["action"] == "run"}
for job in dropped:
    row = next(j for j in less["jobs"] if j["name"] == job)
    assert row["action"] == "drop" and row["reason"], (name, row)
    assert next(j for j in more["jobs"] if j["name"] == job)["action"] != "drop", (name, job)
bytes_ = [sum(p["resource_bytes"].values()) for p in (more, less)]
assert [p["memory_bytes"]["total"] for p in (more, less)] == bytes_, (name, "memory by resource")
assert bytes_[1] < bytes_[0], (name, "memory", bytes_)
work = [sum(j["work_ms"] for j in p["jobs"]) for p in (more, less)]
assert work[1] < work[0], (name, "work", work)
print("ok     %-10s memory %.2f to %.2f MB, work %.1f to %.1f" % (name, *(b / 1e6 for b in bytes_), *work))
END

without() { # NAME "JOBS" "WITH" "WITHOUT"
    $TOILE plan $fast $3 >more.json
    $TOILE plan $fast $4 >less.json
    python3 less.py "$1" more.json less.json "$2" || fail "$1"
}
without gloss "" "--fabric satin" \
    "--fabric satin --set material.model=phong --set material.glossiness=0 --set material.specular=0,0,0"
without detail "detail" "--fabric denim --set detail.mode=parallax" "--fabric none"
without lamps "lamps lamp_rays" "--set lamp.kind=point" "--set lamp.kind=none"
without ground "" "--set image.ground=true" "--set image.ground=false"
without shadows "points lights" "--method pem" "--method unshadowed"
without regions "" "--set light.regions=192" "--set light.regions=48"
sun=$data/envmaps/hdr/kloppenheim_05_1k.hdr
if [ -r "$sun" ]; then
    without sun "" "--env $sun --set light.sun=true" "--env $sun --set light.sun=false"
else
    echo "skipped: sun: $sun is absent"
fi

fast=${fast/ --frame 1/} # a budget measures frames of its own
large="${fast/64x48/320x240} --set light.visibility=vsm" # lit at every sample: fewer of them save most of the time
$TOILE plan $large --budget 1 >tight.json
$TOILE plan $large --budget 100000 >loose.json
check "budgets" python3 - <<'END'
import json
tight, loose = (json.load(open(f))["budget"] for f in ("tight.json", "loose.json"))
assert tight["predicted_ms"] and loose["predicted_ms"]
assert loose["error"] == 0 and all(k["level"] == 0 and k["next_ms"] is None for k in loose["controls"])
assert tight["error"] > 0 and [k["name"] for k in tight["controls"]] == ["ratio", "refresh", "regions", "relief", "scale"]
for control in tight["controls"]: # much error is not accepted for little time, so that not each must be at its last level
    assert control["next_error"] is None or control["next_error"] < 0, control
assert any(k["level"] > 0 for k in tight["controls"][1:])
END
# What was never measured depends on the scene: points on its vertices, lights on the lobes of its materials.
first=${fast/--quiet/--quiet --set light.visibility=rays}
$TOILE plan $first --fabric satin >satin.json
$TOILE plan $first --garment sheet --avatar none --fabric none >matt.json
check "unmeasured costs" python3 - <<'END'
import json
satin, matt = ({j["name"]: j for j in json.load(open(f))["jobs"]} for f in ("satin.json", "matt.json"))
assert satin["cloth"]["action"] == "reuse", satin["cloth"]
assert satin["lights"]["predicted_ms"] > 10 * matt["lights"]["predicted_ms"] > 0
for job in ("points", "trace"):
    assert satin[job]["predicted_ms"] > 1.2 * matt[job]["predicted_ms"] > 0, (job, satin[job], matt[job])
END
# What levels leave out shows what it took when nothing was left out.
$TOILE plan ${first/64x48/480x270} --fabric satin --budget 1 >levels.json
check "savings" python3 - <<'END'
import json
jobs = {j["name"]: j for j in json.load(open("levels.json"))["jobs"]}
for job in ("gbuffer", "samples", "compose"):
    assert jobs[job]["action"] == "drop" and jobs[job]["saved_ms"] > 0 and jobs[job]["saved_bytes"] > 0, jobs[job]
assert not any("saved_ms" in j for j in jobs.values() if j["action"] != "drop")
assert jobs["cloth"]["action"] == "run" and jobs["cloth"]["predicted_ms"] > 0, jobs["cloth"]
END
check "text" grep -q "levels for 50 ms" <($TOILE plan ${fast%--json} --budget 50)
fast=${fast/--json/--fabric cotton_plain --budget 50}
check "rays without a measurement" grep -q "^visibility: rays: GL runs on the CPU" <($TOILE plan $fast)
check "both measured" grep -q "^visibility: .* rays take [0-9.]* ms, shadow maps [0-9.]* ms, of 30.0 ms" \
    <($TOILE plan $fast --calibrate)
refuse "calibration without a budget" "--calibrate: .*add --budget" plan ${fast/--budget 50/} --calibrate
