#!/bin/bash
# parallel-test.sh SCRIPT PVPYTHON PVBATCH PROCESSES LAUNCHER...: runs "SCRIPT write" in so many of
# PVBATCH, started by LAUNCHER, then "SCRIPT check" in PVPYTHON.
set -eu
script=$1 pvpython=$2 pvbatch=$3 processes=$4
shift 4
timeout --kill-after=10 200 "$@" -n "$processes" "$pvbatch" "$script" write
timeout --kill-after=10 60 "$pvpython" "$script" check
