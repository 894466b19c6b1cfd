#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# TestSymbols.sh FOLDER: our libraries share the host's process, so they show nothing but VTK
# classes (vtkSM...: ParaView's proxies), their factories and wrappers, and the plugin's entry points.
set -eu
allowed='^(vtk(SM)?INR|pv_plugin_|INRVolume|real_initvtk|PyInit_|PyV[tT]K|(_init|_fini|_edata|_end|__bss_start)$)'
# Weak ones are not all ours to hide (templates of the standard library), but none may belong to Core
# or to a library that we link statically.
hidden='^_Z[A-Z]*N?[KVrO]*(3inr|3tbb|8nlohmann|[0-9]+Imf_|[0-9]+Imath_|3glm)'

fail() {
  echo "$1 shows:" >&2
  echo "$2" | head -20 >&2
  exit 1
}

checked=0
for library in $(find "$1" -name '*.so'); do
  foreign=$(nm -D --defined-only --demangle "$library" |
    awk '$2 ~ /[TDBR]/ {print substr($0, 20)}' | grep -v -E "$allowed" || true)
  [ -z "$foreign" ] || fail "$library" "$foreign"
  foreign=$(nm -D --defined-only "$library" | awk '{print $3}' | grep -E "$hidden" || true)
  [ -z "$foreign" ] || fail "$library" "$foreign"
  checked=$((checked + 1))
done
[ "$checked" -ge 4 ] || { echo "only $checked libraries in $1" >&2; exit 1; }
