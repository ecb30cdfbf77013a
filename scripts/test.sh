#!/usr/bin/env bash
# Installs what is missing, builds with warnings as errors and runs all tests.
#   scripts/test.sh [ctest options]      for example: scripts/test.sh -R Planck
# PYROSCENE_JOBS sets how many compilers and tests run at once (default: one per processor).
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
jobs=${PYROSCENE_JOBS:-$(nproc)}

scripts/setup.sh build test
cmake --preset dev
cmake --build --preset dev --parallel "$jobs"
ctest --preset dev --parallel "$jobs" --no-tests=error "$@"
