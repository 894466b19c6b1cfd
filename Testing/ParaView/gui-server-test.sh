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
port=$((11000 + $$ % 20000))
start_server "--server-port=$port" "${launcher[@]}" "$pvserver"
"$(dirname "$0")/gui-test.sh" "$@" --server-url="cs://localhost:$port"
status=$?
[ "$status" -eq 0 ] || cat "$logs"/*
exit "$status"
