#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Unpacks Debian's VTK 9.1 into FOLDER without installing it: python3-vtk9, which libvtk9-dev asks
# for, conflicts with python3-paraview, so installing it would remove pvpython.
# Needs: Debian 12 with the packages that the ParaView build needs (they bring VTK's libraries).
set -eu

if [ $# -ne 1 ]; then
  echo "usage: $0 FOLDER   (the vtk preset looks in build-vtk/vtk)" >&2
  exit 2
fi
mkdir -p "$1"
folder=$(cd "$1" && pwd)
packages="libvtk9-dev libvtk9.1 python3-vtk9 vtk9 libvtk9-java libvtk9.1-qt libvtk9-qt-dev"

archives=$(mktemp -d)
trap 'rm -rf "$archives"' EXIT
cd "$archives"
# shellcheck disable=SC2086 # a list of names
apt-get -q download $packages || {
  echo "$0: cannot download $packages; run apt-get update first" >&2
  exit 1
}
for archive in *.deb; do
  dpkg -x "$archive" "$folder"
done
echo "VTK 9.1 is in $folder"
