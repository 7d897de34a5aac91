// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/matlab/internal/plain_arrays.h"

#include <algorithm>
#include <string>
#include <utility>

#include "kinemark/core/index.h"

namespace kinemark::io::internal {
namespace {

constexpr int kMostDepth = 4;         // of structs in structs
constexpr std::size_t kMostAxes = 3;  // of positions
constexpr std::size_t kMostTaken = 10'000;

/// Sizes without those of 1 that MATLAB adds.
std::vector<std::int64_t> shape_of(const MatArray& array) {
  auto shape = array.dims;
  if (shape.size() == 2) std::erase(shape, 1);
  if (array.count() == 1) shape.clear();
  return shape;
}

/// Numbers with the last index fastest.
std::vector<double> in_order_of_c(const Array<double>& numbers, const std::vector<std::int64_t>& shape) {
  std::vector<double> out(numbers.size());
  std::vector<std::int64_t> index(shape.size(), 0);
  for (double& value : out) {
    std::int64_t place = 0;
    for (std::size_t k = shape.size(); k > 0; --k) place = place * shape[k - 1] + index[k - 1];
    value = numbers[at(place)];
    for (std::size_t k = shape.size(); k > 0; --k) {
      if (++index[k - 1] < shape[k - 1]) break;
      index[k - 1] = 0;
    }
  }
  return out;
}

void take(const MatArray& array, const std::string& name, int depth, std::vector<NamedArray>& out) {
  if (out.size() >= kMostTaken) return;
  if (array.kind == MatClass::structure && array.count() == 1 && depth < kMostDepth) {
    for (std::size_t f = 0; f < array.fields.size(); ++f)
      if (const auto* field = array.field(array.fields[f])) take(*field, array.fields[f], depth + 1, out);
    return;
  }
  NamedArray taken{.name = name};
  if (array.kind == MatClass::text) {
    taken.is_text = true;
    taken.texts.push_back(array.text());
  } else if (array.kind == MatClass::cell) {
    const auto is_text = [](const MatArray& cell) { return cell.kind == MatClass::text; };
    if (array.elements.empty() || !std::ranges::all_of(array.elements, is_text)) return;
    taken.is_text = true;
    for (const auto& cell : array.elements) taken.texts.push_back(cell.text());
    taken.shape = {std::ssize(array.elements)};
  } else if (array.is_numeric() && array.count() > 0) {
    taken.shape = shape_of(array);
    if (taken.shape.size() > kMostAxes) return;
    taken.numbers = in_order_of_c(array.numbers(), taken.shape);
  } else {
    return;
  }
  out.push_back(std::move(taken));
}

}  // namespace

std::vector<NamedArray> plain_arrays(const std::vector<MatArray>& variables) {
  std::vector<NamedArray> out;
  for (const auto& variable : variables) take(variable, variable.name, 0, out);
  return out;
}

}  // namespace kinemark::io::internal
