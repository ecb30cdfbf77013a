#include "base/buffer.h"

#include <gtest/gtest.h>

#include <numeric>

namespace pyroscene {
namespace {

TEST(Buffer, KeepsWhatIsWritten) {
    for (const std::size_t n : {std::size_t{1}, std::size_t{1000}, std::size_t{3} << 20}) {
        Buffer<float> buffer;
        buffer.resize(n);
        std::iota(buffer.begin(), buffer.end(), 0.0F);
        EXPECT_EQ(buffer.back(), static_cast<float>(n - 1));
    }
}

TEST(Buffer, FillsWithAValueThatIsGiven) {
    Buffer<int> buffer;
    buffer.resize(5, 7);
    buffer.resize(8, 9);
    EXPECT_EQ(buffer, (Buffer<int>{7, 7, 7, 7, 7, 9, 9, 9}));
}

TEST(Buffer, RefusesSizesThatNoMemoryHolds) { EXPECT_ANY_THROW(Buffer<double>().resize(std::size_t{1} << 60)); }

}  // namespace
}  // namespace pyroscene
