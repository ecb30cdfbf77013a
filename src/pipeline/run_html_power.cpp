#include "pipeline/run_html_power.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "analysis/fire_energy.h"
#include "base/csv.h"
#include "drawing/line_plot.h"
#include "gis/raster_output.h"
#include "pipeline/state_file.h"

namespace pyroscene::pipeline {
namespace {

/// Value recorded as energy/<acquisition>/<name>; NaN when it was not.
double energy(const std::map<std::string, double>& values, const std::string& acquisition, const char* name) {
    const auto found = values.find("energy/" + acquisition + "/" + name);
    return found == values.end() ? std::nan("") : found->second;
}

/// Energy that the images of one sensor saw radiated, where there are two or more of different times.
void show_radiative_energy(drawing::HtmlPage& page, const std::vector<ImagePower>& images) {
    std::map<std::string, std::map<double, double>> power_MW;  // by sensor, then by time
    for (const auto& shown : images)
        if (shown.seen_MW) power_MW[shown.instrument][shown.time_s] = *shown.seen_MW;
    std::vector<std::vector<std::string>> rows;
    for (const auto& [sensor, series] : power_MW) {
        if (series.size() < 2) continue;
        std::vector<double> time_s, MW;
        for (const auto& [t_s, power] : series) {
            time_s.push_back(t_s);
            MW.push_back(power);
        }
        rows.push_back({sensor, std::to_string(series.size()), report_number(time_s.front() / 60.0),
                        report_number(time_s.back() / 60.0),
                        report_number(1e-3 * analysis::fire_radiative_energy(time_s, MW).back())});
    }
    if (rows.empty()) return;
    page.table({"fire radiative energy", "images", "from min", "to min", "GJ"}, rows);
    page.paragraph("Seen fire radiative power, integrated over time by trapezoids between images.");
}

}  // namespace

std::string report_number(double value, const char* unit) {
    if (!std::isfinite(value)) return "–";
    return fmt::format("{:.4g}{}{}", value, *unit != '\0' ? " " : "", unit);
}

void show_power(drawing::HtmlPage& page, const inputs::SceneInputs& inputs, const RunOptions& options,
                const RunReport& report, const std::vector<ImagePower>& images) {
    drawing::PlotSeries released{"heat release, frames", {}, {}, false}, radiated{"front and flame radiate", {}, {}, true},
        seen{"fire radiative power seen", {}, {}, true};
    for (const auto& frame : inputs.frames) {
        const auto path = state_path(options.output, frame.time_s);
        const auto metadata = gis::read_metadata(path);
        if (!metadata || !metadata->contains("HEAT_RELEASE_W")) continue;
        released.x.push_back(frame.time_s / 60.0);
        released.y.push_back(1e-6 * parse_number(metadata->at("HEAT_RELEASE_W"), path.string() + ": HEAT_RELEASE_W"));
    }
    const auto values = report.values();
    for (const auto& shown : images) {
        radiated.x.push_back(shown.time_s / 60.0);
        radiated.y.push_back(1e-6 * energy(values, shown.acquisition, "radiant_fraction") *
                             energy(values, shown.acquisition, "heat_release_W"));
        if (!shown.seen_MW) continue;
        seen.x.push_back(shown.time_s / 60.0);
        seen.y.push_back(*shown.seen_MW);
    }
    drawing::LinePlot plot{"",
                           {"minutes after the start", false, {}, {}},
                           {"power [MW]", true, {}, {}},
                           {std::move(released), std::move(radiated), std::move(seen)},
                           900,
                           400,
                           {}};
    const bool any = std::any_of(plot.series.begin(), plot.series.end(), [](const auto& series) {
        return std::any_of(series.y.begin(), series.y.end(), [](double y) { return y > 0.0; });
    });
    if (!any) return;
    page.heading(2, "Power over time", "power");
    page.picture(
        drawing::line_plots_png(std::span(&plot, 1)), "power over time",
        "Heat that the frames release, what front and flame radiate of it, and the fire radiative power that each image "
        "sees (true, without noise and background; less where the image does not hold the whole fire).");
}

void show_energy(drawing::HtmlPage& page, const RunReport& report, const std::vector<ImagePower>& images) {
    const auto values = report.values();
    std::vector<std::vector<std::string>> rows;
    for (const auto& shown : images) {
        const auto& id = shown.acquisition;
        const auto MW = [&](const char* name) { return report_number(1e-6 * energy(values, id, name)); };
        rows.push_back({shown.id, MW("heat_release_W"), MW("front_W"), MW("flame_W"), MW("flame_gas_W"), MW("scar_W"),
                        report_number(100.0 * energy(values, id, "radiant_fraction")),
                        shown.seen_MW ? report_number(*shown.seen_MW) : "–"});
    }
    page.heading(2, "Energy budget", "energy");
    page.table({"image", "heat release MW", "front MW", "flame soot MW", "flame gas MW", "scar MW", "radiant fraction %",
                "seen FRP MW"},
               rows);
    show_radiative_energy(page, images);
    const double heat_J = energy(values, "inputs", "heat_released_J"), fuel_J = energy(values, "inputs", "fuel_heat_J");
    if (std::isfinite(heat_J))
        page.paragraph(fmt::format(
            "Over all frames the heat flux releases {:.4g} GJ{}.", 1e-9 * heat_J,
            std::isfinite(fuel_J) ? fmt::format("; the fuel that burnt holds {:.4g} GJ", 1e-9 * fuel_J) : std::string()));
    page.paragraph(
        "Front and flame: what they emit into all directions, soot as if nothing took it up again. The radiant fraction "
        "counts of the front what its flames let through. Scar: above ambient.");
}

}  // namespace pyroscene::pipeline
