#!/usr/bin/env bash
# Lists the products of a run and prints commands that open them.
#   scripts/show_products.sh OUTPUT_FOLDER
set -euo pipefail
(($# == 1)) || { echo "usage: show_products.sh OUTPUT_FOLDER" >&2; exit 2; }
[[ -d $1 ]] || { echo "show_products: no folder '$1'" >&2; exit 1; }
out=$(cd -- "$1" && pwd)
shopt -s nullglob

first_of() { (($#)) && printf '%s\n' "$1" || true; }

printf '\nProducts in %s\n' "$out"
for file in "$out"/run.json "$out"/catalog.json; do printf '  %s\n' "${file#"$out"/}"; done
for folder in "$out"/*/; do
    folder=${folder%/}
    files=("$folder"/*.tif "$folder"/*.png "$folder"/*.geojson)
    ((${#files[@]})) || continue
    printf '  %s/\n' "${folder##*/}"
    printf '      %s\n' "${files[@]##*/}"
done

picture=$(first_of "$out"/*/quicklook*.png)
ortho=$(first_of "$out"/*/ortho_*.tif)
radiance=$(first_of "$out"/*/radiance*.tif)
printf '\nLook at them (paths are ready to paste):\n'
[[ -z $picture ]] || printf '  a picture          xdg-open %q\n' "$picture"
[[ -z $ortho ]] || printf '  on the map         qgis %q\n' "$ortho"
[[ -z $radiance ]] || printf '  bands and units    gdalinfo %q\n' "$radiance"
[[ -z $radiance ]] || printf '  your own ortho     gdalwarp -geoloc -t_srs EPSG:4326 %q %q\n' "$radiance" "${radiance%.tif}_geographic.tif"
