#!/bin/bash
# gui-test.sh SCRIPT PARAVIEW PLUGIN_FOLDER DATA OUTPUT [ARGUMENT...]: plays SCRIPT in ParaView's
# window, with settings of nobody's; a script that waits for a dialog to go away is ended. The file
# that the environment variable INR_WANTED names, if it does, is there afterwards, or the test fails.
set -u
script=$1 paraview=$2 plugins=$3 data=$4 output=$5
shift 5
home=$(mktemp -d)
trap 'rm -rf "$home"' EXIT
wanted=${INR_WANTED-}
[ -z "$wanted" ] || rm -f "$wanted"
HOME=$home XDG_RUNTIME_DIR=$home timeout --kill-after=10 240 "$paraview" \
  --plugin-search-paths="$plugins" --plugins=INRVolume --dr --data-directory="$data" \
  --test-directory="$output" --test-script="$script" "$@"
status=$?
if [ $status -eq 0 ] && [ -n "$wanted" ] && [ ! -s "$wanted" ]; then
  echo "gui-test.sh: there is no $wanted" >&2
  exit 1
fi
exit $status
