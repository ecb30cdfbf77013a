#!/usr/bin/env bash
# The two-minute tour: installs what is missing, builds, images a fire on Lolo Peak (Montana) and says where the pictures are.
#   scripts/demo.sh [options of `pyroscene run`]      for example: scripts/demo.sh --threads 1
# Products of an earlier run are kept, an interrupted run is taken up again.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
jobs=${PYROSCENE_JOBS:-$(nproc)}

scripts/setup.sh build
cmake --preset release
cmake --build --preset release --parallel "$jobs" --target pyroscene_cli
build/release/src/cli/pyroscene run scenarios/lolo_peak/scenario.yaml -o out/lolo_peak "$@"
scripts/show_products.sh out/lolo_peak
