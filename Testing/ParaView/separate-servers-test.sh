#!/bin/bash
# separate-servers-test.sh SCRIPT PVPYTHON PVDATASERVER PVRENDERSERVER [LAUNCHER...]: runs SCRIPT
# DATA_PORT RENDER_PORT in PVPYTHON while both servers, started by LAUNCHER, listen.
set -u
source "$(dirname "$0")/servers.sh"
script=$1 pvpython=$2 pvdataserver=$3 pvrenderserver=$4
shift 4
data_port=$((11000 + $$ % 10000))
render_port=$((data_port + 10000))
start_server "--data-server-port=$data_port" "$@" "$pvdataserver"
start_server "--render-server-port=$render_port" "$@" "$pvrenderserver"
timeout --kill-after=10 200 "$pvpython" "$script" "$data_port" "$render_port"
status=$?
[ "$status" -eq 0 ] || cat "$logs"/*
exit "$status"
