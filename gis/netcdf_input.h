#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace pyroscene::gis {

/// A numeric array of a netCDF file with its dimensions in file order.
struct NamedArray {
    std::vector<std::size_t> shape;
    std::vector<std::string> dimensions;
    std::string unit;
    std::vector<double> values;  ///< row-major
};

/// A netCDF file open for reading (GDAL multidimensional API).
class NetcdfFile {
public:
    /// Throws an input error naming the file: not there, not netCDF.
    explicit NetcdfFile(const std::filesystem::path& path);
    NetcdfFile(NetcdfFile&&) noexcept;
    NetcdfFile& operator=(NetcdfFile&&) noexcept;
    ~NetcdfFile();

    [[nodiscard]] const std::filesystem::path& path() const noexcept;
    /// Throws an input error naming file and variable.
    [[nodiscard]] NamedArray read(const std::string& variable) const;
    /// One position along the first dimension, which the result does not have. Throws also when there is no such position.
    [[nodiscard]] NamedArray read_record(const std::string& variable, std::size_t record) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// One variable of a file. Throws as NetcdfFile.
NamedArray read_netcdf_variable(const std::filesystem::path& path, const std::string& variable);

}  // namespace pyroscene::gis
