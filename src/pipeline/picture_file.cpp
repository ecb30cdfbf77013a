#include "pipeline/picture_file.h"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "base/error.h"
#include "base/files.h"

namespace pyroscene::pipeline {

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

}  // namespace pyroscene::pipeline
