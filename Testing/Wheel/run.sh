#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds the wheel `inrvolume` against cvista, installs it in a clean virtual environment with PyVista,
# and tests it there. Needs Debian 13, whose Python is new enough, or root on Debian 12, where it makes
# a Debian 13 in build-wheel/debian13 with debootstrap from the mirror that this machine uses.
#
#   Testing/Wheel/run.sh
#
# Ends with "passed: ..." or "failed: ...". The wheel is then in build-wheel/, what the test drew in
# build-wheel/test, and its result among those of the benchmarks.
set -euo pipefail

cd "$(dirname "$0")/../.."
here=$PWD
work=build-wheel
mkdir -p "$work"
trap 'echo "failed: line $LINENO of Testing/Wheel/run.sh"' ERR

# What a copy of the sources without their history cannot tell.
INR_COMMIT=${INR_COMMIT:-$(cd Testing/Benchmarks && INR_COMPILER=not-asked python3 -c 'import results_file; print(results_file.commit())')}
export INR_COMMIT

# Elsewhere than on Debian 13, the rest runs there, with the sources in /inrvolume.
# shellcheck source=/dev/null
source /etc/os-release
if [ "${VERSION_ID:-}" != 13 ]; then
  root=$here/$work/debian13
  command -v debootstrap > /dev/null || apt-get install -y -q --no-install-recommends debootstrap
  if [ ! -e "$root/made" ]; then
    echo "== Making a Debian 13 in $root"
    rm -rf "$root" # half of one, where it was interrupted
    mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' \
      "Codename: $VERSION_CODENAME" | head -n 1)
    debootstrap --variant=minbase --include=ca-certificates trixie "$root" "$mirror" > "$work/debootstrap.log"
    # How this machine reaches the mirror and the package index.
    cp -n /etc/apt/apt.conf.d/* "$root/etc/apt/apt.conf.d/"
    cp /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/"
    mkdir "$root/inrvolume"
    touch "$root/made"
  fi
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  # In a namespace of its own, so that nothing stays mounted whatever becomes of this; there, this
  # machine's folders are not.
  exec unshare --mount bash -c '
    mount --bind "$1" "$2/inrvolume" && mount --rbind /dev "$2/dev" && mount -t proc proc "$2/proc" &&
    exec env -u TMPDIR -u XDG_RUNTIME_DIR chroot "$2" /inrvolume/Testing/Wheel/run.sh' bash "$here" "$root"
fi

echo "== Installing what is missing"
packages=(
  g++ cmake ninja-build ccache git patchelf python3-dev python3-venv
  libtbb-dev libglm-dev libopenexr-dev nlohmann-json3-dev libzstd-dev
  xvfb xauth libgl1 libgl1-mesa-dri libglx-mesa0 libegl1 libxcursor1
)
if ! dpkg -s "${packages[@]}" > /dev/null 2>&1; then
  apt-get update -q > "$work/apt.log"
  DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -q --no-install-recommends "${packages[@]}" >> "$work/apt.log" 2>&1
fi

echo "== Building the wheel"
rm -rf "$work"/tools "$work"/clean "$work"/test "$work"/*.whl
python3 -m venv "$work/tools"
"$work/tools/bin/pip" install -q auditwheel
"$work/tools/bin/pip" wheel -q --no-deps -w "$work/plain" . -C build-dir="$work/cmake" \
  -C cmake.define.INR_WERROR=true
"$work/tools/bin/auditwheel" repair --exclude 'libvtk*' -w "$work" "$work"/plain/inrvolume-*.whl > "$work/auditwheel.log"
rm -r "$work/plain"
wheel=$(ls "$work"/inrvolume-*.whl)
echo "   $wheel"

echo "== Installing it in a clean virtual environment"
python3 -m venv "$work/clean"
"$work/clean/bin/pip" install -q "$wheel" 'pyvista[cvista]'

echo "== Testing it"
mkdir "$work/test"
version=$(sed -n 's/^project(INRVolume VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
cd "$work/test" # where no other `inrvolume` can be found
"$here/Testing/with-display.sh" "$here/$work/clean/bin/python" "$here/Testing/Wheel/TestWheel.py" \
  "$version" "$PWD"
echo "passed: $(basename "$wheel") in PyVista"
