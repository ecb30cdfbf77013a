#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "gis/crs.h"
#include "gis/fds_lattice.h"
#include "gis/fire_model_files.h"

namespace pyroscene::gis {
namespace {

/// The files of the first label that the run has.
std::vector<FdsFile> first_found(const FdsIndex& index, const std::vector<std::string>& labels) {
    std::vector<FdsFile> files;
    for (const auto& label : labels) {
        std::copy_if(index.files.begin(), index.files.end(), std::back_inserter(files),
                     [&](const FdsFile& f) { return f.label == label; });
        if (!files.empty()) break;
    }
    return files;
}

std::vector<FdsFile> files_of(const FdsIndex& index, const std::vector<std::string>& labels, const std::string& smv) {
    auto files = first_found(index, labels);
    if (!files.empty()) return files;
    std::set<std::string> found;
    for (const auto& file : index.files) found.insert(file.label);
    throw input_error(smv, fmt::format("has no output of '{}'; it has {}", fmt::join(labels, "', '"),
                                       found.empty() ? "none" : fmt::format("{}", fmt::join(found, ", "))));
}

/// A quantity on the ground, moment by moment, from the files of all meshes.
class Ground {
public:
    /// \param volume  volumes, summed over their height; else surfaces
    Ground(const FdsIndex& index, std::vector<FdsFile> files, bool volume, const std::string& smv)
        : index_(index), files_(std::move(files)), smv_(smv), cells_(has_cells()), lattice_(index.meshes, cells_, smv) {
        for (const auto& file : files_) readers_.emplace_back(file, index_.meshes[file.mesh], volume);
        if (std::none_of(readers_.begin(), readers_.end(), [](const FdsReader& r) { return r.on_ground(); }))
            throw input_error(
                smv, fmt::format("'{}' has {}", files_.front().label,
                                 volume ? "no slice that is a volume" : "no horizontal slice and no surface that faces up"));
    }
    [[nodiscard]] const FdsLattice& lattice() const noexcept { return lattice_; }

    /// The next moment; nothing when a file ends. Files of all meshes must be of one time.
    std::optional<std::vector<float>> next(FdsLattice::Rule rule, float most, double& time_s) {
        auto moment = lattice_.moment();
        for (std::size_t i = 0; i < readers_.size(); ++i) {
            auto& reader = readers_[i];
            if (!reader.next()) return std::nullopt;
            if (i == 0) time_s = reader.time_s();
            if (std::abs(reader.time_s() - time_s) > 1e-3 * std::max(1.0, std::abs(time_s)))
                throw input_error(smv_, fmt::format("'{}' is given at {:g} s in one mesh and at {:g} s in another",
                                                    files_[i].label, time_s, reader.time_s()));
            lattice_.lay(reader, files_[i], index_.meshes[files_[i].mesh], rule, most, moment);
        }
        return std::move(moment.values);
    }

    [[nodiscard]] MemoryRaster raster(const std::string& unit, const LocalPlacement& place) const {
        return {
            lattice_.cols(),
            lattice_.rows(),
            north_up(place.west_m + lattice_.west_m(), place.south_m + lattice_.north_m(), lattice_.dx_m(), lattice_.dy_m()),
            parse_map_crs(place.crs, "crs of the FDS run").wkt,
            unit,
            {}};
    }

private:
    [[nodiscard]] bool has_cells() const {
        std::set<bool> kinds;
        for (const auto& file : files_)
            if (file.kind != FdsFile::Kind::Geometry) kinds.insert(file.cell_centred);
        if (kinds.size() > 1)
            throw input_error(
                smv_, fmt::format("'{}' is given at nodes and at cells; expected one of the two", files_.front().label));
        return kinds.empty() || *kinds.begin();
    }

    const FdsIndex& index_;
    std::vector<FdsFile> files_;
    std::string smv_;
    bool cells_;
    FdsLattice lattice_;
    std::deque<FdsReader> readers_;
};

void require_unit(const std::vector<FdsFile>& files, const std::vector<std::string>& units, const std::string& smv) {
    for (const auto& file : files)
        if (file.unit != files.front().unit || std::find(units.begin(), units.end(), file.unit) == units.end())
            throw input_error(
                smv, fmt::format("'{}' is in '{}', expected '{}'", file.label, file.unit, fmt::join(units, "' or '")));
}

std::string key_of(const std::string& smv, const std::string& label, const LocalPlacement& place) {
    return fmt::format("{}|{}|{}|{}|{}", smv, label, place.crs, place.west_m, place.south_m);
}

}  // namespace

std::filesystem::path fds_ground_quantity(const std::filesystem::path& smv, const std::vector<std::string>& labels,
                                          const std::string& unit, const LocalPlacement& place) {
    constexpr float kNotReached = 9e5F;
    const auto subject = smv.string();
    const FdsIndex index = read_fds_index(smv);
    const auto files = files_of(index, labels, subject);
    require_unit(files, {unit}, subject);
    Ground ground(index, files, false, subject);
    auto out = ground.raster(unit, place);
    out.bands.emplace_back(ground.lattice().size(), std::numeric_limits<float>::quiet_NaN());
    double time_s = 0.0;
    while (auto moment = ground.next(FdsLattice::Rule::Smallest, kNotReached, time_s)) out.bands[0] = std::move(*moment);
    return keep_in_memory("fds", key_of(subject, files.front().label, place), "ground", out);
}

std::vector<std::string> fds_flux_labels(const std::string& quantity) {
    if (!quantity.empty()) return {quantity};
    return {"HRRPUA", "HRRPUV"};
}

std::vector<std::filesystem::path> fds_files(const std::filesystem::path& smv, const std::vector<std::string>& labels) {
    std::vector<std::filesystem::path> files;
    for (const auto& file : first_found(read_fds_index(smv), labels)) {
        files.push_back(file.file);
        if (!file.geometry.empty()) files.push_back(file.geometry);
    }
    return files;
}

FluxSeries fds_heat_flux(const std::filesystem::path& smv, const std::string& quantity, const LocalPlacement& place) {
    constexpr float kMost_W_m2 = 1e8F, kAny = std::numeric_limits<float>::infinity();
    const auto subject = smv.string();
    const FdsIndex index = read_fds_index(smv);
    const auto files = files_of(index, fds_flux_labels(quantity), subject);
    require_unit(files, {"kW/m2", "kW/m3"}, subject);
    Ground ground(index, files, files.front().unit == "kW/m3", subject);
    auto out = ground.raster("W m-2", place);
    FluxSeries series;
    double time_s = 0.0;
    while (auto moment = ground.next(FdsLattice::Rule::Largest, kAny, time_s)) {
        for (float& v : *moment) {
            v = v < 0.0F ? 0.0F : 1000.0F * v;  // NaN stays
            if (v > kMost_W_m2)
                throw input_error(subject, fmt::format("'{}' has a flux of {:.4g} kW m-2 at {:g} s, expected 0 to {:g}",
                                                       files.front().label, v / 1000.0F, time_s, kMost_W_m2 / 1000.0F));
        }
        out.bands.push_back(std::move(*moment));
        series.times_s.push_back(time_s);
    }
    if (series.times_s.empty()) throw input_error(subject, fmt::format("'{}' has no moment", files.front().label));
    series.raster = keep_in_memory("fds", key_of(subject, files.front().label, place), "heat_flux", out);
    return series;
}

}  // namespace pyroscene::gis
