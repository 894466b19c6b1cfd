#!/bin/bash
# gui-test.sh SCRIPT PARAVIEW PLUGIN_FOLDER DATA OUTPUT [ARGUMENT...]: plays SCRIPT in ParaView's
# window, with settings of nobody's; a script that waits for a dialog to go away is ended.
set -u
script=$1 paraview=$2 plugins=$3 data=$4 output=$5
shift 5
home=$(mktemp -d)
trap 'rm -rf "$home"' EXIT
HOME=$home XDG_RUNTIME_DIR=$home timeout --kill-after=10 120 "$paraview" \
  --plugin-search-paths="$plugins" --plugins=INRVolume --dr --data-directory="$data" \
  --test-directory="$output" --test-script="$script" "$@"
