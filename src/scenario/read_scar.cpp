#include <set>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/error.h"
#include "fire/scar.h"
#include "scenario/readers.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {
namespace {

using config::Range;
using fire::ScarCooling;

constexpr Range kAmplitude = Range::between(0.0, 3000.0), kTimeConstant{0.0, 1e7, true};
/// Classes are told apart by one byte, and 0 is the curve of all other classes.
constexpr std::size_t kMostClasses = 255;

std::vector<std::string> model_names() {
    std::vector<std::string> names;
    for (const auto& row : fire::scar_models()) names.emplace_back(row.name);
    return names;
}

const fire::ScarModelRow* find_model(const std::string& name) {
    for (const auto& row : fire::scar_models())
        if (name == row.name) return &row;
    return nullptr;
}

/// A coefficient of one row of the table; an empty field or a missing column leaves the default of the model.
void read_field(const CsvTable& table, std::size_t row, const char* column, const Range& range, double& value) {
    if (!table.has(column) || table.rows[row][table.column(column)].empty()) return;
    const auto where = fmt::format("{}:{}: {}", table.path, table.row_lines[row], column);
    value = parse_number(table.rows[row][table.column(column)], where);
    const bool above = range.open_minimum ? value > range.minimum : value >= range.minimum;
    if (!above || !(value <= range.maximum))
        throw input_error(where, fmt::format("is {}, must lie within {} and {}", value, range.minimum, range.maximum));
}

std::vector<fire::CoverScar> read_table(const fs::path& path) {
    const auto table = read_csv(path);
    const std::set<std::string> known{
        "code", "model", "amplitude1_K", "time_constant1_s", "amplitude2_K", "time_constant2_s", "floor_K", "source"};
    for (const auto& column : table.columns)
        if (!known.contains(column))
            throw input_error(table.path, fmt::format("unknown column '{}'; there are code, model, amplitude1_K, "
                                                      "time_constant1_s, amplitude2_K, time_constant2_s, floor_K, source",
                                                      column));
    const auto codes = table.numbers("code");
    std::vector<fire::CoverScar> scars;
    std::set<int> seen;
    for (std::size_t r = 0; r < codes.size(); ++r) {
        const auto where = fmt::format("{}:{}", table.path, table.row_lines[r]);
        const int code = static_cast<int>(codes[r]);
        if (static_cast<double>(code) != codes[r] || !seen.insert(code).second)
            throw input_error(where, fmt::format("code {} is no integer or is there twice", codes[r]));
        const std::string name = table.has("model") ? table.rows[r][table.column("model")] : "";
        const auto* model = find_model(name.empty() ? "double_exponential" : name);
        if (model == nullptr) throw input_error(where, fmt::format("unknown model '{}'", name));
        ScarCooling c = model->defaults;
        read_field(table, r, "amplitude1_K", kAmplitude, c.amplitude1_K);
        read_field(table, r, "time_constant1_s", kTimeConstant, c.time_constant1_s);
        if (model->terms == 2) {
            read_field(table, r, "amplitude2_K", kAmplitude, c.amplitude2_K);
            read_field(table, r, "time_constant2_s", kTimeConstant, c.time_constant2_s);
        }
        read_field(table, r, "floor_K", kTemperature_K, c.floor_K);
        scars.push_back({code, c});
    }
    if (scars.size() > kMostClasses)
        throw input_error(table.path, fmt::format("has {} classes, at most {} are possible", scars.size(), kMostClasses));
    return scars;
}

}  // namespace

void read_scar(const config::Node& node, const fs::path& folder, bool has_cover, fire::FireParameters& p) {
    const auto* model = find_model(node.choice("model", "double_exponential", model_names()));
    if (model == nullptr) model = &fire::scar_models().front();  // told by choice()
    ScarCooling scar = model->defaults;
    scar.amplitude1_K = node.number("amplitude1_K", scar.amplitude1_K, kAmplitude);
    scar.time_constant1_s = node.number("time_constant1_s", scar.time_constant1_s, kTimeConstant);
    const ScarCooling one_term = scar;
    scar.amplitude2_K = node.number("amplitude2_K", scar.amplitude2_K, kAmplitude);
    scar.time_constant2_s = node.number("time_constant2_s", scar.time_constant2_s, kTimeConstant);
    if (model->terms == 1) {
        for (const char* key : {"amplitude2_K", "time_constant2_s"})
            if (node.has(key)) node.child(key).report(fmt::format("{} has one term; leave this key out", model->name));
        scar = one_term;
    }
    scar.floor_K = node.number("floor_K", scar.floor_K, kTemperature_K);
    p.scar = scar;
    if (const auto file = node.child("by_cover"); file.present()) {
        const auto path = read_file_name(file, folder);
        if (!has_cover) file.report("needs 'inputs.cover', which says the class of each cell");
        std::error_code ignored;
        if (fs::is_regular_file(path, ignored)) {
            try {
                p.scar_of_cover = read_table(path);
            } catch (const Error& e) {
                file.report(e.what());
            }
        }
    }
    node.finish();
}

}  // namespace pyroscene::scenario
