#!/usr/bin/env bash
# Figures 4.16 and 4.17 of the thesis and the voxel list of its frame 666 (appendix C.3), from scenarios/thesis_grassfire.
#   scripts/thesis_figures.sh [OUTPUT_FOLDER]      default: out/thesis_figures
# PYROSCENE names the program (default: build/release, built when it is not there). docs/validation/thesis-figures.md shows and
# discusses the pictures.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
out=${1:-out/thesis_figures}
program=${PYROSCENE:-build/release/src/cli/pyroscene}
scene=scenarios/thesis_grassfire

if [[ ! -x $program && -z ${PYROSCENE:-} ]]; then
    cmake --preset release
    cmake --build --preset release --parallel --target pyroscene_cli
fi
mkdir -p -- "$out"

# Figure 4.16, 61 min 54 s: heat flux from above; then a part of the southern flank from the south, step by step.
window=-290,-240,-720,-680
layers=24
view() { "$program" -q export "$scene/$1" --time_s 3714 --format side-view --above-ground --window_m=$window --voxel_m 0.5,0.5,0.25 --layers $layers -o "$out/$2"; }
"$program" -q export "$scene/figure_upright.yaml" --time_s 3714 --format top-view -o "$out/fig_4_16a_heat_flux.png"
view figure_upright.yaml fig_4_16b_heights.png
view figure_leaning.yaml fig_4_16c_tilted.png
view figure_shifted.yaml fig_4_16d_shifted.png

# Figure 4.17, 61:18 to 61:54: the same place as a short-wave camera 28 m above the ground, 300 m to the south sees it.
"$program" -q run "$scene/figure_shifted.yaml" -o "$out/side_views"
for picture in a_6118 b_6130 c_6142 d_6154; do
    cp -- "$out/side_views/side_${picture#*_}/quicklook.png" "$out/fig_4_17$picture.png"
done

# Frame 666 of 6 s each in the thesis's lattice and text.
"$program" -q export "$scene/scenario.yaml" --time_s 3996 --format dirsig-grid --voxel_m 20,20,5 --layers 64 --above-ground -o "$out/666.grid"
printf 'thesis_figures: %s\n' "$out"/*.png "$out/666.grid"
