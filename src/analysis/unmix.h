#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace pyroscene::analysis {

/// Spectra that a pixel may be a mixture of, at the bands of one image.
struct Endmembers {
    std::vector<std::string> names;
    int bands = 0;
    std::vector<double> spectra;  ///< [endmember][band], unit of the image

    [[nodiscard]] int count() const noexcept { return static_cast<int>(names.size()); }
    [[nodiscard]] const double* spectrum(int endmember) const noexcept {
        return spectra.data() + static_cast<std::ptrdiff_t>(endmember) * bands;
    }
};

/// How fractions are found: least squares without constraint, with sum one, without negative ones, with both; or stepwise
/// selection of endmembers by F-tests (thesis appendix F), then one of the others on those that remain.
enum class LeastSquares { Unconstrained, SumToOne, NonNegative, FullyConstrained };

struct UnmixSettings {
    bool stepwise = true;
    LeastSquares solver = LeastSquares::Unconstrained;
    double alpha_enter = 0.05;   ///< an endmember enters when its F exceeds the 1 - alpha quantile of F(1, l - k)
    double alpha_remove = 0.05;  ///< and leaves when it falls below this one; >= alpha_enter, else the two could cycle
    /// [band] standard deviation, unit of the image; bands are weighted by its inverse. Empty: all alike.
    std::vector<double> noise{};
    double unexplained_alpha = 1e-3;    ///< with noise: probability of flagging a pixel that is a mixture
    double unexplained_relative = 0.1;  ///< without noise: residual / length of the pixel's spectrum that is flagged
};

/// Results for a run of pixels, [endmember][pixel] and [pixel]; NaN where a band of the pixel has no data.
struct UnmixOutput {
    std::span<float> fractions;
    std::span<float>
        residual_rms;         ///< over the bands; in standard deviations when noise was given, else in the unit of the image
    std::span<float> chosen;  ///< sum of 2^endmember over the endmembers in use (an integer)
    std::span<float> unexplained;  ///< 1 = the library does not explain the pixel
};

/// Linear unmixing x = B a + e with one library. Constant after construction; one object serves all threads.
///
/// Selection starts from all endmembers and alternates (fire-physics literature: stepwise regression about the origin)
///   backward:  F_j = (SSR_S - SSR_{S-j}) / (SSE_S / (l - |S|)),          the smallest leaves if below F_remove(1, l - |S|)
///   forward:   F_j = (SSR_{S+j} - SSR_S) / (SSE_{S+j} / (l - |S| - 1)),  the largest enters if above F_enter(1, l - |S| - 1)
/// until neither acts, at most 2k moves. The last endmember stays.
/// Numerics: B is replaced once by its triangular factor R, a pixel by its k coordinates z = Q'x; each subset of
/// columns has a QR of R of its own, cached for up to 10 endmembers. Normal equations are never formed.
class Unmixer {
public:
    /// Throws an input error: no endmember or more than 24, not more bands than endmembers, spectra that are not finite or
    /// (within 1e-10) linearly dependent, noise of another length or not positive, alphas outside (0, 1) or in the wrong order.
    Unmixer(const Endmembers& library, const UnmixSettings& settings);
    ~Unmixer();
    Unmixer(Unmixer&&) noexcept;

    /// \param pixels [band][pixel] with `stride` values from band to band  \param count pixels, any number
    void unmix(const float* pixels, std::ptrdiff_t stride, int count, const UnmixOutput& out) const;

    [[nodiscard]] int endmembers() const noexcept;
    [[nodiscard]] int bands() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Quantile of the F distribution with 1 and `degrees` degrees of freedom that `alpha` of it exceeds.
double f_threshold(double alpha, int degrees);

}  // namespace pyroscene::analysis
