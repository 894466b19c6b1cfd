#!/bin/bash
# gui-test.sh SCRIPT PARAVIEW PLUGIN_FOLDER DATA OUTPUT [ARGUMENT...]: plays SCRIPT in ParaView's
# window, with settings of nobody's; a script that waits for a dialog to go away is ended. If the
# environment variable INR_PICTURE names a picture, without folder, SCRIPT saves it in OUTPUT, and it
# resembles the one of that name in INR_BASELINES/ParaView, or the test fails.
set -u
script=$1 paraview=$2 plugins=$3 data=$4 output=$5
shift 5
home=$(mktemp -d)
trap 'rm -rf "$home"' EXIT
picture=${INR_PICTURE-}
[ -z "$picture" ] || rm -f "$output/$picture"
HOME=$home XDG_RUNTIME_DIR=$home timeout --kill-after=10 240 "$paraview" \
  --plugin-search-paths="$plugins" --plugins=INRVolume --dr --data-directory="$data" \
  --test-directory="$output" --test-script="$script" "$@" || exit $?
[ -z "$picture" ] ||
  "$INR_PYTHON" "$(dirname "$0")/compare.py" "$output/$picture" "$INR_BASELINES/ParaView/$picture"
