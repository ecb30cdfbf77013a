#include "gis/array_file.h"

#include <algorithm>
#include <functional>
#include <numeric>

#include <fmt/format.h>

#include "base/error.h"

namespace pyroscene::gis {

std::vector<std::size_t> array_shape(const ArrayFile& file, const ArrayVariable& variable, const std::string& subject) {
    std::vector<std::size_t> shape;
    for (const auto& name : variable.dimensions) {
        const auto found =
            std::find_if(file.dimensions.begin(), file.dimensions.end(), [&](const auto& d) { return d.first == name; });
        if (found == file.dimensions.end())
            throw runtime_error(subject, fmt::format("variable {}: no dimension '{}'", variable.name, name));
        shape.push_back(found->second);
    }
    return shape;
}

void for_each_part(const ArrayFile& file, const ArrayVariable& variable, const std::string& subject,
                   const std::function<void(const ArrayPart&)>& take) {
    auto shape = array_shape(file, variable, subject);
    const bool in_planes = variable.make && shape.size() == 3;
    const std::size_t planes = in_planes ? shape.front() : 1;
    if (in_planes) shape.front() = 1;
    const auto size = std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
    for (std::size_t p = 0; p < planes; ++p) {
        std::vector<double> made;
        if (variable.make) made = variable.make(p);
        const auto& values = variable.make ? made : variable.values;
        if (values.size() != size)
            throw runtime_error(subject, fmt::format("variable {} has {} values, its dimensions ask for {}", variable.name,
                                                     values.size(), size));
        ArrayPart part{std::vector<std::size_t>(shape.size(), 0), shape, values};
        if (in_planes) part.start.front() = p;
        take(part);
    }
}

}  // namespace pyroscene::gis
