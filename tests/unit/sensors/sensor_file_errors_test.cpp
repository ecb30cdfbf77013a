#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/files.h"
#include "sensors/sensor.h"
#include "unit/sensors/temporary_file.h"

namespace pyroscene::sensors {
namespace {

/// The shipped template with one text replaced: what a user's slip looks like.
std::string message_of(const std::string& found, const std::string& replacement) {
    std::string text = read_text_file(sensor_folder() / "specs" / "generic-framing.yaml");
    const auto at = text.find(found);
    EXPECT_NE(at, std::string::npos) << found;
    text.replace(at, found.size(), replacement);
    try {
        static_cast<void>(load_sensor(temporary_file("slip.yaml", text)));
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        return e.what();
    }
    return "accepted";
}

struct Slip {
    const char *name, *found, *replacement;
    const char *place, *problem;  ///< both must be in the message
};
void PrintTo(const Slip& slip, std::ostream* out) { *out << slip.name; }

class SensorFileSlip : public testing::TestWithParam<Slip> {};

TEST_P(SensorFileSlip, IsNamedWithLineAndReason) {
    const Slip& slip = GetParam();
    const std::string message = message_of(slip.found, slip.replacement);
    EXPECT_NE(message.find(slip.place), std::string::npos) << message;
    EXPECT_NE(message.find(slip.problem), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Template, SensorFileSlip,
    testing::Values(
        Slip{"unknown_key", "focal_length_mm: 25.0", "focal_lenght_mm: 25.0", "slip.yaml:15",
             "did you mean 'focal_length_mm'"},
        Slip{"missing_number", "      focal_length_mm: 25.0\n", "", "geometry.groups.main",
             "key 'focal_length_mm' is missing"},
        Slip{"schema", "pyroscene-sensor/1", "pyroscene-sensor/2", "slip.yaml:3", "expected 'pyroscene-sensor/1'"},
        Slip{"scan_type", "scan_type: framing", "scan_type: frame", "slip.yaml:8", "'frame' is none of framing"},
        Slip{"no_groups", "  groups:", "  notes:", "geometry", "key 'groups' is missing"},
        Slip{"edges", "edges_um: [3.4, 4.2]", "edges_um: [4.2, 3.4]", "edges_um", "expected 0 < lower < upper"},
        Slip{"edge_count", "edges_um: [3.4, 4.2]", "edges_um: [3.4]", "edges_um", "expected a list of 2 numbers"},
        Slip{"group", "group: main", "group: mian", "bands[0].group", "no group 'mian' in geometry.groups; there are main"},
        Slip{"twice", "- id: NIR", "- id: RED", "bands[1]", "band 'RED' is given twice"},
        Slip{"noise_kind", "kind: nedt", "kind: netd", "noise.kind",
             "'netd' is none of none, nedt, nedl, snr, snr_at_albedo"},
        Slip{"noise_value", "value_k: 0.05", "value_k: -0.05", "noise.value_k", "found -0.05"},
        Slip{"gain", "saturation: {temperature_k: 1200}",
             "saturation: {temperature_k: 500}\n  dual_gain: {high_gain: {max_temperature_k: 600}}", "dual_gain.high_gain",
             "above the saturation of"},
        Slip{"stray", "psf:\n", "psf:\n  stray: {share: 2, fwhm_samples: 8}\n", "psf.stray.share", "found 2"},
        Slip{"saturation", "temperature_k: 1200", "temperature_k: hot", "saturation.temperature_k", "hot"},
        Slip{"bits", "bits: 14", "bits: 140", "digitisation.bits", "found 140"},
        Slip{"shape", "srf_shape: boxcar", "srf_shape: box", "srf_shape", "'box' is none of boxcar, gaussian"},
        Slip{"no_table", "srf: nominal", "srf: measured", "bands[0]", "key 'srf_file' is missing"},
        Slip{"lost_table", "srf: nominal", "srf: measured\n  srf_file: srf/lost.csv", "bands[0].srf_file", "no such table"},
        Slip{"wide_gaussian", "edges_um: [0.6, 0.68]\n  srf: nominal\n  srf_shape: boxcar",
             "edges_um: [0.1, 1.1]\n  srf: nominal\n  srf_shape: gaussian", "bands[0]", "reaches below 0"},
        Slip{"psf", "shape: gaussian", "shape: gauss", "psf.along_scan.shape", "'gauss' is none of"},
        Slip{"distortion", "k: [0.0, 0.0, 0.0]", "k: [0.0, 0.0]", "distortion.k", "expected a list of 3 numbers"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(SensorFileErrors, AreReportedTogether) {
    const std::string path =
        temporary_file("two.yaml",
                       "schema: pyroscene-sensor/1\nid: two\nplatform: {type: boat}\n"
                       "geometry: {scan_type: framing, groups: {g: {nx: 0, ny: 4, focal_length_mm: 1, pixel_pitch_um: 1}}}\n"
                       "bands: []\n");
    try {
        static_cast<void>(load_sensor(path));
        FAIL() << "accepted";
    } catch (const Error& e) {
        const std::string message = e.what();
        for (const char* part : {"two.yaml:3: platform.type", "two.yaml:4: geometry.groups.g.nx", "at least one band"})
            EXPECT_NE(message.find(part), std::string::npos) << part << " in " << message;
    }
}

TEST(SensorFileErrors, AnUnknownIdNamesTheNearest) {
    try {
        static_cast<void>(load_sensor("wapp"));
        FAIL() << "accepted";
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("did you mean 'wasp'"), std::string::npos) << e.what();
    }
    EXPECT_THROW(static_cast<void>(load_sensor("no/such/file.yaml")), Error);
}

TEST(SensorFileErrors, AnUnknownGroupNamesThoseThereAre) {
    try {
        static_cast<void>(load_sensor("wasp").group("nir"));
        FAIL() << "accepted";
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("it has ir, vis"), std::string::npos) << e.what();
    }
}

}  // namespace
}  // namespace pyroscene::sensors
