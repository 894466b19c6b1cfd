# start_server PVSERVER [LAUNCHER...]: one that LAUNCHER starts, until this script ends. Sets `port` and
# `log`, the name of what it prints.
source "$(dirname "${BASH_SOURCE[0]}")/../stop.sh"
log=$(mktemp)
port=$((11000 + $$ % 20000))

# A server ends when its client has gone. A signal before that might meet it while it frees memory,
# where ParaView's handler, which prints a stack, would wait for the heap for ever.
finish_server() {
  for _ in $(seq 100); do
    kill -0 "$server" 2> /dev/null || break
    sleep 0.1
  done
  stop "$server"
  rm -f "$log"
}

start_server() {
  local pvserver=$1
  shift
  "$@" "$pvserver" --server-port="$port" > "$log" 2>&1 &
  server=$!
  trap finish_server EXIT
  for _ in $(seq 600); do
    grep -q "Accepting connection" "$log" && break
    kill -0 "$server" 2> /dev/null || break
    sleep 0.1
  done
}
