#pragma once

#include <vector>

#include "radiometry/atmosphere.h"
#include "radiometry/atmosphere_slice.h"

namespace pyroscene::radiometry {

/// The tables of a set, sorted by what they are for. Pointers into the set.
struct TableRoles {
    std::vector<const AtmosphereTable*> grounds;            ///< own tables at the base visibility, ascending in elevation
    std::vector<const AtmosphereTable*> visibilities;       ///< tables at the lowest elevation, ascending in visibility
    std::vector<const AtmosphereTable*> reference_grounds;  ///< other model's elevations, when the model has only one
};
/// Throws an input error for an empty set and for tables with different wavelengths.
TableRoles sort_tables(const AtmosphereSet& set);

/// Limits of what the tables cover.
struct TableLimits {
    double view_zenith_rad, sun_zenith_rad, altitude_m;
    double visibility_km[2], ground_elevation_m[2];
};
TableLimits table_limits(const TableRoles& roles);

/// One atmosphere at one sensor altitude and sun: slices of all tables that take part, blended for any view direction.
///   elevation  between tables: sources, C, t_d, S linear; ln(-ln tau) and ln E linear
///   visibility: change of the sea-level tables: ln tau linear in 1/V (added), others as a ratio, ln-linear in ln V
///   other model's elevations: optical depth and the rest scaled by the reference's ratio
class BlendedAtmosphere {
public:
    /// \param conditions finite numbers; values outside the tables are clamped
    BlendedAtmosphere(const AtmosphereSet& set, const AtmosphereConditions& conditions, LambdaRange range);
    void at(double view_secant, PathTerms& out) const;

private:
    struct Pair {
        std::vector<TableSlice> slices;  ///< none, one, or two to interpolate between
        double fraction = 0.0;           ///< of the second, in the coordinate of the blend
        double log_fraction = 0.0;       ///< visibility: in ln V
    };
    Pair ground_, reference_ground_, visibility_;
    std::vector<TableSlice> reference_base_, visibility_base_;  ///< denominators of the ratios: none or one
    bool visibility_replaces_ = false;                          ///< at the base elevation no ratio is needed
    std::vector<double> toa_;
};

/// Throws an input error unless all numbers are finite and visibility and sun distance are positive.
void check_numbers(const AtmospherePoint& point);

/// What the tables' solar terms are multiplied with: 1 / distance^2, the fall-off beyond the largest sun zenith, 0 at night.
double solar_factor(const AtmosphereSet& set, const AtmosphereConditions& conditions);

/// Cosine series of the path radiance in relative azimuth at sample i, exact at 0, 90 and 180 deg; before solar_factor.
std::array<double, 3> solar_series(const PathTerms& path, std::size_t i) noexcept;

}  // namespace pyroscene::radiometry
