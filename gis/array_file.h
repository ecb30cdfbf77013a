#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// Named arrays on named dimensions, as netCDF and HDF4 files hold them.
namespace pyroscene::gis {

enum class SampleType { UInt8, Int16, UInt16, Int32, Float32, Float64 };

/// Calls `f` with a value of the C++ type.
template <class F>
auto with_sample(SampleType type, const F& f) {
    switch (type) {
        case SampleType::UInt8:
            return f(std::uint8_t{});
        case SampleType::Int16:
            return f(std::int16_t{});
        case SampleType::UInt16:
            return f(std::uint16_t{});
        case SampleType::Int32:
            return f(std::int32_t{});
        case SampleType::Float32:
            return f(float{});
        case SampleType::Float64:
            break;
    }
    return f(double{});
}

/// Numbers of one type.
struct Numbers {
    SampleType type = SampleType::Float32;
    std::vector<double> values{};
};
using Attribute = std::variant<std::string, Numbers>;
using Attributes = std::vector<std::pair<std::string, Attribute>>;

/// A numeric array to write, on named dimensions (none: a scalar).
struct ArrayVariable {
    std::string name{};  ///< netCDF: "group/name" for one in a group
    std::vector<std::string> dimensions{};
    std::string unit{}, long_name{};
    std::vector<double> values{};  ///< row-major; what the type cannot hold is an error of the caller
    SampleType type = SampleType::Float32;
    std::optional<double> fill{};  ///< _FillValue
    Attributes attributes{};
    /// Instead of values: gives them when they are written, plane by plane of a variable of three dimensions, else at once.
    std::function<std::vector<double>(std::size_t plane)> make{};
};

struct ArrayFile {
    std::vector<std::pair<std::string, std::size_t>> dimensions;
    std::vector<ArrayVariable> variables;
    std::map<std::string, std::string> attributes;  ///< of the file
};

/// A piece of a variable: from `start` on `count` values along each dimension.
struct ArrayPart {
    std::vector<std::size_t> start, count;
    std::span<const double> values;

    /// The values as they are stored.
    template <class Sample>
    [[nodiscard]] std::vector<Sample> as() const {
        std::vector<Sample> typed(values.size());
        for (std::size_t i = 0; i < typed.size(); ++i) typed[i] = static_cast<Sample>(values[i]);
        return typed;
    }
};

/// Extent of a variable along its dimensions. Throws a runtime error with `subject` for a dimension that the file does not know.
std::vector<std::size_t> array_shape(const ArrayFile& file, const ArrayVariable& variable, const std::string& subject);
/// Hands on the parts of a variable one after another. Throws a runtime error with `subject` when its dimensions ask for another
/// number of values.
void for_each_part(const ArrayFile& file, const ArrayVariable& variable, const std::string& subject,
                   const std::function<void(const ArrayPart&)>& take);

}  // namespace pyroscene::gis
