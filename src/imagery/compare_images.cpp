#include "imagery/compare_images.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/files.h"
#include "drawing/html_page.h"
#include "drawing/quicklook.h"
#include "gis/image_stream.h"
#include "gis/raster_input.h"

namespace pyroscene::imagery {
namespace {

struct Pair {
    int synthetic = 0, real = 0;
};

std::vector<Pair> pairs_of(const CompareJob& job, const gis::ImageInfo& a, const gis::ImageInfo& b) {
    const auto knows = [](const gis::ImageInfo& image) {
        return std::all_of(image.bands.begin(), image.bands.end(),
                           [](const auto& band) { return band.wavelength_um.has_value(); });
    };
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < a.bands.size(); ++i) {
        if (!knows(a) || !knows(b)) {
            if (i < b.bands.size()) pairs.push_back({static_cast<int>(i) + 1, static_cast<int>(i) + 1});
            continue;
        }
        double nearest_um = std::numeric_limits<double>::infinity();
        Pair best;
        for (std::size_t j = 0; j < b.bands.size(); ++j) {
            const double apart_um = std::abs(*a.bands[i].wavelength_um - *b.bands[j].wavelength_um);
            const double width_um = std::max(
                {a.bands[i].fwhm_um.value_or(0.0), b.bands[j].fwhm_um.value_or(0.0), 0.02 * *a.bands[i].wavelength_um});
            if (apart_um > 0.5 * width_um || apart_um >= nearest_um) continue;
            nearest_um = apart_um;
            best = {static_cast<int>(i) + 1, static_cast<int>(j) + 1};
        }
        if (best.real > 0) pairs.push_back(best);
    }
    if (pairs.empty())
        throw input_error(job.real.string(),
                          fmt::format("no band at a wavelength of {}", job.synthetic.filename().string()));
    return pairs;
}

/// A size that the Fourier transform likes, and even: phaseCorrelate() is off by half a pixel at odd sizes.
int even_size(int n) {
    int size = cv::getOptimalDFTSize(n);
    while (size % 2 != 0) size = cv::getOptimalDFTSize(size + 1);
    return size;
}

/// The plane as OpenCV sees it: the mean where there is no data in either image, both to the same rank scale.
cv::Mat registrable(const std::vector<float>& plane, const std::vector<float>& other, int cols, int rows) {
    cv::Mat out = cv::Mat::zeros(even_size(rows), even_size(cols), CV_64FC1);
    double sum = 0.0, squares = 0.0;
    std::int64_t count = 0;
    for (std::size_t i = 0; i < plane.size(); ++i) {
        if (!std::isfinite(plane[i]) || !std::isfinite(other[i])) continue;
        sum += static_cast<double>(plane[i]);
        squares += static_cast<double>(plane[i]) * static_cast<double>(plane[i]);
        ++count;
    }
    const double mean = count > 0 ? sum / static_cast<double>(count) : 0.0;
    const double sd = count > 0 ? std::sqrt(std::max(squares / static_cast<double>(count) - mean * mean, 1e-300)) : 1.0;
    for (std::size_t i = 0; i < plane.size(); ++i) {
        const bool valid = std::isfinite(plane[i]) && std::isfinite(other[i]);
        // The arc tangent keeps saturated or very bright pixels from being all that counts.
        out.at<double>(static_cast<int>(i) / cols, static_cast<int>(i) % cols) =
            valid ? std::atan((static_cast<double>(plane[i]) - mean) / sd) : 0.0;
    }
    return out;
}

struct Shift {
    double dx = 0.0, dy = 0.0, response = 0.0;  ///< pixels, to the east and south
};

/// Repeated on the moved image: what has no data in either stays in place and pulls a single estimate towards zero.
Shift find_shift(const std::vector<float>& synthetic, const std::vector<float>& real, int cols, int rows) {
    constexpr int kMostRounds = 8;
    constexpr double kSmall = 0.01;  // pixels
    Shift shift;
    for (int round = 0; round < kMostRounds; ++round) {
        const auto moved = analysis::shifted(real, cols, rows, shift.dx, shift.dy);
        const cv::Mat a = registrable(synthetic, moved, cols, rows), b = registrable(moved, synthetic, cols, rows);
        cv::Mat window;
        cv::createHanningWindow(window, a.size(), CV_64F);
        const cv::Point2d found = cv::phaseCorrelate(b, a, window, &shift.response);
        shift.dx += found.x;
        shift.dy += found.y;
        if (std::hypot(found.x, found.y) < kSmall) break;
    }
    return shift;
}

/// Otsu's threshold on a scale of 256 steps between the extremes.
double otsu(const std::vector<float>& plane) {
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (const float v : plane) {
        if (!std::isfinite(v)) continue;
        low = std::min(low, v);
        high = std::max(high, v);
    }
    if (!(high > low)) return static_cast<double>(high);
    std::vector<unsigned char> grey;
    for (const float v : plane)
        if (std::isfinite(v)) grey.push_back(static_cast<unsigned char>(255.0F * (v - low) / (high - low)));
    cv::Mat out;
    const double step = cv::threshold(cv::Mat(1, static_cast<int>(grey.size()), CV_8UC1, grey.data()), out, 0, 255,
                                      cv::THRESH_BINARY | cv::THRESH_OTSU);
    return static_cast<double>(low) + (step + 1.0) / 255.0 * static_cast<double>(high - low);
}

std::vector<unsigned char> above(const std::vector<float>& plane, const std::vector<float>& other, double threshold) {
    std::vector<unsigned char> mask;
    for (std::size_t i = 0; i < plane.size(); ++i)
        mask.push_back(std::isfinite(other[i]) && static_cast<double>(plane[i]) >= threshold ? 1 : 0);
    return mask;
}

nlohmann::ordered_json number(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json scores_json(const CompareJob& job, const CompareReport& report) {
    nlohmann::ordered_json json = {{"synthetic", job.synthetic.string()},
                                   {"real", job.real.string()},
                                   {"pixel_m", report.pixel_m},
                                   {"shift_east_m", report.shift_east_m},
                                   {"shift_north_m", report.shift_north_m},
                                   {"registration_response", report.registration_response},
                                   {"shift_believed", report.shift_believed},
                                   {"bands", nlohmann::ordered_json::array()}};
    for (const auto& band : report.bands) {
        const auto& a = band.agreement;
        json["bands"].push_back({{"name", band.name},
                                 {"unit", band.unit},
                                 {"synthetic_band", band.synthetic_band},
                                 {"real_band", band.real_band},
                                 {"pixels", a.pixels},
                                 {"mean_synthetic", a.mean_a},
                                 {"mean_real", a.mean_b},
                                 {"bias", a.bias},
                                 {"rmse", a.rmse},
                                 {"mean_absolute_difference", a.mae},
                                 {"correlation", a.correlation},
                                 {"ssim", number(a.ssim)},
                                 {"fire_threshold", band.threshold},
                                 {"fire_dice", band.fire.dice},
                                 {"fire_pixels_both", band.fire.both},
                                 {"fire_pixels_synthetic_only", band.fire.only_a},
                                 {"fire_pixels_real_only", band.fire.only_b},
                                 {"front_distance_mean_m", number(band.fire.front_distance_mean * report.pixel_m)},
                                 {"front_distance_95_percent_m", number(band.fire.front_distance_95 * report.pixel_m)}});
    }
    return json;
}

std::string report_html(const CompareJob& job, const CompareReport& report, const std::string& picture) {
    drawing::HtmlPage page("Synthetic against real");
    page.facts({{"synthetic", job.synthetic.filename().string()},
                {"real", job.real.filename().string()},
                {"pixel", fmt::format("{:.4g} m", report.pixel_m)},
                {"real image moved east", fmt::format("{:.2f} m", report.shift_east_m)},
                {"real image moved north", fmt::format("{:.2f} m", report.shift_north_m)},
                {"registration (correlation peak)", fmt::format("{:.3f}", report.registration_response)}});
    if (!report.shift_believed)
        page.notice("A shift larger than allowed was found and not believed: the images are compared as they lie.");
    std::vector<std::vector<std::string>> agreement, fire;
    for (const auto& b : report.bands) {
        const auto& a = b.agreement;
        const auto name = fmt::format("{} [{}]", b.name, b.unit);
        agreement.push_back({name, fmt::format("{}", a.pixels), fmt::format("{:.5g}", a.mean_a),
                             fmt::format("{:.5g}", a.mean_b), fmt::format("{:.4g}", a.bias), fmt::format("{:.4g}", a.rmse),
                             fmt::format("{:.4g}", a.mae), fmt::format("{:.4f}", a.correlation),
                             fmt::format("{:.4f}", a.ssim)});
        fire.push_back({name, fmt::format("{:.4g}", b.threshold), fmt::format("{}", b.fire.both),
                        fmt::format("{}", b.fire.only_a), fmt::format("{}", b.fire.only_b),
                        fmt::format("{:.4f}", b.fire.dice),
                        fmt::format("{:.4g}", b.fire.front_distance_mean * report.pixel_m),
                        fmt::format("{:.4g}", b.fire.front_distance_95 * report.pixel_m)});
    }
    page.heading(2, "Agreement of values");
    page.table(
        {"band", "pixels", "mean synthetic", "mean real", "bias", "RMSE", "mean abs. difference", "correlation", "SSIM"},
        agreement);
    page.heading(2, "Agreement of fire masks");
    page.table({"band", "threshold", "both", "synthetic only", "real only", "Dice", "front distance, mean m", "95 % m"},
               fire);
    page.heading(2, "Pictures");
    page.picture(picture, "synthetic, real and their difference", "Synthetic, real (registered) and synthetic - real.");
    return page.text();
}

}  // namespace

CompareReport compare_images(const CompareJob& job) {
    const gis::ImageStream synthetic(job.synthetic), real(job.real);
    if (!synthetic.info().on_map) throw input_error(job.synthetic.string(), "is not on a map; give an ortho product");
    const MapGrid grid = gis::make_map_grid(job.synthetic, {}, {});
    const auto pairs = pairs_of(job, synthetic.info(), real.info());
    const auto read = [&](const std::filesystem::path& file, int band, const gis::OutputBand& like) {
        return gis::read_band(
                   {file, band, gis::Resampling::Bilinear, like.description.empty() ? "image" : like.description, like.unit},
                   grid)
            .values;
    };
    CompareReport report;
    report.pixel_m = grid.cell_m;
    std::vector<std::vector<float>> a, b;
    for (const Pair& pair : pairs) {
        const auto& like = synthetic.info().bands[static_cast<std::size_t>(pair.synthetic) - 1];
        a.push_back(read(job.synthetic, pair.synthetic, like));
        b.push_back(read(job.real, pair.real, like));
    }
    if (job.register_images) {
        const Shift shift = find_shift(a.back(), b.back(), grid.cols, grid.rows);
        report.registration_response = shift.response;
        report.shift_believed = std::hypot(shift.dx, shift.dy) <= job.largest_shift * std::min(grid.cols, grid.rows);
        if (report.shift_believed) {
            report.shift_east_m = shift.dx * grid.cell_m;
            report.shift_north_m = -shift.dy * grid.cell_m;
            for (auto& plane : b) plane = analysis::shifted(plane, grid.cols, grid.rows, shift.dx, shift.dy);
        }
    }
    gis::OutputRaster out;
    out.cols = grid.cols;
    out.rows = grid.rows;
    out.grid = grid;
    out.synthetic = false;
    std::vector<float> difference;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const auto& like = synthetic.info().bands[static_cast<std::size_t>(pairs[k].synthetic) - 1];
        BandComparison band{pairs[k].synthetic,
                            pairs[k].real,
                            like.description,
                            like.unit,
                            analysis::agreement(a[k], b[k], grid.cols, grid.rows),
                            0.0,
                            {}};
        band.threshold = job.threshold.value_or(otsu(a[k]));
        band.fire = analysis::mask_agreement(above(a[k], b[k], band.threshold), above(b[k], a[k], band.threshold), grid.cols,
                                             grid.rows);
        report.bands.push_back(std::move(band));
        out.bands.push_back({like.description + ": synthetic - real", like.unit, like.wavelength_um, like.fwhm_um, {}});
        for (std::size_t i = 0; i < a[k].size(); ++i) difference.push_back(a[k][i] - b[k][i]);
    }
    const auto last = static_cast<std::ptrdiff_t>(a.back().size());
    const auto& shown = report.bands.back();
    const std::vector<drawing::QuicklookPanel> panels{
        {"synthetic " + shown.name, shown.unit, grid.cols, grid.rows, a.back(), false},
        {"real", shown.unit, grid.cols, grid.rows, b.back(), false},
        {"synthetic - real", shown.unit, grid.cols, grid.rows, {difference.end() - last, difference.end()}, false}};
    std::filesystem::create_directories(job.output);
    gis::write_cog(job.output / "difference.tif", out, difference);
    drawing::write_quicklook(job.output / "pictures.png", "synthetic against real", panels, grid.cell_m);
    write_text_file(job.output / "scores.json", scores_json(job, report).dump(2) + "\n");
    write_text_file(job.output / "report.html", report_html(job, report, read_text_file(job.output / "pictures.png")));
    return report;
}

}  // namespace pyroscene::imagery
