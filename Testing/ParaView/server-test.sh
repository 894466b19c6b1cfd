#!/bin/bash
# server-test.sh SCRIPT PVPYTHON PVSERVER PROCESSES [LAUNCHER...]: runs
# SCRIPT PORT PROCESSES LAUNCHER... PVSERVER in PVPYTHON while so many of PVSERVER, started by
# LAUNCHER, listen to PORT.
set -u
source "$(dirname "$0")/servers.sh"
script=$1 pvpython=$2 pvserver=$3 processes=$4
shift 4
port=$((11000 + $$ % 20000))
start_server "--server-port=$port" "$@" "$pvserver"
timeout --kill-after=10 200 "$pvpython" "$script" "$port" "$processes" "$@" "$pvserver"
status=$?
[ "$status" -eq 0 ] || cat "$logs"/*
exit "$status"
