#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds Core and CUDA on a machine with the CUDA toolkit, without VTK, and proves them on its GPU, in
# three parts: the conformance tests (of kernels, of pictures that they draw, and of trainings), the
# benchmarks, which write Testing/Benchmarks/results/<gpu>/cuda.json, and small ones of the tests under
# compute-sanitizer. On Debian it installs what else is missing.
#
#   Testing/run_cuda.sh [conformance] [benchmark] [sanitizers]     all three where none is named
#
# Ends with the names of what failed and "N passed, N failed, N skipped". Its status is 0 when nothing
# failed, 1 when something did, and 77 when nothing failed but there is no GPU: then the kernels have
# run on the host only. It builds for the first GPU that CUDA_VISIBLE_DEVICES leaves. The tests, each
# benchmark and each sanitizer may take half an hour, or INR_TIME_LIMIT seconds; longer is a failure.
# In a copy of the sources without their history, set INR_COMMIT to what they are of.
set -uo pipefail

cd "$(dirname "$0")/.."
build=build-cuda
tests=$build/Testing/CUDA/test_cuda
benchmark=$build/Testing/CUDA/bench_cuda
export INR_TIME_LIMIT=${INR_TIME_LIMIT:-1800} # for cuda.py, too
[[ $INR_TIME_LIMIT =~ ^[1-9][0-9]*$ ]] || {
  echo "INR_TIME_LIMIT is '$INR_TIME_LIMIT'; it has to be a number of seconds, from 1 on" >&2
  exit 2
}
gpu=
passed=0
failed=0
skipped=0
failures=() # a line each

for part in "$@"; do
  case $part in
    conformance | benchmark | sanitizers) ;;
    *)
      echo "There is no part '$part': Testing/run_cuda.sh [conformance] [benchmark] [sanitizers]" >&2
      exit 2
      ;;
  esac
done
parts=" ${*:-conformance benchmark sanitizers} "

# wanted PART
wanted() {
  [[ $parts == *" $1 "* ]]
}

finish() {
  [ "$failed" -eq 0 ] || printf '== FAILED: %s\n' "${failures[@]}"
  echo "$passed passed, $failed failed, $skipped skipped"
  [ "$failed" -gt 0 ] && exit 1
  [ -n "$gpu" ] || exit 77
  exit 0
}

# fail WHAT: counts and remembers a failure.
fail() {
  failed=$((failed + 1))
  failures+=("$1")
}

# count STATUS WHAT: one check more.
count() {
  if [ "$1" -eq 0 ]; then passed=$((passed + 1)); else fail "$2"; fi
}

# skip WHY: one check that is not made.
skip() {
  echo "   skipped: $1"
  skipped=$((skipped + 1))
}

# limited LOG COMMAND...: its status. `where` says of one that took too long in which test it was.
limited() {
  local log=$1 begun=$SECONDS status
  shift
  where=
  # Not in the foreground, or what the program itself has started would go on; so what ends this
  # script is handed on.
  timeout --kill-after=10 "$INR_TIME_LIMIT" "$@" > "$log" 2>&1 &
  local child=$!
  trap 'kill "$child"; exit 1' INT TERM HUP
  wait "$child"
  status=$?
  trap - INT TERM HUP
  if [ "$status" -ne 0 ] && [ $((SECONDS - begun)) -ge "$INR_TIME_LIMIT" ]; then
    where=", not at its end after $INR_TIME_LIMIT s: $(sed -n 's/^\[ RUN      \] //p' "$log" | tail -n 1)"
  fi
  return "$status"
}

export CUDA_DEVICE_ORDER=PCI_BUS_ID # as nvidia-smi counts

# Of the GPUs that CUDA's programs see here, a line each, without a dot. What is wrong stands there, too.
capabilities() {
  local query=(timeout --foreground 60 nvidia-smi --query-gpu=compute_cap --format=csv,noheader) id
  if [ -z "${CUDA_VISIBLE_DEVICES+set}" ]; then
    "${query[@]}"
  else
    for id in ${CUDA_VISIBLE_DEVICES//,/ }; do
      "${query[@]}" -i "$id" || break # nor do the programs see those behind it
    done
  fi 2> /dev/null | tr -d '. '
}

# Where programs are, the toolkit's, too.
tools=${CUDA_PATH:+$CUDA_PATH/bin:}$PATH:/usr/local/cuda/bin

# The first of them that CMake/INRCuda.cmake builds for, with the nvcc that it finds; or nothing.
capability() {
  local known one
  known=$(PATH=$tools nvcc --list-gpu-code 2> /dev/null)
  while read -r one; do
    if [[ $one =~ ^[0-9]+$ ]] && [ "$one" -ge 75 ] && grep -qx "sm_$one" <<< "$known"; then
      echo "$one"
      return
    fi
  done < <(capabilities)
}

echo "== Building"
if command -v apt-get > /dev/null; then
  bash CMake/install-debian-packages.sh core || echo "== Going on with what there is"
fi
# Code for this machine's GPU alone; else the default, whatever an earlier run has built for.
architectures=(-U INR_CUDA_ARCHITECTURES)
found=$(capability)
[ -z "$found" ] || architectures=(-D "INR_CUDA_ARCHITECTURES=$found")
if ! { cmake --preset cuda "${architectures[@]}" &&
       cmake --build --preset cuda --target test_cuda bench_cuda bench_cuda_frames \
         bench_cuda_training; } > "$build.log" 2>&1; then
  tail -n 60 "$build.log"
  fail "preset cuda does not build ($build.log)"
  finish
fi
rm -f "$build.log"
passed=1

gpu=$(timeout --foreground --kill-after=10 60 "$benchmark" --device 2> "$build/no-gpu.txt")
status=$?
if [ "$status" -eq 0 ]; then
  echo "== GPU: $gpu"
else
  gpu=
  echo "== No GPU is used: $(cat "$build/no-gpu.txt")"
  [ "$status" -eq 77 ] || fail "bench_cuda --device, status $status"
fi

conformance() {
  local log=$build/conformance.log status ok missed
  limited "$log" "$tests"
  status=$?
  ok=$(grep -c '^\[       OK \]' "$log")
  missed=$(grep -cE '^\[  SKIPPED \] .* \([0-9]+ ms\)$' "$log")
  mapfile -t bad < <(sed -nE 's/^\[  FAILED  \] ([^,]+).* \([0-9]+ ms\)$/\1/p' "$log")
  if [ "$status" -ne 0 ]; then
    grep -vE '^\[( RUN|       OK|-----)' "$log"
    grep -qE '^\[==========\] .* ran\.' "$log" && [ ${#bad[@]} -gt 0 ] ||
      bad+=("test_cuda, status $status$where")
  fi
  passed=$((passed + ok))
  skipped=$((skipped + missed))
  for name in "${bad[@]}"; do
    fail "$name"
  done
  echo "   $ok passed, ${#bad[@]} failed, $missed skipped ($log)"
}

bad=()
if wanted conformance; then
  echo "== Conformance"
  conformance
fi

# Before the sanitizers, which take longest.
if wanted benchmark; then
  echo "== Benchmark"
  if [ -z "$gpu" ]; then
    skip "no GPU"
  else
    python3 Testing/Benchmarks/cuda.py "$(dirname "$benchmark")" \
      $(wanted conformance && echo "${#bad[@]}")
    count $? "benchmark"
  fi
fi

# Few points, small bricks and small pictures (rays that wait take thousands of launches): under the
# sanitizers everything takes a hundred times longer.
small=$(paste -sd : Testing/CUDA/sanitized-cases.txt)
sanitizer=$(PATH=$tools && command -v compute-sanitizer)
for tool in $(wanted sanitizers && echo memcheck racecheck synccheck); do
  echo "== compute-sanitizer $tool"
  if [ -z "$gpu" ] || [ -z "$sanitizer" ]; then
    skip "$([ -z "$gpu" ] && echo "no GPU" || echo "there is no compute-sanitizer")"
    continue
  fi
  limited "$build/$tool.log" "$sanitizer" --tool "$tool" --error-exitcode 1 "$tests" \
    --gtest_filter="$small"
  status=$?
  [ "$status" -eq 0 ] || tail -n 40 "$build/$tool.log"
  count "$status" "compute-sanitizer $tool$where"
done
finish
