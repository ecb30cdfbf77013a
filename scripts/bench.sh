#!/usr/bin/env bash
# Builds the benchmarks and prints one markdown table: scenes B1 to B3 against the baseline, the growth table, single
# kernels, and the thesis case from the command line. Figures hold as ratios of commands run alternately on one machine.
#   scripts/bench.sh [pairs]        pairs of alternate runs (default 3)
set -euo pipefail
cd "$(dirname "$0")/.."
pairs=${1:-3}
build=build/bench

scripts/setup.sh build bench
log=$(mktemp)
{
    cmake --preset bench
    cmake --build --preset bench -j"${PYROSCENE_JOBS:-$(nproc)}"
} > "$log" 2>&1 || { tail -40 "$log" >&2; exit 1; }
rm -f "$log"

echo "Machine: $(sed -n 's/^model name\s*: //p' /proc/cpuinfo | head -1), $(nproc) cores, load $(cut -d' ' -f1 /proc/loadavg);" \
     "$("${CXX:-c++}" --version | head -1); commit $(git rev-parse --short HEAD 2>/dev/null || echo unknown)"
echo
echo "| case | measured | compared with | ratio | limits | condition on the result |"
echo "|---|---|---|---|---|---|"
"$build/bench/bench_frames" --pairs "$pairs"
"$build/bench/bench_physics" --runs "$pairs"
"$build/bench/bench_kernels"
"$build/bench/bench_prepare"
"$build/bench/bench_spread"
"$build/bench/bench_wrf"
"$build/bench/bench_unmix" --pairs "$pairs"
"$build/bench/bench_rasters" --pairs "$pairs"
"$build/bench/bench_large_scene"

# The thesis case end to end: rasters in, georeferenced products out.
cli="$build/src/cli/pyroscene"
scenario=scenarios/thesis_grassfire/scenario.yaml
if [[ ! -x "$cli" || ! -f "$scenario" ]]; then
    echo "thesis case: $cli or $scenario is missing" >&2
    exit 1
fi
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
median() { printf '%s\n' "$@" | sort -g | sed -n "$(( ($# + 1) / 2 ))p"; }
seconds_of() { sed -n "s#^ *\"$1\": \([0-9.e-]*\),*\$#\1#p" "$out/run/run.json"; }  # a phase of the last run
ratio() { awk "BEGIN { printf \"%.2f\", $1 / $2 }"; }
time_case() {  # name, scenario file, limits; one and two threads alternately
    local threads run user system real kilobytes
    local -A cpu=() wall=() light=() image=() peak=([1]=0 [2]=0)
    for ((run = 0; run < pairs; ++run)); do
        for threads in 1 2; do
            rm -rf "$out/run"
            read -r user system real kilobytes < <({ /usr/bin/time -f '%U %S %e %M' "$cli" run "$2" -o "$out/run" \
                --threads "$threads" -q > "$out/log" 2>&1; } 2>&1 || true; tail -1 "$out/log")
            cpu[$threads]+=" $(awk "BEGIN { print $user + $system }")" wall[$threads]+=" $real"
            light[$threads]+=" $(seconds_of render/ground_irradiance)" image[$threads]+=" $(seconds_of render/image)"
            ((kilobytes / 1024 > peak[$threads])) && peak[$threads]=$((kilobytes / 1024))
        done
    done
    # shellcheck disable=SC2086  # lists of numbers
    for threads in 1 2; do
        cpu[$threads]=$(median ${cpu[$threads]}) wall[$threads]=$(median ${wall[$threads]})
        light[$threads]=$(median ${light[$threads]}) image[$threads]=$(median ${image[$threads]})
        echo "| $1, $threads thread(s) | ${cpu[$threads]} s CPU, ${wall[$threads]} s wall, ${peak[$threads]} MB |  |  | $3 | |"
    done
    echo "| $1, wall | 2 threads | 1 thread | $(ratio "${wall[1]}" "${wall[2]}") times as fast; flame light" \
         "$(ratio "${light[1]}" "${light[2]}"), image $(ratio "${image[1]}" "${image[2]}") | 1.8 on two idle cores | |"
}
# The comparison line is three channels with flames of soot, reflected light and atmosphere as one GeoTIFF; the second case
# adds hot gas in the flames, the third everything else that a run makes (truth, brightness temperature, fractions, FRP,
# ortho COGs, vectors, picture).
sed "s#file: #file: $PWD/scenarios/thesis_grassfire/#" "$scenario" > "$out/radiance.yaml"
echo "products: [radiance]" >> "$out/radiance.yaml"
cp "$out/radiance.yaml" "$out/soot.yaml"
echo "flame: {hot_gas: false}" >> "$out/soot.yaml"
time_case "B2t thesis case, radiance GeoTIFF" "$out/soot.yaml" "P 3.6 s, G 1 s"
time_case "the same with hot gas" "$out/radiance.yaml" ""
time_case "thesis case, all products" "$scenario" ""

# A flight line of an imaging spectrometer over the same fire.
sed -e "s#file: #file: $PWD/scenarios/thesis_grassfire/#" -e '/^acquisitions:/,$d' "$scenario" > "$out/line.yaml"
cat >> "$out/line.yaml" << 'EOL'
acquisitions:
  - {id: line, sensor: aviris-classic, time_s: 3714, lines: 512, samples: all,
     platform: {over: centre, altitude_agl_m: 20000, heading_deg: 0}}
EOL
time_case "AVIRIS 677 x 512 x 224 over the thesis case, all but native forms" "$out/line.yaml" "40 s, 1024 MB"
echo "products: [radiance, ortho, native]" >> "$out/line.yaml"
time_case "the same, radiance, ortho and native forms" "$out/line.yaml" "40 s, 1024 MB"
