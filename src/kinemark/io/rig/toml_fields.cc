// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/rig/toml_fields.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace kinemark::io {
namespace {

/// Numbers of an array; nothing when one of its elements is something else.
bool take(const toml::node& node, std::vector<double>& out) {
  const toml::array* array = node.as_array();
  if (array == nullptr) return false;
  out.clear();
  out.reserve(array->size());
  for (const toml::node& element : *array) {
    const auto value = element.value<double>();
    if (!value || !element.is_number() || !std::isfinite(*value)) return false;
    out.push_back(*value);
  }
  return true;
}

}  // namespace

void TomlFields::refuse(std::string_view key, std::string_view expected) {
  if (!status_) return;
  status_ = fail(Code::bad_input, fmt::format("{}: {} must be {}", where_, key, expected));
}

const toml::node* TomlFields::find(std::string_view key, Need need, std::string_view expected) {
  asked_.emplace_back(key);
  if (!status_) return nullptr;
  const toml::node* node = table_.get(key);
  if (node == nullptr && need == Need::required)
    status_ = fail(Code::bad_input, fmt::format("{}: {} is missing; need {}", where_, key, expected));
  return node;
}

TomlFields& TomlFields::number(std::string_view key, double& out, Need need) {
  constexpr std::string_view expected = "a finite number";
  if (const auto* node = find(key, need, expected)) {
    const auto value = node->value<double>();
    if (value && node->is_number() && std::isfinite(*value))
      out = *value;
    else
      refuse(key, expected);
  }
  return *this;
}

TomlFields& TomlFields::integer(std::string_view key, int& out, Need need) {
  constexpr std::string_view expected = "an integer of at most a million";
  if (const auto* node = find(key, need, expected)) {
    const auto value = node->value_exact<std::int64_t>();
    if (value && *value >= -1'000'000 && *value <= 1'000'000)
      out = static_cast<int>(*value);
    else
      refuse(key, expected);
  }
  return *this;
}

TomlFields& TomlFields::flag(std::string_view key, bool& out) {
  constexpr std::string_view expected = "true or false";
  if (const auto* node = find(key, Need::optional, expected)) {
    if (const auto value = node->value_exact<bool>())
      out = *value;
    else
      refuse(key, expected);
  }
  return *this;
}

TomlFields& TomlFields::text(std::string_view key, std::string& out, Need need) {
  constexpr std::string_view expected = "text in quotes";
  if (const auto* node = find(key, need, expected)) {
    if (const auto value = node->value_exact<std::string>())
      out = *value;
    else
      refuse(key, expected);
  }
  return *this;
}

TomlFields& TomlFields::numbers(std::string_view key, std::vector<double>& out) {
  constexpr std::string_view expected = "a list of numbers";
  if (const auto* node = find(key, Need::optional, expected))
    if (!take(*node, out)) refuse(key, expected);
  return *this;
}

TomlFields& TomlFields::texts(std::string_view key, std::vector<std::string>& out, Need need) {
  constexpr std::string_view expected = "a list of texts in quotes";
  const auto* node = find(key, need, expected);
  if (node == nullptr) return *this;
  const toml::array* array = node->as_array();
  if (array == nullptr ||
      !std::ranges::all_of(*array, [](const toml::node& each) { return each.is_string(); })) {
    refuse(key, expected);
    return *this;
  }
  out.clear();
  for (const toml::node& each : *array) out.push_back(each.as_string()->get());
  return *this;
}

TomlFields& TomlFields::vector(std::string_view key, Eigen::Ref<Eigen::VectorXd> out, Need need) {
  const auto expected = fmt::format("a list of {} numbers", out.size());
  if (const auto* node = find(key, need, expected)) {
    std::vector<double> values;
    if (take(*node, values) && static_cast<Eigen::Index>(values.size()) == out.size())
      out = Eigen::Map<const Eigen::VectorXd>(values.data(), out.size());
    else
      refuse(key, expected);
  }
  return *this;
}

TomlFields& TomlFields::matrix(std::string_view key, Eigen::Ref<Eigen::MatrixXd> out, Need need) {
  const auto expected = fmt::format("{} lists of {} numbers", out.rows(), out.cols());
  const auto* node = find(key, need, expected);
  if (node == nullptr) return *this;
  const toml::array* rows = node->as_array();
  if (rows == nullptr || static_cast<Eigen::Index>(rows->size()) != out.rows()) {
    refuse(key, expected);
    return *this;
  }
  std::vector<double> values;
  for (Eigen::Index i = 0; i < out.rows(); ++i) {
    if (!take(*rows->get(static_cast<std::size_t>(i)), values) ||
        static_cast<Eigen::Index>(values.size()) != out.cols()) {
      refuse(key, expected);
      return *this;
    }
    out.row(i) = Eigen::Map<const Eigen::RowVectorXd>(values.data(), out.cols());
  }
  return *this;
}

const toml::table* TomlFields::table(std::string_view key) {
  const auto* node = find(key, Need::optional, "a table");
  if (node != nullptr && !node->is_table()) refuse(key, "a table");
  return node == nullptr ? nullptr : node->as_table();
}

const toml::array* TomlFields::tables(std::string_view key) {
  const auto* node = find(key, Need::optional, "tables");
  if (node == nullptr) return nullptr;
  const toml::array* array = node->as_array();
  if (array == nullptr ||
      !std::ranges::all_of(*array, [](const toml::node& each) { return each.is_table(); })) {
    refuse(key, fmt::format("a list of tables, [[{}]]", key));
    return nullptr;
  }
  return array;
}

Status TomlFields::finish() const {
  if (!status_) return status_;
  for (const auto& [key, value] : table_)
    if (std::ranges::find(asked_, key.str()) == asked_.end())
      return fail(Code::bad_input, fmt::format("{}: unknown key '{}'", where_, key.str().substr(0, 60)));
  return {};
}

}  // namespace kinemark::io
