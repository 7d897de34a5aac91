// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/number_format.h"

namespace kinemark::io {

std::string_view to_string(Processor processor) {
  switch (processor) {
    case Processor::intel:
      return "Intel";
    case Processor::dec:
      return "DEC";
    case Processor::mips:
      return "MIPS";
  }
  return "unknown";
}

std::uint32_t vax_from_ieee(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = bits & 0x80000000U;
  if (std::isnan(value)) return 0x80000000U;
  const std::uint32_t exponent = (bits >> 23) & 0xFFU;
  if (exponent == 0) return 0;
  if (exponent > 253) return sign | 0x7FFFFFFFU;
  return bits + (2U << 23);
}

std::uint16_t load_u16(const std::byte* p, Processor processor) {
  return processor == Processor::mips ? MipsNumbers::u16(p) : IntelNumbers::u16(p);
}

float load_f32(const std::byte* p, Processor processor) {
  switch (processor) {
    case Processor::dec:
      return DecNumbers::f32(p);
    case Processor::mips:
      return MipsNumbers::f32(p);
    case Processor::intel:
      break;
  }
  return IntelNumbers::f32(p);
}

void store_u16(std::byte* p, std::uint16_t value, Processor processor) {
  if (processor == Processor::mips) value = detail::swap16(value);
  std::memcpy(p, &value, sizeof value);
}

void store_f32(std::byte* p, float value, Processor processor) {
  auto bits = std::bit_cast<std::uint32_t>(value);
  if (processor == Processor::dec) bits = std::rotl(vax_from_ieee(value), 16);
  if (processor == Processor::mips) bits = detail::swap32(bits);
  std::memcpy(p, &bits, sizeof bits);
}

}  // namespace kinemark::io
