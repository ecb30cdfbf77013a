#pragma once

#include <filesystem>

namespace cv {
class Mat;
}

namespace pyroscene::pipeline {

/// Writes a picture atomically, in the format of the path's ending. Throws a runtime error naming the file.
void write_picture_file(const std::filesystem::path& path, const cv::Mat& picture);

}  // namespace pyroscene::pipeline
