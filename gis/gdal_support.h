#pragma once

#include <filesystem>
#include <memory>
#include <string>

class GDALDataset;

/// What every user of GDAL in this module needs: drivers registered once, errors as values, datasets that close themselves.
namespace pyroscene::gis {

/// Registers the GDAL drivers on first use. Thread-safe.
void initialise_gdal();

/// Keeps what GDAL and PROJ report on this thread instead of letting them print it. Scopes nest.
class GdalErrors {
public:
    GdalErrors();
    GdalErrors(const GdalErrors&) = delete;
    GdalErrors& operator=(const GdalErrors&) = delete;
    ~GdalErrors();

    [[nodiscard]] bool failed() const noexcept { return failed_; }
    /// Text of the first failure, which names the cause (later ones are its consequences); "unknown cause" without one.
    [[nodiscard]] std::string message() const;
    void note(std::string text);

private:
    bool failed_ = false;
    std::string first_;
};

/// A GDAL configuration option for this thread while the object lives.
class ThreadOption {
public:
    ThreadOption(const char* key, const char* value);
    ThreadOption(const ThreadOption&) = delete;
    ThreadOption& operator=(const ThreadOption&) = delete;
    ~ThreadOption();

private:
    std::string key_, previous_;
    bool had_previous_ = false;
};

struct DatasetCloser {
    void operator()(GDALDataset* dataset) const noexcept;
};
using DatasetPtr = std::unique_ptr<GDALDataset, DatasetCloser>;

/// Opens a raster for reading. Throws an input error: missing file, not a raster, only subdatasets (which are listed).
DatasetPtr open_raster(const std::filesystem::path& path);

/// Opens a netCDF file for its arrays; nothing when it is none. By name: files without an ending, as WRF's, go to GDAL's HDF5 driver
/// otherwise, for which an unlimited dimension has no length.
DatasetPtr open_netcdf(const std::filesystem::path& path);

/// Raster in memory (GDAL's MEM driver) without bands. Throws a runtime error.
DatasetPtr create_memory_dataset(int cols, int rows);

}  // namespace pyroscene::gis
