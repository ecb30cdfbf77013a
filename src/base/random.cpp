#include "base/random.h"

#include <cmath>

#include "base/constants.h"

namespace pyroscene {

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) noexcept {
    constexpr std::uint64_t kMultiplier0 = 0xD2511F53u, kMultiplier1 = 0xCD9E8D57u;
    constexpr std::uint32_t kWeyl0 = 0x9E3779B9u, kWeyl1 = 0xBB67AE85u;
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t p0 = kMultiplier0 * counter[0], p1 = kMultiplier1 * counter[2];
        counter = {static_cast<std::uint32_t>(p1 >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(p1),
                   static_cast<std::uint32_t>(p0 >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(p0)};
        key[0] += kWeyl0;
        key[1] += kWeyl1;
    }
    return counter;
}

namespace {

std::array<std::uint32_t, 4> draw_words(const RandomKey& key, std::uint64_t index, std::uint32_t draw) noexcept {
    // The frame takes part in the key by an odd multiplier; streams and draws have counter words of their own.
    const auto frame_mix = static_cast<std::uint32_t>(key.frame * 0x9E3779B1u);
    return philox4x32({static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), key.stream, draw},
                      {static_cast<std::uint32_t>(key.seed), static_cast<std::uint32_t>(key.seed >> 32) ^ frame_mix});
}

double to_open_unit(std::uint32_t high, std::uint32_t low) noexcept {
    // 52 bits, so that adding a half is exact: with 53 the largest draw would round to 1.
    const std::uint64_t bits52 = (static_cast<std::uint64_t>(high) << 20) | (low >> 12);
    return (static_cast<double>(bits52) + 0.5) * 0x1.0p-52;
}

}  // namespace

double uniform01(const RandomKey& key, std::uint64_t index, std::uint32_t draw) noexcept {
    const auto w = draw_words(key, index, draw);
    return to_open_unit(w[0], w[1]);
}

double standard_normal(const RandomKey& key, std::uint64_t index, std::uint32_t draw) noexcept {
    const auto w = draw_words(key, index, draw);
    const double u = to_open_unit(w[0], w[1]), v = to_open_unit(w[2], w[3]);
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * kPi * v);
}

std::uint32_t stream_id(const char* text) noexcept {
    std::uint32_t hash = 2166136261u;
    for (; *text != '\0'; ++text) hash = (hash ^ static_cast<unsigned char>(*text)) * 16777619u;
    return hash;
}

}  // namespace pyroscene
