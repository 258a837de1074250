# Sourced by every cli_*.sh: each drives the real executable, TOILE, from an empty folder of its own that goes with it.
# Checks are told as they are made and go on after a failure, which the exit status remembers.
data=${TOILE_DATA:-${TOILE_DATA_DIR:-}}
# What every start takes, whatever the size of its picture: the drape, and the light of each region for each texel of the
# pre-filtered cubes and of the fabric's weave, in rounds at rest. Scripts that look at something else leave most of it out.
cheap_light="--set light.regions=24 --set light.pem_size=16 --set light.rounds=1 --set light.bounce=off"
cheap_cloth="--garment sheet --avatar ball --fabric none --set cloth.settle_s=0.2"
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
room=$(mktemp -d)
failed=0
trap 'status=$?; rm -rf "$room"; exit $((status | failed))' EXIT
cd "$room" || exit 1

fail() { # WORDS...
    echo "FAILED $*"
    failed=1
}

check() { # NAME COMMAND...
    local name=$1
    shift
    if "$@"; then echo "ok     $name"; else fail "$name"; fi
}

# toile ARGUMENTS exits with 2 and says one line, which matches the pattern; it leaves nothing behind.
refuse() { # NAME PATTERN ARGUMENTS...
    local name=$1 pattern=$2 before after message status=0
    shift 2
    before=$(find . | sort)
    message=$($TOILE "$@" --quiet 2>&1) || status=$?
    after=$(find . | sort)
    if [ $status -ne 2 ]; then
        fail "$name: exit status $status, expected 2: $message"
    elif [ "$(printf '%s\n' "$message" | wc -l)" -ne 1 ] || ! printf '%s' "$message" | grep -qE -e "$pattern"; then
        fail "$name: expected one line that matches /$pattern/, got: $message"
    elif [ "$before" != "$after" ]; then
        fail "$name: left behind: $(diff <(echo "$before") <(echo "$after") | tr '\n' ' ')"
    else
        echo "ok     $name: $message"
    fi
}

# Ctrl-C once toile ARGUMENTS has printed a line that matches, however slow the machine: leaves what it wrote in `said`
# and `told`, and its status in $status. Twice at once, as `timeout` does it.
interrupt() { # PATTERN ARGUMENTS...
    local pattern=$1 job
    shift
    : >told
    $TOILE "$@" >said 2>told &
    job=$!
    until grep -q "$pattern" told; do
        kill -0 $job 2>/dev/null || { fail "ended before it printed $pattern: $(cat told)"; break; }
        sleep 0.1
    done
    kill -INT $job && kill -INT $job || true
    status=0
    wait $job || status=$?
}

# The page of a report is whole, shows all data that is written into it and no other, its pictures, and plots.
check_report() { # FILE PLOTS
    if command -v node >/dev/null; then
        check "$1 shows its data" node "$tests/app/report/page.js" "$1" "$2"
    else
        echo "skipped: $1 is not run: node is absent"
    fi
}
