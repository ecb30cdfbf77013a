#!/usr/bin/env bash
# clang-tidy with the checks of .clang-tidy over the modules that need no third-party headers (where a run takes seconds per
# file; GDAL and OpenCV headers would make it minutes), or over the files given.
#   scripts/lint.sh [FILE.cpp]...      needs the dev preset configured (scripts/test.sh does it)
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
jobs=${PYROSCENE_JOBS:-$(nproc)}
files=("$@")
((${#files[@]})) || mapfile -t files < <(find src/base src/fire src/spread src/radiometry src/analysis -name '*.cpp' | sort)
[[ -f build/dev/compile_commands.json ]] || { echo "lint: run scripts/test.sh first, build/dev is not configured" >&2; exit 1; }
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$jobs" clang-tidy -p build/dev --quiet --warnings-as-errors='*'
