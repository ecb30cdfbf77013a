#!/usr/bin/env bash
# The thesis's results from our program, beside its own numbers: runs the thesis's scene and the formulas behind its figures, draws
# them, and checks every number against its band in docs/validation/bands.csv. Exit code 1 when one leaves its band.
#   scripts/validate.sh [--reduced] [--update] [OUTPUT_FOLDER]      default: out/validation
# --reduced  smaller images and fewer times, for a check with every change; --update  takes the pictures and numbers of a full run
# over into docs/validation. PYROSCENE names the program (default: build/release, built when it is not there).
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
reduced=0 update=0 out=out/validation
for word in "$@"; do
    case $word in
        --reduced) reduced=1 ;;
        --update) update=1 ;;
        -*) echo "validate: unknown option $word" >&2; exit 2 ;;
        *) out=$word ;;
    esac
done
((reduced && update)) && { echo "validate: --update needs a full run" >&2; exit 2; }
program=${PYROSCENE:-build/release/src/cli/pyroscene}
if [[ ! -x $program && -z ${PYROSCENE:-} ]]; then
    cmake --preset release
    cmake --build --preset release --parallel --target pyroscene_cli
fi
rm -rf -- "$out"
mkdir -p -- "$out/images" "$out/tables"
numbers=$out/numbers.csv
echo name,value >"$numbers"
number() { echo "$1,$2" >>"$numbers"; }
pyroscene() { "$program" -q "$@"; }
# One result of one formula: calc NAME --option value ..., then the result's name.
result() { local -a words=("${@:1:$#-1}"); "$program" calc "${words[@]}" | awk -v name="${!#}" '$1 == name { print $3 }'; }
# Count, minimum, 5 % quantile, median, mean, maximum, sum of an expression over the pixels of a mask.
statistics() { scripts/pixel_statistics.py "$@"; }

for part in scripts/validation/*.sh; do
    echo "validate: $(basename -- "$part" .sh)"
    # shellcheck source=/dev/null
    source "$part"
done

# Every number of this run against its band; every band that a run of this size must give.
awk -F, -v reduced=$reduced '
    FNR == NR { value[$1] = $2; next }
    FNR == 1 { print "| number | here | band | thesis | errata |\n|---|---|---|---|---|"; next }
    /^#/ { next }
    {
        if (!($1 in value)) { if (!reduced || $7 == "always") { print "validate: no number " $1 > "/dev/stderr"; bad = 1 }; next }
        known[$1] = 1
        inside = value[$1] >= $3 && value[$1] <= $4
        if (!inside) { printf "validate: %s is %s, outside %s to %s (thesis: %s)\n", $1, value[$1], $3, $4, $2 > "/dev/stderr"; bad = 1 }
        printf "| %s | %s%.4g%s | %s to %s | %s | %s |\n", $6, inside ? "" : "**", value[$1], inside ? "" : "**", $3, $4, $2, $5
    }
    END {
        for (name in value) if (name != "name" && !(name in known)) { print "validate: no band for " name > "/dev/stderr"; bad = 1 }
        exit bad
    }' "$numbers" docs/validation/bands.csv >"$out/table.md" && inside=1 || inside=0

# The page: the text of docs/validation/page.in.md with the numbers of this run in place of {{name}}.
awk -F, -v table="$out/table.md" '
    FNR == NR { value[$1] = $2; next }
    /^{{numbers}}$/ { while ((getline line < table) > 0) print line; next }
    {
        line = $0
        while (match(line, /{{[A-Za-z0-9_.-]+}}/)) {
            name = substr(line, RSTART + 2, RLENGTH - 4)
            line = substr(line, 1, RSTART - 1) (name in value ? sprintf("%.4g", value[name]) : "–") substr(line, RSTART + RLENGTH)
        }
        print line
    }' "$numbers" docs/validation/page.in.md >"$out/README.md"
# Figures 4.16 and 4.17 have a page and a command of their own.
if ((!reduced)); then
    PYROSCENE=$program bash scripts/thesis_figures.sh "$out/thesis_figures" >"$out/thesis_figures.txt" 2>>"$out/warnings.txt"
    for picture in "$out"/thesis_figures/fig_4_1[67]*.png; do
        name=$(basename -- "$picture")
        cp -- "$picture" "$out/images/${name:0:9}.png"
    done
fi
cp -- docs/validation/thesis-figures.md "$out/"
if ((update)); then
    cp -- "$out/README.md" docs/validation/README.md
    for picture in "$out"/images/*.png; do
        [[ $picture == */fig_4_1[67]* ]] && continue  # docs/validation/thesis-figures.md keeps its own
        # At most 900 pixels wide, as a page shows them.
        width=$(gdalinfo "$picture" 2>/dev/null | awk -F'[ ,]+' '/^Size is/ { print $3 }')
        if ((width > 900)); then
            gdal_translate -q -of PNG -outsize 900 0 -r average "$picture" "docs/validation/images/$(basename -- "$picture")"
        else
            cp -u -- "$picture" docs/validation/images/
        fi
    done
    rm -f -- docs/validation/images/*.aux.xml
fi
((inside)) || { echo "validate: numbers outside their bands, see above" >&2; exit 1; }
echo "validate: $(($(wc -l <"$numbers") - 1)) numbers in their bands; page: $out/README.md"
