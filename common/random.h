// Counter-based random numbers. Each number depends only on the seed, the stream, the step and the
// index. So a process can draw any number without the earlier numbers (Philox4x32-10, Salmon et al.
// 2011, implemented by Random123).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

// Philox uses no vector instructions. Without these two lines Random123 includes the compiler's
// headers for all vector instructions: 1.8 MB of text.
#define R123_USE_SSE 0
#define R123_USE_X86INTRIN_H 0
#include <Random123/philox.h>

namespace fogline {

/// The streams of random numbers, one for each purpose. The value of an enumerator determines the
/// random numbers of its stream. So never change a value, and never use a value for a second
/// purpose.
enum class Stream : std::uint32_t {
  kRadar = 1,
  kLidar = 2,
  kLidarBeam = 3,
  kFaults = 4,
  kHumanErrors = 5,
  kTakeOver = 6,
  kStyle = 7,
  kFollowerErrors = 256,  // 257 and above are used, too: see FollowerErrors()
};

/// The stream of the errors of one following car; car 0 is nearest to the host. The cars' errors
/// are independent.
constexpr Stream FollowerErrors(std::uint32_t car) {
  return static_cast<Stream>(static_cast<std::uint32_t>(Stream::kFollowerErrors) + car);
}

/// The stream of a role that has no stream in `Stream`. The most significant bit of the result is
/// set, so the result differs from all numbers in `Stream`. @param role name of the role
constexpr Stream StreamOf(std::string_view role) {
  std::uint32_t hash = 2'166'136'261;  // FNV-1a
  for (const char c : role) hash = (hash ^ static_cast<unsigned char>(c)) * 16'777'619;
  return static_cast<Stream>(hash | 0x8000'0000);
}

/// The random numbers of one stream under one seed.
class Random {
 public:
  Random(std::int64_t seed, Stream stream)
      : seed_(static_cast<std::uint64_t>(seed)), stream_(static_cast<std::uint32_t>(stream)) {}

  /// Whether both objects give the same random numbers.
  bool operator==(const Random&) const = default;

  /// Two independent numbers, uniform in (0, 1), of draw `index` in step `step`.
  std::array<double, 2> Uniform2(std::int64_t step, std::uint32_t index) const {
    const auto s = static_cast<std::uint64_t>(step);
    const r123::Philox4x32::ctr_type counter{
        {static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(s >> 32), stream_, index}};
    const r123::Philox4x32::key_type key{
        {static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)}};
    const r123::Philox4x32::ctr_type r = r123::Philox4x32{}(counter, key);
    return {ToUnit(r[0], r[1]), ToUnit(r[2], r[3])};
  }

  /// Two independent standard normal numbers (Box & Muller 1958) of draw `index` in step `step`.
  std::array<double, 2> Normal2(std::int64_t step, std::uint32_t index) const {
    const auto [u, v] = Uniform2(step, index);
    const double radius = std::sqrt(-2.0 * std::log(u));
    const double angle = 2.0 * std::numbers::pi * v;
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }

 private:
  // The interval (0, 1) is divided into 2^52 equal cells. 52 of the 64 random bits choose a cell,
  // and the result is the centre of this cell. A double can represent each centre exactly, and no
  // centre is 0 or 1.
  static double ToUnit(std::uint32_t high, std::uint32_t low) {
    const std::uint64_t cell = (static_cast<std::uint64_t>(high) << 20) ^ (low >> 12);
    return (static_cast<double>(cell) + 0.5) * 0x1p-52;
  }

  std::uint64_t seed_;
  std::uint32_t stream_;
};

}  // namespace fogline
