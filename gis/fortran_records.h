#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace pyroscene::gis {

/// A sequential unformatted file as Fortran compilers write it on little-endian machines: every record between two marks of 4 bytes
/// that hold its length. All readers throw an input error naming file and record when marks do not agree, the file ends inside a record,
/// or a record has another length than asked for.
class FortranRecords {
public:
    explicit FortranRecords(const std::filesystem::path& path);

    [[nodiscard]] bool at_end();
    [[nodiscard]] const std::string& path() const noexcept { return path_; }
    /// Text without trailing blanks. \param length  of the record in bytes
    std::string text(std::size_t length);
    std::vector<std::int32_t> integers(std::size_t count);
    std::vector<float> floats(std::size_t count);
    /// A record of several times so many.
    std::vector<float> layers_of_floats(std::size_t count);

private:
    std::vector<char> record(std::size_t expected_bytes, bool several = false);

    std::string path_;
    std::ifstream in_;
    int number_ = 0;
};

}  // namespace pyroscene::gis
