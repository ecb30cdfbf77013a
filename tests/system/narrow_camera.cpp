#include "system/narrow_camera.h"

#include <cmath>
#include <fstream>

#include "base/files.h"
#include "gis/netcdf_input.h"

namespace pyroscene::test {

void write_narrow_camera(const std::filesystem::path& file) {
    std::ofstream out(file);
    out << R"(schema: pyroscene-sensor/1
id: narrow-camera
name: Narrow camera
platform: {type: airborne, name: generic, altitude_agl_m: 3000, ground_speed_m_s: 30.0}
geometry:
  scan_type: framing
  frame_interval_s: 2.0
  boresight_offset_deg: [0.0, 0.0, 0.0]
  groups:
    main: {nx: 40, ny: 40, focal_length_mm: 60.0, pixel_pitch_um: 60.0, principal_point_px: [19.5, 19.5], distortion: {model: brown, k: [0.0, 0.0, 0.0], p: [0.0, 0.0]}}
psf:
  along_scan: {shape: none}
  along_track: {shape: none}
bands:
)";
    for (const auto& b : kNarrowBands)
        out << "- {id: " << b.id << ", group: main, center_um: " << 0.5 * (b.lower_um + b.upper_um) << ", edges_um: ["
            << b.lower_um << ", " << b.upper_um << "], srf: nominal, srf_shape: boxcar}\n";
}

radiometry::AtmosphereSet shipped_atmosphere(double ground_elevation_m) {
    return radiometry::make_atmosphere_set(
        "midlatitude_summer", 23.0, ground_elevation_m, [](const std::string& file, const std::string& variable) {
            return gis::read_netcdf_variable(data_folder() / "atmosphere" / file, variable).values;
        });
}

double band_mean(
    const radiometry::AtmosphericTerms& air, const Band& band,
    const std::function<double(double lambda_um, const std::function<double(const std::vector<double>&)>&)>& f) {
    constexpr int kSteps = 20000;
    double sum = 0.0;
    std::size_t i = 0;
    for (int s = 0; s < kSteps; ++s) {
        const double lambda_um = band.lower_um + (s + 0.5) * (band.upper_um - band.lower_um) / kSteps;
        while (i + 2 < air.wavelength_um.size() && air.wavelength_um[i + 1] < lambda_um) ++i;
        const double part = (lambda_um - air.wavelength_um[i]) / (air.wavelength_um[i + 1] - air.wavelength_um[i]);
        sum += f(lambda_um, [&](const std::vector<double>& v) { return std::lerp(v[i], v[i + 1], part); });
    }
    return sum / kSteps;
}

}  // namespace pyroscene::test
