#include "drawing/picture_file.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/files.h"

namespace pyroscene::drawing {

void write_picture_file(const std::filesystem::path& path, const cv::Mat& picture) {
    AtomicFile file(path);
    bool written = false;
    try {
        written = cv::imwrite(file.path().string(), picture);
    } catch (const cv::Exception&) {
        written = false;
    }
    if (!written) throw runtime_error(path.string(), "cannot be written");
    file.commit();
}

std::string png_of(const cv::Mat& picture) {
    std::vector<unsigned char> bytes;
    if (!cv::imencode(".png", picture, bytes)) throw runtime_error("picture", "cannot be encoded as PNG");
    return {bytes.begin(), bytes.end()};
}

void draw_scale_bar(cv::Mat& canvas, int x, int y, int picture_width_px, double metres_per_pixel) {
    const cv::Scalar ink(30, 30, 30);
    const double target_m = 0.25 * picture_width_px * metres_per_pixel;
    const double decade = std::pow(10.0, std::floor(std::log10(target_m)));
    const double length_m = target_m >= 5.0 * decade ? 5.0 * decade : target_m >= 2.0 * decade ? 2.0 * decade : decade;
    const int length_px = static_cast<int>(std::lround(length_m / metres_per_pixel));
    cv::rectangle(canvas, {x, y}, {x + length_px, y + 4}, ink, cv::FILLED);
    const auto words = length_m >= 1000.0 ? fmt::format("{:g} km", length_m / 1000.0) : fmt::format("{:g} m", length_m);
    cv::putText(canvas, words, {x + length_px + 8, y + 7}, cv::FONT_HERSHEY_SIMPLEX, 0.42, ink, 1, cv::LINE_AA);
}

}  // namespace pyroscene::drawing
