#!/usr/bin/env bash
# toile measure: tables, CSV and JSON of a drape, of a file as authored, and of a file that is one's own export.
set -u
. "$(dirname "$0")/cli.sh"

quick="--set cloth.edge_m=0.05 --set cloth.settle_s=2 --quiet"
check "a built-in cut is measured" sh -c "$TOILE measure --garment dress $quick -o dress.csv >dress.txt"
check "how the cloth lies comes first" sh -c "head -1 dress.txt | grep -Eq '^cloth, (at rest|moved, not at rest): [0-9]+ vertices, [0-9]+ triangles$'"
check "with strain, open seams, what is inside, what crosses" grep -Eq '^  strain [0-9.]+ % rms, [0-9]+ % at most; 0 open pairs of seams; 0 vertices inside .*; 0 pairs of triangles cross$' dress.txt
check "its panels are listed" grep -Eq '^bodice 1 +[0-9.]+ +[0-9.]+ ' dress.txt
check "its openings are named" sh -c "for name in neck 'left armhole' 'right armhole' hem; do grep -q \"^\$name  *[0-9]\" dress.txt || exit 1; done"
check "the hem's height is that of its lowest cloth or above it" sh -c "grep -q '^opening,\"hem\",height,mm,,[4-8][0-9][0-9]\.' dress.csv"
check "its girths stand beside the body's" grep -Eq '^waist +1[0-9]{3} +6[0-9]{2}\.[0-9] +[67][0-9]{2}\.[0-9]' dress.txt
check "the CSV has a head" sh -c "[ \"\$(head -1 dress.csv)\" = kind,name,quantity,unit,rest,worn,mean,p95,max ]"
check "every line of it has nine fields" sh -c "! grep -Evq '^([^,]*,){8}[^,]*$' dress.csv"
check "all of it is the sum of its panels" awk -F, '
    $3 == "area" && $2 == "\"all\"" { all = $5 } $3 == "area" && $2 != "\"all\"" { sum += $5 }
    END { exit !(all > 9000 && all < 12000 && sum - all < 0.1 && all - sum < 0.1) }' dress.csv

# Opened again, the export has the areas, lengths and strains that it had: its UVs are its pattern.
$TOILE export --garment dress $quick -o dress.obj
# One argument is enough, and what is exported again is where it was, to the micrometre.
check "a garment file is exported again" $TOILE export dress.obj --quiet -o back.obj
check "it is where it was" python3 -c '
read = lambda name: [[float(x) for x in line.split()[1:]] for line in open(name) if line.startswith("v ")]
a, b = read("dress.obj"), read("back.obj")
assert len(a) == len(b) > 100, (len(a), len(b))
assert all(abs(p - q) < 1e-6 for u, v in zip(a, b) for p, q in zip(u, v))'
check "an export is measured" sh -c "$TOILE measure dress.obj --avatar form --quiet -o again.csv >again.txt"
check "and has the same measures" awk -F, '
    NR == FNR { rest[$1 $2 $3] = $5; mean[$1 $2 $3] = $7; next }
    FNR > 1 { key = $1 $2 $3; n++
        if ($5 != "" && ($5 / rest[key] > 1.01 || $5 / rest[key] < 0.99)) { print key, $5, rest[key]; bad = 1 }
        if ($7 != "" && ($7 - mean[key] > 0.2 || $7 - mean[key] < -0.2)) { print key, $7, mean[key]; bad = 1 } }
    END { exit bad || n < 20 }' dress.csv again.csv
check "by its mesh it is not strained" sh -c "$TOILE measure dress.obj --set cloth.rest=mesh --quiet | grep -Eq '^all .* 0\.00 +-?0\.00 +0\.00 '"
check "that is said" sh -c "$TOILE measure dress.obj --set cloth.rest=mesh 2>&1 >skirt.txt | grep -q 'has no pattern'"
check "nobody wears it: no girths" sh -c "! $TOILE measure dress.obj --quiet | grep -q '^girth'"
check "info tells the rest shape" sh -c "$TOILE info dress.obj | grep -Eq '^ +of +uv$'"
check "and the openings" sh -c "$TOILE info dress.obj | grep -Eq '^ +left armhole +5[0-9]{2}'"
check "JSON is one object" sh -c "$TOILE measure dress.obj --json --quiet | python3 -c '
import json, sys
measures = json.load(sys.stdin)
assert len(measures[\"panels\"]) == 5 and measures[\"openings_mm\"][\"hem\"][\"rest\"] > 2000, measures'"
# A fault that let each start be the garment's own would leave no interval.
check "the interval of friction" sh -c "$TOILE measure --garment dress $quick --no-cache --interval --json | python3 -c '
import json, sys
told = json.load(sys.stdin)
interval = told[\"interval_mm\"]
assert len(interval[\"starts\"]) == 5, interval
for kind, of, key in ((\"openings\", \"openings_mm\", \"worn\"), (\"heights\", \"openings_mm\", \"height\"), (\"girths\", \"girths_mm\", \"worn\")):
    assert len(interval[kind]) == len(told[of]), kind
    for name, item in interval[kind].items():
        assert abs(item[\"own\"] - told[of][name][key]) < 1e-9, name
        assert item[\"min\"] <= item[\"own\"] <= item[\"max\"] < item[\"min\"] + 60, (name, item)
neck = interval[\"openings\"][\"neck\"]
assert neck[\"max\"] > neck[\"min\"] + 0.01, neck'"
refuse "an interval of a garment as authored" '^toile: --interval: the garment is as authored: add --set scene.drape=settle' measure dress.obj --interval
refuse "an interval in motion" 'leave --frame out' measure --garment dress $quick --interval --frame 1
refuse "an interval of what does not settle" "cloth.settle_s=0" measure --garment dress --set cloth.edge_m=0.08 --set cloth.settle_s=0 --interval
refuse "an interval as CSV" 'leave -o out' measure dress.obj --interval -o interval.csv
check "a later frame is measured too" sh -c "$TOILE measure dress.obj --frame 2 --quiet | grep -q '^hem '"

pattern=$data/patterns/shirt_mean_specification.json
if [ -r "$pattern" ]; then
    check "a pattern's openings are known before it is sewn" sh -c "$TOILE info $pattern | grep -Eq '^ +left cuff +4[0-9]{2}\.'"
fi
refuse "a picture is no table" 'end the name in .csv' measure dress.obj -o out.png
refuse "a scene without a garment" 'no garment' measure --garment none --avatar form
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >flat.obj
refuse "UVs that are not there" 'cloth.rest=uv: flat.obj has no UVs' measure flat.obj --set cloth.rest=uv
