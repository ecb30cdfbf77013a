#pragma once

#include <filesystem>
#include <string>

namespace cv {
class Mat;
}

namespace pyroscene::drawing {

/// Writes a picture as PNG, atomically. Throws a runtime error naming the file, also when its name does not end in .png.
void write_picture_file(const std::filesystem::path& path, const cv::Mat& picture);

/// The picture, 8 bits of grey or of blue, green and red, as bytes of a PNG.
std::string png_of(const cv::Mat& picture);

/// Draws a scale bar with its length from (x, y) to the right: 1, 2 or 5 times a power of ten, about a quarter of the picture's
/// width long.
void draw_scale_bar(cv::Mat& canvas, int x, int y, int picture_width_px, double metres_per_pixel);

}  // namespace pyroscene::drawing
