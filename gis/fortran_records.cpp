#include "gis/fortran_records.h"

#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "base/error.h"

namespace pyroscene::gis {
namespace {

static_assert(std::endian::native == std::endian::little, "records are read as they lie in memory");

template <class T>
std::vector<T> as(const std::vector<char>& bytes) {
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

}  // namespace

FortranRecords::FortranRecords(const std::filesystem::path& path) : path_(path.string()), in_(path, std::ios::binary) {
    if (!in_) throw input_error(path_, "cannot be opened");
}

bool FortranRecords::at_end() { return in_.peek() == std::ifstream::traits_type::eof(); }

std::vector<char> FortranRecords::record(std::size_t expected_bytes, bool several) {
    ++number_;
    const auto mark = [&] {
        std::uint32_t length = 0;
        in_.read(reinterpret_cast<char*>(&length), sizeof length);
        if (!in_) throw input_error(path_, fmt::format("ends before the end of record {}", number_));
        return length;
    };
    const std::uint32_t before = mark();
    const bool fits = several ? before > 0 && before % expected_bytes == 0 : before == expected_bytes;
    if (!fits)
        throw input_error(path_,
                          fmt::format("record {} has {} bytes, expected {}{}; is it a little-endian Fortran file of this "
                                      "grid?",
                                      number_, before, several ? "a multiple of " : "", expected_bytes));
    std::vector<char> bytes(before);
    in_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!in_) throw input_error(path_, fmt::format("ends inside record {}", number_));
    if (const std::uint32_t after = mark(); after != before)
        throw input_error(path_, fmt::format("record {} begins with length {} and ends with {}", number_, before, after));
    return bytes;
}

std::string FortranRecords::text(std::size_t length) {
    const auto bytes = record(length);
    std::string out(bytes.begin(), bytes.end());
    out.erase(out.find_last_not_of(std::string(" \0", 2)) + 1);
    return out;
}

std::vector<std::int32_t> FortranRecords::integers(std::size_t count) {
    return as<std::int32_t>(record(count * sizeof(std::int32_t)));
}

std::vector<float> FortranRecords::floats(std::size_t count) { return as<float>(record(count * sizeof(float))); }

std::vector<float> FortranRecords::layers_of_floats(std::size_t count) {
    return as<float>(record(count * sizeof(float), true));
}

}  // namespace pyroscene::gis
