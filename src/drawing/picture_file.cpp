#include "drawing/picture_file.h"

#include <cmath>

#include <fmt/format.h>
#include <png.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/files.h"

namespace pyroscene::drawing {

void write_picture_file(const std::filesystem::path& path, const cv::Mat& picture) {
    if (path.extension() != ".png") throw runtime_error(path.string(), "cannot be written: pictures are PNG, name it *.png");
    write_text_file(path, png_of(picture));
}

std::string png_of(const cv::Mat& picture) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(picture.cols);
    image.height = static_cast<png_uint_32>(picture.rows);
    image.format = picture.channels() == 3 ? PNG_FORMAT_BGR : PNG_FORMAT_GRAY;
    image.flags = PNG_IMAGE_FLAG_FAST;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string bytes(size, '\0');
    const auto row_bytes = static_cast<png_int_32>(picture.step[0]);
    if (png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.data, row_bytes, nullptr) == 0)
        throw runtime_error("picture", fmt::format("cannot be encoded as PNG: {}", image.message));
    bytes.resize(size);
    return bytes;
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
