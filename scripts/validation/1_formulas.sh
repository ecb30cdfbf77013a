# Formulas of chapters 2 and 4: figures 2.4, 2.5, 4.10 to 4.14, 4.19.
tables=$out/tables images=$out/images

# Figure 2.4: blackbodies.
{
    echo "temperature_K,wavelength_um"
    for T in 300 600 800 1100 1700; do awk -v T=$T 'BEGIN { for (i = 0; i <= 200; ++i) printf "%d,%.5f\n", T, 0.4 * (40 ^ (i / 200)) }'; done
} >"$tables/planck_in.csv"
pyroscene calc planck --csv "$tables/planck_in.csv" -o "$tables/planck.csv"
pyroscene plot "$tables/planck.csv" --x wavelength_um --y radiance_W_m2_sr_um --by temperature_K --log-x --log-y --y-range 0.1,1e5 \
    --x-label "wavelength [um]" --y-label "radiance [W m-2 sr-1 um-1]" -o "$images/fig_2_4.png"
number planck_4um_1100K "$(result planck --wavelength_um 4 --temperature_K 1100 radiance_W_m2_sr_um)"
number wien_peak_1100K_um "$(awk -F, '$1 == 1100 && $3 > best { best = $3; at = $2 } END { print at }' "$tables/planck.csv")"

# Figure 2.5: a slab that absorbs, transmitted and own radiance.
awk 'BEGIN {
    print "k_per_m,path_m,transmitted,own"
    n = split("0.03 0.3 3", k, " ")
    for (j = 1; j <= n; ++j) for (b = 0; b <= 5; b += 0.05) printf "%s,%.2f,%.6f,%.6f\n", k[j], b, exp(-k[j] * b), 1 - exp(-k[j] * b)
}' >"$tables/slab.csv"
pyroscene plot "$tables/slab.csv" --x path_m --y transmitted --by k_per_m --x-label "path [m]" --y-label "transmitted / source" -o "$images/fig_2_5_left.png"
pyroscene plot "$tables/slab.csv" --x path_m --y own --by k_per_m --x-label "path [m]" --y-label "emissivity of the slab" -o "$images/fig_2_5_right.png"

# Figures 4.10 and 4.11: scar cooling, and its coefficients found again in a record with 5 K of scatter.
{ echo time_s; seq 0 10 1500; } >"$tables/scar_in.csv"
pyroscene calc scar-temperature --csv "$tables/scar_in.csv" -o "$tables/scar.csv"
pyroscene plot "$tables/scar.csv" --x time_s --y temperature_K --x-label "time after the fire's arrival [s]" --y-label "temperature [K]" -o "$images/fig_4_11.png"
for t in 0 100 300 600; do
    number "scar_${t}s_C" "$(result scar-temperature --time_s $t temperature_K | awk '{ print $1 - 273.15 }')"
done
awk -F, 'NR == 1 { print "time_s,temperature_K"; next } { printf "%s,%.3f\n", $1, $2 + 5 * sin(12.9898 * NR) * cos(78.233 * NR * NR) }' "$tables/scar.csv" >"$tables/record.csv"
for algorithm in powell nelder-mead; do
    pyroscene fit-scar "$tables/record.csv" --algorithm $algorithm -o "$tables/fit_$algorithm" >"$tables/fit_$algorithm.txt"
    cp -- "$tables/fit_$algorithm.png" "$images/fig_4_10_$algorithm.png"
    for key in time_constant1_s time_constant2_s; do
        number "fit_${algorithm}_$key" "$(awk -F'[:,} ]+' -v key=$key '{ for (i = 1; i < NF; ++i) if ($i == key) { print $(i + 1); exit } }' "$tables/fit_$algorithm.yaml")"
    done
done

# Figure 4.12: heat flux over height, e-folding 50 m, and the heat of the column below: H A (1 - exp(-z / 50 m)).
awk 'BEGIN {
    print "height_m,heat_flux_MW_m2,heat_below_GW"
    for (z = 0; z <= 300; z += 2) printf "%d,%.6f,%.6f\n", z, 5.92 * exp(-z / 50), 5.92e6 * 400 * (1 - exp(-z / 50)) * 1e-9
}' >"$tables/column.csv"
pyroscene plot "$tables/column.csv" --x height_m --y heat_flux_MW_m2,heat_below_GW --x-label "height [m]" --y-label "MW m-2, GW" -o "$images/fig_4_12.png"

# Figures 4.13 and 4.14: Heskestad's height of the hottest cell of each frame, fire on a fortieth of the cell.
echo "time_s,heat_flux_W_m2" >"$tables/hottest_in.csv"
gdalinfo -mm scenarios/thesis_grassfire/heat_flux.tif 2>/dev/null | awk -F'[=, ]+' '
    /Computed Min\/Max/ { for (i = 1; i <= NF; ++i) if ($i == "Min/Max") most = $(i + 2) }
    /time_s=/ { for (i = 1; i <= NF; ++i) if ($i == "time_s") time = $(i + 1); printf "%s,%s\n", time, most }' >>"$tables/hottest_in.csv"
for fuel in gas:0.235 wood:0.062; do
    pyroscene calc flame-height --method heskestad --csv "$tables/hottest_in.csv" --cell_area_m2 400 --diameter_m 3.57 \
        --plume_coefficient_m_kW "${fuel#*:}" -o "$tables/heskestad_${fuel%:*}.csv"
    number "heskestad_${fuel%:*}_highest_m" "$(awk -F, 'NR > 1 && $3 > best { best = $3 } END { print best }' "$tables/heskestad_${fuel%:*}.csv")"
done
pyroscene plot "$tables/heskestad_gas.csv" --x time_s --y height_m --x-label "time [s]" --y-label "height [m], gas" -o "$images/fig_4_13.png"
pyroscene plot "$tables/heskestad_wood.csv" --x time_s --y height_m --x-label "time [s]" --y-label "height [m], wood char" -o "$images/fig_4_14.png"
number heat_flux_height_m "$(result flame-height --method heat_flux --heat_flux_W_m2 5.92e6 height_m)"

# Figure 4.19: air between the ground and 4.2 km, midlatitude summer, 23 km visibility.
{ echo wavelength_um; awk 'BEGIN { for (w = 0.4; w <= 14; w *= 1.004) printf "%.5f\n", w }'; } >"$tables/air_in.csv"
pyroscene calc atmosphere --csv "$tables/air_in.csv" --altitude_m 4200 -o "$tables/air.csv"
awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; print "wavelength_um,black_body,at_sensor,transmittance,solar_irradiance_W_m2_um"; next } {
    w = $1; b = 1.191042972e8 / (w ^ 5 * (exp(14387.7688 / (w * 1100)) - 1)); t = $column["transmittance"]
    printf "%s,%.6g,%.6g,%.6g,%.6g\n", w, b, b * t + $column["path_thermal_W_m2_sr_um"] + $column["path_solar_W_m2_sr_um"], t, $column["direct_irradiance_W_m2_um"]
}' "$tables/air.csv" >"$tables/at_sensor.csv"
pyroscene plot "$tables/at_sensor.csv" --x wavelength_um --y solar_irradiance_W_m2_um --log-x --log-y --y-range 0.01,3000 --x-label "wavelength [um]" --y-label "sun on the ground [W m-2 um-1]" -o "$images/fig_4_19a.png"
pyroscene plot "$tables/at_sensor.csv" --x wavelength_um --y transmittance --log-x --x-label "wavelength [um]" -o "$images/fig_4_19b.png"
pyroscene plot "$tables/at_sensor.csv" --x wavelength_um --y black_body,at_sensor --log-x --log-y --y-range 1,20000 --x-label "wavelength [um]" --y-label "radiance [W m-2 sr-1 um-1]" -o "$images/fig_4_19d.png"
air_at() { result atmosphere --altitude_m 4200 --wavelength_um "$1" transmittance; }
for w in 2.2 3.9 4.3 10.5; do number "transmittance_${w}um" "$(air_at $w)"; done
