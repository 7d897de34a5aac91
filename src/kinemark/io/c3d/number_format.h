// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>

namespace kinemark::io {

/// How a C3D file stores numbers; the value is the byte that says so in the parameter section.
enum class Processor : std::uint8_t { intel = 84, dec = 85, mips = 86 };

/// "Intel", "DEC" or "MIPS".
[[nodiscard]] std::string_view to_string(Processor processor);

/// IEEE single of a VAX F_floating number whose two 16-bit words are already in IEEE order.
/// VAX: 0.1f x 2^(e - 128), that is 1.f x 2^(e - 129); e = 0 is zero, or with the sign bit set a reserved
/// operand, which becomes NaN.
[[nodiscard]] inline float ieee_from_vax(std::uint32_t bits) {
  const std::uint32_t exponent = (bits >> 23) & 0xFFU;
  if (exponent > 2) [[likely]]
    return std::bit_cast<float>(bits - (2U << 23));
  if (exponent == 0) return bits >> 31 ? std::numeric_limits<float>::quiet_NaN() : 0.0F;
  const float mantissa = 1.0F + static_cast<float>(bits & 0x7FFFFFU) * 0x1p-23F;
  return std::copysign(std::ldexp(mantissa, static_cast<int>(exponent) - 129), bits >> 31 ? -1.0F : 1.0F);
}

/// The VAX number nearest to an IEEE single: NaN becomes the reserved operand, numbers out of range the
/// largest, denormal ones zero.
[[nodiscard]] std::uint32_t vax_from_ieee(float value);

namespace detail {

inline std::uint16_t bytes16(const std::byte* p) {
  std::uint16_t v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
inline std::uint32_t bytes32(const std::byte* p) {
  std::uint32_t v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
inline std::uint16_t swap16(std::uint16_t v) { return static_cast<std::uint16_t>(v << 8 | v >> 8); }
inline std::uint32_t swap32(std::uint32_t v) { return __builtin_bswap32(v); }

}  // namespace detail

static_assert(std::endian::native == std::endian::little, "number formats assume a little-endian host");

/// Number formats as compile-time policies, for loops over many samples.
struct IntelNumbers {
  static std::uint16_t u16(const std::byte* p) { return detail::bytes16(p); }  ///< 16 bits at p
  /// single precision at p
  static float f32(const std::byte* p) { return std::bit_cast<float>(detail::bytes32(p)); }
};
/// VAX words.
struct DecNumbers {
  static std::uint16_t u16(const std::byte* p) { return detail::bytes16(p); }  ///< 16 bits at p
  /// single precision at p
  static float f32(const std::byte* p) { return ieee_from_vax(std::rotl(detail::bytes32(p), 16)); }
};
/// Big-endian words.
struct MipsNumbers {
  /// 16 bits at p
  static std::uint16_t u16(const std::byte* p) { return detail::swap16(detail::bytes16(p)); }
  /// single precision at p
  static float f32(const std::byte* p) { return std::bit_cast<float>(detail::swap32(detail::bytes32(p))); }
};

/// The same, chosen at run time.
[[nodiscard]] std::uint16_t load_u16(const std::byte* p, Processor processor);
/// Single precision at p.
[[nodiscard]] float load_f32(const std::byte* p, Processor processor);
/// Write 16 bits at p.
void store_u16(std::byte* p, std::uint16_t value, Processor processor);
/// Write single precision at p.
void store_f32(std::byte* p, float value, Processor processor);

}  // namespace kinemark::io
