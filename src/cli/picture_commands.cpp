#include "cli/picture_commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/error.h"
#include "drawing/line_plot.h"
#include "drawing/quicklook.h"
#include "gis/image_stream.h"
#include "gis/raster_input.h"

namespace pyroscene::cli {
namespace {

struct PlotOptions {
    std::string csv, x, by, title, x_label, y_label, output;
    std::vector<std::string> y, points;
    std::vector<double> x_range, y_range;
    bool log_x = false, log_y = false;
};

drawing::PlotAxis axis(const std::string& label, bool logarithmic, const std::vector<double>& range) {
    drawing::PlotAxis a{label, logarithmic, {}, {}};
    if (!range.empty()) {
        a.lowest = range[0];
        a.highest = range[1];
    }
    return a;
}

/// One curve per column, or, with --by, per value of that column in the order of the table.
std::vector<drawing::PlotSeries> series_of(const CsvTable& table, const PlotOptions& o) {
    const auto x = table.numbers(o.x);
    std::vector<drawing::PlotSeries> all;
    for (const auto& column : o.y) {
        const auto y = table.numbers(column);
        const bool points = std::find(o.points.begin(), o.points.end(), column) != o.points.end();
        for (std::size_t i = 0; i < x.size(); ++i) {
            const auto label = o.by.empty()
                                   ? (o.y.size() > 1 ? column : "")
                                   : (o.y.size() > 1 ? column + ", " : "") + o.by + " " + table.rows[i][table.column(o.by)];
            // The curves of this column are the last ones.
            auto found = std::find_if(all.begin(), all.end(), [&](const auto& s) { return s.label == label; });
            if (found == all.end()) found = all.insert(all.end(), {label, {}, {}, points});
            found->x.push_back(x[i]);
            found->y.push_back(y[i]);
        }
    }
    return all;
}

void run_plot(const PlotOptions& o, bool quiet) {
    for (const auto& column : o.points)
        if (std::find(o.y.begin(), o.y.end(), column) == o.y.end())
            throw input_error("--points", fmt::format("'{}' is not among the columns of --y", column));
    const auto table = read_csv(o.csv);
    const drawing::LinePlot plot{o.title,
                                 axis(o.x_label.empty() ? o.x : o.x_label, o.log_x, o.x_range),
                                 axis(o.y_label.empty() ? o.y.front() : o.y_label, o.log_y, o.y_range),
                                 series_of(table, o),
                                 900,
                                 480,
                                 {}};
    drawing::write_line_plots(o.output, std::span(&plot, 1));
    if (!quiet) fmt::print("written: {}\n", o.output);
}

void add_plot(CLI::App& app, const bool& quiet) {
    auto o = std::make_shared<PlotOptions>();
    auto* sub = app.add_subcommand("plot", "a diagram (PNG) of columns of a table");
    sub->add_option("CSV", o->csv, "table with one header row")->required();
    sub->add_option("--x", o->x, "column along the axis")->required();
    sub->add_option("--y", o->y, "columns to draw")->required()->delimiter(',');
    sub->add_option("--by", o->by, "column whose values part the rows into curves");
    sub->add_option("--points", o->points, "columns of --y drawn as points")->delimiter(',');
    sub->add_flag("--log-x", o->log_x, "logarithmic axis");
    sub->add_flag("--log-y", o->log_y, "logarithmic axis");
    sub->add_option("--x-range", o->x_range, "low,high (default: those of the values)")->delimiter(',')->expected(2);
    sub->add_option("--y-range", o->y_range, "low,high")->delimiter(',')->expected(2);
    sub->add_option("--title", o->title, "above the diagram");
    sub->add_option("--x-label", o->x_label, "instead of the column's name");
    sub->add_option("--y-label", o->y_label, "instead of the column's name");
    sub->add_option("-o,--output", o->output, "PNG file")->required();
    sub->footer("Example: pyroscene plot scar.csv --x time_s --y temperature_K -o scar.png");
    sub->callback([o, &quiet] { run_plot(*o, quiet); });
}

struct PictureOptions {
    std::string raster, title, output;
    std::vector<int> bands;
    std::vector<std::string> names;
    std::vector<double> range, window;
    bool logarithmic = false;
};

/// The part of a plane that --window asks for: first column, first row, columns, rows.
drawing::QuicklookPanel panel_of(const PictureOptions& o, gis::ImageStream& image, std::size_t k) {
    const auto& info = image.info();
    const int band = o.bands[k];
    if (band < 1 || band > static_cast<int>(info.bands.size()))
        throw input_error(o.raster, fmt::format("has no band {}, it has {}", band, info.bands.size()));
    const auto& about = info.bands[static_cast<std::size_t>(band) - 1];
    const std::vector<int> part =
        o.window.empty() ? std::vector<int>{0, 0, info.cols, info.rows} : std::vector<int>(o.window.begin(), o.window.end());
    if (part[0] < 0 || part[1] < 0 || part[2] < 1 || part[3] < 1 || part[0] + part[2] > info.cols ||
        part[1] + part[3] > info.rows)
        throw input_error("--window", fmt::format("leaves the image of {} x {} pixels", info.cols, info.rows));
    const auto plane = image.read_band(band);
    drawing::QuicklookPanel panel{
        k < o.names.size() ? o.names[k] : about.description, about.unit, part[2], part[3], {}, o.logarithmic, {}, {}};
    for (int row = part[1]; row < part[1] + part[3]; ++row) {
        const auto first = plane.begin() + static_cast<std::ptrdiff_t>(row) * info.cols + part[0];
        panel.values.insert(panel.values.end(), first, first + part[2]);
    }
    if (!o.range.empty()) {
        panel.lowest = o.range[0];
        panel.highest = o.range[1];
    }
    return panel;
}

void run_picture(const PictureOptions& o, bool quiet) {
    if (o.range.size() == 2 && !(o.range[1] > o.range[0])) throw input_error("--range", "low must be below high");
    gis::ImageStream image(o.raster);
    std::vector<drawing::QuicklookPanel> panels;
    for (std::size_t k = 0; k < o.bands.size(); ++k) panels.push_back(panel_of(o, image, k));
    const double pixel_m = image.info().on_map ? gis::make_map_grid(o.raster, {}, {}).cell_m : 0.0;
    drawing::write_quicklook(o.output, o.title, panels, pixel_m);
    if (!quiet) fmt::print("written: {}\n", o.output);
}

void add_picture(CLI::App& app, const bool& quiet) {
    auto o = std::make_shared<PictureOptions>();
    auto* sub = app.add_subcommand("picture", "bands of any raster as a PNG with colour bars");
    sub->add_option("RASTER", o->raster, "any raster that GDAL reads")->required();
    sub->add_option("--bands", o->bands, "from 1, a picture each (default: 1)")->delimiter(',');
    sub->add_option("--names", o->names, "titles of the pictures (default: what the bands are called)")->delimiter(',');
    sub->add_option("--range", o->range, "low,high of the colours (default: from the pixels)")->delimiter(',')->expected(2);
    sub->add_option("--window", o->window, "first column, first row, columns, rows")->delimiter(',')->expected(4);
    sub->add_flag("--log", o->logarithmic, "logarithmic colours");
    sub->add_option("--title", o->title, "above the pictures");
    sub->add_option("-o,--output", o->output, "PNG file")->required();
    sub->footer("Example: pyroscene picture out/minimal/state/t000000120.tif --bands 4 -o temperature.png");
    sub->callback([o, &quiet] {
        if (o->bands.empty()) o->bands = {1};
        run_picture(*o, quiet);
    });
}

}  // namespace

void add_picture_commands(CLI::App& app, const bool& quiet) {
    add_plot(app, quiet);
    add_picture(app, quiet);
}

}  // namespace pyroscene::cli
