#include "radiometry/smoke.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/error.h"

namespace pyroscene::radiometry {

SmokeOptics load_smoke_optics(const std::filesystem::path& path, std::string_view kind) {
    const auto table = read_csv(path);
    const auto column = [&](const char* quantity) {
        Spectrum spectrum{Quantity::Dimensionless, table.numbers("wavelength_um"),
                          table.numbers(fmt::format("{}_{}", quantity, kind))};
        for (std::size_t i = 0; i < spectrum.value.size(); ++i)
            if (!(spectrum.value[i] >= 0.0 && (i == 0 || spectrum.lambda_um[i] > spectrum.lambda_um[i - 1])))
                throw input_error(fmt::format("{}:{}", table.path, table.row_lines[i]),
                                  fmt::format("{} = {} at {} um, expected no negative number and ascending wavelengths",
                                              quantity, spectrum.value[i], spectrum.lambda_um[i]));
        if (spectrum.value.size() < 2) throw input_error(table.path, "expected at least two wavelengths");
        return spectrum;
    };
    return {column("mee"), column("ssa"), column("g")};
}

double smoke_absorption_m2_g(const SmokeOptics& smoke, double lambda_um) noexcept {
    const auto& range = smoke.extinction_m2_g.lambda_um;
    const double at_um = std::clamp(lambda_um, range.front(), range.back());
    return smoke.extinction_m2_g.at(at_um) * (1.0 - smoke.albedo.at(at_um));
}

}  // namespace pyroscene::radiometry
