#include "pipeline/run_html.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "drawing/html_page.h"
#include "drawing/line_plot.h"
#include "gis/geodesy.h"
#include "gis/raster_output.h"
#include "pipeline/fire_map.h"
#include "pipeline/hash.h"
#include "pipeline/image_digest.h"
#include "pipeline/run_html_power.h"
#include "pipeline/stac.h"
#include "pipeline/state_file.h"

namespace pyroscene::pipeline {
namespace {

constexpr std::size_t kMostImages = 24;
using Json = nlohmann::json;

/// An image with what its files say of it.
struct ShownImage {
    const ReportImage* image = nullptr;
    ImageDigest digest;
    Json item;  ///< STAC

    [[nodiscard]] std::string id() const { return image->acquisition->id + image->files.suffix; }
    [[nodiscard]] double property(const char* name) const {
        return item.value("properties", Json::object()).value(name, std::nan(""));
    }
};

std::string utc(const scenario::Scenario& scenario, double time_s) {
    return UtcTime{scenario.start.unix_s + time_s}.iso8601();
}

std::vector<std::string> fraction_heads(const ImageDigest& digest) {
    std::vector<std::string> names;
    for (const auto& [name, mean] : digest.mean_fractions) names.push_back(name);
    return names;
}

/// Places of at most `most` bands, evenly over all.
std::vector<std::size_t> some_bands(std::size_t count, std::size_t most) {
    std::vector<std::size_t> chosen;
    for (std::size_t k = 0; k < std::min(count, most); ++k)
        chosen.push_back(count <= most ? k : k * (count - 1) / (most - 1));
    return chosen;
}

std::string band_label(const gis::OutputBand& band, std::size_t k) {
    const auto id = band.metadata.find("band_id");
    const auto name = id != band.metadata.end() ? id->second : fmt::format("band {}", k + 1);
    return band.wavelength_um ? fmt::format("{} {:.3g} um", name, *band.wavelength_um) : name;
}

void show_spectra(drawing::HtmlPage& page, const ShownImage& shown) {
    const auto& digest = shown.digest;
    page.heading(4, "Spectra of picked pixels");
    drawing::LinePlot plot{"",
                           {digest.bands.size() > 1 ? "wavelength [um]" : "wavelength [um], one band", false, {}, {}},
                           {"radiance [W m-2 sr-1 um-1]", true, {}, {}},
                           {},
                           900,
                           420,
                           {}};
    const bool arriving = std::all_of(digest.picked.begin(), digest.picked.end(), [](const auto& p) {
        return std::all_of(p.arriving_W_m2_sr_um.begin(), p.arriving_W_m2_sr_um.end(),
                           [](double L) { return std::isfinite(L); });
    });
    for (const auto& p : digest.picked) {
        drawing::PlotSeries series{
            p.kind, {}, arriving ? p.arriving_W_m2_sr_um : p.radiance_W_m2_sr_um, digest.bands.size() == 1};
        for (std::size_t b = 0; b < digest.bands.size(); ++b)
            series.x.push_back(digest.bands[b].wavelength_um.value_or(static_cast<double>(b + 1)));
        plot.series.push_back(std::move(series));
    }
    const bool positive =
        std::any_of(digest.statistics.begin(), digest.statistics.end(), [](const auto& s) { return s.highest > 0.0; });
    if (positive && !plot.series.empty())
        page.picture(drawing::line_plots_png(std::span(&plot, 1)), "spectra of picked pixels of " + shown.id(),
                     arriving
                         ? "Radiance that arrives, before noise and saturation; the table has what the detector reports."
                         : "Radiance as the detector reports it, band by band.");
    std::vector<std::string> head{"pixel", "sample", "line", "longitude", "latitude"};
    for (const auto& name : fraction_heads(digest)) head.push_back(name + " %");
    head.insert(head.end(), {"ground K", "flame K"});
    std::vector<std::vector<std::string>> rows, radiances;
    const auto bands = some_bands(digest.bands.size(), 8);
    std::vector<std::string> radiance_head{"radiance, W m-2 sr-1 um-1"};
    for (const auto b : bands) radiance_head.push_back(band_label(digest.bands[b], b));
    for (const auto& p : digest.picked) {
        rows.push_back({p.kind, std::to_string(p.sample), std::to_string(p.line), fmt::format("{:.5f}", p.longitude_deg),
                        fmt::format("{:.5f}", p.latitude_deg)});
        for (const double f : p.fractions) rows.back().push_back(fmt::format("{:.2f}", 100.0 * f));
        rows.back().push_back(report_number(p.ground_temperature_K));
        rows.back().push_back(report_number(p.flame_temperature_K));
        radiances.push_back({p.kind});
        for (const auto b : bands) {
            const auto limit = digest.bands[b].metadata.find("saturation_radiance");
            constexpr double kRounding = 1e-5;  // the limit is kept in six digits
            const bool clipped = limit != digest.bands[b].metadata.end() &&
                                 p.radiance_W_m2_sr_um[b] >= std::stod(limit->second) * (1.0 - kRounding);
            radiances.back().push_back(report_number(p.radiance_W_m2_sr_um[b]) + (clipped ? " (clipped)" : ""));
        }
    }
    page.table(head, rows);
    page.table(radiance_head, radiances);
}

void show_histogram(drawing::HtmlPage& page, const ShownImage& shown) {
    const auto& digest = shown.digest;
    drawing::LinePlot plot{"", {"radiance [W m-2 sr-1 um-1]", true, {}, {}}, {"pixels", true, 0.8, {}}, {}, 900, 360, {}};
    for (const auto b : some_bands(digest.bands.size(), 4))
        if (!digest.statistics[b].counts.empty())
            plot.series.push_back(
                {band_label(digest.bands[b], b), digest.statistics[b].bin_centres, digest.statistics[b].counts, false});
    page.heading(4, "Histogram");
    if (plot.series.empty()) return page.paragraph("No band holds a radiance above 0.");
    page.picture(drawing::line_plots_png(std::span(&plot, 1)), "histogram of radiance of " + shown.id(),
                 "Pixels per bin of radiance, 80 bins of equal ratio.");
    std::vector<std::vector<std::string>> rows;
    for (const auto b : some_bands(digest.bands.size(), 12)) {
        const auto& s = digest.statistics[b];
        rows.push_back(
            {band_label(digest.bands[b], b), report_number(s.lowest), report_number(s.mean), report_number(s.highest)});
    }
    page.table({"band", "lowest", "mean", "highest, W m-2 sr-1 um-1"}, rows);
}

void show_image(drawing::HtmlPage& page, const scenario::Scenario& scenario, const ShownImage& shown) {
    const auto& image = *shown.image;
    const auto& digest = shown.digest;
    page.heading(3, shown.id(), shown.id());
    page.facts({{"sensor", image.sensor + ", " + image.group},
                {"time", utc(scenario, image.acquisition->time_s)},
                {"after the start", report_number(image.acquisition->time_s / 60.0, "min")},
                {"image", fmt::format("{} x {}, {} band{}", digest.samples, digest.lines, digest.bands.size(),
                                      digest.bands.size() == 1 ? "" : "s")},
                {"pixel on the ground", report_number(shown.property("gsd"), "m")},
                {"view zenith, centre", report_number(shown.property("view:incidence_angle"), "deg")},
                {"sun elevation", report_number(shown.property("view:sun_elevation"), "deg")},
                {"pixels with fire", std::to_string(digest.fire_pixels)},
                {"fire radiative power seen", digest.seen_frp_MW ? report_number(*digest.seen_frp_MW, "MW") : "–"}});
    const auto quicklook = image.files.folder / ("quicklook" + image.files.suffix + ".png");
    if (std::filesystem::exists(quicklook))
        page.picture(read_text_file(quicklook), "quick-look of " + shown.id(), "Quick-look, sensor geometry.");
    if (!digest.mean_fractions.empty()) {
        page.heading(4, "Truth: what the pixels hold");
        std::vector<std::string> row{"mean over the image, %"};
        for (const auto& [name, mean] : digest.mean_fractions) row.push_back(fmt::format("{:.3f}", 100.0 * mean));
        auto head = fraction_heads(digest);
        head.insert(head.begin(), "fraction");
        page.table(head, {row});
    }
    show_spectra(page, shown);
    show_histogram(page, shown);
}

std::vector<MapOutline> footprints(const inputs::SceneInputs& inputs, const std::vector<ShownImage>& images) {
    const gis::MapProjection projection(inputs.grid.crs_wkt);
    std::vector<MapOutline> outlines;
    for (const auto& shown : images) {
        const auto geometry = shown.item.value("geometry", Json::object());
        if (!geometry.contains("coordinates") || geometry["coordinates"].empty()) continue;
        MapOutline outline{shown.id(), {}};
        for (const auto& point : geometry["coordinates"][0])
            outline.ring_xy_m.push_back(projection.to_map(point.at(1).get<double>(), point.at(0).get<double>()));
        const auto same = std::find_if(outlines.begin(), outlines.end(), [&](const auto& other) {
            return std::equal(
                other.ring_xy_m.begin(), other.ring_xy_m.end(), outline.ring_xy_m.begin(), outline.ring_xy_m.end(),
                [&](const auto& a, const auto& b) { return std::hypot(a[0] - b[0], a[1] - b[1]) < inputs.grid.cell_m; });
        });
        if (same == outlines.end())
            outlines.push_back(std::move(outline));
        else
            same->label += ", " + outline.label;
    }
    return outlines;
}

void show_map(drawing::HtmlPage& page, const scenario::Scenario& scenario, const inputs::SceneInputs& inputs,
              const RunOptions& options, const std::vector<ShownImage>& images) {
    double time_s = images.front().image->acquisition->time_s;
    for (const auto& shown : images) time_s = std::max(time_s, shown.image->acquisition->time_s);
    const auto frame = inputs.frames[inputs::frame_at(inputs.frames, time_s, images.front().image->acquisition->id)].time_s;
    const auto path = state_path(options.output, frame);
    if (!std::filesystem::exists(path)) return;
    const auto state = read_state(path, inputs.grid, inputs.arrival_time_s);
    page.heading(2, "Map", "map");
    page.picture(
        fire_map_png(inputs.terrain_m, state, footprints(inputs, images)), "map of the fire",
        fmt::format("The fire at {} ({:.0f} s after the start) on shaded terrain, with the ground that the images see.",
                    utc(scenario, frame), frame));
}

void show_overview(drawing::HtmlPage& page, const scenario::Scenario& scenario, const inputs::SceneInputs& inputs,
                   const std::vector<ShownImage>& images, const RunReport& report) {
    page.paragraph((scenario.title.empty() ? std::string() : scenario.title + ". ") +
                   "Synthetic images of a simulated wildland fire, made by Pyroscene.");
    std::vector<std::pair<std::string, std::string>> links{{"Map", "#map"}, {"Power", "#power"}, {"Energy", "#energy"}};
    for (const auto& shown : images) links.emplace_back(shown.id(), "#" + shown.id());
    links.emplace_back("run.json", "run.json");
    page.links(links);
    page.facts({{"start of the fire", scenario.start.iso8601()},
                {"physics", scenario.physics == fire::Physics::Thesis ? "thesis" : "default"},
                {"atmosphere", scenario.atmosphere.model},
                {"map", fmt::format("{} x {} cells of {:.4g} m", inputs.grid.cols, inputs.grid.rows, inputs.grid.cell_m)},
                {"centre", fmt::format("{:.4f}, {:.4f}", inputs.centre.lat_deg, inputs.centre.lon_deg)},
                {"frames", std::to_string(inputs.frames.size())},
                {"images", std::to_string(images.size())},
                {"program", "pyroscene " + version()}});
    page.heading(2, "Warnings");
    const auto warnings = report.warnings();
    if (warnings.empty()) page.paragraph("None.");
    for (const auto& warning : warnings) page.notice(warning);
}

}  // namespace

void write_html_report(const scenario::Scenario& scenario, const inputs::SceneInputs& inputs,
                       const std::vector<ReportImage>& images, const RunOptions& options, const RunReport& report) {
    if (images.empty()) return;
    const auto path = options.output / "report.html";
    std::string prints;
    for (const auto& image : images) prints += image.fingerprint + image.files.suffix;
    const auto fingerprint = sha256(prints).substr(0, 32);
    if (!options.force && std::filesystem::exists(path) &&
        read_text_file(path).find("name=\"fingerprint\" content=\"" + fingerprint + "\"") != std::string::npos)
        return;
    std::vector<ShownImage> shown;
    for (const auto& image : images) {
        std::ifstream item(stac_item_path(image.files));
        auto json = Json::parse(item, nullptr, false);
        shown.push_back({&image, digest_image(image.files), json.is_discarded() ? Json::object() : std::move(json)});
    }
    drawing::HtmlPage page(scenario.name, {{"generator", "pyroscene " + version()}, {"fingerprint", fingerprint}});
    show_overview(page, scenario, inputs, shown, report);
    show_map(page, scenario, inputs, options, shown);
    std::vector<ImagePower> powers;
    for (const auto& s : shown)
        powers.push_back({s.id(), s.image->acquisition->id, s.image->sensor + ", " + s.image->group,
                          s.image->acquisition->time_s, s.digest.seen_frp_MW});
    show_power(page, inputs, options, report, powers);
    show_energy(page, report, powers);
    page.heading(2, "Images");
    for (std::size_t k = 0; k < std::min(shown.size(), kMostImages); ++k) show_image(page, scenario, shown[k]);
    if (shown.size() > kMostImages)
        page.paragraph(fmt::format("{} more images are in the tables above only.", shown.size() - kMostImages));
    page.open_details("The scenario file");
    page.preformatted(read_text_file(scenario.path));
    page.close_details();
    write_text_file(path, page.text());
}

}  // namespace pyroscene::pipeline
