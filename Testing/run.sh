#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds everything on Debian 12 and runs every test but those labelled `long`; installs what is
# missing. Ends with the names of what failed and "N passed, N failed"; its status is 0 when nothing
# failed. What a machine cannot run, like the kernels on a GPU, is skipped, and counts as neither:
# Testing/run_cuda.sh. The wheel has a test of its own, which wants Debian 13: Testing/Wheel/run.sh.
#
# Tests of windows and servers wait for other programs, which a busy machine can hold up for longer than they
# do, and any program can be the victim of its machine: what fails runs once more, by itself, unless much
# does. The end names what passed only then, too, and shows the end of
# what each of them had printed.
#
#   Testing/run.sh [CTEST-OPTION...]     e.g. Testing/run.sh -L core
set -uo pipefail

cd "$(dirname "$0")/.."
bash CMake/install-debian-packages.sh test || exit 1

export CCACHE_BASEDIR=$PWD # so that no preset compiles what another one with the same flags has compiled

passed=0
failed=0
skipped=0
failures=() # a line each
seconds=()  # what passed at the second attempt
printed=""  # by what had failed

# build PRESET: configures and builds; a failure counts as one failed test.
build() {
  echo "== Building preset $1"
  # Nothing is kept of a configuration for another compiler: with it the preset's values would be lost.
  if cmake --fresh --preset "$1" > "build-$1.log" 2>&1 && cmake --build --preset "$1" >> "build-$1.log" 2>&1; then
    passed=$((passed + 1))
    rm -f "build-$1.log"
    return 0
  fi
  tail -n 60 "build-$1.log"
  fail "preset $1 does not build (build-$1.log)"
  return 1
}

# fail WHAT: counts and remembers a failure.
fail() {
  failed=$((failed + 1))
  failures+=("$1")
}

# run_tests FOLDER [CTEST-OPTION...]: adds the folder's tests to the sums.
run_tests() {
  local folder=$1 summary missed names name
  shift
  ctest --test-dir "$folder" -j "$(nproc)" --output-on-failure "$@" | tee "$folder/ctest.log"
  summary=$(grep -E 'tests passed, .* failed out of' "$folder/ctest.log")
  if [[ $summary =~ ([0-9]+)\ tests?\ failed\ out\ of\ ([0-9]+) ]]; then
    missed=$(grep -c '\*\*\*Skipped' "$folder/ctest.log")
    passed=$((passed + BASH_REMATCH[2] - BASH_REMATCH[1] - missed))
    skipped=$((skipped + missed))
    mapfile -t names < <(sed -nE '/^The following tests FAILED/,$s/^\s*[0-9]+ - (\S+) .*/\1/p' \
      "$folder/ctest.log")
    : > "$folder/again.log"
    [ ${#names[@]} -eq "${BASH_REMATCH[1]}" ] || fail "$folder: not all that failed have a name"
    [ ${#names[@]} -eq 0 ] || [ ${#names[@]} -gt 5 ] || run_again "$folder" "${names[@]}"
    for name in "${names[@]}"; do
      printed+=$(output_of "$name" "$folder/ctest.log")$'\n'
      if grep -F " $name " "$folder/again.log" | grep -q ' Passed '; then
        passed=$((passed + 1))
        seconds+=("$folder: $name")
      else
        fail "$folder: $name"
      fi
    done
  elif ! grep -q 'No tests were found' "$folder/ctest.log"; then
    fail "$folder: no sum of tests"
  fi
}

# output_of NAME LOG: the last of what a test printed, below ctest's line of how it ended.
output_of() {
  NAME=$1 awk '/^ *[0-9]+\/[0-9]+ Test +#/ { wanted = index($0, ": " ENVIRON["NAME"] " ") > 0 }
    /^ +Start +[0-9]+: / || /^[0-9]+% tests passed/ { wanted = 0 }
    wanted' "$2" | sed '1!s/^/  /' | { IFS= read -r ended; printf '%s\n' "$ended"; tail -n 40; }
}

# run_again FOLDER NAME...: these tests, one at a time.
run_again() {
  local folder=$1 names
  shift
  names=$(printf '%s\n' "$@" | sed 's/[].*+?^$()|\[]/\\&/g' | paste -sd '|')
  echo "== Once more, by themselves:"
  ctest --test-dir "$folder" -R "^($names)\$" --output-on-failure | tee "$folder/again.log"
}

# Everything: Core, the VTK modules, the plugin in ParaView's own tools and window.
build release && run_tests build -LE long "$@"

# The same readers and mapper against plain VTK, unpacked beside the build, no ParaView; of Core and
# CUDA, all has been built and tested before. The benchmarks are built here, so that they go on building.
if [ -d build-vtk/vtk/usr ] || Testing/fetch-vtk.sh build-vtk/vtk; then
  build vtk && run_tests build-vtk -L 'vtk|image' -LE long "$@"
else
  fail "plain VTK is not to be had"
fi

# Core alone, as on a machine without VTK and by another compiler, under the sanitizers; without what would
# execute the same lines over and over again, and what waits for a GPU, which this build has no code of.
build asan && run_tests build-asan -L 'core|fuzz' -LE 'long|repeated|gpu' "$@"

[ -z "$printed" ] || printf '== What failed printed:\n%s' "$printed"
[ "$skipped" -eq 0 ] || echo "== $skipped skipped, as their output says why"
[ ${#seconds[@]} -eq 0 ] || printf '== passed only at the second attempt: %s\n' "${seconds[@]}"
[ "$failed" -eq 0 ] || printf '== FAILED: %s\n' "${failures[@]}"
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
