#include "gis/gdal_support.h"

#include <mutex>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_srs_api.h>

#include "base/error.h"

namespace pyroscene::gis {

void initialise_gdal() {
    static std::once_flag once;
    std::call_once(once, [] {
        GDALAllRegister();
        OSRSetPROJEnableNetwork(0);  // results must not depend on a connection
    });
}

namespace {

void CPL_STDCALL keep_failure(CPLErr severity, CPLErrorNum, const char* text) {
    if (severity != CE_Failure && severity != CE_Fatal) return;
    static_cast<GdalErrors*>(CPLGetErrorHandlerUserData())->note(text);
}

}  // namespace

GdalErrors::GdalErrors() {
    CPLErrorReset();
    CPLPushErrorHandlerEx(keep_failure, this);
}

GdalErrors::~GdalErrors() { CPLPopErrorHandler(); }

std::string GdalErrors::message() const { return first_.empty() ? "unknown cause" : first_; }

void GdalErrors::note(std::string text) {
    if (!failed_) first_ = std::move(text);
    failed_ = true;
}

ThreadOption::ThreadOption(const char* key, const char* value) : key_(key) {
    if (const char* previous = CPLGetThreadLocalConfigOption(key, nullptr)) {
        had_previous_ = true;
        previous_ = previous;
    }
    CPLSetThreadLocalConfigOption(key, value);
}

ThreadOption::~ThreadOption() { CPLSetThreadLocalConfigOption(key_.c_str(), had_previous_ ? previous_.c_str() : nullptr); }

void DatasetCloser::operator()(GDALDataset* dataset) const noexcept { GDALClose(dataset); }

namespace {

std::string subdataset_list(GDALDataset& dataset) {
    std::string names;
    const char* const* items = dataset.GetMetadata("SUBDATASETS");
    for (int i = 1; const char* name = CSLFetchNameValue(items, fmt::format("SUBDATASET_{}_NAME", i).c_str()); ++i)
        names += (names.empty() ? "" : ", ") + std::string(name);
    return names;
}

}  // namespace

DatasetPtr open_raster(const std::filesystem::path& path) {
    initialise_gdal();
    const std::string name = path.string();
    const GdalErrors errors;
    DatasetPtr dataset(GDALDataset::Open(name.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
    if (!dataset) {
        std::error_code ignored;
        const bool plain_file = name.find(':') == std::string::npos;  // else a name such as NETCDF:"file":variable
        if (plain_file && !std::filesystem::exists(path, ignored)) throw input_error(name, "no such file");
        throw input_error(name, "is not a raster that can be read: " + errors.message());
    }
    if (dataset->GetRasterCount() == 0) {
        const auto list = subdataset_list(*dataset);
        throw input_error(name, list.empty() ? "holds no raster band" : "holds several rasters; name one of " + list);
    }
    return dataset;
}

DatasetPtr open_netcdf(const std::filesystem::path& path) {
    initialise_gdal();
    return DatasetPtr(GDALDataset::Open(("NETCDF:\"" + path.string() + "\"").c_str(),
                                        GDAL_OF_MULTIDIM_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
}

DatasetPtr create_memory_dataset(int cols, int rows) {
    initialise_gdal();
    const GdalErrors errors;
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
    DatasetPtr dataset(driver == nullptr ? nullptr : driver->Create("", cols, rows, 0, GDT_Float32, nullptr));
    if (!dataset) throw runtime_error("raster in memory", errors.message());
    return dataset;
}

}  // namespace pyroscene::gis
