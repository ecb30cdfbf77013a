# Section 6.6: unmixing (figures 6.18 to 6.21) and fire radiative power (table 6.1).

# Figure 6.19: five endmembers of the slant view, 63 min 36 s. Figures 6.20 and 6.21: four of the view from above.
band_called() { gdalinfo "$1" 2>/dev/null | awk -v name="$2" '/^Band/ { b = $2 } /Description = / { sub(/.*Description = /, ""); if ($0 == name) print b }'; }
unmixed() { # folder, least fraction in the purest pixels of a class, name of its numbers
    pyroscene unmix "$1/radiance.tif" --truth "$1/truth.tif" --purest "$2" --method fcls -o "$1/unmixed.tif" >"$1/unmixed.txt"
    local name
    for name in flame front; do
        number "$3_rms_$name" "$(statistics "(a-b)*(a-b)" "(a == a) & (b == b)" \
            "a=$1/unmixed.tif:$(band_called "$1/unmixed.tif" "fraction of $name")" "b=$1/truth.tif:$(band_called "$1/truth.tif" "fraction_$name")" | awk '{ print sqrt($5) }')"
    done
}
unmixed "$out/slant/t3816" 0.4 unmix_slant
unmixed "$out/top/t3714" 0.5 unmix_top
pyroscene picture "$out/slant/t3816/unmixed.tif" --bands 1,2,3,4,5 --range 0,1 --names "flame,hot ground,burn scar,background,plume" --title "fractions by unmixing" -o "$images/fig_6_19.png"
pyroscene picture "$out/slant/t3816/truth.tif" --bands 1,2,3,4,5 --range 0,1 --names "flame,hot ground,burn scar,background,plume" --title "fractions, truth" -o "$images/fig_6_19_truth.png"
pyroscene plot "$out/slant/t3816/unmixed_endmembers.csv" --x wavelength_um --y flame,front,scar,background,smoke --log-y --x-label "wavelength [um]" --y-label "radiance [W m-2 sr-1 um-1]" -o "$images/fig_6_19_spectra.png"
pyroscene picture "$out/top/t3714/radiance.tif" --bands $um_2 --range 0.5,5000 --log -o "$images/fig_6_20.png"
pyroscene picture "$out/top/t3714/unmixed.tif" --bands 2,1,4,3 --range 0,1 --names "hot ground,flame,unburned,burn scar" --title "fractions by unmixing" -o "$images/fig_6_21.png"
pyroscene picture "$out/top/t3714/truth.tif" --bands 2,1,4,3 --range 0,1 --names "hot ground,flame,unburned,burn scar" --title "fractions, truth" -o "$images/fig_6_21_truth.png"

# Table 6.1, emissivity 0.9: eq 6.3 from the fractions with 1100, 1000 and 600 K, and eq 6.6 from the radiance at 4 um (a = 3.3e-9),
# over pixels that are at least 98 % fire. The thesis's lower ends are those of its pixels; here the 5 % quantile.
fire=$out/fire_power/t3714
pyroscene frp "$fire/radiance.tif" --mir-band $um_4 --coefficient bird --no-background -o "$out/frp_bird.tif"
planes=("flame=$fire/truth.tif:1" "front=$fire/truth.tif:2" "scar=$fire/truth.tif:3" "exitance=$fire/truth.tif:8" "mir=$out/frp_bird.tif:1")
read -r _ _ low _ _ high _ <<<"$(statistics "0.9*sigma*(front*1100**4+flame*1000**4+scar*600**4)" "front+flame>=0.98" "${planes[@]}")"
number frp_true_low "$low"; number frp_true_high "$high"
read -r _ _ low _ _ high _ <<<"$(statistics "mir*0.9/0.9" "front+flame>=0.98" "${planes[@]}")"
number frp_mir_low "$low"; number frp_mir_high "$high"
number frp_exitance_high "$(statistics exitance "front+flame>=0.98" "${planes[@]}" | awk '{ print $6 }')"
# Its largest MIR value, 7.89e4, is that of emissivity 1 (E33): the brightest pixel of figure 6.13 through the same formula.
number frp_mir_of_fig_6_13 "$(awk -F, '$1 == "wasp_mwir_thesis" { print 5.670374419e-8 / 3.3e-9 * $2 }' "$numbers")"

# The same with the default physics, air in between: fitted coefficient, background taken off, corrected for the transmittance.
plain=$out/top/t3714
tau=$(result atmosphere --altitude_m 3000 --wavelength_um 4 transmittance)
pyroscene frp "$plain/radiance.tif" --mir-band $um_4 --mir-transmittance "$tau" -o "$out/frp_default.tif"
planes=("exitance=$plain/truth.tif:8" "mir=$out/frp_default.tif:1" "flame=$plain/truth.tif:1" "front=$plain/truth.tif:2")
read -r _ _ low _ mean high truth <<<"$(statistics exitance "front+flame>=0.5" "${planes[@]}")"
number frp_default_true_mean "$mean"; number frp_default_true_high "$high"
number frp_default_mir_over_true "$(statistics mir "front+flame>=0.5" "${planes[@]}" | awk -v t="$truth" '{ print $7 / t }')"
