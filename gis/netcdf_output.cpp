#include "gis/netcdf_output.h"

#include <algorithm>

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include "base/error.h"
#include "base/files.h"
#include "gis/gdal_support.h"

namespace pyroscene::gis {
namespace {

using Dimensions = std::map<std::string, std::shared_ptr<GDALDimension>>;

template <class Owner>
void set_text(Owner& owner, const std::string& name, const std::string& text) {
    if (text.empty()) return;
    const auto attribute = owner.CreateAttribute(name, {}, GDALExtendedDataType::CreateString());
    if (attribute) attribute->Write(text.c_str());
}

void write_variable(GDALGroup& root, const Dimensions& dimensions, const NetCdfVariable& v, const std::string& subject,
                    const GdalErrors& errors) {
    std::vector<std::shared_ptr<GDALDimension>> axes;
    std::vector<std::size_t> count;
    std::size_t size = 1;
    for (const auto& name : v.dimensions) {
        axes.push_back(dimensions.at(name));
        count.push_back(static_cast<std::size_t>(axes.back()->GetSize()));
        size *= count.back();
    }
    if (v.values.size() != size)
        throw runtime_error(
            subject, fmt::format("variable {} has {} values, its dimensions ask for {}", v.name, v.values.size(), size));
    CPLStringList options;
    if (!axes.empty()) options.SetNameValue("COMPRESS", "DEFLATE");
    const auto type = GDALExtendedDataType::Create(v.single_precision ? GDT_Float32 : GDT_Float64);
    const auto array = root.CreateMDArray(v.name, axes, type, options.List());
    if (!array) throw runtime_error(subject, fmt::format("variable {}: {}", v.name, errors.message()));
    array->SetUnit(v.unit);
    set_text(*array, "long_name", v.long_name);
    const std::vector<GUInt64> start(count.size(), 0);
    if (!array->Write(start.data(), count.data(), nullptr, nullptr, GDALExtendedDataType::Create(GDT_Float64),
                      v.values.data()))
        throw runtime_error(subject, fmt::format("variable {}: {}", v.name, errors.message()));
}

}  // namespace

void write_netcdf(const std::filesystem::path& path, const NetCdfFile& file) {
    initialise_gdal();
    const GdalErrors errors;
    const std::string subject = path.string();
    auto* driver = GetGDALDriverManager()->GetDriverByName("netCDF");
    if (driver == nullptr) throw runtime_error(subject, "GDAL was built without netCDF");
    AtomicFile target(path);
    {
        CPLStringList options;
        options.SetNameValue("FORMAT", "NC4");
        const DatasetPtr dataset(driver->CreateMultiDimensional(target.path().c_str(), nullptr, options.List()));
        if (!dataset) throw runtime_error(subject, "cannot be created: " + errors.message());
        const auto root = dataset->GetRootGroup();
        if (!root) throw runtime_error(subject, "cannot be created: " + errors.message());
        Dimensions dimensions;
        for (const auto& [name, size] : file.dimensions) {
            dimensions[name] = root->CreateDimension(name, "", "", size);
            if (!dimensions[name]) throw runtime_error(subject, fmt::format("dimension {}: {}", name, errors.message()));
        }
        for (const auto& variable : file.variables) write_variable(*root, dimensions, variable, subject, errors);
        for (const auto& [name, text] : file.attributes) set_text(*root, name, text);
        dataset->FlushCache(true);
        if (errors.failed()) throw runtime_error(subject, "cannot be written: " + errors.message());
    }
    target.commit();
}

}  // namespace pyroscene::gis
