// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/matlab/internal/plain_arrays.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <deque>

namespace kinemark::io::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Arrays whose numbers live here.
class PlainArrays : public ::testing::Test {
 protected:
  MatArray numbers(std::string name, std::vector<std::int64_t> dims, std::vector<double> values) {
    auto& bytes = kept_.emplace_back(values.size() * sizeof(double));
    if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return {.name = std::move(name),
            .kind = MatClass::float64,
            .dims = std::move(dims),
            .type = MatType::float64,
            .bytes = bytes};
  }
  MatArray text(std::string name, std::string_view value) {
    auto& bytes = kept_.emplace_back(value.size());
    std::memcpy(bytes.data(), value.data(), bytes.size());
    return {.name = std::move(name),
            .kind = MatClass::text,
            .dims = {1, std::ssize(value)},
            .type = MatType::utf8,
            .bytes = bytes};
  }

  std::deque<std::vector<std::byte>> kept_;
};

TEST_F(PlainArrays, LieInTheOrderOfC) {
  const auto out = plain_arrays({numbers("x", {2, 3}, {1, 2, 3, 4, 5, 6}), numbers("t", {3, 1}, {7, 8, 9}),
                                 numbers("r", {1, 3}, {7, 8, 9}), numbers("fs", {1, 1}, {100})});
  ASSERT_EQ(out.size(), 4U);
  EXPECT_THAT(out[0].shape, ElementsAre(2, 3));
  EXPECT_THAT(out[0].numbers, ElementsAre(1, 3, 5, 2, 4, 6));
  EXPECT_THAT(out[1].shape, ElementsAre(3));
  EXPECT_THAT(out[2].numbers, ElementsAre(7, 8, 9));
  EXPECT_THAT(out[3].shape, IsEmpty());
}

TEST_F(PlainArrays, OfThreeAxesToo) {
  const auto out = plain_arrays({numbers("x", {2, 1, 3}, {1, 2, 3, 4, 5, 6})});
  ASSERT_EQ(out.size(), 1U);
  EXPECT_THAT(out[0].shape, ElementsAre(2, 1, 3));
  EXPECT_THAT(out[0].numbers, ElementsAre(1, 3, 5, 2, 4, 6));
}

TEST_F(PlainArrays, FieldsOfStructsStandUnderTheirOwnNames) {
  MatArray inner{.name = "", .kind = MatClass::structure, .dims = {1, 1}, .fields = {"hand"}};
  inner.elements.push_back(numbers("", {1, 3}, {1, 2, 3}));
  MatArray outer{.name = "S", .kind = MatClass::structure, .dims = {1, 1}, .fields = {"markers", "Rate"}};
  outer.elements.push_back(inner);
  outer.elements.push_back(numbers("", {1, 1}, {50}));
  const auto out = plain_arrays({outer});
  ASSERT_EQ(out.size(), 2U);
  EXPECT_EQ(out[0].name, "hand");
  EXPECT_EQ(out[1].name, "Rate");
  outer.dims = {1, 2};  // an array of structs has no one value of each field
  outer.elements.push_back(inner);
  outer.elements.push_back(numbers("", {1, 1}, {50}));
  EXPECT_THAT(plain_arrays({outer}), IsEmpty());
}

TEST_F(PlainArrays, CellsOfTextsAreNamesAndOtherCellsArePassedOver) {
  MatArray names{.name = "labels", .kind = MatClass::cell, .dims = {1, 2}};
  names.elements = {text("", "LASI"), text("", "RASI")};
  MatArray others{.name = "c", .kind = MatClass::cell, .dims = {1, 2}};
  others.elements = {text("", "LASI"), numbers("", {1, 1}, {1})};
  const auto out = plain_arrays({names, others, text("unit", "mm"), numbers("empty", {0, 0}, {})});
  ASSERT_EQ(out.size(), 2U);
  EXPECT_THAT(out[0].texts, ElementsAre("LASI", "RASI"));
  EXPECT_THAT(out[0].shape, ElementsAre(2));
  EXPECT_THAT(out[1].texts, ElementsAre("mm"));
}

}  // namespace
}  // namespace kinemark::io::internal
