#!/usr/bin/env bash
# Builds what a wheel carries of other people's libraries, from Debian's sources: static, fit for a module of Python, and without
# what needs more than the C library. HDF5 goes without its network, cairo without windows and without fonts other than its own.
#   packaging/wheel/libraries.sh PREFIX        as root; the licenses go to PREFIX/licenses
set -euo pipefail
prefix=$1
work=$prefix/work
export CFLAGS="-O2 -fPIC -fvisibility=hidden -ffunction-sections -fdata-sections" PKG_CONFIG_PATH=$prefix/lib/pkgconfig CPPFLAGS="-I$prefix/include" \
  LDFLAGS="-L$prefix/lib"
mkdir -p "$work" "$prefix/licenses"
cd "$work"

# sources NAME: fetches the sources of a package, of which the folder is then NAME. Some mirrors lack updates, or Debian's changes.
sources() {
  [[ -d $1 ]] && return
  local release
  release=$(. /etc/os-release && echo "$VERSION_CODENAME")
  if ! apt-get source -q "$1" && ! apt-get source -q -t "$release" "$1"; then
    apt-get source -q -t "$release" --tar-only "$1"
    tar xf "$1"_*.orig.tar.*
  fi
  mv "$1"-*/ "$1"
  # Changes must not look as if they called for autoconf.
  for made in aclocal.m4 Makefile.in configure config.h.in; do find "$1" -name "$made" -exec touch {} +; done
  cp "$1/debian/copyright" "$prefix/licenses/$1" 2>/dev/null || cp "$1/COPYING" "$prefix/licenses/$1"
}

# autotools NAME FOLDER OPTION...: makes and installs what is in this folder of the package, and not its tests.
autotools() {
  local name=$1 folder=$2
  shift 2
  sources "$name"
  (cd "$name" && ./configure -q --prefix="$prefix" --disable-shared --enable-static --with-pic "$@" &&
    make -s -j"${JOBS:-1}" SUBDIRS="$folder" install)
}

sources zlib
(cd zlib && ./configure --static --prefix="$prefix" && make -s libz.a && make -s install)
sources libpng1.6
(cd libpng1.6 && ./configure -q --prefix="$prefix" --disable-shared --enable-static --with-pic --disable-tools && make -s -j"${JOBS:-1}" libpng16.la &&
  make -s install-libLTLIBRARIES install-nodist_pkgincludeHEADERS install-pkgincludeHEADERS install-pkgconfigDATA install-data-hook)
autotools pixman pixman --disable-gtk --disable-libpng
autotools cairo src --disable-xlib --disable-xcb --disable-fc --disable-ft --disable-gobject --disable-script --disable-interpreter \
  --disable-ps --disable-trace --disable-gtk-doc --enable-png --enable-pdf --enable-svg
# Debian's changes make a shared library of it; these are all of its sources.
sources metis
(cd metis && mkdir -p objects && for source in GKlib/*.c libmetis/*.c; do
  gcc $CFLAGS -w -DNDEBUG -DNDEBUG2 -D_FILE_OFFSET_BITS=64 -DHAVE_EXECINFO_H -DHAVE_GETLINE -IGKlib -Iinclude -Ilibmetis -c "$source" \
    -o "objects/${source//\//-}.o"
done && ar rcs "$prefix/lib/libmetis.a" objects/*.o && cp include/metis.h "$prefix/include/")
autotools hdf5 src --disable-hl --disable-tests --disable-tools --enable-build-mode=production --with-zlib="$prefix" --without-szlib \
  --disable-ros3-vfd
