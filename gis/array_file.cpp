#include "gis/array_file.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"

namespace pyroscene::gis {

std::vector<std::size_t> checked_shape(const ArrayFile& file, const ArrayVariable& variable, const std::string& subject) {
    std::vector<std::size_t> shape;
    std::size_t size = 1;
    for (const auto& name : variable.dimensions) {
        const auto found =
            std::find_if(file.dimensions.begin(), file.dimensions.end(), [&](const auto& d) { return d.first == name; });
        if (found == file.dimensions.end())
            throw runtime_error(subject, fmt::format("variable {}: no dimension '{}'", variable.name, name));
        shape.push_back(found->second);
        size *= found->second;
    }
    if (variable.values.size() != size)
        throw runtime_error(subject, fmt::format("variable {} has {} values, its dimensions ask for {}", variable.name,
                                                 variable.values.size(), size));
    return shape;
}

}  // namespace pyroscene::gis
