#!/usr/bin/env bash
# An installed tree stands alone: the program renders from it where the source and the build are not in sight, its man
# pages are well formed, its completion completes, both examples of the C library run, and so does the Debian package.
# BUILD is the build's folder, SOURCE the sources'.
set -eu
. "$(dirname "$0")/cli.sh"

DESTDIR=$room/first cmake --install "$BUILD" --prefix /usr --strip >/dev/null
mv first moved # nothing may remember where it was installed
root=$room/moved/usr
lib=$(dirname "$(find "$root/lib" -name 'libtoile.so.0')")
toile=$root/bin/toile
printf 'scene: {garment: sheet, avatar: ball, fabric: none, preset: draft}\ncloth: {settle_s: 0.2}\nlight: {regions: 24, pem_size: 16, rounds: 4, bounce: off}\n' >scene.yaml

# In a mount namespace of its own, in which sources and build are empty folders.
hidden() {
    unshare --mount sh -c 'mount -t tmpfs none "$1" && mount -t tmpfs none "$2" && shift 2 && exec "$@"' sh "$BUILD" "$SOURCE" "$@"
}
if hidden true 2>/dev/null; then
    check "sources are hidden" hidden test ! -e "$SOURCE/README.md"
else
    echo "skipped: no mount namespace here: sources stay in sight"
    hidden() { "$@"; }
fi
check "the installed program renders" hidden env -i HOME="$room" PATH=/usr/bin "$toile" render scene.yaml --frame 3 --size 320x400 --quiet -o program.png
hidden env -i HOME="$room" PATH=/usr/bin "$toile" stability shading --quiet >extremes
check "... and toile-stability" grep -q ' 0 silent, 0 with NaN' extremes
check "... and has its fabrics" sh -c "env -i '$toile' info fabrics | grep -q satin"

if command -v man >/dev/null && command -v groff >/dev/null; then
    for page in "$root"/share/man/man1/*.1; do
        warned=$(LC_ALL=C.UTF-8 MANROFFSEQ= MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 -Z "$page" 2>&1 >/dev/null || true)
        [ -z "$warned" ] || fail "$(basename "$page"): $warned"
    done
    check "man shows a page" sh -c "MANWIDTH=80 man -l '$root/share/man/man1/toile-render.1' | grep -q -- --frames"
else
    echo "skipped: man pages are not formatted: man is absent"
fi
for command in $("$toile" help complete "toile " | cut -f 1); do
    [ -s "$root/share/man/man1/toile-$command.1" ] || fail "toile-$command has no man page"
done
options=$("$toile" help reference | grep -c '^| `')
check "toile.1 has all $options options" test "$(grep -cE '^\\fB[a-z_]+\.[a-z_0-9]+' "$root/share/man/man1/toile.1")" = "$options"

# Completion, as readline calls it.
complete_line() { # LINE: the words that are offered
    PATH=$root/bin:$PATH bash -c '. "$1"; COMP_LINE=$2 COMP_POINT=${#2}; _toile 2>/dev/null; printf "%s " "${COMPREPLY[@]}"' \
        bash "$root/share/bash-completion/completions/toile" "$1"
}
offers() { # LINE WORDS
    local words
    words=$(complete_line "$1")
    if [ "$words" = "$2 " ]; then echo "ok     completes: $1 -> $2"; else fail "completes: $1 -> $words, expected $2"; fi
}
touch dress.glb
offers "toile rend" "render"
offers "toile render --colourw" "--colourway"
offers "toile render --fabric velv" "velvet"
offers "toile render --set light.ratio_a" "light.ratio_at="
offers "toile render --set light.method=refe" "reference"
offers "toile trade --axis det" "detail"
offers "toile view dress.g" "dress.glb"
offers "toile render --method unshadowed dre" "dress dress.glb"
offers "toile nosuch --" ""

if command -v cc >/dev/null && command -v pkg-config >/dev/null; then
    export PKG_CONFIG_PATH=$lib/pkgconfig
    check "the example in C builds" cc "$root/share/doc/toile/examples/example.c" -o example $(pkg-config --cflags --libs toile)
    check "... and draws" env LD_LIBRARY_PATH="$lib" ./example library.png scene.yaml
    check "... what the program draws" cmp library.png program.png
    status=0
    LD_LIBRARY_PATH=$lib ./example library.png nosuch.yaml 2>said || status=$?
    check "... and prints an error" sh -c "test $status = 1 && grep -q '^example: nosuch.yaml' said && test \$(wc -l <said) = 1"
    check "the version is that of the program" test "toile $(pkg-config --modversion toile)" = "$("$toile" --version)"
else
    echo "skipped: the example in C is not built: cc or pkg-config is absent"
fi
check "the library shows its own names only" sh -c "! nm -D --defined-only '$lib/libtoile.so.0' | grep -vE ' (toile_[a-z_]+@@TOILE_0|TOILE_0)$'"
if command -v python3 >/dev/null; then
    covered=$(LD_LIBRARY_PATH=$lib python3 "$root/share/doc/toile/examples/example.py" scene.yaml)
    check "the example in Python draws: $covered" sh -c "echo '$covered' | grep -qE '^covered: 0\.[1-9]'"
else
    echo "skipped: the example in Python is not run: python3 is absent"
fi

if command -v dpkg-deb >/dev/null && command -v dpkg-shlibdeps >/dev/null; then
    package=$(bash "$SOURCE/app/install/deb.sh" "$BUILD" "$room/deb" 2>/dev/null)
    dpkg -x "$package" unpacked
    check "the package's program renders" hidden env -i HOME="$room" PATH=/usr/bin unpacked/usr/bin/toile render scene.yaml --frame 3 --size 320x400 --quiet -o package.png
    check "... the same" cmp package.png program.png
    check "the package depends on what it links" sh -c "dpkg-deb -f '$package' Depends | grep -q libembree && dpkg-deb -f '$package' Depends | grep -q libglfw3"
    if command -v lintian >/dev/null; then
        check "lintian finds no error" lintian --allow-root --fail-on error "$package"
    fi
else
    echo "skipped: no package is made: dpkg-deb or dpkg-shlibdeps is absent"
fi
if command -v desktop-file-validate >/dev/null; then
    check "the desktop entry is valid" desktop-file-validate "$root/share/applications/toile.desktop"
fi
