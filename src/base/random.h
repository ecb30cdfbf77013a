#pragma once

#include <array>
#include <cstdint>

namespace pyroscene {

/// Counter-based random numbers: every draw is a pure function of (seed, stream, counter), so results do not
/// depend on thread count or job order. Generator: Philox4x32-10 (Salmon et al. 2011, SC'11, doi 10.1145/2063384.2063405).
struct RandomKey {
    std::uint64_t seed = 0;    ///< the scenario's seed
    std::uint32_t stream = 0;  ///< what is drawn: hash of purpose / sensor / band (see stream_id)
    std::uint32_t frame = 0;   ///< frame or acquisition number
};

/// Four 32-bit words for the given counter.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) noexcept;

/// Uniform in the open interval (0, 1) for draw number `draw` of element `index`.
double uniform01(const RandomKey& key, std::uint64_t index, std::uint32_t draw = 0) noexcept;

/// Standard normal deviate (Box-Muller) for draw number `draw` of element `index`.
double standard_normal(const RandomKey& key, std::uint64_t index, std::uint32_t draw = 0) noexcept;

/// Stable 32-bit identifier of a text (FNV-1a), to build RandomKey::stream from names such as "noise/wasp_1h/MWIR".
std::uint32_t stream_id(const char* text) noexcept;

}  // namespace pyroscene
