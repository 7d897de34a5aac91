// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/matlab/internal/struct_fields.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace kinemark::io::internal {
namespace {

bool same_sizes(const MatArray& array, const std::vector<std::int64_t>& dims) {
  for (std::size_t i = 0; i < std::max(dims.size(), array.dims.size()); ++i)
    if (array.dim(i) != (i < dims.size() ? dims[i] : 1)) return false;
  return true;
}

std::int64_t product(const std::vector<std::int64_t>& dims) {
  std::int64_t out = 1;
  for (const std::int64_t size : dims) out *= size;
  return out;
}

}  // namespace

MatPlace MatPlace::operator()(std::string_view field, std::int64_t i) const {
  std::string name = where.empty() ? std::string(field) : fmt::format("{}.{}", where, field);
  return {.array = array == nullptr ? nullptr : array->field(field, i), .where = std::move(name)};
}

std::unexpected<Error> MatPlace::bad(std::string_view what) const {
  return fail(Code::bad_input, fmt::format("{}: {}", where, what));
}

Result<double> MatPlace::number() const {
  if (array == nullptr) return bad("is absent; expected a number");
  const auto value = array->number();
  if (!value || array->count() != 1) return bad("expected one number");
  return *value;
}

Result<std::int64_t> MatPlace::whole(std::int64_t least, std::int64_t most) const {
  const auto value = number();
  if (!value) return std::unexpected(value.error());
  // Both bounds are below 2^53.
  if (!(*value >= static_cast<double>(least) && *value <= static_cast<double>(most)) ||
      *value != std::floor(*value))
    return bad(fmt::format("is {}; expected a whole number from {} to {}", *value, least, most));
  return static_cast<std::int64_t>(*value);
}

std::string MatPlace::text() const { return array == nullptr ? std::string() : array->text(); }

Result<std::vector<std::string>> MatPlace::texts() const {
  std::vector<std::string> out;
  if (array == nullptr) return out;
  if (array->kind == MatClass::text) {
    out.push_back(array->text());
    return out;
  }
  if (array->kind != MatClass::cell) {
    if (array->count() == 0) return out;
    return bad("expected a cell of texts");
  }
  for (const MatArray& element : array->elements) {
    if (element.kind != MatClass::text && element.count() != 0) return bad("expected a cell of texts");
    out.push_back(element.text());
  }
  return out;
}

Result<Array<double>> MatPlace::numbers(const std::vector<std::int64_t>& dims) const {
  if (array == nullptr) return bad("is absent; expected numbers");
  const bool empty = array->count() == 0 && product(dims) == 0;
  if (!empty && (!array->is_numeric() || !same_sizes(*array, dims)))
    return bad(fmt::format("is {}{}; expected {} numbers", fmt::join(array->dims, " x "),
                           array->is_numeric() ? "" : " and no numbers", fmt::join(dims, " x ")));
  return empty ? Array<double>() : array->numbers();
}

Result<Array<double>> MatPlace::frame_first(std::int64_t frames, std::int64_t width,
                                            std::int64_t depth) const {
  const auto columns = numbers({frames, width, depth});
  if (!columns) return columns;
  Array<double> out(columns->size());
  for (std::int64_t k = 0; k < depth; ++k)
    for (std::int64_t m = 0; m < width; ++m)
      for (std::int64_t f = 0; f < frames; ++f)
        out[static_cast<std::size_t>((f * width + m) * depth + k)] =
            (*columns)[static_cast<std::size_t>(f + frames * (m + width * k))];
  return out;
}

Result<Array<std::uint8_t>> MatPlace::bytes(std::int64_t frames, std::int64_t width) const {
  const auto values = frame_first(frames, width, 1);
  if (!values) return std::unexpected(values.error());
  Array<std::uint8_t> out(values->size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double value = (*values)[i];
    if (!(value >= 0.0 && value <= 255.0)) return bad(fmt::format("holds {}; expected 0 to 255", value));
    out[i] = static_cast<std::uint8_t>(value);
  }
  return out;
}

}  // namespace kinemark::io::internal
