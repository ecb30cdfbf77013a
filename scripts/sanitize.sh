#!/usr/bin/env bash
# The whole test suite under AddressSanitizer and UndefinedBehaviorSanitizer. Any finding fails the test that met it.
#   scripts/sanitize.sh [ctest options]
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
jobs=${PYROSCENE_JOBS:-$(nproc)}

scripts/setup.sh build test
cmake --preset asan-ubsan
cmake --build --preset asan-ubsan --parallel "$jobs"
UBSAN_OPTIONS=print_stacktrace=1 ctest --preset asan-ubsan --parallel "$jobs" --no-tests=error "$@"
