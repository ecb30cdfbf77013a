#pragma once

#include <filesystem>
#include <string>

namespace pyroscene {

/// An output file that exists only when it is whole: write to path(), then commit() renames it to its final name.
/// Without commit() the temporary (and what GDAL wrote beside it) is removed. The temporary keeps the extension,
/// because drivers look at it, and lies in the target's folder, so that the rename is atomic.
class AtomicFile {
public:
    explicit AtomicFile(std::filesystem::path target);
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return temporary_; }
    /// Throws a runtime error when the rename fails.
    void commit();

private:
    std::filesystem::path target_, temporary_;
    bool committed_ = false;
};

/// Writes a whole text file atomically. Throws a runtime error.
void write_text_file(const std::filesystem::path& path, const std::string& text);

/// Reads a whole text file. Throws an input error.
std::string read_text_file(const std::filesystem::path& path);

/// Folder of the data the product ships (atmosphere, optical tables, fuel models): the environment variable
/// PYROSCENE_DATA, else the folder installed beside the program, else the source tree it was built from.
/// Throws a runtime error when none exists.
std::filesystem::path data_folder();

/// Folder with the shipped sensor files (specs/, srf/, bands/): `sensors` beside data_folder()'s contents or,
/// in a source tree, `sensors/`.
std::filesystem::path sensor_folder();

}  // namespace pyroscene
