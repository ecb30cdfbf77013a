#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

namespace pyroscene::analysis {

/// A ground point and where an image shows it; pixel CENTRES at integers, as RPC files count.
struct GroundTie {
    double lat_deg = 0.0, lon_deg = 0.0, h_m = 0.0;
    double sample = 0.0, line = 0.0;
};

/// Rational polynomial camera model RPC00B (STDI-0002, appendix E): line and sample as quotients of cubic polynomials of
/// normalised latitude, longitude and height. Coefficients in the order of RPC00B; denominators start with 1.
struct RationalCamera {
    /// normalised = (value - offset) / scale
    struct Range {
        double offset = 0.0, scale = 1.0;
    };
    Range line, sample, lat_deg, lon_deg, h_m;
    std::array<double, 20> line_numerator{}, line_denominator{}, sample_numerator{}, sample_denominator{};
};

/// Sample and line of a ground point.
std::array<double, 2> project(const RationalCamera& camera, double lat_deg, double lon_deg, double h_m) noexcept;

/// Least squares over the ties (at least 39, on several heights), linearised and reweighted by the denominator; a small ridge
/// keeps coefficients that the ties do not determine near zero. Throws an input error for too few ties.
RationalCamera fit_rational_camera(std::span<const GroundTie> ties);

/// Largest distance [pixels] between ties and model.
double largest_residual_px(const RationalCamera& camera, std::span<const GroundTie> ties) noexcept;

/// Names and values as GDAL's metadata domain RPC has them.
std::vector<std::array<std::string, 2>> rpc_metadata(const RationalCamera& camera, double largest_residual_px);

}  // namespace pyroscene::analysis
