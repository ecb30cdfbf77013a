# The thesis's grass fire: table 6.1 and figures 6.4 and 6.6 to 6.21.
scene=$out/scene
cp -r -- scenarios/thesis_grassfire "$scene"
slant=(t0000 t0960 t1800 t3000 t3816 t4440) top=(t0000 t0960 t1800 t3000 t3714 t4440)
if ((reduced)); then
    # The head of the fire alone, at full resolution.
    sed -i 's/nx: 640/nx: 160/; s/ny: 512/ny: 128/; s/319.5, 255.5/79.5, 63.5/' "$scene/spectral_camera.yaml"
    sed -i 's/over: centre/over: {x_m: 418900, y_m: 4761300}/; s/x_m: 418500/x_m: 418900/' "$scene"/{slant_views,top_views,fire_power}.yaml
    slant=(t3816) top=(t3714)
fi
chosen() { printf -- '--acquisition %s ' "$@"; }
# shellcheck disable=SC2046
{
    pyroscene run "$scene/slant_views.yaml" $(chosen "${slant[@]}") -o "$out/slant" 2>>"$out/warnings.txt"
    pyroscene run "$scene/top_views.yaml" $(chosen "${top[@]}") -o "$out/top" 2>>"$out/warnings.txt"
}
for name in scenario scenario_thesis fire_power; do pyroscene run "$scene/$name.yaml" -o "$out/$name" 2>>"$out/warnings.txt"; done

# One band of several images side by side, in common colours: sheet OUT BAND LOW,HIGH FOLDER ACQUISITION...
sheet() {
    local target=$1 band=$2 range=$3 folder=$4 id parts=() names=
    shift 4
    for id in "$@"; do
        gdal_translate -q -b "$band" -a_ullr 0 0 1 -1 "$folder/$id/radiance.tif" "$tables/${target}_$id.tif" 2>/dev/null
        parts+=("$tables/${target}_$id.tif")
        names+=${names:+,}"$((10#${id#t} / 60)) min"
    done
    gdalbuildvrt -q -separate "$tables/$target.vrt" "${parts[@]}"
    pyroscene picture "$tables/$target.vrt" --bands "$(seq -s, 1 $#)" --names "$names" --range "$range" --log --title "W m-2 sr-1 um-1" -o "$images/$target.png"
}
# Bands of spectral_camera.yaml.
um_2=3 um_3=5 um_4=7 um_5=8
highest() { statistics a "a == a" "a=$1:$2" | awk '{ print $6 }'; }

# Figure 6.4: ground temperature at the thesis's times; the front is as long as the scene's README says.
for t in 0 960 1800 3000 4440; do
    state=$(printf '%s/scenario/state/t%09d' "$out" $t)
    gdal_translate -q -b 4 "$state.tif" "$tables/temperature_$t.tif"
    number "front_cells_$((t / 60))min" "$(awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "cells") c = i; next } { n += $c } END { print n }' "${state}_fronts.csv")"
done
gdalbuildvrt -q -separate "$tables/fig_6_4.vrt" "$tables"/temperature_{0,960,1800,3000,4440}.tif
pyroscene picture "$tables/fig_6_4.vrt" --bands 1,2,3,4,5 --names "0 min,16 min,30 min,50 min,74 min" --range 300,600 --title "ground temperature [K]" -o "$images/fig_6_4.png"

# Figures 6.6, 6.8, 6.9, 6.18: the plume at a slant; 6.6 right with a higher threshold.
last=t3816
sed -i 's/minimum_excess_K: 12/minimum_excess_K: 40/' "$scene/slant_views.yaml"
pyroscene run "$scene/slant_views.yaml" --acquisition $last -o "$out/slant_less" 2>>"$out/warnings.txt"
pyroscene picture "$out/slant/$last/radiance.tif" --bands $um_3 --range 1,6000 --log -o "$images/fig_6_6_left.png"
pyroscene picture "$out/slant_less/$last/radiance.tif" --bands $um_3 --range 1,6000 --log -o "$images/fig_6_6_right.png"
cp -- "$images/fig_6_6_left.png" "$images/fig_6_18.png"
share() { statistics a "a > 0.05" "a=$1/$last/truth.tif:5" | awk '{ print $1 }'; }
number plume_pixels_fewer_with_threshold "$(awk -v a="$(share "$out/slant")" -v b="$(share "$out/slant_less")" 'BEGIN { print b / a }')"
pyroscene picture "$out/top/t3714/radiance.tif" --bands $um_3,$um_5 --range 1,6000 --log -o "$images/fig_6_8_top.png"
sheet fig_6_9 $um_3 1,6000 "$out/slant" "${slant[@]}"
sheet fig_6_16 $um_3 1,6000 "$out/top" "${top[@]}"

# Figure 6.7: spectra of the brightest hot ground and of the thickest flame, beside a blackbody at 1100 K.
hottest() { # pixel with the largest value of a truth band: column row
    /usr/bin/python3 - "$1" "$2" <<'PY'
import sys, numpy
from osgeo import gdal
data = gdal.Open(sys.argv[1])
a = data.GetRasterBand(int(sys.argv[2])).ReadAsArray()
row, col = numpy.unravel_index(numpy.nanargmax(a), a.shape)
print(col, row)
PY
}
spectrum() { gdallocationinfo -valonly "$out/top/t3714/radiance.tif" $1 2>/dev/null; }
waves="1.25 1.65 2.00 2.20 3.00 3.75 4.00 5.00 8.60 9.60 10.80 12.00"
paste -d, <(tr ' ' '\n' <<<"$waves") <(spectrum "$(hottest "$out/top/t3714/truth.tif" 2)") <(spectrum "$(hottest "$out/top/t3714/truth.tif" 1)") |
    awk -F, 'BEGIN { print "wavelength_um,hot_ground,flame,black_body_1100_K" } { printf "%s,%.6g\n", $0, 1.191042972e8 / ($1 ^ 5 * (exp(14387.7688 / ($1 * 1100)) - 1)) }' >"$tables/fig_6_7.csv"
pyroscene plot "$tables/fig_6_7.csv" --x wavelength_um --y hot_ground,flame,black_body_1100_K --log-y --x-label "wavelength [um]" --y-label "radiance [W m-2 sr-1 um-1]" -o "$images/fig_6_7.png"

# Figures 6.10, 6.11, 6.15: flame light on the ground, as point sources and over the hemisphere, whole and enlarged.
printf '\nrender: {flame_light_model: point_sources}\n' >>"$scene/top_views.yaml"
pyroscene run "$scene/top_views.yaml" --acquisition t3714 -o "$out/top_points" 2>>"$out/warnings.txt"
size=$(gdalinfo "$out/top/t3714/radiance.tif" 2>/dev/null | awk -F'[ ,]+' '/^Size is/ { print $3 }')
window=$((size * 66 / 100)),$((size * 22 / 100)),$((size / 5)),$((size / 5))
for kind in top_points:fig_6_10 top:fig_6_15; do
    image=$out/${kind%:*}/t3714/radiance.tif
    pyroscene picture "$image" --bands $um_3 --range 1,6000 --log -o "$images/${kind#*:}a.png"
    pyroscene picture "$image" --bands $um_3 --range 1,6000 --log --window $window -o "$images/${kind#*:}b.png"
done
reflected() { statistics a "a > 0" "a=$1/t3714/truth.tif:$(gdalinfo "$1/t3714/truth.tif" 2>/dev/null | awk '/^Band/ { b = $2 } /B3.00 term_reflected_flame/ { print b }')" | awk '{ print $5 }'; }
number point_over_hemisphere_light "$(awk -v a="$(reflected "$out/top_points")" -v b="$(reflected "$out/top")" 'BEGIN { print a / b }')"

# Figures 6.12 to 6.14: the WASP's peaks with the thesis's assumptions and with the default physics.
i=0
for band in swir mwir lwir; do
    i=$((i + 1))
    figure=fig_6_1$((i + 1))
    number "wasp_${band}_thesis" "$(highest "$out/scenario_thesis/wasp_3714s/radiance.tif" $i)"
    number "wasp_${band}_default" "$(highest "$out/scenario/wasp_3714s/radiance.tif" $i)"
    pyroscene picture "$out/scenario_thesis/wasp_3714s/radiance.tif" --bands $i --log -o "$images/$figure.png"
done
