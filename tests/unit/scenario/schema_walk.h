#pragma once

#include <map>
#include <string>
#include <vector>

#include "config/yaml.h"

namespace pyroscene::scenario {

/// One key of the JSON Schema: its path ("fire.tilt.method", "acquisitions[].id") and what the schema says of it, with
/// references resolved. Values are kept as they are written.
struct SchemaKey {
    std::string path;
    std::map<std::string, std::string> facts;  ///< minimum, exclusiveMinimum, maximum, default, type (scalars only)
    std::vector<std::string> words;            ///< of an enum
    std::vector<std::string> default_list;     ///< of a default that is a list
    std::vector<std::string> properties;       ///< keys of a map; empty for values
    bool is_map = false;
};

/// Every key and every map of the schema (JSON is YAML, so the strict reader reads it). The root map has an empty path.
std::vector<SchemaKey> walk_schema(const config::Document& schema);

/// The value at the end of a path as a YAML text in flow style: "fire.tilt.method", "x" -> "fire: {tilt: {method: x}}".
std::string as_yaml(const std::string& path, const std::string& value);

}  // namespace pyroscene::scenario
