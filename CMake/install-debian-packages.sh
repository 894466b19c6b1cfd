#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# install-debian-packages.sh [test|core]: installs on Debian 12 what building and running INRVolume
# takes; with `test`, also what its tests take; with `core`, what Core, CUDA and their tests take,
# without ParaView and the CUDA toolkit. Does nothing, and needs no rights, when all is there.
set -euo pipefail

# our own libraries and tools
own=(
  g++ cmake ninja-build ccache git libtbb-dev libglm-dev libopenexr-dev nlohmann-json3-dev libzstd-dev
  python3-numpy
)
packages=(
  # ParaView with its development files, and what those need but do not ask for
  paraview paraview-dev python3-paraview libdouble-conversion-dev liblz4-dev libopenmpi-dev
  libglew-dev libfreetype-dev libx11-dev libgl-dev libexpat1-dev zlib1g-dev libpng-dev python3-dev
  openmpi-bin libgl1-mesa-dri
  libqt5svg5 # the icons in ParaView's window
  qttools5-dev qtxmlpatterns5-dev-tools # for the help in ParaView's window
  "${own[@]}" xvfb xauth
)
case ${1:-} in
  test) packages+=(libgtest-dev libbenchmark-dev python3-pil clang libclang-rt-14-dev) ;;
  core) packages=("${own[@]}" libgtest-dev) ;;
esac

missing=()
for package in "${packages[@]}"; do
  if ! dpkg-query -W -f '${Status}' "$package" 2> /dev/null | grep -q 'ok installed'; then
    missing+=("$package")
  fi
done
[ ${#missing[@]} -eq 0 ] && exit 0

if ! command -v apt-get > /dev/null; then
  echo "This is not Debian. Please install: ${missing[*]}" >&2
  exit 1
fi
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo > /dev/null; then
    echo "Neither root nor sudo. Please have installed: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "== Installing ${#missing[@]} packages: ${missing[*]}"
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -q --no-install-recommends "${missing[@]}"
