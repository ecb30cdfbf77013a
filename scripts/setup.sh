#!/usr/bin/env bash
# Installs the Debian 12 packages that are missing, and nothing else.
#   scripts/setup.sh [build] [test] [bench] [lint]      default: build test
# As root apt-get is called directly, otherwise through sudo. PYROSCENE_SKIP_SETUP=1 skips the whole step, for systems where
# the libraries come from somewhere else.
set -euo pipefail

build_packages=(
    g++ cmake ninja-build pkg-config
    libgdal-dev gdal-bin libproj-dev proj-data libgeographiclib-dev # rasters, map projections, geodesics
    libembree-dev libtbb-dev                                        # ray tracer, threads
    libopencv-core-dev libopencv-imgproc-dev libpng-dev             # quick-looks; libopencv-dev would pull in everything
    libnlopt-cxx-dev libnlopt-dev libeigen3-dev libboost-math-dev   # minimisers, linear algebra, distributions
    libyaml-cpp-dev nlohmann-json3-dev libssl-dev                   # scenarios, reports, checksums
    libhdf4-alt-dev                                                 # MODIS level 1B; comes with libgdal-dev anyway
    libopenvdb-dev                                                  # optional: flames as .vdb
    libcli11-dev libspdlog-dev libfmt-dev
    libgtest-dev # looked for whenever CMake configures with tests on
)
test_packages=(
    python3-gdal                                 # validator of Cloud-Optimized GeoTIFFs
    python3-spectral python3-satpy python3-hdf4 # readers of native forms: AVIRIS; VIIRS and MODIS
)
bench_packages=(libbenchmark-dev time)
lint_packages=(clang-format clang-tidy)

die() {
    printf 'setup: %s\n' "$*" >&2
    exit 1
}

wanted=()
for group in "${@:-build test}"; do
    # Word splitting is wanted for the default, which is two groups in one string.
    for name in $group; do
        case $name in
            build) wanted+=("${build_packages[@]}") ;;
            test) wanted+=("${test_packages[@]}") ;;
            bench) wanted+=("${bench_packages[@]}") ;;
            lint) wanted+=("${lint_packages[@]}") ;;
            *) die "unknown group '$name'; there are: build test bench lint" ;;
        esac
    done
done

[[ ${PYROSCENE_SKIP_SETUP:-0} != 1 ]] || exit 0
command -v dpkg-query >/dev/null && command -v apt-get >/dev/null || die "this is not a Debian system. Install the counterparts of
  ${wanted[*]}
and set PYROSCENE_SKIP_SETUP=1."

installed=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "${wanted[@]}" 2>/dev/null | awk '$2 == "installed" { print $1 }' || true)
missing=()
for package in "${wanted[@]}"; do
    grep -qxF -- "$package" <<<"$installed" || missing+=("$package")
done
((${#missing[@]})) || exit 0

as_root=()
if ((EUID != 0)); then
    command -v sudo >/dev/null || die "these packages are missing and neither root rights nor sudo are at hand; ask an administrator for
  apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
    # Without a terminal nobody can type a password: fail at once rather than hang.
    [[ -t 0 ]] || as_root=(sudo -n)
    "${as_root[@]}" true || die "sudo was refused; ask an administrator for
  apt-get install --no-install-recommends ${missing[*]}"
fi
apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=120 -o Acquire::Retries=3 "$@"; }

printf 'setup: installing %s\n' "${missing[*]}"
# Strict about unreachable mirrors so that the retry happens, but old package lists may still do for the installation.
update() { apt -qq -o APT::Update::Error-Mode=any update; }
update || { sleep 5 && update; } || echo "setup: the package lists could not be refreshed; trying with those there are" >&2
apt -qq install -y --no-install-recommends "${missing[@]}" >/dev/null || die "apt-get could not install ${missing[*]}; is the package mirror reachable?"
