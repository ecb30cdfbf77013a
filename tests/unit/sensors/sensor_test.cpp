#include "sensors/sensor.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "config/yaml.h"
#include "radiometry/planck.h"
#include "sensors/detector.h"
#include "unit/sensors/temporary_file.h"

namespace pyroscene::sensors {
namespace {

struct Moments {
    double area_um = 0.0, centroid_um = 0.0;
};
/// Exact integrals of a polyline.
Moments moments(const Spectrum& s) {
    double area = 0.0, first = 0.0;
    for (std::size_t i = 1; i < s.value.size(); ++i) {
        const double a = s.lambda_um[i - 1], b = s.lambda_um[i], fa = s.value[i - 1], fb = s.value[i];
        area += 0.5 * (b - a) * (fa + fb);
        first += (b - a) / 6.0 * (a * fa + (a + b) * (fa + fb) + b * fb);
    }
    return {area, first / area};
}

/// Wavelengths where the response crosses half of its peak, from below and from above.
std::vector<double> half_power_um(const Spectrum& s) {
    constexpr int kSteps = 200000;
    const double lower = s.lambda_um.front() - 0.1, upper = s.lambda_um.back() + 0.1;
    std::vector<double> inside;
    for (int i = 0; i <= kSteps; ++i) {
        const double lambda_um = lower + (upper - lower) * i / kSteps;
        if (s.at(lambda_um, false) >= 0.5) inside.push_back(lambda_um);
    }
    return {inside.front(), inside.back()};
}

/// The `derived` block of each band was computed independently of this code from the same file.
class ShippedSensor : public testing::TestWithParam<std::string> {};

TEST_P(ShippedSensor, AgreesWithTheDerivedNumbersOfItsFile) {
    const Sensor sensor = load_sensor(GetParam());
    const config::Document document(sensor.source_path);
    if (document.root().has("spectral")) {  // a gaussian has its derived numbers in closed form
        for (const Band& band : sensor.bands) {
            SCOPED_TRACE(band.id);
            const auto [area_um, centroid_um] = moments(band.response);
            EXPECT_NEAR(centroid_um / band.centre_um, 1.0, 1e-6);
            EXPECT_NEAR(area_um / (band.fwhm_um * std::sqrt(M_PI / (4.0 * std::log(2.0)))), 1.0, 1e-3);
            const auto half = half_power_um(band.response);
            EXPECT_NEAR((half[1] - half[0]) / band.fwhm_um, 1.0, 1e-3);
        }
        return;
    }
    const auto nodes = document.root().child("bands").items();
    ASSERT_EQ(sensor.bands.size(), nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Band& band = sensor.bands[i];
        SCOPED_TRACE(band.id);
        const auto derived = nodes[i].child("derived");
        ASSERT_TRUE(derived.present());
        const auto [area_um, centroid_um] = moments(band.response);
        EXPECT_NEAR(centroid_um / derived.number("centroid_um", 0.0), 1.0, 1e-4);
        EXPECT_NEAR(area_um / derived.number("equivalent_width_um", 0.0), 1.0, 1e-4);
        const auto half = half_power_um(band.response), expected_half = derived.numbers("half_power_um", 2);
        EXPECT_NEAR(half[0] / expected_half[0], 1.0, 1e-4);
        EXPECT_NEAR(half[1] / expected_half[1], 1.0, 1e-4);
        const auto planck = derived.child("band_planck_w_m2_sr_um");
        for (const auto& T_K : planck.keys())
            EXPECT_NEAR(radiometry::band_mean_radiance(std::stod(T_K), band.response) / planck.number(T_K, 0.0), 1.0, 2e-3)
                << T_K;
        // Where a file gives radiance and temperature, the radiance holds; `derived` is the other one's.
        const auto saturation = derived.optional_number("saturation_radiance_w_m2_sr_um");
        if (saturation && !nodes[i].child("saturation").has("radiance_w_m2_sr_um")) {
            EXPECT_NEAR(band.saturation_radiance_W_m2_sr_um.value() / *saturation, 1.0, 2e-3);
        }
        if (const auto nedl = derived.optional_number("nedl_w_m2_sr_um")) {
            EXPECT_NEAR(noise_radiance(band, 0.0) / *nedl, 1.0, 2e-3);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Files, ShippedSensor, testing::ValuesIn(sensor_ids()), [](const auto& test) {
    std::string name = test.param;
    std::erase(name, '-');
    return name;
});

TEST(Sensor, WaspIsReadAsItsFileSays) {
    const Sensor wasp = load_sensor("wasp");
    EXPECT_EQ(wasp.id, "wasp");
    EXPECT_EQ(wasp.scan, ScanType::Framing);
    EXPECT_TRUE(wasp.airborne);
    EXPECT_EQ(wasp.altitude_agl_m, 3048.0);
    EXPECT_EQ(wasp.ground_speed_m_s, 65.0);
    const CameraGroup& ir = wasp.group("ir");
    EXPECT_EQ(ir.samples, 640);
    EXPECT_EQ(ir.lines, 512);
    EXPECT_DOUBLE_EQ(ir.focal_length_m, 0.025);
    EXPECT_DOUBLE_EQ(ir.pixel_pitch_m, 25e-6);
    EXPECT_EQ(ir.principal_point_px, (std::array{319.5, 255.5}));
    EXPECT_EQ(wasp.bands_of("ir"), (std::vector{0, 1, 2}));
    EXPECT_EQ(wasp.bands_of("vis"), (std::vector{3, 4, 5}));
    EXPECT_EQ(wasp.band_index("MWIR"), 1);
    EXPECT_EQ(wasp.band_index("TIR"), -1);
    EXPECT_EQ(wasp.psf_across.shape, Psf::Shape::Gaussian);
    EXPECT_EQ(wasp.psf_across.width_samples, 1.1);
    const Band& swir = wasp.bands[0];
    EXPECT_EQ(swir.saturation_radiance_W_m2_sr_um, 100.0);
    EXPECT_EQ(swir.bits, 14);
    EXPECT_EQ(swir.noise.kind, Noise::Kind::SignalToNoise);
    EXPECT_FALSE(swir.noise.at_radiance.has_value());
    EXPECT_DOUBLE_EQ(swir.fwhm_um, 0.8);
    EXPECT_FALSE(wasp.bands[3].saturation_radiance_W_m2_sr_um.has_value());
    EXPECT_EQ(wasp.confidence.front(), (std::array<std::string, 2>{"*", "D"}));
    EXPECT_EQ(wasp.sources.size(), 2u);
}

TEST(Sensor, ImagingSpectrometersHaveNoiseAndSaturationByRule) {
    // 0.0015 uW cm-2 nm-1 sr-1 above 1.85 um; saturation at 1.2 times full sun, about 1.2 x 70 W m-2 um-1 / pi at 2.26 um.
    const Sensor aviris = load_sensor("aviris-classic");
    const Band& swir = aviris.bands[static_cast<std::size_t>(aviris.band_index("200"))];
    EXPECT_NEAR(noise_radiance(swir, 10.0), 0.015, 1e-12);
    EXPECT_NEAR(swir.saturation_radiance_W_m2_sr_um.value(), 1.2 * 70.0 / M_PI, 2.0);
    EXPECT_EQ(swir.bits, 12);
}

TEST(Sensor, GainsAndCountsAreThoseOfTheFiles) {
    const Sensor viirs = load_sensor("viirs-snpp");
    const auto band = [&](const char* id) { return viirs.bands[static_cast<std::size_t>(viirs.band_index(id))]; };
    // M13: high gain to 343 K with 0.107 K at 300 K, low gain to 634 K with 0.423 K at 380 K.
    const Band m13 = band("M13");
    ASSERT_TRUE(m13.sensitive_range.has_value());
    EXPECT_NEAR(radiometry::band_brightness_temperature(m13.sensitive_range->maximum_W_m2_sr_um, m13.response), 343.0, 0.01);
    EXPECT_EQ(m13.sensitive_range->noise.value, 0.107);
    EXPECT_EQ(m13.noise.at_temperature_K, 380.0);
    EXPECT_EQ(band("M01").sensitive_range->maximum_W_m2_sr_um, 155.0);
    EXPECT_EQ(band("I04").fold_over, 8.0);
    EXPECT_FALSE(band("I05").fold_over.has_value());
    EXPECT_NEAR(band("DNB").saturation_radiance_W_m2_sr_um.value(), 500.0, 1e-9);  // 200 W m-2 sr-1 in 0.4 um
    EXPECT_FALSE(band("DNB").bits.has_value());
    // Two exposures 1 : 20, the longer one to 350 K.
    const Sensor hsrs = load_sensor("bird-hsrs");
    const Band& mir = hsrs.bands[static_cast<std::size_t>(hsrs.band_index("MIR"))];
    ASSERT_TRUE(mir.sensitive_range.has_value());
    EXPECT_NEAR(radiometry::band_brightness_temperature(mir.sensitive_range->maximum_W_m2_sr_um, mir.response), 350.0, 0.01);
    EXPECT_NEAR(noise_radiance(mir, 100.0) / noise_radiance(mir, 1.0), 20.0, 1e-9);
    // AVHRR/3: half of 1024 counts below an albedo of 25 % (12.5 % in channel 3A), the other half from there to 100 %.
    const Sensor avhrr = load_sensor("avhrr3-noaa18");
    for (const auto& [id, knee] : {std::pair{"1", 0.25}, {"2", 0.25}, {"3A", 0.125}}) {
        SCOPED_TRACE(id);
        Band quiet = avhrr.bands[static_cast<std::size_t>(avhrr.band_index(id))];
        ASSERT_TRUE(quiet.sensitive_range.has_value());
        const double sunlit = sunlit_radiance(1.0, quiet.response);
        std::vector<float> L{static_cast<float>(0.0997 * sunlit), static_cast<float>(0.6017 * sunlit)};
        std::vector<std::uint8_t> flags(L.size());
        quiet.noise = quiet.sensitive_range->noise = {};
        apply_detector(quiet, {}, L, flags);
        EXPECT_NEAR(L[0] / sunlit, std::round(0.0997 / knee * 512.0) / 512.0 * knee, 1e-6);
        EXPECT_NEAR(L[1] / sunlit, knee + (1.0 - knee) * std::round((0.6017 - knee) / (1.0 - knee) * 512.0) / 512.0, 1e-6);
    }
    const Sensor ols = load_sensor("dmsp-ols");
    EXPECT_EQ(ols.bands.front().bits, 6);
    EXPECT_EQ(ols.bands[static_cast<std::size_t>(ols.band_index("TIR"))].bits, 8);
}

TEST(Sensor, AngularPointSpreadIsDividedByTheStepOfItsAxis) {
    const Sensor aviris = load_sensor("aviris-classic");  // 1 mrad; samples 0.87 mrad apart, lines 1 mrad
    EXPECT_NEAR(aviris.psf_across.width_samples, 1.0 / 0.87, 0.005);
    EXPECT_NEAR(aviris.psf_along.width_samples, 1.0, 1e-12);
}

TEST(Sensor, TheThesisCameraHasNoNoiseNoCountsAndNoBlur) {
    const Sensor thesis = load_sensor("wasp-thesis");
    EXPECT_EQ(thesis.psf_across.shape, Psf::Shape::None);
    for (const Band& band : thesis.bands) {
        EXPECT_EQ(band.noise.kind, Noise::Kind::None);
        EXPECT_FALSE(band.bits.has_value());
        EXPECT_FALSE(band.saturation_radiance_W_m2_sr_um.has_value());
    }
}

TEST(Sensor, ListsShippedSensorsInOrder) {
    const auto ids = sensor_ids();
    EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end()));
    EXPECT_EQ(ids.size(), 40u);
    for (const char* id : {"generic-framing", "wasp", "wasp-thesis", "modis-terra", "aviris-classic", "phoenix", "master"})
        EXPECT_NE(std::find(ids.begin(), ids.end(), id), ids.end()) << id;
}

Sensor sensor_from(const std::string& name, const std::string& text) { return load_sensor(temporary_file(name, text)); }

const std::string kScanner =
    "schema: pyroscene-sensor/1\n"
    "id: scanner\n"
    "platform: {type: airborne, altitude_agl_m: 3000, ground_speed_knots: 200}\n"
    "geometry:\n"
    "  scan_type: line_scanner\n"
    "  groups: {main: {samples_per_line: 716, detectors_along_track: 2, ifov_across_mrad: 2.5, step_across_mrad: 2.0}}\n"
    "digitisation: {bits: 12}\n";

TEST(SensorFile, ReadsMeasuredResponsesScaledToAPeakOfOne) {
    temporary_file("tent.csv", "band,wavelength_um,response\nother,1.0,1.0\nT,3.0,0.0\nT,4.0,0.5\nT,6.0,0.0\n");
    const Sensor s =
        sensor_from("tent.yaml", kScanner +
                                     "psf: {along_scan: {shape: gaussian, fwhm_mrad: 3.0}}\n"
                                     "bands:\n"
                                     "- {id: T, group: all, center_um: 4.0, edges_um: [3.5, 5.0], srf: measured,\n"
                                     "   srf_file: tent.csv, bits: 10, saturation: {temperature_k: 500}}\n");
    ASSERT_EQ(s.bands.size(), 1u);
    EXPECT_EQ(s.bands[0].group, "main");  // "all" = the only group there is
    EXPECT_TRUE(s.bands[0].measured_response);
    EXPECT_EQ(s.bands[0].response.kind, Quantity::Response);
    EXPECT_EQ(s.bands[0].response.value, (std::vector{0.0, 1.0, 0.0}));
    EXPECT_EQ(s.bands[0].bits, 10);
    EXPECT_NEAR(moments(s.bands[0].response).centroid_um, (3.0 + 4.0 + 6.0) / 3.0, 1e-12);  // of a triangle
    EXPECT_DOUBLE_EQ(s.psf_across.width_samples, 1.5);                                      // 3 mrad, samples every 2 mrad
    EXPECT_EQ(s.psf_along.shape, Psf::Shape::None);
    EXPECT_EQ(s.scan, ScanType::LineScanner);
    EXPECT_EQ(s.groups[0].samples, 716);
    EXPECT_EQ(s.groups[0].lines, 2);
    EXPECT_NEAR(s.ground_speed_m_s, 102.9, 0.02);  // sensor-geometry notes: 200 kn
}

TEST(SensorFile, ReadsChannelTablesAsGaussians) {
    temporary_file("channels.csv", "channel,center_um,fwhm_um,flag\n1,0.40,0.010,nominal\n2,0.41,0.012,nominal\n");
    const Sensor s =
        sensor_from("imager.yaml", kScanner + "spectral: {bands_file: channels.csv, srf: gaussian, group: main}\n");
    ASSERT_EQ(s.bands.size(), 2u);
    EXPECT_EQ(s.bands[1].id, "2");
    EXPECT_EQ(s.bands[1].bits, 12);
    EXPECT_DOUBLE_EQ(s.bands[1].fwhm_um, 0.012);
    EXPECT_NEAR(s.bands[1].response.at(0.41), 1.0, 1e-12);
    EXPECT_NEAR(s.bands[1].response.at(0.416), 0.5, 1e-9);  // half of the peak half a width away
    // Area of a gaussian: fwhm sqrt(pi / (4 ln 2)); 0.04 % lies beyond 1.5 widths.
    EXPECT_NEAR(moments(s.bands[1].response).area_um / (0.012 * std::sqrt(M_PI / (4.0 * std::log(2.0)))), 1.0, 1e-3);
}

TEST(SensorFile, TurnsPointSpreadWordsIntoShapes) {
    const std::string bands = "bands: [{id: A, group: main, center_um: 4, edges_um: [3, 5]}]\n";
    const auto across = [&](const std::string& psf) {
        return sensor_from("psf.yaml", kScanner + "psf: {along_scan: " + psf + "}\n" + bands).psf_across;
    };
    EXPECT_EQ(across("{shape: triangle, fwhm_samples: 1.0}").width_samples, 2.0);
    EXPECT_EQ(across("{shape: triangle, fwhm_samples: 1.0, base_samples: 2.5}").width_samples, 2.5);
    EXPECT_EQ(across("{shape: box, width_samples: 1.19}").shape, Psf::Shape::Box);
    const Psf two_boxes = across("{shape: box_conv_box, widths_samples: [1.362, 1.0]}");
    EXPECT_EQ(two_boxes.shape, Psf::Shape::Trapezoid);
    EXPECT_EQ(two_boxes.width_samples, 1.362);
    EXPECT_EQ(two_boxes.second_width_samples, 1.0);
}

}  // namespace
}  // namespace pyroscene::sensors
