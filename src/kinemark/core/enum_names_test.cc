// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/enum_names.h"

#include <gtest/gtest.h>

namespace kinemark {
namespace {

enum class Fruit : std::uint8_t { apple, pear, plum };
constexpr EnumNames<Fruit::plum> kFruits{"apple", "pear", "plum"};

TEST(EnumNames, GoBothWays) {
  for (const Fruit fruit : {Fruit::apple, Fruit::pear, Fruit::plum})
    EXPECT_EQ(kFruits.find(kFruits[fruit]), fruit);
  static_assert(kFruits[Fruit::pear] == "pear");
  EXPECT_EQ(kFruits[static_cast<Fruit>(7)], "unknown");
  EXPECT_EQ(kFruits.find("Pear"), std::nullopt);
}

TEST(EnumNames, AnErrorTellsWhatThereIs) {
  EXPECT_EQ(kFruits.parse("plum", "fruit").value(), Fruit::plum);
  const auto none = kFruits.parse("nut", "fruit", Code::bad_input);
  EXPECT_EQ(none.error().code, Code::bad_input);
  EXPECT_EQ(none.error().message, "there is no fruit 'nut'; there are apple, pear and plum");
}

TEST(EnumNames, NeedANameForEveryEnumerator) {
  static_assert(std::is_constructible_v<EnumNames<Fruit::pear>, const char*, const char*>);
  static_assert(!std::is_constructible_v<EnumNames<Fruit::plum>, const char*, const char*>);
}

}  // namespace
}  // namespace kinemark
