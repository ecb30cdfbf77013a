// The scenarios that ship, end to end.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

#include "base/csv.h"
#include "gis/raster_input.h"
#include "pipeline/run.h"
#include "radiometry/planck.h"
#include "render/scene.h"
#include "scenario/scenario.h"
#include "sensors/sensor.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

std::filesystem::path scenario_file(const std::string& folder, const std::string& file = "scenario.yaml") {
    return source_folder() / "scenarios" / folder / file;
}

/// Runs a scenario in this process.
void run_in(const std::filesystem::path& scenario, const std::filesystem::path& output, int threads = 2) {
    pipeline::RunOptions options;
    options.output = output;
    options.threads = threads;
    RunReport report;
    pipeline::run(scenario::load(scenario), options, report);
}

std::string first_acquisition(const std::string& folder) {
    return scenario::load(scenario_file(folder)).acquisitions.front().id;
}

TEST(Minimal, WritesEverythingTheContractNames) {
    const ScratchFolder scratch;
    run_in(scenario_file("minimal"), scratch / "out");
    const auto acquisition = scratch / "out" / first_acquisition("minimal");
    for (const char* file : {"radiance.tif", "geolocation.tif", "truth.tif", "brightness_temperature.tif", "fractions.tif",
                             "frp.tif", "ortho_radiance.tif", "ortho_brightness_temperature.tif", "quicklook.png",
                             "item.json", "fire_pixels.geojson", "perimeter.geojson"})
        EXPECT_TRUE(std::filesystem::exists(acquisition / file)) << file;
    EXPECT_TRUE(std::filesystem::exists(scratch / "out" / "run.json"));
    EXPECT_TRUE(std::filesystem::exists(scratch / "out" / "catalog.json"));
    for (const auto& entry : std::filesystem::recursive_directory_iterator(scratch.path())) {
        const auto name = entry.path().filename().string();
        EXPECT_EQ(name.find(".part"), std::string::npos) << name;
        EXPECT_FALSE(name.ends_with(".aux.xml")) << name;
    }
}

TEST(Check, TellsTheSizeOfTheFilesAndWhatMayNotBeMeant) {
    const ScratchFolder scratch;
    std::ofstream(scratch / "late.yaml") << fmt::format(R"(pyroscene: 1
inputs: {{terrain: {{file: {0}/dem.tif}}, heat_flux: {{file: {0}/heat_flux.tif}}}}
start: 2021-08-12T20:00:00Z
products: [radiance, truth]
acquisitions:
  - {{id: now, sensor: {0}/camera.yaml, time_s: 150, platform: {{over: centre, altitude_agl_m: 300}}}}
  - {{id: late, sensor: {0}/camera.yaml, time_s: 5000, platform: {{over: centre, altitude_agl_m: 300}}}}
)",
                                                        (source_folder() / "scenarios" / "minimal").string());
    const auto result = pipeline::check(scenario::load(scratch / "late.yaml"));
    EXPECT_TRUE(result.problems.empty());
    ASSERT_EQ(result.warnings.size(), 1U);
    EXPECT_EQ(result.warnings[0],
              "acquisition 'late' is 4880 s after the last frame (120 s): what burned then still flames in it");
    run_in(scratch / "late.yaml", scratch / "out");
    double bytes = 0.0;
    for (const char* file : {"radiance.tif", "truth.tif", "geolocation.tif"}) {
        const auto image = gis::read_image(scratch / "out" / "now" / file);
        bytes += static_cast<double>(image.pixels.size()) * (std::string(file) == "geolocation.tif" ? 8.0 : 4.0);
    }
    EXPECT_NE(
        result.summary.find(fmt::format("radiance, geolocation and truth of {:.2g} MB before compression", 1e-6 * bytes)),
        std::string::npos)
        << result.summary << bytes;
}

TEST(Minimal, TermsSumToTheTotalAndFractionsToOne) {
    const ScratchFolder scratch;
    run_in(scenario_file("minimal"), scratch / "out");
    const auto truth = gis::read_image(scratch / "out" / first_acquisition("minimal") / "truth.tif");
    const std::size_t n = plane(truth, 0).size();
    std::size_t compared = 0;
    for (std::size_t b = 0; b < truth.bands.size(); ++b) {
        const auto& description = truth.bands[b].description;
        const auto tail = description.find(" radiance_noise_free");
        if (tail == std::string::npos) continue;
        const auto total = plane(truth, b);
        std::vector<double> sum(n, 0.0);
        for (const std::string term : render::kTermNames) {
            if (term == "smoke_emission" || term == "smoke_scattering") continue;  // no plume here
            const auto values = plane(truth, band_named(truth, description.substr(0, tail) + " term_" + term));
            for (std::size_t i = 0; i < n; ++i) sum[i] += values[i];
        }
        for (std::size_t i = 0; i < n; ++i) {
            if (std::isnan(total[i])) continue;
            ASSERT_NEAR(sum[i], total[i], 1e-6 * total[i] + 1e-12) << description << " pixel " << i;
            ++compared;
        }
    }
    EXPECT_GT(compared, n / 2);
    for (std::size_t i = 0; i < n; ++i) {
        double sum = 0.0;
        for (std::size_t b = 0; b < 5; ++b) sum += truth.pixels[b * n + i];
        if (!std::isnan(sum)) {
            ASSERT_NEAR(sum, 1.0, 2e-6) << i;
        }
    }
}

TEST(Minimal, SameBytesForAnyNumberOfThreads) {
    const ScratchFolder scratch;
    run_in(scenario_file("minimal"), scratch / "one", 1);
    run_in(scenario_file("minimal"), scratch / "two", 2);
    const auto id = first_acquisition("minimal");
    std::size_t compared = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(scratch / "one")) {
        const auto relative = std::filesystem::relative(entry.path(), scratch / "one");
        const auto extension = relative.extension();
        if (extension != ".tif") continue;
        // Pixels, not files: a sensor-geometry file names the absolute path of its geolocation.
        const auto a = gis::read_image(entry.path()), b = gis::read_image(scratch / "two" / relative);
        ASSERT_EQ(a.pixels.size(), b.pixels.size());
        EXPECT_EQ(std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(double)), 0) << relative;
        ++compared;
    }
    EXPECT_GT(compared, 5U);
    EXPECT_EQ(file_bytes(scratch / "one" / id / "quicklook.png"), file_bytes(scratch / "two" / id / "quicklook.png"));
}

TEST(Minimal, FinishedOutputsAreSkippedAndChangesRedone) {
    const ScratchFolder scratch;
    std::filesystem::copy(source_folder() / "scenarios" / "minimal", scratch / "minimal",
                          std::filesystem::copy_options::recursive);
    const auto file = scratch / "minimal/scenario.yaml";
    const auto counters_of = [&] {
        pipeline::RunOptions options;
        options.output = scratch / "out";
        RunReport report;
        pipeline::run(scenario::load(file), options, report);
        return report.counters();
    };
    auto first = counters_of();
    EXPECT_GT(first["states_made"], 0);
    EXPECT_GT(first["images_made"], 0);
    auto again = counters_of();
    EXPECT_EQ(again["states_made"], 0);
    EXPECT_EQ(again["images_made"], 0);
    EXPECT_GT(again["images_skipped"], 0);
    EXPECT_EQ(again["product_sets_made"], 0);
    // Another seed changes the noise, not the fire.
    std::string text = file_bytes(file);
    const auto seed = text.find("\nseed:");
    if (seed != std::string::npos) text.erase(seed + 1, text.find('\n', seed + 1) - seed);
    std::ofstream(file) << text << "\nseed: 4711\n";
    auto other = counters_of();
    EXPECT_GT(other["images_made"], 0);
}

TEST(Furnace, EveryPixelReadsPlanck) {
    const ScratchFolder scratch;
    run_in(scenario_file("furnace"), scratch / "out");
    const auto scene = scenario::load(scenario_file("furnace"));
    for (const auto& a : scene.acquisitions) {
        const auto truth = gis::read_image(scratch / "out" / a.id / "truth.tif");
        const auto sensor = sensors::load_sensor(a.sensor);
        std::size_t checked = 0;
        for (const auto& band : sensor.bands) {
            std::size_t b = truth.bands.size();
            for (std::size_t i = 0; i < truth.bands.size(); ++i)
                if (truth.bands[i].description == band.id + " radiance_noise_free") b = i;
            if (b == truth.bands.size()) continue;
            const double expected = radiometry::band_mean_radiance(1000.0, band.response);
            for (const double v : plane(truth, b)) {
                ASSERT_NEAR(v / expected, 1.0, 1e-5) << band.id;
                ++checked;
            }
        }
        EXPECT_GT(checked, 1000U);
    }
}

// Counts of cells above 1000 W/m2 as the README of the data set lists them.
TEST(ThesisGrassfire, FrontCellsPerFrame) {
    const ScratchFolder scratch;
    pipeline::RunOptions options;
    options.output = scratch / "out";
    RunReport report;
    pipeline::prepare(scenario::load(scenario_file("thesis_grassfire")), options, report);
    const std::vector<std::pair<int, int>> expected{{0, 40},      {960, 434},   {1800, 781},  {3000, 1564},
                                                    {3672, 1478}, {3678, 1480}, {3690, 1477}, {3702, 1465},
                                                    {3714, 1453}, {3816, 1393}, {3996, 1300}, {4440, 1201}};
    for (const auto& [time_s, cells] : expected) {
        const auto state = gis::read_image(scratch / "out" / "state" / fmt::format("t{:09d}.tif", time_s));
        const auto labels = plane(state, 0);
        EXPECT_EQ(std::count(labels.begin(), labels.end(), 1.0), cells) << time_s << " s";
    }
}

// The brightest MWIR pixel of the thesis, 0.459 W cm-2 sr-1 um-1, is a blackbody at 1100 K seen without air.
TEST(ThesisGrassfire, PeakOfTheMidwaveBand) {
    const ScratchFolder scratch;
    run_in(scenario_file("thesis_grassfire", "scenario_thesis.yaml"), scratch / "out");
    const auto scene = scenario::load(scenario_file("thesis_grassfire", "scenario_thesis.yaml"));
    const auto truth = gis::read_image(scratch / "out" / scene.acquisitions.front().id / "truth.tif");
    double peak = 0.0;
    for (const double v : plane(truth, band_named(truth, "MWIR radiance_noise_free")))
        if (!std::isnan(v)) peak = std::max(peak, v);
    EXPECT_NEAR(peak * 1e-4, 0.459, 0.02 * 0.459);
}

}  // namespace
}  // namespace pyroscene::test
