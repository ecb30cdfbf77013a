#!/usr/bin/env bash
# Installs the dev build into an empty folder, moves the folder (an installation must not remember where it was made), builds
# tests/consumer against it and runs that and the installed program.
#   scripts/check_consumer.sh [BUILD_FOLDER]      default: build/dev
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
build=${1:-build/dev}
scratch=$(mktemp -d)
trap 'rm -rf -- "$scratch"' EXIT

cmake --install "$build" --prefix "$scratch/made" >/dev/null
mv "$scratch/made" "$scratch/prefix"
cmake -S tests/consumer -B "$scratch/consumer" -G Ninja -DCMAKE_PREFIX_PATH="$scratch/prefix" >/dev/null
cmake --build "$scratch/consumer"
ctest --test-dir "$scratch/consumer" --output-on-failure --no-tests=error

# From a foreign folder the program must find its own data, not the source tree's.
program=$scratch/prefix/bin/pyroscene
cd /
"$program" --version
listed=$("$program" sensors)
grep -qw wasp <<<"$listed" || { echo "check_consumer: the installed program does not list its sensors" >&2; exit 1; }
