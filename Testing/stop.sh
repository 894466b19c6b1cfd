# SPDX-License-Identifier: BSD-3-Clause
# To be sourced. stop PID: ends a process that this shell started, by force if it takes longer than
# ten seconds; its status is that of the process, 137 where force was needed.
stop() {
  local force status
  kill "$1" 2> /dev/null
  (sleep 10 && kill -KILL "$1") > /dev/null 2>&1 &
  force=$!
  wait "$1" 2> /dev/null
  status=$?
  kill "$force" 2> /dev/null
  return "$status"
}
