#!/usr/bin/env bash
# deb.sh BUILD FOLDER: installs the build into FOLDER/root and makes FOLDER/toile_VERSION_ARCH.deb of it.
set -euo pipefail
build=$1
mkdir -p "$2"
cd "$2"
version=$("$build/app/toile" --version | cut -d ' ' -f 2)
arch=$(dpkg --print-architecture)
# As for other tools of Debian, DEBFULLNAME and DEBEMAIL name who makes the package.
maintainer="${DEBFULLNAME:-The toile authors} <${DEBEMAIL:-toile@example.org}>"
source=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$build/CMakeCache.txt")

rm -rf root debian
DESTDIR=$PWD/root cmake --install "$build" --prefix /usr --strip >/dev/null
doc=root/usr/share/doc/toile
rm "$doc/LICENSE" # the file `copyright` holds it
gzip -9n root/usr/share/man/man1/*.1
gzip -9n "$doc/CHANGELOG.md"
printf 'toile (%s) unstable; urgency=medium\n\n  * See CHANGELOG.md.gz.\n\n -- %s  %s\n' \
  "$version" "$maintainer" "$(date -R -u -r "$source/CHANGELOG.md")" | gzip -9n >"$doc/changelog.gz"
{
  printf 'Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\nUpstream-Name: toile\n\n'
  printf 'Files: *\nCopyright: 2026 The toile authors\nLicense: Expat\n'
  sed -n '/^Permission/,$s/^/ /p' "$source/LICENSE" | sed 's/^ $/ ./'
} >"$doc/copyright"

# dpkg-shlibdeps reads the names of source and package here. What is opened at run time it cannot see.
mkdir debian
printf 'Source: toile\n\nPackage: toile\nArchitecture: any\n' >debian/control
depends=$(dpkg-shlibdeps -O root/usr/bin/toile root/usr/libexec/toile/* root/usr/lib/*/libtoile.so.0 2>/dev/null | sed 's/^shlibs:Depends=//')
mkdir root/DEBIAN
cat >root/DEBIAN/control <<TEXT
Package: toile
Version: $version
Architecture: $arch
Maintainer: $maintainer
Installed-Size: $(du -sk --exclude=DEBIAN root | cut -f 1)
Depends: $depends, libegl1, libgl1-mesa-dri, fonts-dejavu-core
Suggests: ffmpeg, zenity
Section: graphics
Priority: optional
Description: garment review: draping, light with shadows, and checks
 toile opens a garment, lets it drape on a body, lights it with a real place,
 and judges it: an interactive window, recorded flights that measure time,
 and runs without a screen that check every frame. The package also holds a
 C library with its header.
TEXT
printf 'libtoile 0 toile (>= %s)\n' "$version" >root/DEBIAN/shlibs
printf 'activate-noawait ldconfig\n' >root/DEBIAN/triggers
(cd root && find . -type f -not -path './DEBIAN/*' -printf '%P\0' | sort -z | xargs -0 md5sum >DEBIAN/md5sums)
chmod -R go-w root
dpkg-deb --root-owner-group --build root "toile_${version}_$arch.deb" >&2
echo "$PWD/toile_${version}_$arch.deb"
