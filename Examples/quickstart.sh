#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# From a volume to a picture: installs what is missing (Debian 12), builds the plugin, compresses a
# real 256^3 volume into model.inr, opens that file and renders it beside the original. The results
# are in quickstart-output/.
#
#   Examples/quickstart.sh [SECONDS]     seconds of training (default 120)
set -euo pipefail

seconds=${1:-120}
if ! [[ $seconds =~ ^[1-9][0-9]*$ ]]; then
  echo "usage: $0 [SECONDS]   a whole number above 0" >&2
  exit 2
fi
cd "$(dirname "$(readlink -f "$0")")/.."

echo "== 1/3 Packages"
bash CMake/install-debian-packages.sh

echo "== 2/3 Building the plugin"
configured=$(cmake --preset release -DINR_BUILD_TESTING=OFF 2>&1) || {
  echo "$configured"
  exit 1
}
cmake --build --preset release

echo "== 3/3 Training and rendering in ParaView"
plugin=$(echo build/lib/paraview-*/plugins/INRVolume/INRVolume.so)
PYTHONPATH=build/lib/python bash Testing/with-display.sh pvpython --force-offscreen-rendering \
  Examples/quickstart.py "$plugin" Testing/Data/rm_mixing.vti quickstart-output "$seconds"
