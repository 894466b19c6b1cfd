#!/bin/bash
# server-test.sh SCRIPT PVPYTHON PVSERVER PROCESSES [LAUNCHER...]: runs
# SCRIPT PORT PROCESSES LAUNCHER... PVSERVER in PVPYTHON while so many of PVSERVER, started by
# LAUNCHER, listen to PORT.
set -u
source "$(dirname "$0")/../stop.sh"
script=$1 pvpython=$2 pvserver=$3 processes=$4
shift 4
log=$(mktemp)
port=$((11000 + $$ % 20000))
"$@" "$pvserver" --server-port="$port" > "$log" 2>&1 &
server=$!
# A server ends when its client has gone. A signal before that might meet it while it frees memory,
# where ParaView's handler, which prints a stack, would wait for the heap for ever.
finish() {
  for _ in $(seq 100); do
    kill -0 "$server" 2> /dev/null || break
    sleep 0.1
  done
  stop "$server"
  rm -f "$log"
}
trap finish EXIT
for _ in $(seq 600); do
  grep -q "Accepting connection" "$log" && break
  kill -0 "$server" 2> /dev/null || break
  sleep 0.1
done
timeout --kill-after=10 200 "$pvpython" "$script" "$port" "$processes" "$@" "$pvserver"
status=$?
[ "$status" -eq 0 ] || cat "$log"
exit "$status"
