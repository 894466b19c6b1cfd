#!/bin/bash
# with-display.sh COMMAND [ARGUMENT...]: runs COMMAND on an X server of its own (Xvfb), which ends
# with it; the exit status is COMMAND's.
set -u

if ! command -v Xvfb > /dev/null; then
  echo "with-display.sh: Xvfb is not installed (Debian: apt-get install xvfb)" >&2
  exit 1
fi

source "$(dirname "$0")/stop.sh"
scratch=$(mktemp -d)
server=
finish() {
  [ -n "$server" ] && stop "$server"
  rm -rf "$scratch"
}
trap finish EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# -displayfd lets the server pick a free display; -noreset keeps it alive between its clients.
Xvfb -displayfd 3 -screen 0 1280x1024x24 -noreset +extension GLX -nolisten tcp \
  3> "$scratch/display" 2> "$scratch/log" &
server=$!

for _ in $(seq 300); do
  [ -s "$scratch/display" ] && break
  if ! kill -0 "$server" 2> /dev/null; then
    break
  fi
  sleep 0.05
done
if [ ! -s "$scratch/display" ]; then
  echo "with-display.sh: Xvfb did not start:" >&2
  cat "$scratch/log" >&2
  exit 1
fi

DISPLAY=":$(tr -d '[:space:]' < "$scratch/display")" "$@"
