// Band radiances of every shipped sensor on the transport wavelengths of a render, against 1 cm-1.
//   bench_quadrature [--bands] [SENSOR ...]      default: all sensors, one row each; --bands: one row per band
// Exit code 1 when a band is more than 0.5 % off. docs/validation/spectral-quadrature.md holds its output.

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "band_reference.h"
#include "base/error.h"
#include "base/files.h"
#include "gis/netcdf_input.h"

namespace {

using namespace pyroscene;

constexpr double kAllowed = 5e-3;

bool report(const sensors::Sensor& sensor, const std::vector<bench::BandError>& errors, bool every_band) {
    const auto magnitude = [](const bench::BandError& e) { return std::abs(e.worst); };
    int nodes = 0;
    std::size_t off = 0;
    for (const auto& e : errors) {
        nodes += e.nodes;
        off += magnitude(e) > kAllowed ? 1U : 0U;
        if (every_band || magnitude(e) > kAllowed)
            fmt::print("    {} {}: {:.4f} um, {} wavelengths, {:+.3f} %{}\n", sensor.id, e.band->id, e.band->centre_um,
                       e.nodes, 100.0 * e.worst, e.scene < 0 ? "" : fmt::format(" ({})", bench::kReferenceScenes[e.scene]));
    }
    const auto worst = std::max_element(errors.begin(), errors.end(),
                                        [&](const auto& a, const auto& b) { return magnitude(a) < magnitude(b); });
    fmt::print("| {} | {} | {} | {:.1f} | {:.3f} | {} | {:.3f} |\n", sensor.id, errors.size(), nodes,
               static_cast<double>(nodes) / static_cast<double>(errors.size()), 100.0 * magnitude(*worst), worst->band->id,
               worst->band->centre_um);
    std::fflush(stdout);
    return off == 0;
}

int run(int argc, char** argv) {
    bool every_band = false;
    std::vector<std::string> ids;
    for (int i = 1; i < argc; ++i)
        if (std::strcmp(argv[i], "--bands") == 0)
            every_band = true;
        else
            ids.emplace_back(argv[i]);
    if (ids.empty()) ids = sensors::sensor_ids();
    const auto optics = radiometry::load_flame_optics(data_folder() / "optical");
    const auto set = radiometry::make_atmosphere_set(
        "midlatitude_summer", 23.0, 0.0, [](const std::string& file, const std::string& variable) {
            return gis::read_netcdf_variable(data_folder() / "atmosphere" / file, variable).values;
        });
    fmt::print("| sensor | bands | wavelengths | per band | largest error % | band | um |\n|---|---|---|---|---|---|---|\n");
    bool good = true;
    for (const auto& id : ids) {
        const auto sensor = sensors::load_sensor(id);
        good = report(sensor, bench::quadrature_errors(sensor, optics, set), every_band) && good;
    }
    return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& e) {
        fmt::print(stderr, "bench_quadrature: {}\n", e.what());
        return 1;
    }
}
