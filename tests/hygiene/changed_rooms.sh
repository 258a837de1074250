#!/usr/bin/env bash
# changed_rooms.sh <FILES: reads the names of changed files, one a line, and prints the test folders that they touch, one a
# line: those of each file's room, of the rooms above it (rooms.txt), and hygiene. Prints `all` where a file takes part in
# every test. A folder that no room has the name of counts to the room around it.
set -euo pipefail
cd "$(dirname "$0")/.."
folders=$({ echo app && find . -name 'test_*.c' -printf '%h\n' | sed 's:^\./::'; } | sort -u)
awk -v folders="$folders" '
  # The longest folder of a path that is a key of a table; empty where none is.
  function nearest(path, table) {
    while (path != "" && !(path in table)) path = path ~ /\// ? substr(path, 1, match(path, /\/[^\/]*$/) - 1) : ""
    return path
  }
  function touch(room, count, i, above) {
    if (room in touched) return
    touched[room]
    count = split(users[room], above, " ")
    for (i = 1; i <= count; i++) touch(above[i])
  }
  BEGIN {
    count = split(folders, list, "\n")
    for (i = 1; i <= count; i++) tested[list[i]]
  }
  FNR == NR { # rooms.txt
    if (/^#/ || !/:/) next
    room = $1
    sub(/:$/, "", room)
    users[room] = users[room]
    for (i = 2; i <= NF; i++) users[$i] = users[$i] " " room
    next
  }
  /^tests\/[^\/]*$|^CMakeLists.txt$|^CMakePresets.json$/ { all = 1; next }
  sub(/^tests\//, "") { own[nearest($0, tested)]; next } # no room changed
  (room = nearest($0, users)) != "" { touch(room); program = 1 }
  END {
    if (all) { print "all"; exit }
    own["hygiene"]
    if (program) { touch("app"); own["fuzz"] } # both link every room
    for (i = 1; i <= count; i++)
      if (list[i] in own || nearest(list[i], users) in touched) print list[i]
  }' hygiene/rooms.txt -
