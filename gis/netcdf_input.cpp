#include "gis/netcdf_input.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/error.h"
#include "gis/gdal_support.h"

namespace pyroscene::gis {
namespace {

std::string names_of(const GDALGroup& root) {
    std::string list;
    for (const auto& name : root.GetMDArrayNames()) list += (list.empty() ? "" : ", ") + name;
    return list;
}

/// \param start, count  along all dimensions of the file
void read_values(const GDALMDArray& array, const std::vector<GUInt64>& start, const std::vector<std::size_t>& count,
                 NamedArray& out, const std::string& subject, const GdalErrors& errors) {
    // GDAL converts value by value, which costs more than reading: floats are read as they are.
    const auto read = [&](auto& values, GDALDataType type) {
        if (!array.Read(start.data(), count.data(), nullptr, nullptr, GDALExtendedDataType::Create(type), values.data()))
            throw input_error(subject, "cannot be read: " + errors.message());
    };
    if (array.GetDataType().GetNumericDataType() == GDT_Float32) {
        std::vector<float> values(out.values.size());
        read(values, GDT_Float32);
        std::copy(values.begin(), values.end(), out.values.begin());
    } else {
        read(out.values, GDT_Float64);
    }
    bool has_nodata = false, has_scale = false, has_offset = false;
    const double nodata = array.GetNoDataValueAsDouble(&has_nodata);
    const double scale = array.GetScale(&has_scale), offset = array.GetOffset(&has_offset);
    for (double& value : out.values) {
        if (has_nodata && value == nodata) value = std::numeric_limits<double>::quiet_NaN();
        if (has_scale) value *= scale;
        if (has_offset) value += offset;
    }
}

}  // namespace

struct NetcdfFile::Impl {
    std::filesystem::path path;
    DatasetPtr dataset;

    [[nodiscard]] NamedArray read(const std::string& variable, std::optional<std::size_t> record) const;
};

NetcdfFile::NetcdfFile(const std::filesystem::path& path) {
    initialise_gdal();
    const GdalErrors errors;
    DatasetPtr dataset = open_netcdf(path);
    if (!dataset) {
        std::error_code ignored;
        if (!std::filesystem::exists(path, ignored)) throw input_error(path.string(), "no such file");
        throw input_error(path.string(), "is not a netCDF file that can be read: " + errors.message());
    }
    impl_ = std::make_unique<Impl>(Impl{path, std::move(dataset)});
}
NetcdfFile::NetcdfFile(NetcdfFile&&) noexcept = default;
NetcdfFile& NetcdfFile::operator=(NetcdfFile&&) noexcept = default;
NetcdfFile::~NetcdfFile() = default;

const std::filesystem::path& NetcdfFile::path() const noexcept { return impl_->path; }

/// A variable, whole or one position along its first dimension.
NamedArray NetcdfFile::Impl::read(const std::string& variable, std::optional<std::size_t> record) const {
    const GdalErrors errors;
    const std::string subject = fmt::format("{}, variable '{}'", path.string(), variable);
    const auto root = dataset->GetRootGroup();
    const auto array = root ? root->OpenMDArray(variable) : nullptr;
    if (!array)
        throw input_error(subject, "not in the file; it has " + (root ? names_of(*root) : std::string("no variables")));
    if (array->GetDataType().GetClass() != GEDTC_NUMERIC) throw input_error(subject, "is text; expected numbers");
    NamedArray out;
    std::size_t size = 1;
    std::vector<GUInt64> start;
    std::vector<std::size_t> count;
    for (const auto& dimension : array->GetDimensions()) {
        const auto length = static_cast<std::size_t>(dimension->GetSize());
        const bool picked = record && start.empty();
        if (picked && *record >= length)
            throw input_error(subject, fmt::format("record {} is asked for, found {}", *record, length));
        start.push_back(picked ? *record : 0);
        count.push_back(picked ? 1 : length);
        if (picked) continue;
        out.dimensions.push_back(dimension->GetName());
        out.shape.push_back(length);
        size *= length;
    }
    out.unit = array->GetUnit();
    out.values.resize(size);
    if (size > 0) read_values(*array, start, count, out, subject, errors);
    return out;
}

NamedArray NetcdfFile::read(const std::string& variable) const { return impl_->read(variable, std::nullopt); }

NamedArray NetcdfFile::read_record(const std::string& variable, std::size_t record) const {
    return impl_->read(variable, record);
}

NamedArray read_netcdf_variable(const std::filesystem::path& path, const std::string& variable) {
    return NetcdfFile(path).read(variable);
}

}  // namespace pyroscene::gis
