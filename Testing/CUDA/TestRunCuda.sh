#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# TestRunCuda.sh: Testing/run_cuda.sh on made-up machines: what it builds for, what it says of parts
# that fail or hang, and its status. Nothing is compiled or installed, and no GPU asked.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/bin" "$folder/Testing/CUDA"
cp "$(dirname "$0")/../run_cuda.sh" "$folder/Testing"
cp "$(dirname "$0")/sanitized-cases.txt" "$folder/Testing/CUDA"
cd "$folder"
unset CUDA_PATH CUDA_VISIBLE_DEVICES INR_TIME_LIMIT GPU GPU_0 GPU_1 FAILS HANGS BROKEN FOUND_BY
export PATH=$folder/bin:$PATH

# made FILE: an executable of what is read.
made() {
  { echo '#!/bin/bash' && cat; } > "$1"
  chmod +x "$1"
}
made bin/cmake << 'END'
echo "$@" >> asked.txt
mkdir -p build-cuda/Testing/CUDA && cp test_cuda bench_cuda build-cuda/Testing/CUDA
END
made bin/nvcc <<< 'printf "sm_%s\n" 70 75 80 86 90'
# GPU_0, GPU_1: their compute capabilities; of those that are not there it says so where they would stand.
made bin/nvidia-smi << 'END'
if [ -z "${GPU_0:-}" ]; then echo "NVIDIA-SMI has failed"; exit 9; fi
case "$*" in
  *"-i 0") echo "$GPU_0" ;;
  *"-i 1") echo "$GPU_1" ;;
  *-i*) echo "No devices were found"; exit 6 ;;
  *) printf '%s\n' "$GPU_0" ${GPU_1:+"$GPU_1"} ;;
esac
END
made bench_cuda << 'END'
[ -z "${BROKEN:-}" ] || exit "$BROKEN"
[ -n "${GPU:-}" ] || { echo "there is none" >&2; exit 77; }
echo "$GPU"
END
made bin/compute-sanitizer <<< '[ "$2" != "${FOUND_BY:-}" ]'
made bin/python3 <<< 'echo "benchmark: $*"'
made test_cuda << 'END'
echo "[       OK ] A.Passes (1 ms)"
[ -z "${FAILS:-}" ] || echo "[  FAILED  ] B.Fails/Gpu, where GetParam() = Gpu (1 ms)"
echo "[ RUN      ] C.Hangs"
[ -z "${HANGS:-}" ] || { echo $$ > hangs.txt && sleep 60; }
echo "[  SKIPPED ] C.Hangs (1 ms)"
echo "[==========] 3 tests from 3 test suites ran. (3 ms total)"
[ -z "${FAILS:-}" ]
END

# expect STATUS TEXT [ENVIRONMENT...] [-- PART...]: how the script ends, and that it asks CMake for, or
# says, this.
expect() {
  local status=$1 text=$2 ended=0 environment=()
  shift 2
  while [ $# -gt 0 ] && [ "$1" != -- ]; do
    environment+=("$1")
    shift
  done
  shift || true
  rm -rf build-cuda
  : > asked.txt
  env "${environment[@]}" bash Testing/run_cuda.sh "$@" > said.txt 2>&1 || ended=$?
  if [ "$ended" -ne "$status" ] || ! cat asked.txt said.txt | tr '\n' '|' | grep -qF -e "$text"; then
    echo "${environment[*]} $*: status $ended in place of $status, or it lacks '$text':" >&2
    cat asked.txt said.txt >&2
    exit 1
  fi
}

default='--preset cuda -U INR_CUDA_ARCHITECTURES|'
expect 77 "$default"
expect 77 "2 passed, 0 failed, 5 skipped"
expect 77 "$default" GPU_0=6.1
expect 77 "$default" GPU_0=7.0
expect 77 "$default" GPU_0=13.0
expect 0 "INR_CUDA_ARCHITECTURES=90|" GPU=B GPU_0=9.0
expect 0 "INR_CUDA_ARCHITECTURES=86|" GPU=B GPU_0=6.1 GPU_1=8.6
expect 0 "INR_CUDA_ARCHITECTURES=75|" GPU=B GPU_0=9.0 GPU_1=7.5 CUDA_VISIBLE_DEVICES=1,0
expect 0 "$default" GPU=B GPU_0=9.0 CUDA_VISIBLE_DEVICES=MIG-2,0
expect 77 "$default" GPU_0=9.0 CUDA_VISIBLE_DEVICES=

expect 0 "6 passed, 0 failed, 1 skipped" GPU=B
expect 0 "benchmark: Testing/Benchmarks/cuda.py build-cuda/Testing/CUDA 0|== compute-sanitizer memcheck" GPU=B
expect 1 "== FAILED: B.Fails/Gpu|6 passed, 1 failed, 1 skipped" GPU=B FAILS=1
expect 1 "== FAILED: bench_cuda --device, status 3|2 passed, 1 failed, 5 skipped" BROKEN=3
expect 1 "== FAILED: compute-sanitizer racecheck|5 passed, 1 failed" GPU=B FOUND_BY=racecheck
expect 1 "== FAILED: test_cuda, status 124, not at its end after 3 s: C.Hangs|6 passed, 1 failed, 0 skipped" \
  GPU=B HANGS=1 INR_TIME_LIMIT=3
expect 0 "|4 passed, 0 failed, 0 skipped" GPU=B -- sanitizers
expect 0 "benchmark: Testing/Benchmarks/cuda.py build-cuda/Testing/CUDA|2 passed" GPU=B -- benchmark
mkdir -p toolkit/bin
mv bin/compute-sanitizer toolkit/bin/
expect 0 "|4 passed, 0 failed, 0 skipped" GPU=B CUDA_PATH="$PWD/toolkit" -- sanitizers
expect 0 "there is no compute-sanitizer" GPU=B -- sanitizers
expect 2 "There is no part 'tests'" -- tests
expect 2 "INR_TIME_LIMIT is '30m'" INR_TIME_LIMIT=30m

# What ends the script ends what it has begun.
rm -f hangs.txt
env GPU=B HANGS=1 bash Testing/run_cuda.sh conformance > said.txt 2>&1 &
for ((tries = 0; tries < 300; ++tries)); do
  [ ! -s hangs.txt ] || break
  sleep 0.1
done
kill $!
! wait $!
for ((tries = 0; tries < 200; ++tries)); do
  kill -0 "$(cat hangs.txt)" 2> /dev/null || exit 0
  sleep 0.1
done
echo "What hangs goes on after the script was ended" >&2
exit 1
