#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "config/scalar.h"
#include "scenario_folder.h"
#include "schema_walk.h"
#include "source_folder.h"

namespace fs = std::filesystem;

namespace pyroscene::scenario {

namespace {

class Schema : public ::testing::Test {
protected:
    Schema() {
        const fs::path file = folder.path() / "schema.json";
        std::ofstream(file) << json_schema();
        keys = walk_schema(config::Document(file));
    }

    /// Everything but maps.
    [[nodiscard]] std::vector<SchemaKey> values() const {
        std::vector<SchemaKey> result;
        std::copy_if(keys.begin(), keys.end(), std::back_inserter(result), [](const SchemaKey& k) { return !k.is_map; });
        return result;
    }

    /// What load() says about the value at one path; other problems of the fragment are left out.
    [[nodiscard]] std::string said_of(const std::string& path, const std::string& value) const {
        std::string place = path;
        if (const auto brackets = place.find("[]"); brackets != std::string::npos) place.replace(brackets, 2, "[0]");
        for (const auto& line : folder.problems(as_yaml(path, value) + "\n"))
            if (line.find(": " + place + ": ") != std::string::npos) return line.substr(line.find(place) + place.size() + 2);
        return "";
    }

    ScenarioFolder folder;
    std::vector<SchemaKey> keys;
};

std::set<std::string> as_set(const std::vector<std::string>& words) { return {words.begin(), words.end()}; }

/// "known here: a, b, c" as a set.
std::set<std::string> known_keys(const std::vector<std::string>& problems) {
    const std::string mark = "known here: ";
    std::set<std::string> known;
    for (const auto& problem : problems) {
        const auto start = problem.find(mark);
        if (start == std::string::npos) continue;
        std::istringstream list(problem.substr(start + mark.size()));
        for (std::string word; std::getline(list, word, ',');) known.insert(word.substr(word.find_first_not_of(' ')));
    }
    return known;
}

}  // namespace

// A key that nobody knows makes every map list the keys it accepts: they are those of the schema, neither more nor fewer.
TEST_F(Schema, NamesExactlyTheKeysThatLoadAccepts) {
    const std::string stranger = "qqqqqqqqqqqq";
    int maps = 0;
    for (const auto& key : keys) {
        if (!key.is_map) continue;
        SCOPED_TRACE(key.path);
        const std::string path = key.path.empty() ? stranger : key.path + "." + stranger;
        EXPECT_EQ(known_keys(folder.problems(as_yaml(path, "1") + "\n")), as_set(key.properties));
        ++maps;
    }
    EXPECT_GE(maps, 19);
}

TEST_F(Schema, BoundsAreThoseOfLoad) {
    int checked = 0;
    for (const auto& key : values()) {
        if (key.facts.contains("type") && key.facts.at("type") == "array") continue;
        SCOPED_TRACE(key.path);
        const bool integer = key.facts.contains("type") && key.facts.at("type") == "integer";
        const auto step = [&](const std::string& bound, double sign) {
            const double value = config::parse_double(bound).value();
            const double next = integer ? value + sign : value + sign * std::max(1e-6 * std::abs(value), 1e-9);
            return integer ? fmt::format("{}", static_cast<long long>(next)) : fmt::format("{:.12g}", next);
        };
        const auto refused = [&](const std::string& value) { return said_of(key.path, value).rfind("must be ", 0) == 0; };
        if (const auto bound = key.facts.find("minimum"); bound != key.facts.end()) {
            EXPECT_TRUE(refused(step(bound->second, -1.0)));
            EXPECT_FALSE(refused(bound->second));
            ++checked;
        }
        if (const auto bound = key.facts.find("exclusiveMinimum"); bound != key.facts.end()) {
            EXPECT_TRUE(refused(bound->second));
            EXPECT_FALSE(refused(step(bound->second, 1.0)));
            ++checked;
        }
        if (const auto bound = key.facts.find("maximum"); bound != key.facts.end()) {
            const std::string whole = integer ? fmt::format("{:.0f}", *config::parse_double(bound->second)) : bound->second;
            EXPECT_TRUE(refused(step(bound->second, 1.0)));
            EXPECT_FALSE(refused(whole));
            ++checked;
        }
    }
    EXPECT_GT(checked, 60);
}

TEST_F(Schema, BoundsOfVoxelEdgesAreThoseOfLoad) {
    EXPECT_EQ(folder.problems(shortest("flame: {voxel_m: [0.05, 200, 1]}\n")), Lines{});
    EXPECT_EQ(folder.problems(shortest("flame: {voxel_m: [0.049, 200.1, 1]}\n")).size(), 2U);
}

TEST_F(Schema, WordsAreThoseOfLoad) {
    int checked = 0;
    for (const auto& key : values()) {
        if (key.words.empty()) continue;
        SCOPED_TRACE(key.path);
        EXPECT_EQ(said_of(key.path, "qqqqqqqqqqqq"),
                  fmt::format("'qqqqqqqqqqqq' is none of {}", fmt::join(key.words, ", ")));
        for (const auto& word : key.words) EXPECT_EQ(said_of(key.path, word), "") << word;
        ++checked;
    }
    EXPECT_GE(checked, 8);  // physics, methods and models, temperature profile, atmosphere
}

namespace {

std::string describe_flames(const fire::FlameRelations& f) {
    return fmt::format(" | {} {} {} {} {} {} | {} {} {} | {} {} {} {} {}", f.height.method, f.height.constant_m,
                       f.height.air_fuel_ratio, f.height.plume_coefficient_m_kW.has_value(),
                       f.height.burning_area_fraction.has_value(), f.height.stand_height_m, f.tilt.method, f.tilt.slope,
                       f.tilt.fuel_vapour_density_kg_m3, static_cast<int>(f.intensity), static_cast<int>(f.depth),
                       f.heat_of_combustion_J_kg, f.consumed_fraction, f.maximum_spread_rate_m_s);
}

/// All numbers and words of a scenario that have a default.
std::string describe(const Scenario& s) {
    const auto& f = s.fire;
    const auto& p = s.products;
    return fmt::format(
        "{} {} {} | {} {} {} {} {} {} {} {} {:.12g} {} {} {} | {} {} {} {} {:.12g} | {} {} {} {} {} | {} {} {} | {} {} | "
        "{} {} {} {} {} | {}{}{}{}{}{}{} | {} {} {} {}",
        s.geoid_undulation_m, static_cast<int>(s.physics), s.seed, f.front_threshold_W_m2, f.front_temperature_K,
        f.ambient_temperature_K, f.flaming_heat_flux_W_m2, f.one_sigma_rule, f.jitter_m, f.height_alpha,
        f.volumetric_heat_release_W_m3, f.maximum_tilt_rad, f.air_density_kg_m3, f.air_heat_capacity_J_kg_K,
        f.air_temperature_K, f.scar.amplitude1_K, f.scar.time_constant1_s, f.scar.amplitude2_K, f.scar.time_constant2_s,
        f.scar.floor_K, s.flame.off, s.flame.parameters.temperature_K, s.flame.gas.soot_volume_fraction,
        fmt::join(s.flame.parameters.voxel_m, ","), s.flame.parameters.ember_gap_m, s.surface.unburned, s.surface.burned,
        s.surface.emissivity.has_value(), s.atmosphere.model, s.atmosphere.visibility_km, s.render.samples_per_axis,
        s.render.light_directions, s.render.light_reach_m, s.render.flame_light, s.render.sun, p.radiance,
        p.brightness_temperature, p.ortho, p.truth, p.fractions, p.frp, p.quicklook, s.acquisitions[0].platform.over_centre,
        s.acquisitions[0].platform.heading_deg, s.acquisitions[0].platform.pitch_deg, s.acquisitions[0].platform.roll_deg);
}

std::string describe_all(const Scenario& s) { return describe(s) + describe_flames(s.fire.flames); }

}  // namespace

// A default that is written out changes nothing.
TEST_F(Schema, DefaultsAreThoseOfLoad) {
    const std::string without = describe_all(folder.load(shortest()));
    int checked = 0;
    for (const auto& key : values()) {
        const auto scalar = key.facts.find("default");
        if (scalar == key.facts.end() && key.default_list.empty()) continue;
        SCOPED_TRACE(key.path);
        const std::string value =
            scalar != key.facts.end() ? scalar->second : fmt::format("[{}]", fmt::join(key.default_list, ", "));
        const std::string platform = "acquisitions[].platform.", acquisition = "acquisitions[].";
        const auto said = [&](const std::string& prefix) { return key.path.substr(prefix.size()) + ": " + value; };
        const std::string text = key.path.starts_with(platform) ? with_platform("{altitude_m: 3000, " + said(platform) + "}")
                                 : key.path.starts_with(acquisition)
                                     ? with_platform("{altitude_m: 3000}, " + said(acquisition))
                                     : shortest(as_yaml(key.path, value) + "\n");
        EXPECT_EQ(describe_all(folder.load(text)), without);
        ++checked;
    }
    EXPECT_GE(checked, 40);
}

TEST_F(Schema, EveryModelOfTheAtmosphereIsShipped) {
    for (const auto& key : values()) {
        if (key.path != "atmosphere.model") continue;
        for (const auto& model : key.words) {
            const fs::path file = data_folder() / "atmosphere" / ("lowtran7_" + model + "_rural23_ground0.nc");
            EXPECT_TRUE(model == "none" || fs::exists(file)) << file;
        }
    }
}

namespace {

/// A row of a table of docs/scenario.md: key(s), default, unit, range, meaning.
struct DocumentedKey {
    std::string default_text, range;
};

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
    return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::map<std::string, DocumentedKey> documented_keys() {
    std::map<std::string, DocumentedKey> found;
    std::ifstream in(source_folder() / "docs" / "scenario.md");
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with("| `")) continue;
        std::vector<std::string> cells;
        std::istringstream row(line.substr(1));
        for (std::string cell; std::getline(row, cell, '|');) cells.push_back(trimmed(cell));
        std::string names = cells.at(0);
        for (std::size_t open; (open = names.find('`')) != std::string::npos;) {
            const auto close = names.find('`', open + 1);
            found[names.substr(open + 1, close - open - 1)] = {cells.at(1), cells.at(3)};
            names.erase(0, close + 1);
        }
    }
    return found;
}

std::string expected_range(const SchemaKey& key) {
    if (!key.words.empty()) return fmt::format("one of `{}`", fmt::join(key.words, "`, `"));
    const auto bound = [&](const char* name) { return key.facts.contains(name) ? key.facts.at(name) : ""; };
    const std::string lowest = bound("minimum"), above = bound("exclusiveMinimum"), highest = bound("maximum");
    const std::string lower = above.empty() ? lowest : "> " + above;
    if (highest.empty()) return lower.empty() ? "" : ">= " + lower;
    return lower + " to " + highest;
}

}  // namespace

TEST_F(Schema, EveryKeyIsDocumentedWithItsDefaultAndRange) {
    auto documented = documented_keys();
    for (const auto& key : values()) {
        SCOPED_TRACE(key.path);
        const auto row = documented.find(key.path);
        if (row == documented.end()) {
            ADD_FAILURE() << "not in docs/scenario.md";
            continue;
        }
        const bool list = key.facts.contains("type") && key.facts.at("type") == "array";
        if (!list) {
            EXPECT_EQ(row->second.range, expected_range(key));
        }
        if (const auto value = key.facts.find("default"); value != key.facts.end()) {
            EXPECT_EQ(row->second.default_text, "`" + value->second + "`");
        }
        documented.erase(row);
    }
    for (const auto& [path, row] : documented) ADD_FAILURE() << path << " is documented, but not a key";
}

}  // namespace pyroscene::scenario
