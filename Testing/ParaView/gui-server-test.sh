#!/bin/bash
# gui-server-test.sh PVSERVER LAUNCHER... -- ARGUMENT...: gui-test.sh with these arguments, its window
# connected to PVSERVER, which LAUNCHER starts.
set -u
source "$(dirname "$0")/servers.sh"
pvserver=$1
shift
launcher=()
while [ "$1" != -- ]; do
  launcher+=("$1")
  shift
done
shift
start_server "$pvserver" "${launcher[@]}"
"$(dirname "$0")/gui-test.sh" "$@" --server-url="cs://localhost:$port"
status=$?
[ "$status" -eq 0 ] || cat "$log"
exit "$status"
