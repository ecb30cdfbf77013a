#include "spread/fuel_model.h"

#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"
#include "fire/residence_time.h"

namespace pyroscene::spread {
namespace {

constexpr std::array<const char*, kFuelClasses> kClassNames{"1h", "10h", "100h", "herb", "woody"};

/// One row of the table; asks each column for a number within bounds.
class Row {
public:
    Row(const CsvTable& table, std::size_t row) : table_(table), row_(row) {}

    [[nodiscard]] double number(const std::string& column, double lowest, double highest) const {
        const auto subject = fmt::format("{}:{}: column '{}'", table_.path, table_.row_lines[row_], column);
        const double value = parse_number(table_.rows[row_][table_.column(column)], subject);
        if (!(value >= lowest && value <= highest))
            throw input_error(subject, fmt::format("found {}, expected {} to {}", value, lowest, highest));
        return value;
    }
    [[nodiscard]] std::string text(const std::string& column) const { return table_.rows[row_][table_.column(column)]; }
    [[nodiscard]] std::string where() const { return fmt::format("{}:{}", table_.path, table_.row_lines[row_]); }

private:
    const CsvTable& table_;
    std::size_t row_;
};

FuelModel read_model(const Row& row) {
    FuelModel m;
    const double number = row.number("number", 1, 65535);
    if (number != std::floor(number))
        throw input_error(row.where(), fmt::format("fuel model number {}, expected a whole number", number));
    m.number = static_cast<int>(number);
    m.code = row.text("code");
    m.dynamic = row.number("dynamic", 0, 1) != 0.0;
    m.depth_m = row.number("depth_m", 1e-3, 20.0);
    m.extinction_moisture = row.number("mx_dead_frac", 0.01, 3.0);
    m.heat_dead_J_kg = 1e3 * row.number("heat_dead_kJ_kg", 1e3, 1e5);
    m.heat_live_J_kg = 1e3 * row.number("heat_live_kJ_kg", 1e3, 1e5);
    for (std::size_t i = 0; i < kFuelClasses; ++i) {
        m.load_kg_m2[i] = row.number(fmt::format("load_{}_kg_m2", kClassNames[i]), 0.0, 100.0);
        m.surface_to_volume_per_m[i] = row.number(fmt::format("sav_{}_1_m", kClassNames[i]), 1.0, 1e5);
    }
    if (!(m.total_load_kg_m2() > 0.0))
        throw input_error(row.where(), fmt::format("fuel model {} has no load; expected one above 0", m.number));
    return m;
}

}  // namespace

double FuelModel::total_load_kg_m2() const noexcept { return std::accumulate(load_kg_m2.begin(), load_kg_m2.end(), 0.0); }

double FuelModel::characteristic_surface_to_volume_per_m() const noexcept {
    std::array<fire::FuelParticles, kFuelClasses> bed;
    for (std::size_t i = 0; i < kFuelClasses; ++i) bed[i] = {load_kg_m2[i], surface_to_volume_per_m[i]};
    return fire::characteristic_surface_to_volume_per_m(bed);
}

FuelModels read_fuel_models(const std::filesystem::path& csv) {
    const auto table = read_csv(csv);
    FuelModels models;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const Row row(table, i);
        const auto model = read_model(row);
        if (!models.emplace(model.number, model).second)
            throw input_error(row.where(), fmt::format("fuel model {} is given twice", model.number));
    }
    return models;
}

const FuelModels& standard_fuel_models() {
    static const FuelModels models = read_fuel_models(data_folder() / "fuel" / "fuel_models_53.csv");
    return models;
}

const std::set<int>& nonburnable_codes() {
    static const std::set<int> codes = [] {
        std::set<int> out;
        for (const double code : read_csv(data_folder() / "fuel" / "nonburnable.csv").numbers("number"))
            out.insert(static_cast<int>(code));
        return out;
    }();
    return codes;
}

fire::BurnOut burn_out_of(const FuelModel& model, double coarse_time_s) noexcept {
    const double coarse = (model.load_kg_m2[kTenHours] + model.load_kg_m2[kHundredHours]) / model.total_load_kg_m2();
    return fire::residence_burn_out(fire::residence_time_s(model.characteristic_surface_to_volume_per_m()), coarse,
                                    coarse_time_s);
}

}  // namespace pyroscene::spread
