# start_server OPTION COMMAND...: a server, COMMAND OPTION, until this script ends; returns when it listens.
# What servers print is in the files of $logs.
source "$(dirname "${BASH_SOURCE[0]}")/../stop.sh"
logs=$(mktemp -d)
servers=()

# A server ends when its client has gone. A signal before that might meet it while it frees memory,
# where ParaView's handler, which prints a stack, would wait for the heap for ever.
finish_servers() {
  local server
  for server in "${servers[@]}"; do
    for _ in $(seq 100); do
      kill -0 "$server" 2> /dev/null || break
      sleep 0.1
    done
    stop "$server"
  done
  rm -rf "$logs"
}
trap finish_servers EXIT

start_server() {
  local option=$1 log=$logs/${#servers[@]}
  shift
  "$@" "$option" > "$log" 2>&1 &
  servers+=($!)
  for _ in $(seq 600); do
    grep -q "Accepting connection" "$log" && break
    kill -0 "${servers[-1]}" 2> /dev/null || break
    sleep 0.1
  done
}
