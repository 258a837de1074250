#!/bin/bash
# The second render of a scene neither drapes nor filters its environment again, and shows the same; --no-cache does;
# `toile cache` lists and clears.
set -eu
. "$(dirname "$0")/cli.sh"
export XDG_CACHE_HOME=$room/cache

render() { "$TOILE" render --preset draft --size 24x32 --set cloth.edge_m=0.08 --set cloth.settle_s=0.1 $cheap_light -o "$1.exr" "${@:2}" 2>"$1.log"; }
count() { "$TOILE" cache --json | grep -c '"used_unix_s"' || true; }
check "nothing is kept at first" [ "$(count)" = 0 ]
render first
results=$(count)
check "a drape and lobes are kept" [ "$results" -gt 5 ]
kept=$(ls -l --time-style=full-iso "$XDG_CACHE_HOME/toile/drapes")
render second
check "the second shows the same" cmp first.exr second.exr
check "and kept nothing more" [ "$(count)" = "$results" ]
used=$(ls -l --time-style=full-iso "$XDG_CACHE_HOME/toile/drapes")
check "it used all that was kept" [ "$(comm -12 <(sort <<<"$kept") <(sort <<<"$used") | wc -l)" = 1 ] # the total
"$TOILE" cache --clear >cleared
check "cleared" grep -q "^$results results removed" cleared
render third --no-cache
check "without the cache nothing is kept" [ "$(count)" = 0 ]
check "and the image is the same" cmp first.exr third.exr
XDG_CACHE_HOME=/proc/nowhere render fourth
check "a folder that cannot be written is no error" cmp first.exr fourth.exr
"$TOILE" cache >listed
check "the list names its folder" grep -q "$XDG_CACHE_HOME/toile/drapes" listed
refuse "cache with a name" 'takes no name' cache dress
refuse "a missing garment" 'no_such.glb' render --garment no_such.glb -o x.exr
