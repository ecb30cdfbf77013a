#pragma once

#include <array>
#include <cstdint>
#include <vector>

/// Small least-squares problems with up to 24 unknowns; shared by the files of unmixing, not for other modules.
namespace pyroscene::analysis {

inline constexpr int kMostEndmembers = 24;
using Coordinates = std::array<double, kMostEndmembers>;

/// Orthonormal basis and triangular factor of some columns of a k x k matrix R: R(:, S) = Q T.
struct SubsetFactor {
    int size = 0;
    std::array<std::uint8_t, kMostEndmembers> members{};  ///< columns, ascending
    std::vector<double> basis;                            ///< Q': [size][k]
    std::vector<double> inverse;                          ///< T^-1, upper triangular: [size][size]
    std::vector<double> variance;                         ///< [size] diagonal of (R_S' R_S)^-1 = squared row norms of T^-1
};

/// \param r [k][k] upper triangular, row major  \param subset bits of the columns; at least one
SubsetFactor factor_subset(const std::vector<double>& r, int k, std::uint32_t subset);

/// y = Q'z, the squared length of which is the sum of squares that the subset explains.
double project(const SubsetFactor& factor, int k, const Coordinates& z, Coordinates& y) noexcept;
/// a = T^-1 y.
void solve(const SubsetFactor& factor, const Coordinates& y, Coordinates& a) noexcept;

/// QR of a tall matrix given by columns [k][l]: the triangular factor [k][k] row major, and Q by columns [k][l].
struct TallFactor {
    std::vector<double> r, q;
};
TallFactor factor_tall(const std::vector<double>& columns, int k, int l);

}  // namespace pyroscene::analysis
