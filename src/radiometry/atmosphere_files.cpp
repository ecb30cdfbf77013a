#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "radiometry/atmosphere.h"

namespace pyroscene::radiometry {
namespace {

constexpr double kBaseVisibility_km = 23.0;
constexpr std::array<double, 3> kVisibilities_km{5.0, 23.0, 50.0};
constexpr std::array<double, 4> kGrounds_km{0.0, 1.0, 2.0, 3.0};
constexpr const char* kReferenceModel = "midlatitude_summer";

struct Model {
    const char* name;
    bool complete;  ///< has all visibilities (at sea level) and all elevations (at 23 km)
};
constexpr std::array<Model, 5> kModels{{{"midlatitude_summer", true},
                                        {"us_standard_1976", true},
                                        {"tropical", false},
                                        {"midlatitude_winter", false},
                                        {"subarctic_summer", false}}};

const Model& find_model(const std::string& name) {
    for (const auto& model : kModels)
        if (name == model.name) return model;
    throw input_error("atmosphere model",
                      fmt::format("'{}' is unknown; there are {}", name, fmt::join(atmosphere_models(), ", ")));
}

AtmosphereFile file(const std::string& model, double visibility_km, double ground_km) {
    return {fmt::format("lowtran7_{}_rural{:.0f}_ground{:.0f}.nc", model, visibility_km, ground_km), visibility_km,
            ground_km};
}

/// The values of an ascending list between which all from `low` to `high` lie; the nearest end outside.
template <std::size_t N>
std::vector<double> enclosing(const std::array<double, N>& values, double low, double high) {
    auto first = std::upper_bound(values.begin(), values.end(), low);
    auto last = std::lower_bound(values.begin(), values.end(), high);
    if (first != values.begin()) --first;
    if (last == values.end()) --last;
    return {first, std::max(first, last) + 1};
}

void add(std::vector<AtmosphereFile>& files, const AtmosphereFile& wanted) {
    const bool known = std::any_of(files.begin(), files.end(), [&](const auto& f) { return f.file == wanted.file; });
    if (!known) files.push_back(wanted);
}

}  // namespace

std::vector<std::string> atmosphere_models() {
    std::vector<std::string> names;
    names.reserve(std::size(kModels));
    for (const auto& model : kModels) names.emplace_back(model.name);
    return names;
}

std::vector<AtmosphereFile> atmosphere_files(const std::string& model) {
    std::vector<AtmosphereFile> files;
    if (!find_model(model).complete) return {file(model, kBaseVisibility_km, 0.0)};
    files.reserve(std::size(kGrounds_km) + std::size(kVisibilities_km));
    for (const double ground_km : kGrounds_km) files.push_back(file(model, kBaseVisibility_km, ground_km));
    for (const double visibility_km : kVisibilities_km) add(files, file(model, visibility_km, 0.0));
    return files;
}

std::vector<AtmosphereFile> needed_files(const std::string& model, double visibility_km, ElevationRange ground) {
    const bool complete = find_model(model).complete;
    const auto grounds = enclosing(kGrounds_km, ground.lowest_m / 1000.0, ground.highest_m / 1000.0);
    const auto visibilities = enclosing(kVisibilities_km, visibility_km, visibility_km);
    const bool other_ground = grounds.back() > 0.0, other_visibility = visibilities != std::vector{kBaseVisibility_km};

    std::vector<AtmosphereFile> files;
    const std::string& source = complete ? model : kReferenceModel;
    if (!complete) files.push_back(file(model, kBaseVisibility_km, 0.0));
    if (!complete && !other_ground && !other_visibility) return files;
    if (!complete) files.push_back(file(source, kBaseVisibility_km, 0.0));
    for (const double ground_km : grounds) add(files, file(source, kBaseVisibility_km, ground_km));
    if (!other_visibility) return files;
    add(files, file(source, kBaseVisibility_km, 0.0));
    for (const double other_km : visibilities) add(files, file(source, other_km, 0.0));
    return files;
}

AtmosphereSet make_atmosphere_set(
    const std::string& model, double visibility_km, ElevationRange ground,
    const std::function<std::vector<double>(const std::string& file, const std::string& variable)>& read) {
    AtmosphereSet set;
    for (const auto& needed : needed_files(model, visibility_km, ground))
        set.tables.push_back(
            make_atmosphere_table([&](const std::string& variable) { return read(needed.file, variable); }));
    return set;
}

}  // namespace pyroscene::radiometry
