#pragma once

#include <filesystem>

namespace pyroscene {

/// The source tree that the tests belong to: shipped data, scenarios and test data are read from it.
std::filesystem::path source_folder();

}  // namespace pyroscene
