// `pyroscene sensors`: outlines of a scenario's images on the ground and pictures of responses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "system/support.h"

namespace pyroscene::test {
namespace {

nlohmann::json footprints(const ScratchFolder& scratch) {
    const auto scenario = (source_folder() / "scenarios/lolo_peak/scanners.yaml").string();
    const auto file = (scratch / "footprints.geojson").string();
    const auto result = pyroscene_cli("sensors --footprint " + scenario + " -o " + file);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return nlohmann::json::parse(std::ifstream(file));
}

TEST(SensorsCommand, PixelsHaveTheSizeThatTheirAnglesGive) {
    const ScratchFolder scratch;
    int nadir = 0, edge = 0, images = 0;
    const auto collection = footprints(scratch);
    for (const auto& feature : collection.at("features")) {
        const auto& p = feature.at("properties");
        if (p.at("kind") == "image") ++images;
        if (p.at("kind") != "pixel" || p.at("sensor") != "phoenix") continue;
        const double zenith_deg = p.at("view_zenith_deg"), across_m = p.at("across_m"), along_m = p.at("along_m");
        const double cosine = std::cos(zenith_deg * 3.14159265358979 / 180.0);
        // IFOV 2.1 mrad square over flat ground: IFOV H / cos along and IFOV H / cos^2 across (Section 5 of the geometry notes);
        // H from the pixel at nadir, which is square.
        if (zenith_deg < 0.1) {
            ++nadir;
            EXPECT_NEAR(across_m / along_m, 1.0, 1e-3);
            EXPECT_NEAR(along_m, 0.0021 * 3000.0, 0.06 * 0.0021 * 3000.0);  // 3000 m above the ground below, not the mean
        } else {
            ++edge;
            EXPECT_NEAR(across_m / along_m, 1.0 / cosine, 3e-3 / cosine);
        }
    }
    EXPECT_EQ(nadir, 3);
    EXPECT_EQ(edge, 6);
    EXPECT_EQ(images, 8);
}

TEST(SensorsCommand, OutlinesHoldTheirPixels) {
    const ScratchFolder scratch;
    const auto collection = footprints(scratch);
    double west = 0.0, east = 0.0, south = 0.0, north = 0.0;
    for (const auto& feature : collection.at("features")) {
        const bool image = feature.at("properties").at("kind") == "image";
        if (image) west = 180.0, east = -180.0, south = 90.0, north = -90.0;
        for (const auto& point : feature.at("geometry").at("coordinates").at(0)) {
            const double lon = point.at(0), lat = point.at(1), slack = image ? 0.0 : 0.02 * (east - west);
            if (image)
                west = std::min(west, lon), east = std::max(east, lon), south = std::min(south, lat),
                north = std::max(north, lat);
            EXPECT_TRUE(lon >= west - slack && lon <= east + slack && lat >= south - slack && lat <= north + slack)
                << feature.at("properties");
        }
    }
}

TEST(SensorsCommand, TellsPixelsAnglesAndCounts) {
    const auto holds = [](const std::string& id, const char* text) {
        const auto output = pyroscene_cli("sensors " + id).output;
        EXPECT_NE(output.find(text), std::string::npos) << text << " not in\n" << output;
    };
    holds("avhrr3-noaa18", "group lac: 2048 samples a line, 1 line a scan, a scan every 0.166667 s, step 0.944 mrad across");
    holds("avhrr3-noaa18", ", 10 bits, finer up to ");
    holds("modis-terra", "group 1km: 1354 samples a line, 10 lines a scan");
    holds("wasp", "group ir: 640 x 512 pixels, focal length 25 mm, pitch 25 um, IFOV 1 mrad");
    holds("viirs-snpp", "folds over beyond ");
}

// The numbers of the text, in the units of their names, for programs.
TEST(SensorsCommand, TellsTheSameAsJson) {
    const auto sensor = [](const std::string& id) {
        return nlohmann::json::parse(pyroscene_cli("sensors " + id + " --json").output);
    };
    const auto avhrr = sensor("avhrr3-noaa18"), lac = avhrr.at("groups").at(0);
    EXPECT_EQ(avhrr.at("orbit").at("height_m"), 833e3);
    EXPECT_EQ(lac.at("samples"), 2048);
    EXPECT_EQ(lac.at("scan").at("law"), "mirror");
    EXPECT_EQ(lac.at("scan").at("lines_per_scan"), 1);
    EXPECT_NEAR(lac.at("scan").at("period_s").get<double>(), 1.0 / 6.0, 1e-9);
    EXPECT_NEAR(lac.at("scan").at("step_across_rad").get<double>(), 0.944e-3, 1e-12);
    EXPECT_NEAR(lac.at("scan").at("step_along_rad").get<double>(), 1.3e-3, 1e-12);
    EXPECT_TRUE(lac.at("ifov_rad").is_null());
    const auto red = avhrr.at("bands").at(0);
    EXPECT_EQ(red.at("bits"), 10);
    EXPECT_EQ(red.at("sensitive_range_share_of_counts"), 0.5);
    EXPECT_EQ(red.at("noise"), (nlohmann::json{{"kind", "snr_at_albedo"}, {"value", 9.0}, {"at_albedo", 0.005}}));
    EXPECT_NEAR(sensor("wasp").at("groups").at(0).at("ifov_rad").get<double>(), 1e-3, 1e-12);
    EXPECT_EQ(sensor("slstr-s3a").at("groups").at(0).at("views").size(), 2U);
    EXPECT_EQ(sensor("viirs-snpp").at("groups").at(0).at("scan").at("zones").at(0).at("positions_per_pixel"), 3);
}

TEST(SensorsCommand, DrawsResponses) {
    const ScratchFolder scratch;
    const auto file = scratch / "responses.png";
    EXPECT_EQ(pyroscene_cli("sensors modis-aqua --plot " + file.string()).exit_code, 0);
    EXPECT_EQ(file_bytes(file).substr(1, 3), "PNG");
}

TEST(SensorsCommand, RefusesWhatDoesNotGoTogether) {
    EXPECT_EQ(pyroscene_cli("sensors --plot x.png").exit_code, 2);
    EXPECT_EQ(pyroscene_cli("sensors wasp -o x").exit_code, 2);
    EXPECT_EQ(pyroscene_cli("sensors wasp --footprint nothing.yaml").exit_code, 2);
    EXPECT_EQ(pyroscene_cli("sensors --footprint nothing.yaml").exit_code, 3);
    EXPECT_EQ(pyroscene_cli("sensors warp").exit_code, 3);
}

}  // namespace
}  // namespace pyroscene::test
