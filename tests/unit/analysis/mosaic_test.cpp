#include "analysis/mosaic.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pyroscene::analysis {
namespace {

/// An image of 4 x 4 pixels of 1 m whose first pixel's corner lies at x = west, y = 4, on a grid of 8 x 4 cells.
struct Image {
    std::vector<double> x_m, y_m, z_m;
    std::vector<float> value, zenith_deg, time_s;

    Image(double west, float radiance, float first_zenith_deg, float step_deg, float at_s) {
        for (int line = 0; line < 4; ++line)
            for (int s = 0; s < 4; ++s) {
                x_m.push_back(west + s + 0.5);
                y_m.push_back(3.5 - line);
                z_m.push_back(0.0);
                value.push_back(radiance);
                zenith_deg.push_back(first_zenith_deg + step_deg * static_cast<float>(s));
                time_s.push_back(at_s + static_cast<float>(line));
            }
    }
};

const MapGrid kGrid{8, 4, 0.0, 4.0, 1.0, ""};

/// The mosaic and its only band.
struct Merged : Mosaic {
    std::vector<float> pixels;
};

Merged merge(const std::vector<Image>& images, MosaicRule rule) {
    Merged mosaic{empty_mosaic(kGrid), std::vector<float>(kGrid.size(), std::nanf(""))};
    std::vector<OrthoLookup> lookups;
    for (const auto& i : images) {
        lookups.push_back(ortho_lookup(kGrid, 4, 4, i.x_m, i.y_m, i.z_m));
        add_to_mosaic(mosaic, {lookups.back(), 4, 4, i.zenith_deg, i.time_s}, rule, static_cast<int>(lookups.size()));
    }
    for (std::size_t k = 0; k < images.size(); ++k)
        fill_from_member(mosaic, {lookups[k], 4, 4, {}, {}}, static_cast<int>(k) + 1, images[k].value, mosaic.pixels);
    return mosaic;
}

// Columns 0 to 3 are seen by the first, 2 to 5 by the second, 6 and 7 by none. The first looks from above at column 0, the
// second at column 5.
const std::vector<Image> kTwo{Image(0.0, 10.0F, 0.0F, 10.0F, 100.0F), Image(2.0, 20.0F, 28.0F, -9.0F, 50.0F)};

std::vector<float> first_row(const Mosaic& m) { return {m.member.begin(), m.member.begin() + 8}; }

TEST(Mosaic, ShowsTheImageNearestToNadir) {
    const auto m = merge(kTwo, MosaicRule::NearestNadir);
    const auto row = first_row(m);
    // Zenith angles in the overlap: 20 against 28, 30 against 19.
    EXPECT_EQ(row[0], 1.0F);
    EXPECT_EQ(row[2], 1.0F);
    EXPECT_EQ(row[3], 2.0F);
    EXPECT_EQ(row[5], 2.0F);
    EXPECT_TRUE(std::isnan(row[6]));
    EXPECT_EQ(m.pixels[2], 10.0F);
    EXPECT_EQ(m.pixels[3], 20.0F);
    EXPECT_TRUE(std::isnan(m.pixels[7]));
}

TEST(Mosaic, StampsEachPixelWithItsTime) {
    for (const auto rule : {MosaicRule::Latest, MosaicRule::Earliest}) {
        const auto m = merge(kTwo, rule);
        const float number = rule == MosaicRule::Latest ? 1.0F : 2.0F;
        for (std::size_t row = 0; row < 4; ++row)
            for (const std::size_t col : {2U, 3U}) {
                const std::size_t i = row * 8 + col;
                EXPECT_EQ(m.member[i], number);
                EXPECT_EQ(m.time_s[i], (number == 1.0F ? 100.0F : 50.0F) + static_cast<float>(row));
            }
    }
}

TEST(Mosaic, ByZenithOrTimeDoesNotDependOnTheOrder) {
    const std::vector<Image> turned{kTwo[1], kTwo[0]};
    for (const auto rule : {MosaicRule::NearestNadir, MosaicRule::Latest, MosaicRule::Earliest}) {
        const auto a = merge(kTwo, rule), b = merge(turned, rule);
        for (std::size_t i = 0; i < a.pixels.size(); ++i)
            EXPECT_TRUE(a.pixels[i] == b.pixels[i] || (std::isnan(a.pixels[i]) && std::isnan(b.pixels[i])));
    }
}

}  // namespace
}  // namespace pyroscene::analysis
