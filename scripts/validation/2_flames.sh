# Spectra of flames: figures 6.1 to 6.3, 6.5, A.1, A.2 and A.4.
flame() { pyroscene calc flame-emissivity "$@"; }

# Figure 6.1 (a): 2.4 m of flame of 1700 K against a blackbody, without the lines, which 5 nm miss; (b): its potassium lines at the 3 nm of the ASD's sampling.
{ echo wavelength_um; awk 'BEGIN { for (w = 0.35; w <= 2.5; w += 0.005) printf "%.4f\n", w }'; } >"$tables/asd_in.csv"
flame --csv "$tables/asd_in.csv" --temperature_K 1700 --path_m 2.438 --potassium_ppm 0 -o "$tables/asd.csv"
awk -F, 'NR == 1 { print "wavelength_um,flame,black_body_1700_K"; next } { printf "%s,%s,%.6g\n", $1, $3, 1.191042972e8 / ($1 ^ 5 * (exp(14387.7688 / ($1 * 1700)) - 1)) }' "$tables/asd.csv" >"$tables/fig_6_1a.csv"
pyroscene plot "$tables/fig_6_1a.csv" --x wavelength_um --y flame,black_body_1700_K --x-label "wavelength [um]" --y-label "radiance [W m-2 sr-1 um-1]" -o "$images/fig_6_1a.png"
# Figure 6.2: radiance at 1.2 um over the length of the fuel bed.
{ echo path_m; for l in 0.305 0.61 0.914 1.219 1.524 1.829 2.134 2.438 2.743; do echo $l; done; } >"$tables/bed_in.csv"
flame --csv "$tables/bed_in.csv" --temperature_K 1700 --wavelength_um 1.2 -o "$tables/bed.csv"
pyroscene plot "$tables/bed.csv" --x path_m --y radiance_W_m2_sr_um --points radiance_W_m2_sr_um --x-label "length [m]" --y-label "radiance at 1.2 um [W m-2 sr-1 um-1]" -o "$images/fig_6_2.png"
number bed_2438_over_305 "$(awk -F, '$1 == "0.305" { a = $3 } $1 == "2.438" { print $3 / a }' "$tables/bed.csv")"

# Figures 6.1 (b) and 6.2 as the field spectroradiometer sees them, of flames of 1100 K: scenarios/field_flame.
beds=(--acquisition bed_0305mm --acquisition bed_2438mm)
((reduced)) && beds+=(--acquisition bed_1219mm) || beds=()
pyroscene run scenarios/field_flame/bed_length.yaml "${beds[@]}" -o "$out/bed_length"
spectra=("$out"/bed_length/bed_*mm/spectrum.csv)
bed_m='FNR == 1 { n = split(FILENAME, part, "/"); bed = substr(part[n - 1], 5, 4) / 1000 }'
awk -F, "$bed_m"' NR == 1 { print "bed_m,wavelength_um,radiance" }
    FNR > 1 && $2 > 0.745 && $2 < 0.8 && (bed == 0.305 || bed == 1.219 || bed == 2.438) { printf "%.3f,%s,%s\n", bed, $2, $4 }' "${spectra[@]}" >"$tables/fig_6_1b.csv"
pyroscene plot "$tables/fig_6_1b.csv" --x wavelength_um --y radiance --by bed_m --x-label "wavelength [um]" --y-label "radiance [W m-2 sr-1 um-1]" -o "$images/fig_6_1b.png"
soot_per_m=$(result flame-emissivity --wavelength_um 1.199 --temperature_K 1100 --path_m 1 emissivity | awk '{ print -log(1 - $1) }')
awk -F, "$bed_m"' NR == 1 { print "length_m,instrument,slab" }
    FNR > 1 && $2 > 1.1985 && $2 < 1.1995 {
        black = 1.191042972e8 / ($2 ^ 5 * (exp(14387.7688 / ($2 * 1100)) - 1))
        printf "%.3f,%s,%.5g\n", bed, $4, black * (1 - exp(-k * bed))
    }' k="$soot_per_m" "${spectra[@]}" >"$tables/fig_6_2_instrument.csv"
pyroscene plot "$tables/fig_6_2_instrument.csv" --x length_m --y instrument,slab --points instrument --x-label "length of the fuel bed [m]" --y-label "radiance at 1.2 um [W m-2 sr-1 um-1]" -o "$images/fig_6_2_instrument.png"
number instrument_2438_over_305 "$(awk -F, '$1 == "0.305" { a = $2 } $1 == "2.438" { print $2 / a }' "$tables/fig_6_2_instrument.csv")"

# Figure 6.3: the infrared spectroradiometer before 20 cm of flame of 1100 K (scenarios/field_flame), beside the same slab by the
# narrow-band formula without the 2 m of air between, and the blackbody of 1153 K that the thesis draws.
pyroscene run scenarios/field_flame/gas_bands.yaml --acquisition sideways_2m -o "$out/gas_bands"
spectrum=$out/gas_bands/sideways_2m/spectrum.csv
awk -F, 'NR == 1 { print "wavelength_um"; next } { print $2 }' "$spectrum" >"$tables/ir_in.csv"
flame --csv "$tables/ir_in.csv" --temperature_K 1100 --path_m 0.2 -o "$tables/ir.csv"
paste -d, "$spectrum" "$tables/ir.csv" | awk -F, 'NR == 1 { print "wavelength_um,instrument,slab,black_body_1153_K"; next }
    { printf "%s,%s,%s,%.6g\n", $2, $4, $8, 1.191042972e8 / ($2 ^ 5 * (exp(14387.7688 / ($2 * 1153)) - 1)) }' >"$tables/fig_6_3.csv"
pyroscene plot "$tables/fig_6_3.csv" --x wavelength_um --y slab,instrument,black_body_1153_K --points instrument --x-label "wavelength [um]" --y-label "radiance [W m-2 sr-1 um-1]" -o "$images/fig_6_3.png"
number instrument_over_slab_3.9um "$(awk -F, 'NR > 1 && $1 > 3.85 && $1 < 3.95 { a += $2; b += $3 } END { print a / b }' "$tables/fig_6_3.csv")"
number instrument_over_slab_4.3um "$(awk -F, 'NR > 1 && $1 > 4.25 && $1 < 4.35 { a += $2; b += $3 } END { print a / b }' "$tables/fig_6_3.csv")"
emissivity() { result flame-emissivity --wavelength_um "$1" --temperature_K 1153 --path_m 0.2 emissivity; }
number emissivity_20cm_4.3um "$(emissivity 4.4)"
number emissivity_20cm_gas_over_window "$(awk -v a="$(emissivity 4.4)" -v b="$(emissivity 3.9)" 'BEGIN { print a / b }')"

# Figure 6.5: 8 m of air at 1100 K with the gases of the atmosphere, no soot.
{ echo wavelength_um; awk 'BEGIN { for (w = 1; w <= 15; w += 0.02) printf "%.4f\n", w }'; } >"$tables/hot_air_in.csv"
flame --csv "$tables/hot_air_in.csv" --temperature_K 1100 --path_m 8 --soot_volume_fraction 0 --x_h2o 0.014 --x_co2 0.00037 --x_co 0 --x_o2 0.2 --potassium_ppm 0 -o "$tables/hot_air.csv"
awk -F, 'NR == 1 { print "wavelength_um,transmittance,radiance"; next } { printf "%s,%.6g,%s\n", $1, 1 - $2, $3 }' "$tables/hot_air.csv" >"$tables/fig_6_5.csv"
pyroscene plot "$tables/fig_6_5.csv" --x wavelength_um --y transmittance --x-label "wavelength [um]" -o "$images/fig_6_5_transmission.png"
pyroscene plot "$tables/fig_6_5.csv" --x wavelength_um --y radiance --x-label "wavelength [um]" --y-label "radiance [W m-2 sr-1 um-1]" -o "$images/fig_6_5_emission.png"

# Figures A.1 and A.2: appendix A as printed (n_e, N and A are not given there).
{ echo temperature_K; seq 600 20 2000; } >"$tables/potassium_in.csv"
pyroscene calc thesis-potassium --csv "$tables/potassium_in.csv" -o "$tables/potassium.csv"
pyroscene plot "$tables/potassium.csv" --x temperature_K --y power_W --log-y --x-label "temperature [K]" --y-label "power of the lines [W]" -o "$images/fig_A_1.png"
pyroscene plot "$tables/potassium.csv" --x temperature_K --y ratio_766,ratio_770 --log-y --x-label "temperature [K]" --y-label "potassium / blackbody" -o "$images/fig_A_2.png"
# Figure A.4: what the lines are in local thermal equilibrium, 1 m of flame at 1100 K with 1 ppm of potassium.
{ echo wavelength_um; awk 'BEGIN { for (w = 0.764; w <= 0.772; w += 0.00001) printf "%.5f\n", w }'; } >"$tables/lines_in.csv"
flame --csv "$tables/lines_in.csv" --temperature_K 1100 --path_m 1 --potassium_ppm 1 -o "$tables/lines.csv"
pyroscene plot "$tables/lines.csv" --x wavelength_um --y radiance_W_m2_sr_um --x-label "wavelength in vacuum [um]" --y-label "radiance [W m-2 sr-1 um-1]" -o "$images/fig_A_4.png"
number potassium_line_over_continuum "$(awk -F, 'NR > 1 { if ($2 > most) most = $2; if (!first) first = $2 } END { print most / first }' "$tables/lines.csv")"
