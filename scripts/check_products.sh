#!/usr/bin/env bash
# Runs the minimal scenario with the dev build and asks GDAL's own tools about the files: every ortho image must pass the
# Cloud-Optimized GeoTIFF validator, every raster must open and carry units, and a second run must find nothing to do.
#   scripts/check_products.sh [PROGRAM]      default: build/dev/src/cli/pyroscene
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
program=$(realpath -- "${1:-build/dev/src/cli/pyroscene}")
out=$(mktemp -d)
trap 'rm -rf -- "$out"' EXIT
die() { echo "check_products: $*" >&2; exit 1; }

"$program" -q run scenarios/minimal/scenario.yaml -o "$out"

shopt -s nullglob
cogs=("$out"/*/ortho_*.tif)
((${#cogs[@]})) || die "no ortho image was written"
for file in "${cogs[@]}"; do
    # Debian's interpreter, not one that a version manager puts first: GDAL's bindings belong to it.
    /usr/bin/python3 -m osgeo_utils.samples.validate_cloud_optimized_geotiff "$file" || die "${file##*/} is not a valid COG"
done

for file in "$out"/*/*.tif; do
    info=$(gdalinfo "$file" 2>&1) || die "gdalinfo cannot read ${file##*/}"
    grep -qi 'synthetic=true' <<<"$info" || die "${file##*/} does not say that it is synthetic"
    # The geolocation file is itself what places the others.
    [[ $file == */geolocation*.tif ]] || grep -qE 'PROJCRS|Geolocation' <<<"$info" || die "${file##*/} has neither CRS nor geolocation"
    grep -q 'Unit Type' <<<"$info" || die "${file##*/} has no units"
done

before=$(find "$out" -name '*.tif' -printf '%p %T@\n' | sort)
"$program" -q run scenarios/minimal/scenario.yaml -o "$out"
after=$(find "$out" -name '*.tif' -printf '%p %T@\n' | sort)
[[ $before == "$after" ]] || die "a second run wrote finished outputs again"
