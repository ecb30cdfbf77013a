#!/usr/bin/env bash
# Holds the direction between modules: who may include whom, and which third-party package is seen where.
#   scripts/check_includes.sh [TREE]      default: the tree this script lives in
# Prints file:line for each include that breaks a rule; exit code 1 when there is any. The rules are the tables below;
# docs/architecture.md says why they are as they are.
set -euo pipefail
cd -- "${1:-$(dirname -- "${BASH_SOURCE[0]}")/..}"

find src gis sensors \( -name '*.h' -o -name '*.cpp' -o -name '*.inc' \) -print | sort | xargs awk '
BEGIN {
    # module -> folders whose headers it may include, besides its own
    allow["base"]       = ""
    allow["config"]     = "base"
    allow["fire"]       = "base"
    allow["spread"]     = "base fire"
    allow["radiometry"] = "base"
    allow["analysis"]   = "base"
    allow["gis"]        = "base"
    allow["render"]     = "base fire radiometry"
    allow["sensors"]    = "base config radiometry gis/geodesy.h"
    allow["scenario"]   = "base config fire spread"
    allow["inputs"]     = "base fire spread radiometry gis scenario"
    allow["drawing"]    = "base radiometry"
    allow["imagery"]    = "base radiometry analysis gis sensors drawing"
    allow["pipeline"]   = "base config fire spread radiometry analysis gis render sensors scenario inputs drawing imagery"
    allow["cli"]        = "base fire spread radiometry analysis gis sensors scenario inputs drawing imagery pipeline"

    # module -> third-party headers (regular expression) its .cpp files may include; fmt is free for all, headers get none
    foreign["gis"]      = "^(gdal|ogr|cpl_|proj|GeographicLib/|hdf/mfhdf)"
    foreign["fire"]     = "^(nlopt|Eigen/|unsupported/Eigen/)"
    foreign["spread"]   = "^(tbb/|oneapi/tbb)"
    foreign["analysis"] = "^boost/math/"
    foreign["config"]   = "^yaml-cpp/"
    foreign["render"]   = "^(embree3/|tbb/|oneapi/tbb)"
    foreign["inputs"]   = "^(tbb/|oneapi/tbb)"
    foreign["drawing"]  = "^(opencv2/|openssl/|png[.]h$)"
    foreign["imagery"]  = "^(tbb/|oneapi/tbb|opencv2/|nlohmann/)"
    foreign["pipeline"] = "^(tbb/|oneapi/tbb|opencv2/|openvdb/|nlohmann/|openssl/)"
    foreign["cli"]      = "^(CLI/|spdlog/|nlohmann/)"

    standard = "^[a-z0-9_]+$"
    posix    = "^((unistd|dlfcn|fcntl|signal|poll|termios|pthread|immintrin)\\.h|sys/[a-z]+\\.h)$"
}
function complain(text) {
    printf "%s:%d: %s\n", FILENAME, FNR, text
    broken = 1
}
FNR == 1 {
    parts = split(FILENAME, path, "/")
    module = (path[1] == "src") ? path[2] : path[1]
    is_header = (FILENAME ~ /\.(h|inc)$/)
    if (!(module in allow)) complain("folder \"" module "\" is not in the table of modules (scripts/check_includes.sh)")
}
/^[ \t]*#[ \t]*include[ \t]*"/ {
    split($0, quoted, "\""); target = quoted[2]
    if (split(target, parts_of_target, "/") < 2) {
        complain("\"" target "\" must be written as \"<folder>/<header>.h\""); next
    }
    folder = parts_of_target[1]
    if (folder == module) next
    count = split(allow[module], permitted, " ")
    for (i = 1; i <= count; ++i) if (permitted[i] == folder || permitted[i] == target) next
    complain("module \"" module "\" may not include \"" target "\"; it may include: " (count ? allow[module] : "nothing but its own headers"))
}
/^[ \t]*#[ \t]*include[ \t]*</ {
    match($0, /<[^>]*>/); target = substr($0, RSTART + 1, RLENGTH - 2)
    if (target ~ standard || target ~ posix) next
    if (is_header) { complain("<" target "> in a header; third-party headers belong into .cpp files"); next }
    if (target ~ /^fmt\//) next
    if ((module in foreign) && target ~ foreign[module]) next
    complain("module \"" module "\" may not see <" target ">")
}
END { exit broken }
'
