#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds Core and CUDA on a machine with the CUDA toolkit, without VTK, and proves them on its GPU:
# the conformance tests (of kernels, of pictures that they draw, and of trainings), small ones of
# them under compute-sanitizer, and the benchmarks, which write
# Testing/Benchmarks/results/<gpu>/cuda.json. On Debian it installs what else is missing.
#
#   Testing/run_cuda.sh
#
# Ends with "N passed, N failed, N skipped". Its status is 0 when nothing failed, 1 when something
# did, and 77 when nothing failed but there is no GPU: then the kernels have run on the host only.
# It builds for the first GPU that CUDA_VISIBLE_DEVICES leaves.
# In a copy of the sources without their history, set INR_COMMIT to what they are of.
set -uo pipefail

cd "$(dirname "$0")/.."
build=build-cuda
tests=$build/Testing/CUDA/test_cuda
benchmark=$build/Testing/CUDA/bench_cuda
passed=0
failed=0
skipped=0

finish() {
  echo "$passed passed, $failed failed, $skipped skipped"
  [ "$failed" -gt 0 ] && exit 1
  [ -n "$gpu" ] || exit 77
  exit 0
}

# count STATUS: one check more.
count() {
  if [ "$1" -eq 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
}

export CUDA_DEVICE_ORDER=PCI_BUS_ID # as nvidia-smi counts
gpu=

# Of the GPUs that CUDA's programs see here, a line each, without a dot. What is wrong stands there, too.
capabilities() {
  local query=(timeout 60 nvidia-smi --query-gpu=compute_cap --format=csv,noheader) id
  if [ -z "${CUDA_VISIBLE_DEVICES+set}" ]; then
    "${query[@]}"
  else
    for id in ${CUDA_VISIBLE_DEVICES//,/ }; do
      "${query[@]}" -i "$id" || break # nor do the programs see those behind it
    done
  fi 2> /dev/null | tr -d '. '
}

# The first of them that CMake/INRCuda.cmake builds for, with the nvcc that it finds; or nothing.
capability() {
  local known one
  known=$(PATH=${CUDA_PATH:+$CUDA_PATH/bin:}$PATH:/usr/local/cuda/bin nvcc --list-gpu-code 2> /dev/null)
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
  echo "== Preset cuda does not build ($build.log)"
  failed=1
  finish
fi
rm -f "$build.log"
passed=1

if gpu=$("$benchmark" --device 2> "$build/no-gpu.txt"); then
  echo "== GPU: $gpu"
else
  gpu=
  echo "== No GPU is used: $(cat "$build/no-gpu.txt")"
fi

echo "== Conformance"
"$tests" > "$build/conformance.log" 2>&1
status=$?
ok=$(grep -c '^\[       OK \]' "$build/conformance.log")
bad=$(grep -cE '^\[  FAILED  \] .* \([0-9]+ ms\)$' "$build/conformance.log")
skipped=$(grep -cE '^\[  SKIPPED \] .* \([0-9]+ ms\)$' "$build/conformance.log")
if [ "$status" -ne 0 ]; then
  grep -vE '^\[( RUN|       OK|-----)' "$build/conformance.log"
  [ "$bad" -gt 0 ] || bad=1 # it did not come to its end
fi
passed=$((passed + ok))
failed=$((failed + bad))
conformance_failed=$bad
echo "   $ok passed, $bad failed, $skipped skipped ($build/conformance.log)"

# Few points, small bricks and pictures of one launch: under the sanitizers everything takes a hundred
# times longer.
small='Kernels/Bricks.LayersAreThoseOfTheWhole/Gpu*:Kernels/Conformance.ValueDoesNotDependOnTheBatch/Gpu*'
small+=':Kernels/Conformance.EveryWidthAgreesWithCore/Gpu*'
small+=':Kernels/NetworkDrawingOf.GivesThePicturesOfTheCpu/GpuLit:Kernels/NetworkDrawingOf.GivesThePicturesOfTheCpu/GpuPlain'
small+=':Kernels/DrawingOf.GivesThePicturesOfTheCpu/GpuLitMixedLevels:Kernels/Drawing.TracesThePathsOfTheCpu/Gpu'
small+=':Kernels/DrawingOf.GivesThePicturesOfTheCpu/GpuLayered:Kernels/DrawingOf.GivesThePicturesOfTheCpu/GpuSurfacesLit'
small+=':Kernels/DrawingOf.GivesThePicturesOfTheCpu/GpuIntegratedLayered'
small+=':Kernels/NetworkDrawingOf.GivesThePicturesOfTheCpu/GpuLitLayered:Kernels/WaitingFor.NeedsNoMoreThanTheSmallestCache/GpuSurfaces'
small+=':Kernels/DrawingSettings.RoundsWhatItKeepsAsTheCpuDoes/Gpu*:Kernels/NetworkPaths.AreThoseOfTheCpu/GpuPlain'
small+=':Kernels/Training.AgreesForEveryShape/Gpu:Kernels/Training.UpdatesAreCoresOwn/Gpu'
for tool in memcheck racecheck synccheck; do
  echo "== compute-sanitizer $tool"
  sanitizer=$(command -v compute-sanitizer || ls /usr/local/cuda/bin/compute-sanitizer 2> /dev/null)
  if [ -z "$gpu" ] || [ -z "$sanitizer" ]; then
    echo "   skipped: $([ -z "$gpu" ] && echo "no GPU" || echo "there is no compute-sanitizer")"
    skipped=$((skipped + 1))
    continue
  fi
  "$sanitizer" --tool "$tool" --error-exitcode 1 "$tests" --gtest_filter="$small" \
    > "$build/$tool.log" 2>&1
  status=$?
  [ "$status" -eq 0 ] || tail -n 40 "$build/$tool.log"
  count "$status"
done

echo "== Benchmark"
if [ -z "$gpu" ]; then
  echo "   skipped: no GPU"
  skipped=$((skipped + 1))
else
  python3 Testing/Benchmarks/cuda.py "$(dirname "$benchmark")" "$conformance_failed"
  count $?
fi
finish
