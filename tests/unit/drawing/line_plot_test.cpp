#include "drawing/line_plot.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "base/error.h"
#include "unit/base/temp_folder.h"

namespace pyroscene::pipeline {
namespace {

TEST(AxisTicks, AreRound) {
    EXPECT_EQ(drawing::axis_ticks(0.0, 1800.0, false, 8),
              (std::vector<double>{0, 200, 400, 600, 800, 1000, 1200, 1400, 1600, 1800}));
    EXPECT_EQ(drawing::axis_ticks(-3.3, 4.0, false, 3), (std::vector<double>{-2, 0, 2, 4}));
    EXPECT_EQ(drawing::axis_ticks(0.3, 20.0, true, 5), (std::vector<double>{0.5, 1, 2, 5, 10, 20}));
    EXPECT_EQ(drawing::axis_ticks(0.5, 2e4, true, 5), (std::vector<double>{1, 10, 100, 1000, 10000}));
    EXPECT_EQ(drawing::axis_ticks(2e-8, 2e8, true, 4), (std::vector<double>{1e-6, 1e-4, 1e-2, 1, 1e2, 1e4, 1e6, 1e8}));
}

cv::Mat read_png(const std::filesystem::path& file) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_file(&png, file.c_str()), 0) << png.message;
    png.format = PNG_FORMAT_BGR;
    cv::Mat image(static_cast<int>(png.height), static_cast<int>(png.width), CV_8UC3);
    EXPECT_NE(png_image_finish_read(&png, nullptr, image.data, static_cast<png_int_32>(image.step[0]), nullptr), 0);
    return image;
}

bool is_coloured(const cv::Vec3b& c) { return std::abs(c[0] - c[2]) > 60; }

// A straight line in a frame of known place: its colour lies on the diagonal and nowhere off it.
TEST(LinePlot, DrawsWhereTheValuesAre) {
    const TempFolder folder;
    const auto file = folder.path() / "line.png";
    drawing::LinePlot plot{"diagonal", {"x, m", false, 0.0, 1.0}, {"y, m", false, 0.0, 1.0}, {{"", {0, 1}, {0, 1}}}, 516,
                           496};
    drawing::write_line_plots(file, std::vector{plot});
    const cv::Mat image = read_png(file);
    ASSERT_EQ(image.cols, 516);
    ASSERT_EQ(image.rows, 496);
    // The frame's inside is 400 x 400 pixels from (92, 38).
    for (const int k : {50, 100, 200, 350}) {
        EXPECT_TRUE(is_coloured(image.at<cv::Vec3b>(38 + 400 - k, 92 + k))) << k;
        EXPECT_FALSE(is_coloured(image.at<cv::Vec3b>(38 + 400 - k, 92 + k - 12))) << k;
        EXPECT_FALSE(is_coloured(image.at<cv::Vec3b>(38 + 400 - k + 12, 92 + k + 24))) << k;
    }
}

TEST(LinePlot, LeavesGapsAndRefusesNothingToShow) {
    const TempFolder folder;
    const double nan = std::nan("");
    drawing::LinePlot plot{"gaps", {"x", true, {}, {}}, {"y", true, {}, {}}, {{"a", {1, 10, 100, 1000}, {1, nan, -5, 20}}}};
    EXPECT_NO_THROW(drawing::write_line_plots(folder.path() / "gaps.png", std::vector{plot}));
    plot.series[0].y = {nan, nan, -1, 0};
    EXPECT_THROW(drawing::write_line_plots(folder.path() / "none.png", std::vector{plot}), Error);
    plot.series[0].y = {1};
    EXPECT_THROW(drawing::write_line_plots(folder.path() / "ragged.png", std::vector{plot}), Error);
    plot.series[0].y = {1, 2, 3, 4};
    EXPECT_THROW(drawing::write_line_plots(folder.path() / "plot.jpg", std::vector{plot}), Error);
    EXPECT_THROW(drawing::write_line_plots(folder.path() / "gaps.png" / "x.png", std::vector<drawing::LinePlot>{}), Error);
}

}  // namespace
}  // namespace pyroscene::pipeline
