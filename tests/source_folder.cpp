#include "source_folder.h"

namespace pyroscene {

std::filesystem::path source_folder() { return PYROSCENE_TEST_SOURCE_DIR; }

}  // namespace pyroscene
