#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# TestSanitizedCases.sh TEST_CUDA: whatever run_cuda.sh names for the sanitizers is there. Of a name that
# no test has, a sanitizer would find nothing wrong.
set -u
status=0
while read -r pattern; do
  if ! "$1" --gtest_list_tests --gtest_filter="$pattern" | grep -q '^  '; then
    echo "no test is called $pattern" >&2
    status=1
  fi
done < "$(dirname "$0")/sanitized-cases.txt"
exit $status
