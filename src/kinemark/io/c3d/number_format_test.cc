// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/number_format.h"

#include <gtest/gtest.h>

#include <array>
#include <cfloat>

#include "kinemark/core/random.h"

namespace kinemark::io {
namespace {

TEST(NumberFormat, OneIsStoredAsEachProcessorStoresIt) {
  std::array<std::byte, 4> b{};
  const auto hex = [&] {
    return std::to_integer<unsigned>(b[0]) << 24 | std::to_integer<unsigned>(b[1]) << 16 |
           std::to_integer<unsigned>(b[2]) << 8 | std::to_integer<unsigned>(b[3]);
  };
  store_f32(b.data(), 1.0F, Processor::intel);
  EXPECT_EQ(hex(), 0x0000803FU);
  store_f32(b.data(), 1.0F, Processor::mips);
  EXPECT_EQ(hex(), 0x3F800000U);
  store_f32(b.data(), 1.0F, Processor::dec);
  EXPECT_EQ(hex(), 0x80400000U);
  store_u16(b.data(), 0x1234, Processor::mips);
  EXPECT_EQ(hex() >> 16, 0x1234U);
  store_u16(b.data(), 0x1234, Processor::dec);
  EXPECT_EQ(hex() >> 16, 0x3412U);
}

TEST(NumberFormat, EveryProcessorGivesBackEveryNumber) {
  Random random(1, 0);
  std::array<std::byte, 4> b{};
  for (const Processor p : {Processor::intel, Processor::dec, Processor::mips}) {
    for (int i = 0; i < 20000; ++i) {
      const auto value =
          static_cast<float>(random.uniform(-1.0, 1.0) * std::pow(10.0, random.uniform(-30.0, 30.0)));
      store_f32(b.data(), value, p);
      EXPECT_EQ(load_f32(b.data(), p), value) << to_string(p);
      const auto word = static_cast<std::uint16_t>(random.uniform(0.0, 65536.0));
      store_u16(b.data(), word, p);
      EXPECT_EQ(load_u16(b.data(), p), word) << to_string(p);
    }
    store_f32(b.data(), 0.0F, p);
    EXPECT_EQ(load_f32(b.data(), p), 0.0F);
    store_f32(b.data(), std::numeric_limits<float>::quiet_NaN(), p);
    EXPECT_TRUE(std::isnan(load_f32(b.data(), p))) << to_string(p);
  }
}

TEST(NumberFormat, VaxNumbersAtTheEdgesOfTheirRange) {
  // Exponents 1 and 2 are denormal in IEEE; 255 would be infinity if read as IEEE and divided by four.
  EXPECT_EQ(ieee_from_vax(1U << 23), std::ldexp(1.0F, -128));
  EXPECT_EQ(ieee_from_vax(0x80000000U | 2U << 23 | 0x400000U), -std::ldexp(1.5F, -127));
  EXPECT_EQ(ieee_from_vax(255U << 23), std::ldexp(1.0F, 126));
  EXPECT_EQ(ieee_from_vax(0x00001234U), 0.0F) << "a zero exponent is zero whatever the fraction";
  EXPECT_EQ(ieee_from_vax(vax_from_ieee(FLT_MAX)), std::nextafter(std::ldexp(1.0F, 127), 0.0F));
  EXPECT_EQ(vax_from_ieee(1e-45F), 0U);
}

}  // namespace
}  // namespace kinemark::io
