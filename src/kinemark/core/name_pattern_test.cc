// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/name_pattern.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace kinemark {
namespace {

/// The definition, by recursion.
bool plainly(std::string_view pattern, std::string_view name) {
  if (pattern.empty()) return name.empty();
  if (pattern[0] == '*')
    return plainly(pattern.substr(1), name) || (!name.empty() && plainly(pattern, name.substr(1)));
  return !name.empty() && (pattern[0] == '?' || pattern[0] == name[0]) &&
         plainly(pattern.substr(1), name.substr(1));
}

/// Every text of up to `length` of the letters.
std::vector<std::string> all_of(std::string_view letters, std::size_t length) {
  std::vector<std::string> all{""};
  for (std::size_t begin = 0, n = 0; n < length; ++n) {
    const std::size_t end = all.size();
    for (; begin < end; ++begin)
      for (const char letter : letters) all.push_back(all[begin] + letter);
  }
  return all;
}

TEST(NamePattern, IsWhatItsDefinitionSaysOnAllShortOnes) {
  const auto names = all_of("ab", 4);
  for (const auto& pattern : all_of("ab*?", 4))
    for (const auto& name : names)
      ASSERT_EQ(matches_name_pattern(pattern, name), plainly(pattern, name)) << pattern << " on " << name;
}

TEST(NamePattern, ManyStarsTakeNoTime) {
  const std::string name(20000, 'a');
  std::string pattern;
  for (int i = 0; i < 30; ++i) pattern += "a*";
  EXPECT_FALSE(matches_name_pattern(pattern + "b", name));
  EXPECT_TRUE(matches_name_pattern(pattern, name));
}

TEST(NamePattern, IsKnownByItsSigns) {
  EXPECT_TRUE(is_name_pattern("L*"));
  EXPECT_TRUE(is_name_pattern("?ASI"));
  EXPECT_FALSE(is_name_pattern("LASI"));
  EXPECT_FALSE(is_name_pattern(""));
}

}  // namespace
}  // namespace kinemark
