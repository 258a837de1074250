#!/bin/sh
# make_man.sh TOILE FOLDER: the program's man pages, one for each command and one for all.
set -eu
mkdir -p "$2"
for command in $("$1" help complete "toile " | cut -f 1); do
  "$1" help man "$command" >"$2/toile-$command.1"
done
"$1" help man >"$2/toile.1"
