#!/bin/bash
# separate-servers-test.sh SCRIPT PVPYTHON PVDATASERVER PVRENDERSERVER: runs SCRIPT DATA_PORT
# RENDER_PORT in PVPYTHON while both servers listen.
set -u
source "$(dirname "$0")/../stop.sh"
script=$1 pvpython=$2 pvdataserver=$3 pvrenderserver=$4
folder=$(mktemp -d)
data_port=$((11000 + $$ % 10000))
render_port=$((data_port + 10000))
"$pvdataserver" --data-server-port="$data_port" > "$folder/data" 2>&1 &
data=$!
"$pvrenderserver" --render-server-port="$render_port" > "$folder/render" 2>&1 &
render=$!
# They end when their client has gone; see server-test.sh.
finish() {
  for server in "$data" "$render"; do
    for _ in $(seq 100); do
      kill -0 "$server" 2> /dev/null || break
      sleep 0.1
    done
    stop "$server"
  done
  rm -rf "$folder"
}
trap finish EXIT
for _ in $(seq 600); do
  grep -q "Accepting connection" "$folder/data" && grep -q "Accepting connection" "$folder/render" &&
    break
  kill -0 "$data" 2> /dev/null && kill -0 "$render" 2> /dev/null || break
  sleep 0.1
done
timeout --kill-after=10 200 "$pvpython" "$script" "$data_port" "$render_port"
status=$?
[ "$status" -eq 0 ] || cat "$folder/data" "$folder/render"
exit "$status"
