#include "system/modtran_files.h"

#include <cmath>

#include <fmt/format.h>

#include "base/constants.h"
#include "gis/netcdf_input.h"
#include "radiometry/planck.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

std::vector<double> shipped(const std::string& variable) {
    return gis::read_netcdf_variable(source_folder() / "data/atmosphere/lowtran7_midlatitude_summer_rural23_ground0.nc",
                                     variable)
        .values;
}

/// Rows with ascending wavenumber, rounded as the file prints it.
template <class Row>
std::string rows(const SimulatedRun& run, const Row& row) {
    std::string text;
    for (std::size_t l = run.terms.wavelength_um.size(); l-- > 0;)
        text += row(std::round(1e4 / run.terms.wavelength_um[l]), run.at(l));
    return text;
}

/// W m-2 um-1 -> W cm-2 cm: divided by the square of the wavenumber.
double per_wavenumber(double value, double wavenumber) { return value / (wavenumber * wavenumber); }

double angle_at_sensor_deg(const SimulatedRun& run) {
    constexpr double kEarth_km = 6371.23;
    const double sine = std::sin(run.view_zenith_deg * kDegree_rad) * kEarth_km / (kEarth_km + run.sensor_altitude_km);
    return 180.0 - std::asin(sine) / kDegree_rad;
}

/// MODTRAN counts the sun's angles at the observer (IPARM 2); its vertical leans from that of the target.
double sun_at_sensor_deg(const SimulatedRun& run) {
    const double lean = (run.view_zenith_deg - (180.0 - angle_at_sensor_deg(run))) * kDegree_rad;
    const double sun = run.sun_zenith_deg * kDegree_rad;
    return std::acos(std::cos(lean) * std::cos(sun) -
                     std::sin(lean) * std::sin(sun) * std::cos(run.relative_azimuth_deg * kDegree_rad)) /
           kDegree_rad;
}

}  // namespace

SimulatedRun::Columns SimulatedRun::at(std::size_t l) const {
    static const auto toa_irradiance = shipped("toa_solar_irradiance");
    const double lambda_um = terms.wavelength_um[l], A = albedo, S = terms.spherical_albedo[l];
    const double beam = sun ? terms.direct_normal[l] * std::cos(sun_zenith_deg * kDegree_rad) : 0.0;
    const double dark = beam + (sun ? terms.diffuse[l] : 0.0);  // irradiance over black ground
    const double bounced = (dark + terms.thermal_sky[l]) / (1.0 - A * S);
    Columns c{};
    c.tau = terms.transmittance[l];
    c.thermal = terms.path_thermal[l];
    c.surface = (1.0 - A) * radiometry::planck_radiance(lambda_um, ground_temperature_K) * c.tau;
    c.solar = sun ? terms.path_solar[l] + A * dark / (1.0 - A * S) / kPi * terms.diffuse_transmittance[l] : 0.0;
    c.ground = A / kPi * bounced * c.tau;
    c.direct = A / kPi * beam * c.tau;
    c.total = c.thermal + c.surface + c.solar + c.ground;
    c.toa = toa_irradiance[l];
    return c;
}

SimulatedRun simulate(double sensor_altitude_km, double view_zenith_deg, double sun_zenith_deg, double relative_azimuth_deg,
                      double albedo) {
    static const radiometry::AtmosphereSet set{{radiometry::make_atmosphere_table(shipped)}};
    radiometry::AtmospherePoint point;
    point.conditions.sensor_altitude_agl_m = 1e3 * sensor_altitude_km;
    point.conditions.sun_zenith_rad = sun_zenith_deg * kDegree_rad;
    point.view_zenith_rad = view_zenith_deg * kDegree_rad;
    point.relative_azimuth_rad = relative_azimuth_deg * kDegree_rad;
    return {evaluate(set, point),
            sensor_altitude_km,
            view_zenith_deg,
            sun_zenith_deg,
            relative_azimuth_deg,
            albedo,
            true,
            300.0};
}

std::string tape7_text(const SimulatedRun& run) {
    std::string text = fmt::format("T F 2    2    {}    1    2    2    2    2    2    2    0    0    0{:8.3f}{:7.2f}\n",
                                   run.sun ? 2 : 1, run.ground_temperature_K, run.albedo);
    text += "    1    0    0    0    0    0  23.00000   0.00000   0.00000   0.00000   0.00000\n";
    text += " -99.000 -99.000 -99.000\n   36MIDLATITUDE SUMMER\n";
    text += fmt::format("{:10.5f}{:10.5f}{:10.5f}{:10.5f}{:10.5f}{:10.5f}    0        0.00000\n", run.sensor_altitude_km,
                        0.0, angle_at_sensor_deg(run), 0.0, 0.0, 0.0);
    text += "    2    2    0    0\n";
    text += fmt::format("{:10.5f}{:10.5f}   0.00000   0.00000   0.00000   0.00000   0.00000   0.00000\n",
                        run.relative_azimuth_deg, sun_at_sensor_deg(run));
    text += "     640.0   28700.0      10.0      20.0NW              \n    0\n";
    return text + tape7_table(run);
}

std::string tape7_table(const SimulatedRun& run) {
    std::string text =
        "    FREQ  TOT_TRANS  PTH_THRML  THRML_SCT  SURF_EMIS   SOL_SCAT  SING_SCAT  GRND_RFLT  DRCT_RFLT  TOTAL_RAD  "
        "REF_SOL  "
        "SOL@OBS   DEPTH DIR_EM    TOA_SUN BBODY_T[K]\n";
    text += rows(run, [&](double v, const SimulatedRun::Columns& c) {
        const auto L = [v](double value) { return per_wavenumber(value, v); };
        return fmt::format(
            "{:8.2f}{:11.8f}{:11.4E}           {:11.4E}{:11.4E}{:11.4E}{:11.4E}{:11.4E}{:11.4E}{:9.2E}{:9.2E}"
            "{:8.3f}{:7.4f}{:11.4E}{:11.3f}\n",
            v, c.tau, L(c.thermal), L(c.surface), L(c.solar), 0.0, L(c.ground), L(c.direct), L(c.total), 0.0, 0.0,
            std::min(99.99, -std::log(std::max(c.tau, 1e-40))), 1.0 - run.albedo, L(c.toa), 250.0);
    });
    return text + " -9999.\n";
}

std::string modtran_csv_text(const SimulatedRun& run) {
    std::string text =
        "MODTRAN6 spectral output\nWAVLEN,TOT_TRANS,THRML_EM,THRML_SCT,SURF_EMIS,MULT_SCAT,SING_SCAT,GRND_RFLT,"
        "DRCT_RFLT,TOTAL_RAD,TOA_SUN\n";
    const std::string radiance = "W SR-1 CM-2 / MICRON";
    text += "(MICRON),," + radiance;
    for (int k = 0; k < 7; ++k) text += "," + radiance;
    text += ",W CM-2 / MICRON\n";
    for (std::size_t l = 0; l < run.terms.wavelength_um.size(); ++l) {
        const auto c = run.at(l);
        text +=
            fmt::format("{:.7g},{:.8f},{:.6E},{:.6E},{:.6E},{:.6E},{:.6E},{:.6E},{:.6E},{:.6E},{:.6E}\n",
                        run.terms.wavelength_um[l], c.tau, 0.9e-4 * c.thermal, 0.1e-4 * c.thermal, 1e-4 * c.surface,
                        0.7e-4 * c.solar, 0.3e-4 * c.solar, 1e-4 * c.ground, 1e-4 * c.direct, 1e-4 * c.total, 1e-4 * c.toa);
    }
    return text;
}

std::string modtran_json_text(const SimulatedRun& run) {
    const auto array = [&](const char* name, const auto& value) {
        std::string text = fmt::format("\"{}\": [", name);
        const std::string list =
            rows(run, [&](double v, const SimulatedRun::Columns& c) { return fmt::format("{:.7E},", value(v, c)); });
        return text + list.substr(0, list.size() - 1) + "]";
    };
    using C = const SimulatedRun::Columns&;
    std::string text = fmt::format(
        R"({{"MODTRAN": [{{"MODTRANINPUT": {{"RTOPTIONS": {{"IEMSCT": "RT_SOLAR_AND_THERMAL"}},
 "AEROSOLS": {{"IHAZE": "AER_RURAL", "VIS": 23.0}},
 "GEOMETRY": {{"ITYPE": 2, "H1ALT": {}, "H2ALT": 0.0, "OBSZEN": {}, "IPARM": 2, "PARM1": {}, "PARM2": {}, "IDAY": 0}},
 "SURFACE": {{"SURFTYPE": "REFL_CONSTANT", "SURREF": {}, "GNDALT": 0.0}},
 "SPECTRAL": {{"V1": 650.0, "V2": 28600.0, "DV": 10.0, "FWHM": 20.0, "XFLAG": "W"}}}},
 "MODTRANOUTPUT": {{"SPECTRA": {{"RADIANCE": {{)",
        run.sensor_altitude_km, angle_at_sensor_deg(run), run.relative_azimuth_deg, sun_at_sensor_deg(run), run.albedo);
    text += array("FREQ", [](double v, C) { return v; }) + ",\n";
    text += array("TOT_TRANS", [](double, C c) { return c.tau; }) + ",\n";
    text += array("THRML_EM", [](double v, C c) { return per_wavenumber(c.thermal, v); }) + ",\n";
    text += array("THRML_SCT", [](double, C) { return 0.0; }) + ",\n";
    text += array("SURF_EMIS", [](double v, C c) { return per_wavenumber(c.surface, v); }) + ",\n";
    text += array("MULT_SCAT", [](double v, C c) { return per_wavenumber(c.solar, v); }) + ",\n";
    text += array("SING_SCAT", [](double, C) { return 0.0; }) + ",\n";
    text += array("GRND_RFLT", [](double v, C c) { return per_wavenumber(c.ground, v); }) + ",\n";
    text += array("DRCT_RFLT", [](double v, C c) { return per_wavenumber(c.direct, v); }) + ",\n";
    text += array("TOTAL_RAD", [](double v, C c) { return per_wavenumber(c.total, v); }) + ",\n";
    text += array("TOA_RAD", [](double v, C c) { return per_wavenumber(c.toa, v); }) + "\n";
    return text + "}}}}]}\n";
}

}  // namespace pyroscene::test
