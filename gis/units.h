#pragma once

#include <optional>
#include <string>
#include <string_view>

/// Units as rasters spell them. A unit text is a product of symbols with exponents ("W m-2", "W/m2", "W/m^2", "W m**-2",
/// "kW·m⁻²", "tons/acre", "Btu/ft/s", "uW/(cm2 sr nm)"), with SI prefixes and the English names and customary units of fire
/// reports. Two units convert when their dimensions agree, so a wrong quantity is noticed whatever its spelling.
namespace pyroscene::gis {

/// canonical value = scale * file value + offset.
struct UnitConversion {
    double scale = 1.0, offset = 0.0;
    [[nodiscard]] bool is_identity() const noexcept { return scale == 1.0 && offset == 0.0; }
};

/// How to get from one unit to the other; nothing when either text is no unit or the quantities differ.
std::optional<UnitConversion> unit_conversion(std::string_view found, std::string_view wanted);

/// As unit_conversion; an empty text counts as `wanted`. Throws an input error with `subject` that says what was found, what
/// quantity that is not, and which spellings would do.
UnitConversion require_unit(const std::string& subject, std::string_view found, const std::string& wanted);

}  // namespace pyroscene::gis
