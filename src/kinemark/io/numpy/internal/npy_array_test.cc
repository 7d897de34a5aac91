// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/numpy/internal/npy_array.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/io/numpy/testing/archive.h"

namespace kinemark::io::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace testing_npz;

Result<NpyArray> parse(const std::string& text) { return parse_npy(bytes_of(text)); }

std::vector<double> numbers(const std::string& type, const std::string& data) {
  const auto array = parse(npy(type, "(2,)", data));
  EXPECT_TRUE(array) << type << ": " << array.error().message;
  return array ? array->numbers : std::vector<double>{};
}

TEST(NpyArray, NumbersOfEveryTypeAndOrder) {
  EXPECT_THAT(numbers("<f8", doubles({1.5, -2.0})), ElementsAre(1.5, -2.0));
  EXPECT_THAT(numbers("<f4", std::string("\0\0\xc0\x3f\0\0\0\xc0", 8)), ElementsAre(1.5, -2.0));
  EXPECT_THAT(numbers(">f4", std::string("\x3f\xc0\0\0\xc0\0\0\0", 8)), ElementsAre(1.5, -2.0));
  EXPECT_THAT(numbers("<f2", std::string("\0\x3e\0\xc0", 4)), ElementsAre(1.5, -2.0));
  EXPECT_THAT(numbers("<i2", std::string("\xff\xff\x05\0", 4)), ElementsAre(-1.0, 5.0));
  EXPECT_THAT(numbers(">i4", std::string("\xff\xff\xff\xfe\0\0\1\0", 8)), ElementsAre(-2.0, 256.0));
  EXPECT_THAT(numbers("|u1", "\xff\x01"), ElementsAre(255.0, 1.0));
  EXPECT_THAT(numbers("|b1", std::string("\1\0", 2)), ElementsAre(1.0, 0.0));
  EXPECT_THAT(numbers("<i8", little(static_cast<std::uint64_t>(-7), 8) + little(9, 8)),
              ElementsAre(-7.0, 9.0));
  const auto odd = numbers("<f2", std::string("\0\x7c\0\x7e", 4));
  EXPECT_TRUE(std::isinf(odd[0]));
  EXPECT_TRUE(std::isnan(odd[1]));
}

TEST(NpyArray, TextsAndShapes) {
  const auto names = parse(texts({"LASI", "R"}, "(2,)"));
  ASSERT_TRUE(names);
  EXPECT_TRUE(names->is_text);
  EXPECT_THAT(names->texts, ElementsAre("LASI", "R"));
  const auto letter = parse(npy("<U1", "(1,)", little(0xe9, 4)));
  EXPECT_THAT(letter->texts, ElementsAre("\xc3\xa9"));
  EXPECT_THAT(parse(npy("|S3", "(2,)", std::string("ab\0xyz", 6)))->texts, ElementsAre("ab", "xyz"));
  const auto one = parse(npy("<f8", "()", doubles({60.0})));
  EXPECT_TRUE(one->shape.empty());
  EXPECT_EQ(one->size(), 1);
  const auto none = parse(npy("<f8", "(0, 3)", ""));
  EXPECT_EQ(none->size(), 0);
  EXPECT_TRUE(none->numbers.empty());
}

TEST(NpyArray, ColumnsFirstAreTurned) {
  const auto array = parse(npy("<f8", "(2, 3)", doubles({1, 4, 2, 5, 3, 6}), "True"));
  ASSERT_TRUE(array);
  EXPECT_THAT(array->shape, ElementsAre(2, 3));
  EXPECT_THAT(array->numbers, ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST(NpyArray, OthersAreRefusedWithWhatToSave) {
  EXPECT_THAT(parse(npy("|O", "(2,)", "pickle")).error().message, HasSubstr("numpy.array(names, dtype=str)"));
  EXPECT_THAT(parse(npy("<c16", "(1,)", std::string(16, 'x'))).error().message,
              HasSubstr("has the type '<c16'"));
  EXPECT_THAT(parse(npy("<f3", "(1,)", "xxx")).error().message, HasSubstr("numbers of 3 bytes"));
  std::string fields = npy("<f8", "(1,)", doubles({1}));
  fields.replace(fields.find("'<f8'"), 5, "[a   ");
  EXPECT_THAT(parse(fields).error().message, HasSubstr("structured array"));
}

TEST(NpyArray, DamageIsRefused) {
  const std::string good = npy("<f8", "(2,)", doubles({1, 2}));
  ASSERT_TRUE(parse(good));
  for (std::size_t size = 0; size < good.size(); ++size) EXPECT_FALSE(parse(good.substr(0, size))) << size;
  for (const char* shape :
       {"(1000000, 1000000, 1000000)", "(-1,)", "(2.5,)", "2", "(1,1,1,1,1,1,1,1,1)", "(2"})
    EXPECT_FALSE(parse(npy("<f8", shape, doubles({1, 2})))) << shape;
  EXPECT_FALSE(parse(npy("<U0", "(100000000000,)", ""))) << "texts without letters take memory too";
}

}  // namespace
}  // namespace kinemark::io::internal
