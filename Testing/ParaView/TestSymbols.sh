#!/bin/bash
# TestSymbols.sh FOLDER: the plugin's libraries, which share ParaView's process, show nothing but
# VTK classes, their factories and wrappers, and the plugin's entry points.
set -eu
checked=0
for library in $(find "$1" -name '*.so'); do
  foreign=$(nm -D --defined-only --demangle "$library" | awk '$2 ~ /[TDBR]/ {print substr($0, 20)}' |
    grep -v -E '^(vtkINR|pv_plugin_|INRVolume|vtkINR[A-Za-z]+_Initialize|real_initvtk|PyInit_|PyV[tT]K|(_init|_fini|_edata|_end|__bss_start)$)' || true)
  if [ -n "$foreign" ]; then
    echo "$library shows:" >&2
    echo "$foreign" | head -20 >&2
    exit 1
  fi
  checked=$((checked + 1))
done
[ "$checked" -ge 4 ] || { echo "only $checked libraries in $1" >&2; exit 1; }
