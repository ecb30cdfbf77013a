#include "render/parallel.h"

#include <cstdint>
#ifdef __linux__
#include <sys/mman.h>
#endif

namespace pyroscene::render {

void make_large(std::vector<float>& values, std::size_t count) {
    values.reserve(count);
#ifdef __linux__
    constexpr std::uintptr_t kHugePage = std::uintptr_t{2} << 20U;
    const auto address = reinterpret_cast<std::uintptr_t>(values.data());
    const std::uintptr_t begin = (address + kHugePage - 1) / kHugePage * kHugePage;
    const std::uintptr_t end = (address + count * sizeof(float)) / kHugePage * kHugePage;
    if (begin < end)
        madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // advice only: failure is harmless
#endif
    values.resize(count);
}

}  // namespace pyroscene::render
