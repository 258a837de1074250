#!/usr/bin/env bash
# The tests that `./dev test --changed` chooses: what each change must bring and must leave out.
set -euo pipefail
here=$(dirname "$0")
failed=0
# expect FILE WANTED... -- UNWANTED...
expect() {
  local file=$1 wanted=1 word chosen
  chosen=$(echo "$file" | "$here/changed_rooms.sh")
  for word in "${@:2}"; do
    if [[ $word == -- ]]; then
      wanted=0
    elif [[ $(grep -cx "$word" <<<"$chosen") != "$wanted" ]]; then
      echo "$file: $word is chosen $((1 - wanted)) times, expected $wanted"
      failed=1
    fi
  done
}
expect render/pem/chain.c render/pem render/frame render app hygiene fuzz -- render/gpu render/metrics cloth/energy cloth assets config all
expect cloth/energy/forces.c cloth/energy cloth/solvers cloth app/scene app -- render/pem assets/gltf
expect config/presets/paper.yaml config render/pem cloth/energy app/lab
expect tests/render/pem/test_chain.c render/pem hygiene -- render app fuzz
expect tests/app/cli/cli_env.sh app -- app/scene fuzz
expect tests/fuzz/corpus/exr/empty fuzz -- app
expect docs/options.md hygiene -- app fuzz
expect tests/testing.h all
expect CMakeLists.txt all
exit "$failed"
