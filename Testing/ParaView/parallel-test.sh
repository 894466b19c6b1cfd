#!/bin/bash
# parallel-test.sh SCRIPT PVPYTHON COMMAND...: runs "SCRIPT write" in several processes by COMMAND, then
# "SCRIPT check" in PVPYTHON.
set -eu
script=$1 pvpython=$2
shift 2
timeout --kill-after=10 200 "$@" "$script" write
timeout --kill-after=10 60 "$pvpython" "$script" check
