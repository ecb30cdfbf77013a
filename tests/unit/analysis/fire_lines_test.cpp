#include "analysis/fire_lines.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pyroscene::analysis {
namespace {

/// 'F' front, '.' unburned, 's' scar.
struct Map {
    int cols, rows;
    std::vector<std::uint8_t> front, unburned;

    explicit Map(const std::vector<std::string>& text)
        : cols(static_cast<int>(text[0].size())), rows(static_cast<int>(text.size())) {
        for (const auto& line : text)
            for (const char c : line) {
                front.push_back(c == 'F' ? 1 : 0);
                unburned.push_back(c == '.' ? 1 : 0);
            }
    }
    [[nodiscard]] std::vector<FireLine> lines() const { return fire_lines(front, unburned, cols, rows); }
};

double length(const FireLine& line) {
    double sum = 0.0;
    for (std::size_t k = 1; k < line.points.size(); ++k)
        sum += std::hypot(line.points[k][0] - line.points[k - 1][0], line.points[k][1] - line.points[k - 1][1]);
    return sum;
}

TEST(FireLines, FollowTheUnburnedSideOnly) {
    const auto lines = Map({"......", "FFFFFF", "ssssss"}).lines();
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NEAR(length(lines[0]), 6.0, 1e-12);
    for (const auto& p : lines[0].points) EXPECT_DOUBLE_EQ(p[1], 1.0);
}

TEST(FireLines, AreStraightAlongADiagonal) {
    // Staircase of 8 steps: its middles lie on a line of 45 degrees.
    std::vector<std::string> text(9, std::string(9, '.'));
    for (std::size_t r = 0; r < 9; ++r)
        for (std::size_t c = 0; c < r; ++c) text[r][c] = c + 1 == r ? 'F' : 's';
    const auto lines = Map(text).lines();
    ASSERT_EQ(lines.size(), 1u);
    const auto& points = lines[0].points;
    for (std::size_t k = 1; k + 1 < points.size(); ++k) EXPECT_NEAR(points[k][1] - points[k][0], 0.5, 0.5 + 1e-12);
    EXPECT_NEAR(length(lines[0]), 8.0 * std::sqrt(2.0), 0.5);
}

TEST(FireLines, CloseAroundASpotAndSplitWhereFrontsEnd) {
    const auto spot = Map({".....", "..F..", ".....", "....."}).lines();
    ASSERT_EQ(spot.size(), 1u);
    EXPECT_EQ(spot[0].points.front(), spot[0].points.back());
    EXPECT_NEAR(length(spot[0]), 4.0 * std::sqrt(0.5), 1e-12);
    const auto two = Map({"........", "FFssFFss", "ssssssss"}).lines();
    EXPECT_EQ(two.size(), 2u);
    EXPECT_TRUE(Map({"sss", "sFs", "sss"}).lines().empty());
    // Two cells that touch by a corner keep a line each, or share one: either way nothing is lost.
    double total = 0.0;
    for (const auto& line : Map({"....", ".F..", "..F.", "...."}).lines()) total += length(line);
    EXPECT_NEAR(total, 8.0 * std::sqrt(0.5), 1e-9);
}

TEST(HeatClasses, SeparateIntenseScatteredAndIsolatedHeat) {
    // F flaming, h hot. The pair at the right is far from everything; the single h at the left is within reach of the front.
    const std::vector<std::string> text{"............", ".FFFh......h", "...........h", ".....h......", "............"};
    std::vector<Heat> heat;
    for (const auto& line : text)
        for (const char c : line) heat.push_back(c == 'F' ? Heat::Flaming : c == 'h' ? Heat::Hot : Heat::None);
    const auto classes = heat_classes(heat, 12, 5, 2, 2);
    const auto at = [&](std::size_t col, std::size_t row) { return classes[row * 12 + col]; };
    EXPECT_EQ(at(1, 1), HeatClass::Intense);
    EXPECT_EQ(at(4, 1), HeatClass::Scattered);
    EXPECT_EQ(at(5, 3), HeatClass::Scattered);
    EXPECT_EQ(at(11, 1), HeatClass::Isolated);
    EXPECT_EQ(at(11, 2), HeatClass::Isolated);
    EXPECT_EQ(at(0, 0), HeatClass::None);
}

}  // namespace
}  // namespace pyroscene::analysis
