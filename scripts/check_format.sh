#!/usr/bin/env bash
# Names the headers and sources that clang-format would lay out differently.  `scripts/check_format.sh --fix` rewrites them.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
mapfile -t files < <(find src gis sensors tests bench \( -name '*.h' -o -name '*.cpp' \) -print 2>/dev/null | sort)

if [[ ${1:-} == --fix ]]; then
    clang-format -i "${files[@]}"
    exit 0
fi
wrong=$(clang-format --dry-run "${files[@]}" 2>&1 | sed -nE 's/^([^:]+):[0-9]+:[0-9]+: warning:.*/\1/p' | sort -u)
[[ -z $wrong ]] && exit 0
printf 'not laid out by clang-format (scripts/check_format.sh --fix):\n%s\n' "$wrong" >&2
exit 1
