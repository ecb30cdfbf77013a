#pragma once

#include <cstdint>
#include <vector>

#include "analysis/least_squares.h"
#include "analysis/unmix.h"

namespace pyroscene::analysis {

/// What all pixels of an image share.
struct UnmixTables {
    UnmixSettings settings;
    int k = 0, l = 0;
    std::vector<double> r;                  ///< [k][k] triangular factor of the weighted library
    std::vector<double> q;                  ///< [k][band], weights included: z = q x
    std::vector<double> weight;             ///< [band] 1 / noise, or 1
    std::vector<double> f_enter, f_remove;  ///< [size of the subset that is tested with its member]
    std::vector<double> chi2;               ///< [size of the subset] flagged above, with noise
    std::vector<SubsetFactor> cache;

    [[nodiscard]] std::uint32_t everything() const noexcept { return (1U << k) - 1U; }
    const SubsetFactor& factor(std::uint32_t subset, SubsetFactor& scratch) const {
        if (!cache.empty()) return cache[subset];
        return scratch = factor_subset(r, k, subset);
    }
};

/// One pixel in the coordinates of the library: which endmembers it holds, and how much of each.
class MixedPixel {
public:
    /// \param z  q x, kept by reference like `shared`  \param length2  squared length of the weighted spectrum
    MixedPixel(const UnmixTables& shared, const Coordinates& z, double length2);
    /// Stepwise selection; returns the subset that remains.
    std::uint32_t select();
    /// Fractions of a subset by one of the solvers; zero elsewhere. Narrows `subset` to the members in use.
    void fractions(LeastSquares solver, std::uint32_t& subset, Coordinates& a);
    /// Sum of squared residuals of any fractions.
    [[nodiscard]] double squared_error(const Coordinates& a) const;

private:
    // Selection
    [[nodiscard]] double unexplained(double explained) const;
    /// F of one degree of freedom against the rest; rounding of the spectrum's length is no evidence.
    [[nodiscard]] double f(double gain, double error, int degrees) const;
    std::uint32_t without_the_weakest(std::uint32_t subset);
    std::uint32_t with_the_strongest(std::uint32_t subset);

    // Solvers
    void scatter(const SubsetFactor& factor, const Coordinates& of_subset, Coordinates& a) const;
    void free(std::uint32_t subset, Coordinates& a);
    /// Least squares with sum one: a + G 1 (1 - 1'a) / (1'G 1), G = T^-1 T^-T.
    void sum_to_one(std::uint32_t subset, Coordinates& a);
    [[nodiscard]] Coordinates residual(const Coordinates& a) const;
    /// Correlation of a member's spectrum with the residual.
    [[nodiscard]] double gradient(int j, const Coordinates& rest) const;
    /// Moves `a` towards the solution on `active` until a member reaches zero; that one leaves. Repeats until none does.
    template <class Solve>
    void move_inside(std::uint32_t& active, Coordinates& a, Solve&& solve_on);
    /// Lawson and Hanson 1974, chapter 23.
    void non_negative(std::uint32_t& subset, Coordinates& a);
    /// The same with sum one: starts from the member that alone fits best.
    void fully_constrained(std::uint32_t& subset, Coordinates& a);
    /// Member with the largest gradient above a level; -1 when none stands out of the rounding.
    [[nodiscard]] int steepest(std::uint32_t among, const Coordinates& a, double level) const;

    const UnmixTables& s_;
    const Coordinates& z_;
    double length2_, inside_ = 0.0, outside_ = 0.0;  ///< of the squared length: what the library could explain, and the rest
    SubsetFactor scratch_;
};

}  // namespace pyroscene::analysis
