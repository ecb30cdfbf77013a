// The page that a run ends with.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>

#include <fmt/format.h>

#include "base/files.h"
#include "drawing/html_page.h"
#include "pipeline/image_digest.h"
#include "system/support.h"

namespace pyroscene::test {
namespace {

/// The file's picture, decoded by the system's own base64.
std::string first_picture(const std::filesystem::path& page, const ScratchFolder& scratch) {
    const auto html = read_text_file(page);
    const std::string mark = "data:image/png;base64,";
    const auto from = html.find(mark) + mark.size();
    write_text_file(scratch / "picture.b64", html.substr(from, html.find('"', from) - from));
    const auto target = scratch / "picture.png";
    EXPECT_EQ(run_command("base64 -d " + (scratch / "picture.b64").string() + " > " + target.string()).exit_code, 0);
    return file_bytes(target);
}

TEST(RunReportPage, HoldsTheRunAndNeedsNothingElse) {
    const ScratchFolder scratch;
    const auto scenario = (source_folder() / "scenarios/minimal/scenario.yaml").string(), out = (scratch / "out").string();
    ASSERT_EQ(pyroscene_cli("-q run " + scenario + " -o " + out).exit_code, 0);
    const auto page = scratch / "out/report.html";
    const auto html = read_text_file(page);
    EXPECT_EQ(html.find("http:"), std::string::npos);
    EXPECT_EQ(html.find("https:"), std::string::npos);
    EXPECT_EQ(html.find("<script"), std::string::npos);
    for (const auto* part : {"Map", "Power over time", "Energy budget", "Warnings", "Spectra of picked pixels", "Histogram",
                             "brightest", "flame", "front", "scar", "background"})
        EXPECT_NE(html.find(part), std::string::npos) << part;
    EXPECT_EQ(first_picture(page, scratch).substr(1, 3), "PNG");

    // The power that the page tells is the sum of the product's pixels.
    const auto power_MW = plane(gis::read_image(scratch / "out/camera_150s/frp.tif"), 1);
    double sum_MW = 0.0;
    for (const double v : power_MW)
        if (std::isfinite(v)) sum_MW += v;
    EXPECT_NE(html.find(fmt::format("<dd>{:.4g} MW</dd>", sum_MW)), std::string::npos) << sum_MW;

    // The radiant fraction follows from the powers beside it: all of soot and gas, and some of the front.
    std::vector<double> row;
    const auto budget_at = html.find("id=\"energy\"");
    const auto table = html.substr(budget_at, html.find("</table>", budget_at) - budget_at);
    const std::regex cell("<td[^>]*>([-0-9.eE+]+)</td>");
    for (std::sregex_iterator i(table.begin(), table.end(), cell), end; i != end; ++i) row.push_back(std::stod((*i)[1]));
    ASSERT_EQ(row.size(), 7U) << table;  // heat, front, soot, gas, scar, fraction in percent, seen
    EXPECT_GT(0.01 * row[5] * row[0], row[2] + row[3]);
    EXPECT_LT(0.01 * row[5] * row[0], row[1] + row[2] + row[3]);

    // The scenario's text is shown as text: its quotes and ampersands are entities.
    EXPECT_NE(html.find(drawing::html_escaped(read_text_file(scenario))), std::string::npos);

    // A second run finds the page done; one that is told to redo the products writes it anew with the same budget of energy.
    const auto written = std::filesystem::last_write_time(page);
    ASSERT_EQ(pyroscene_cli("-q run " + scenario + " -o " + out).exit_code, 0);
    EXPECT_EQ(std::filesystem::last_write_time(page), written);
    ASSERT_EQ(pyroscene_cli("-q products --force " + scenario + " -o " + out).exit_code, 0);
    EXPECT_NE(std::filesystem::last_write_time(page), written);
    const auto budget = [](const std::string& text) {
        const auto from = text.find("id=\"energy\"");
        return text.substr(from, text.find("</table>", from) - from);
    };
    EXPECT_EQ(budget(read_text_file(page)), budget(html));
}

TEST(RunReportPage, IntegratesThePowerThatOneSensorSaw) {
    const ScratchFolder scratch;
    for (const auto* file : {"camera.yaml", "dem.tif", "heat_flux.tif"})
        std::filesystem::copy(source_folder() / "scenarios/minimal" / file, scratch / file);
    auto text = read_text_file(source_folder() / "scenarios/minimal/scenario.yaml");
    const auto from = text.find("acquisitions:");
    text = text.substr(0, from) +
           "acquisitions:\n"
           "  - {id: a, sensor: camera.yaml, time_s: 60, platform: {over: centre, altitude_agl_m: 500}}\n"
           "  - {id: b, sensor: camera.yaml, time_s: 150, platform: {over: centre, altitude_agl_m: 500}}\n"
           "products: [radiance, truth, frp, report]\n";
    write_text_file(scratch / "scenario.yaml", text);
    const auto result =
        pyroscene_cli("-q run " + (scratch / "scenario.yaml").string() + " -o " + (scratch / "out").string());
    ASSERT_EQ(result.exit_code, 0) << result.output;
    double MW[2] = {0.0, 0.0};
    for (int k = 0; k < 2; ++k)
        for (const double v : plane(gis::read_image(scratch / (k == 0 ? "out/a/frp.tif" : "out/b/frp.tif")), 1))
            if (std::isfinite(v)) MW[k] += v;
    const auto html = read_text_file(scratch / "out/report.html");
    EXPECT_NE(html.find(fmt::format("<td>2</td><td>1</td><td>2.5</td><td>{:.4g}</td>", 1e-3 * 90.0 * (MW[0] + MW[1]) / 2.0)),
              std::string::npos)
        << MW[0] << " " << MW[1];
}

TEST(RunReportPage, IsAProductThatCanBeLeftOut) {
    const ScratchFolder scratch;
    for (const auto* file : {"camera.yaml", "dem.tif", "heat_flux.tif"})
        std::filesystem::copy(source_folder() / "scenarios/minimal" / file, scratch / file);
    write_text_file(scratch / "scenario.yaml",
                    read_text_file(source_folder() / "scenarios/minimal/scenario.yaml") + "\nproducts: [radiance]\n");
    const auto out = (scratch / "out").string();
    const auto result = pyroscene_cli("-q run " + (scratch / "scenario.yaml").string() + " -o " + out);
    ASSERT_EQ(result.exit_code, 0) << result.output;
    EXPECT_FALSE(std::filesystem::exists(scratch / "out/report.html"));
}

/// Four pixels in a row with two bands, and their truth.
class Digest : public ::testing::Test {
protected:
    void SetUp() override {
        std::filesystem::create_directories(scratch_ / "a");
        write("radiance", {"1", "2"}, {1, 100, 50, 2, /**/ 3, 40, 80, 4});
        write("truth",
              {"fraction_flame", "fraction_front", "fraction_scar", "fraction_background", "ground_temperature",
               "flame_temperature", "1 radiance_noise_free"},
              {0,      0,   0.5, 0, /**/ 0,   0.9,  0.5, 0,   /**/ 0, 0, 0,    1,
               /**/ 1, 0.1, 0,   0, /**/ 300, 1000, 900, 500, /**/ 0, 0, 1100, 0, /**/ 1, 140, 50, 2});
        write("frp", {"per area", "of the pixel"}, {0, 7, 7, 0, /**/ 0, 1.5, 2.25, std::nanf("")});
    }
    void write(const std::string& stem, const std::vector<std::string>& bands, const std::vector<float>& pixels) {
        gis::OutputRaster out;
        out.cols = 4, out.rows = 1;
        for (const auto& name : bands) out.bands.push_back({name, "1", {}, {}, {{"band_id", name}}});
        gis::write_geotiff(scratch_ / "a" / (stem + ".tif"), out, pixels);
    }
    [[nodiscard]] pipeline::ImageDigest digest() const { return pipeline::digest_image({scratch_ / "a", ""}); }

    ScratchFolder scratch_;
};

TEST_F(Digest, PicksTheRightPixels) {
    const auto d = digest();
    std::map<std::string, int> where;
    for (const auto& p : d.picked) where[p.kind] = p.sample;
    // 100/100 + 40/80 = 1.5 equals 50/100 + 80/80: the tie goes to the pixel with more fire, 0.5 + 0.5 against 0.9.
    EXPECT_EQ(where,
              (std::map<std::string, int>{{"brightest", 2}, {"flame", 2}, {"front", 1}, {"scar", 3}, {"background", 0}}));
    EXPECT_EQ(d.picked[2].radiance_W_m2_sr_um, (std::vector<double>{100, 40}));
    EXPECT_EQ(d.picked[2].arriving_W_m2_sr_um[0], 140.0);
    EXPECT_TRUE(std::isnan(d.picked[2].arriving_W_m2_sr_um[1]));  // the truth does not hold band 2
    EXPECT_EQ(d.fire_pixels, 2U);
    ASSERT_TRUE(d.seen_frp_MW);
    EXPECT_DOUBLE_EQ(*d.seen_frp_MW, 3.75);
    ASSERT_EQ(d.mean_fractions.size(), 4U);
    EXPECT_NEAR(d.mean_fractions[1].second, 0.35, 1e-7);
}

TEST_F(Digest, CountsEveryPixelOnce) {
    for (const auto& band : digest().statistics) {
        double sum = 0.0;
        for (const double count : band.counts) sum += count;
        EXPECT_EQ(sum, 4.0);
        EXPECT_TRUE(std::is_sorted(band.bin_centres.begin(), band.bin_centres.end()));
    }
    EXPECT_EQ(digest().statistics[0].mean, 38.25);
}

TEST(HtmlPage, EscapesWhatItIsTold) {
    EXPECT_EQ(drawing::html_escaped("a<b & \"c\">"), "a&lt;b &amp; &quot;c&quot;&gt;");
    drawing::HtmlPage page("<x>");
    page.table({"<head>"}, {{"<cell>"}});
    EXPECT_EQ(page.text().find("<cell>"), std::string::npos);
    EXPECT_NE(page.text().find("&lt;cell&gt;"), std::string::npos);
}

}  // namespace
}  // namespace pyroscene::test
