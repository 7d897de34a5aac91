// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Files put together by hand, as "MAT-File Format" of The MathWorks describes them.
#include "kinemark/io/matlab/internal/mat_parse.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "kinemark/io/matlab/internal/inflate.h"
#include "kinemark/io/matlab/internal/mat_build.h"
#include "kinemark/io/matlab/testing/sample.h"

namespace kinemark::io::internal {
namespace {

using io::testing::mat_file;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Numbers of 32 bits in an order of bytes.
std::string words(std::initializer_list<std::uint32_t> values, bool big = false) {
  std::string out;
  for (const std::uint32_t value : values)
    for (int i = 0; i < 4; ++i) out.push_back(static_cast<char>(value >> (big ? 24 - 8 * i : 8 * i)));
  return out;
}

Result<MatVariables> parse(const std::string& file) {
  return parse_mat_variables(std::as_bytes(std::span(file)));
}

std::string message(const std::string& variable) {
  const std::string file = mat_file({variable});
  const auto parsed = parse(file);
  return parsed ? "read" : parsed.error().message;
}

/// x = [1 2 3] of doubles that are stored as bytes, name and numbers in short elements.
std::string short_array(bool big) {
  std::string out = words({14, 48}, big) + words({6, 8, 6, 0}, big) + words({5, 8, 1, 3}, big);
  const auto narrow = [&](std::uint32_t type, std::uint32_t size, std::string bytes) {
    bytes.resize(4, '\0');
    return words({size << 16 | type}, big) + bytes;
  };
  return out + narrow(1, 1, "x") + narrow(2, 3, "\1\2\3");
}

TEST(MatParse, ReadsShortElementsAndNumbersNarrowerThanTheirClass) {
  for (const bool big : {false, true}) {
    std::string file = mat_file({short_array(big)});
    if (big) file.replace(124, 4, std::string("\1\0MI", 4));
    const auto parsed = parse(file);
    ASSERT_TRUE(parsed) << parsed.error().message;
    ASSERT_EQ(parsed->variables.size(), 1);
    EXPECT_EQ(parsed->variables[0].name, "x");
    EXPECT_THAT(parsed->variables[0].dims, ElementsAre(1, 3));
    EXPECT_THAT(parsed->variables[0].numbers(), ElementsAre(1.0, 2.0, 3.0));
    EXPECT_EQ(parsed->variables[0].number(), 1.0);
  }
}

TEST(MatParse, ReadsNumbersOfEveryTypeInBothOrders) {
  const struct {
    std::uint32_t type;
    std::string little;
  } cases[] = {{1, std::string("\xFE", 1)},
               {3, std::string("\xFE\xFF", 2)},
               {5, std::string("\xFE\xFF\xFF\xFF", 4)},
               {7, std::string("\0\0\0\xC0", 4)},
               {9, std::string("\0\0\0\0\0\0\0\xC0", 8)},
               {12, std::string("\xFE\xFF\xFF\xFF\xFF\xFF\xFF\xFF", 8)}};
  for (const bool big : {false, true})
    for (const auto& c : cases) {
      std::string bytes = big ? std::string(c.little.rbegin(), c.little.rend()) : c.little;
      bytes.resize(8, '\0');
      const std::string array = words({14, 56}, big) + words({6, 8, 6, 0, 5, 8, 1, 1}, big) +
                                words({1, 0}, big) +
                                words({c.type, static_cast<std::uint32_t>(c.little.size())}, big) + bytes;
      std::string file = mat_file({array});
      if (big) file.replace(124, 4, std::string("\1\0MI", 4));
      const auto parsed = parse(file);
      ASSERT_TRUE(parsed) << parsed.error().message;
      EXPECT_EQ(parsed->variables.at(0).number(), -2.0) << c.type;
    }
}

TEST(MatParse, ReadsWhatTheBuilderMakes) {
  const std::vector<std::string> names = {"a", "Grüße", "", "\U0001F3C3"};
  const std::string variable = mat_struct({{"names", mat_texts(names)},
                                           {"one", mat_number(-0.5)},
                                           {"all", mat_structs({"k"}, {{mat_number(7)}, {mat_number(8)}})}},
                                          "v");
  const auto packed = deflate_all(std::as_bytes(std::span(variable)));
  const std::string element = words({15, static_cast<std::uint32_t>(packed.size())}) +
                              std::string(reinterpret_cast<const char*>(packed.data()), packed.size());
  for (const std::string& way : {variable, element}) {
    const std::string file = mat_file({way, short_array(false)});
    const auto parsed = parse(file);
    ASSERT_TRUE(parsed) << parsed.error().message;
    ASSERT_EQ(parsed->variables.size(), 2);
    const MatArray& v = parsed->variables[0];
    EXPECT_EQ(v.name, "v");
    for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(v.field("names")->elements[i].text(), names[i]);
    EXPECT_EQ(v.field("one")->number(), -0.5);
    EXPECT_EQ(v.field("all")->field("k", 1)->number(), 8.0);
    EXPECT_EQ(v.field("all")->field("k", 2), nullptr);
    EXPECT_EQ(v.field("none"), nullptr);
    EXPECT_EQ(parsed->variables[1].name, "x");
  }
}

TEST(MatParse, ObjectsSparseAndComplexArraysArePassedOver) {
  const std::string sparse = words({14, 32, 6, 8, 5, 0, 5, 8, 1, 1});
  const std::string complex = words({14, 56, 6, 8, 6 | 0x800, 0, 5, 8, 1, 1, 1, 0, 9, 8, 0, 0});
  const auto file = mat_file({sparse, complex, short_array(false)});
  const auto parsed = parse(file);
  ASSERT_TRUE(parsed) << parsed.error().message;
  ASSERT_EQ(parsed->variables.size(), 3);
  EXPECT_EQ(parsed->variables[0].kind, MatClass::none);
  EXPECT_EQ(parsed->variables[1].kind, MatClass::none);
  EXPECT_FALSE(parsed->variables[1].number());
  EXPECT_EQ(parsed->variables[2].number(), 1.0);
}

TEST(MatParse, SizesThatNothingExplainsAreRefused) {
  EXPECT_THAT(message(words({14, 4000, 6, 8})),
              HasSubstr("byte 128: an element of 4000 bytes where 8 are left"));
  EXPECT_THAT(message(words({14, 48, 6, 8, 6, 0, 5, 8, 1, 1000, 0x10001, 0, 0x30002, 0})),
              HasSubstr("an array of 1000 elements holds 3 bytes of 1 each"));
  EXPECT_THAT(message(words({14, 40, 6, 8, 1, 0, 5, 8, 0x7FFFFFFF, 0x7FFFFFFF, 1, 0})),
              HasSubstr("arrays in 0 bytes"));
  EXPECT_THAT(message(words({14, 56, 6, 8, 6, 0, 5, 20, 0x7FFFFFFF, 0x7FFFFFFF, 0x7FFFFFFF, 0x7FFFFFFF,
                             0x7FFFFFFF, 0, 1, 0})),
              HasSubstr("more elements than can be counted"));
  EXPECT_THAT(message(words({14, 32, 6, 8, 6, 0, 5, 4, 1, 0})), HasSubstr("an array of 1 dimensions"));
  EXPECT_THAT(message(words({14, 16, 0x70006, 0, 0, 0})), HasSubstr("a short element of 7 bytes"));
  EXPECT_THAT(message(words({14, 16, 9, 8, 0, 0})), HasSubstr("begins with an element of type 9"));
}

TEST(MatParse, ArraysInArraysHaveAnEnd) {
  std::string array = mat_number(1.0);
  const std::string name = "c";
  for (int level = 0; level < 40; ++level) array = mat_struct({{name, array}}, name);
  EXPECT_THAT(message(array), HasSubstr("more than 32 times"));
}

TEST(MatParse, WhatIsCompressedMustBeExplainedByTheFile) {
  const auto claim = [](std::uint32_t bytes) {
    const std::string head = words({14, bytes, 6, 8});
    const auto packed = deflate_all(std::as_bytes(std::span(head)));
    return words({15, static_cast<std::uint32_t>(packed.size())}) +
           std::string(reinterpret_cast<const char*>(packed.data()), packed.size());
  };
  EXPECT_THAT(message(claim(600U << 20)), HasSubstr("bytes are compressed in a file that explains"));
  EXPECT_THAT(message(claim(100U << 20)), HasSubstr("damaged or cut short"));  // and nothing is allocated
  EXPECT_THAT(message(words({15, 8, 1, 2})), HasSubstr("damaged or cut short"));
}

TEST(MatParse, CompressedDataThatEndEarlyAreDamaged) {
  const std::string variable = mat_struct({{"one", mat_number(1.0)}}, "v");
  const auto packed = deflate_all(std::as_bytes(std::span(variable)));
  const std::string whole(reinterpret_cast<const char*>(packed.data()), packed.size());
  for (std::size_t n = 0; n + 8 < whole.size(); ++n)
    EXPECT_NE(message(words({15, static_cast<std::uint32_t>(n)}) + whole.substr(0, n)), "read") << n;
}

}  // namespace
}  // namespace kinemark::io::internal
