// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/matlab/internal/struct_fields.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "kinemark/core/missing.h"
#include "kinemark/io/matlab/internal/mat_build.h"
#include "kinemark/io/matlab/internal/mat_parse.h"
#include "kinemark/io/matlab/testing/sample.h"

namespace kinemark::io::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A struct `s` of these fields, as it is read.
class Struct {
 public:
  explicit Struct(const MatFields& fields)
      : file_(io::testing::mat_file({mat_struct(fields, "s")})),
        read_(parse_mat_variables(std::as_bytes(std::span(file_))).value()) {}
  [[nodiscard]] MatPlace operator()(std::string_view field) const {
    return MatPlace{.array = read_.variables.data(), .where = "s"}(field);
  }

 private:
  std::string file_;
  MatVariables read_;
};

const std::vector<double> kSix = {1, 2, 3, 4, 5, 6};

TEST(StructFields, NumbersHaveTheSizesThatAreAskedFor) {
  const Struct s({{"x", mat_numbers(kSix, {2, 3})},
                  {"none", mat_numbers(std::vector<double>{}, {0, 0})},
                  {"word", mat_text("six")}});
  EXPECT_THAT(*s("x").numbers({2, 3}), ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_TRUE(s("x").numbers({2, 3, 1})) << "sizes of 1 at the end go without saying";
  EXPECT_THAT(s("x").numbers({3, 2}).error().message, HasSubstr("s.x: is 2 x 3; expected 3 x 2 numbers"));
  EXPECT_THAT(s("word").numbers({1, 3}).error().message, HasSubstr("and no numbers"));
  EXPECT_THAT(s("gone").numbers({1, 1}).error().message, HasSubstr("s.gone: is absent"));
  EXPECT_THAT(*s("none").numbers({0, 7, 3}), IsEmpty());
  EXPECT_FALSE(s("none").numbers({1, 1}));
}

TEST(StructFields, ColumnsBecomeFrames) {
  const Struct s({{"x", mat_numbers(kSix, {2, 3})}});
  EXPECT_THAT(*s("x").frame_first(2, 3, 1), ElementsAre(1, 3, 5, 2, 4, 6));
  const Struct t({{"x", mat_numbers(to_columns(std::span<const double>(kSix), 2, 1, 3), {2, 1, 3})}});
  EXPECT_THAT(*t("x").frame_first(2, 1, 3), ElementsAre(1, 2, 3, 4, 5, 6)) << "there and back";
}

TEST(StructFields, BytesAndWholeNumbersHaveTheirRange) {
  const Struct s({{"x", mat_numbers(std::vector<double>{0, 255}, {1, 2})},
                  {"large", mat_number(256)},
                  {"nan", mat_number(kNaN)},
                  {"half", mat_number(2.5)}});
  EXPECT_THAT(*s("x").bytes(1, 2), ElementsAre(0, 255));
  EXPECT_THAT(s("large").bytes(1, 1).error().message, HasSubstr("holds 256; expected 0 to 255"));
  EXPECT_FALSE(s("nan").bytes(1, 1));
  EXPECT_EQ(s("large").whole(0, 256), 256);
  EXPECT_THAT(s("large").whole(0, 255).error().message,
              HasSubstr("is 256; expected a whole number from 0 to 255"));
  EXPECT_FALSE(s("half").whole(0, 9));
  EXPECT_FALSE(s("nan").whole(0, 9));
  EXPECT_FALSE(s("x").number()) << "two are not one";
}

TEST(StructFields, TextsAreCellsOrOneText) {
  const std::vector<std::string> two = {"a", ""};
  const Struct s({{"cell", mat_texts(two)},
                  {"one", mat_text("b")},
                  {"number", mat_number(1)},
                  {"none", mat_numbers(std::vector<double>{}, {0, 0})}});
  EXPECT_THAT(*s("cell").texts(), ElementsAre("a", ""));
  EXPECT_THAT(*s("one").texts(), ElementsAre("b"));
  EXPECT_THAT(*s("none").texts(), IsEmpty());
  EXPECT_THAT(*s("gone").texts(), IsEmpty());
  EXPECT_THAT(s("number").texts().error().message, HasSubstr("s.number: expected a cell of texts"));
  EXPECT_EQ(s("one").text(), "b");
  EXPECT_EQ(s("number").text(), "");
}

}  // namespace
}  // namespace kinemark::io::internal
