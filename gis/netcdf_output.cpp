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
using Groups = std::map<std::string, std::shared_ptr<GDALGroup>>;

GDALDataType gdal_type(SampleType type) {
    switch (type) {
        case SampleType::UInt8:
            return GDT_Byte;
        case SampleType::Int16:
            return GDT_Int16;
        case SampleType::UInt16:
            return GDT_UInt16;
        case SampleType::Int32:
            return GDT_Int32;
        case SampleType::Float32:
            return GDT_Float32;
        case SampleType::Float64:
            break;
    }
    return GDT_Float64;
}

template <class Owner>
void set_text(Owner& owner, const std::string& name, const std::string& text) {
    if (text.empty()) return;
    const auto attribute = owner.CreateAttribute(name, {}, GDALExtendedDataType::CreateString());
    if (attribute) attribute->Write(text.c_str());
}

void set_attribute(GDALMDArray& array, const std::string& name, const Attribute& value) {
    if (const auto* text = std::get_if<std::string>(&value)) return set_text(array, name, *text);
    const auto& numbers = std::get<Numbers>(value);
    std::vector<GUInt64> count;
    if (numbers.values.size() > 1) count.push_back(numbers.values.size());
    const auto attribute = array.CreateAttribute(name, count, GDALExtendedDataType::Create(gdal_type(numbers.type)));
    if (attribute) attribute->Write(numbers.values.data(), numbers.values.size());
}

/// The group of "group/name", made when it is not there yet; the root for a plain name.
std::pair<GDALGroup*, std::string> place_of(const std::string& name, Groups& groups) {
    const auto slash = name.find('/');
    if (slash == std::string::npos) return {groups.at("").get(), name};
    auto& group = groups[name.substr(0, slash)];
    if (!group) group = groups.at("")->CreateGroup(name.substr(0, slash));
    return {group.get(), name.substr(slash + 1)};
}

void write_variable(Groups& groups, const Dimensions& dimensions, const ArrayFile& file, const ArrayVariable& v,
                    const std::string& subject, const GdalErrors& errors) {
    std::vector<std::shared_ptr<GDALDimension>> axes;
    (void)array_shape(file, v, subject);  // all dimensions are there
    for (const auto& name : v.dimensions) axes.push_back(dimensions.at(name));
    CPLStringList options;
    if (!axes.empty()) options.SetNameValue("COMPRESS", "DEFLATE");
    const auto type = GDALExtendedDataType::Create(gdal_type(v.type));
    const auto [group, name] = place_of(v.name, groups);
    const auto array = group == nullptr ? nullptr : group->CreateMDArray(name, axes, type, options.List());
    if (!array) throw runtime_error(subject, fmt::format("variable {}: {}", v.name, errors.message()));
    if (!v.unit.empty()) array->SetUnit(v.unit);
    set_text(*array, "long_name", v.long_name);
    if (v.fill) array->SetNoDataValue(*v.fill);
    for (const auto& [key, value] : v.attributes) set_attribute(*array, key, value);
    for_each_part(file, v, subject, [&](const ArrayPart& part) {
        const std::vector<GUInt64> start(part.start.begin(), part.start.end());
        // In the type of the array: what GDAL has to convert it writes value by value.
        const bool done = with_sample(v.type, [&](auto sample) {
            const auto typed = part.as<decltype(sample)>();
            return array->Write(start.data(), part.count.data(), nullptr, nullptr, type, typed.data());
        });
        if (!done) throw runtime_error(subject, fmt::format("variable {}: {}", v.name, errors.message()));
    });
}

}  // namespace

void write_netcdf(const std::filesystem::path& path, const ArrayFile& file) {
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
        Groups groups{{"", dataset->GetRootGroup()}};
        const auto& root = groups.at("");
        if (!root) throw runtime_error(subject, "cannot be created: " + errors.message());
        Dimensions dimensions;
        for (const auto& [name, size] : file.dimensions) {
            dimensions[name] = root->CreateDimension(name, "", "", size);
            if (!dimensions[name]) throw runtime_error(subject, fmt::format("dimension {}: {}", name, errors.message()));
        }
        for (const auto& [name, text] : file.attributes) set_text(*root, name, text);
        for (const auto& variable : file.variables) write_variable(groups, dimensions, file, variable, subject, errors);
        dataset->FlushCache(true);
        if (errors.failed()) throw runtime_error(subject, "cannot be written: " + errors.message());
    }
    target.commit();
}

}  // namespace pyroscene::gis
