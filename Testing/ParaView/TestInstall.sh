#!/bin/bash
# TestInstall.sh CMAKE BUILD_FOLDER OUTPUT_FOLDER PVPYTHON PYTHON: what `cmake --install` leaves is
# complete: it works after it has been moved, without the build.
set -eu
cmake=$1 build=$2 output=$3 pvpython=$4 python=$5
rm -rf "$output/installed" "$output/moved"
"$cmake" --install "$build" --prefix "$output/installed" > "$output/install.log"
mv "$output/installed" "$output/moved"

plugin=$(find "$output/moved" -name INRVolume.so)
case "$plugin" in
  */lib/paraview-*/plugins/INRVolume/INRVolume.so) ;;
  *) echo "unexpected plugin path: '$plugin'" >&2; exit 1 ;;
esac
if [ ! -s "$output/moved/share/doc/INRVolume/LICENSE" ]; then
  echo "it comes without its licence" >&2
  exit 1
fi
# Nothing in it may point back to the build.
for library in $(find "$output/moved" -name '*.so'); do
  if readelf -d "$library" | grep -F "$build"; then
    echo "$library looks for libraries in the build folder" >&2
    exit 1
  fi
done
"$pvpython" - <<END
from paraview import simple
simple.LoadPlugin("$plugin", remote=False, ns=globals())
INRReader()
END
for interpreter in "$pvpython" "$python"; do
  PYTHONPATH="$output/moved/lib/python" "$interpreter" -c '
from inrvolume.vtkINRReaders import vtkINRReader
from inrvolume.vtkINRMapper import vtkINRVolumeMapper
assert vtkINRReader().GetMaximumGridPoints() == 2**24
assert vtkINRVolumeMapper().GetSampleDistance() > 0'
done
