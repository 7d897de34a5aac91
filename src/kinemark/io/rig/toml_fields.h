// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Typed access to the fields of a TOML table, with one sentence for what is wrong.
#pragma once

#include <toml++/toml.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io {

/// Reads fields of one table into variables that already hold the defaults. Reading stops at the first error;
/// finish() returns it, or names a key that was never read.
class TomlFields {
 public:
  /// `where` begins every failure: "rig.toml: camera 'A'".
  TomlFields(const toml::table& table, std::string where) : table_(table), where_(std::move(where)) {}

  /// Whether a key may be absent.
  enum class Need : std::uint8_t { optional, required };

  /// A finite number.
  TomlFields& number(std::string_view key, double& out, Need need = Need::optional);
  /// A whole number that fits an int.
  TomlFields& integer(std::string_view key, int& out, Need need = Need::optional);
  /// true or false.
  TomlFields& flag(std::string_view key, bool& out);
  /// A text.
  TomlFields& text(std::string_view key, std::string& out, Need need = Need::optional);
  /// A list of finite numbers, of any length.
  TomlFields& numbers(std::string_view key, std::vector<double>& out);
  /// A list of texts, of any length.
  TomlFields& texts(std::string_view key, std::vector<std::string>& out, Need need = Need::optional);
  /// A vector of out.size() numbers, or a matrix of as many rows.
  TomlFields& vector(std::string_view key, Eigen::Ref<Eigen::VectorXd> out, Need need = Need::optional);
  /// A list of out.rows() lists of out.cols() numbers.
  TomlFields& matrix(std::string_view key, Eigen::Ref<Eigen::MatrixXd> out, Need need = Need::optional);
  /// A table or an array of tables inside this one; null when absent.
  const toml::table* table(std::string_view key);
  /// An array of tables inside this one; null when absent.
  const toml::array* tables(std::string_view key);

  /// The first failure, or one that names a key which nobody asked for.
  [[nodiscard]] Status finish() const;
  [[nodiscard]] bool failed() const { return !status_.has_value(); }  ///< whether something was wrong so far
  [[nodiscard]] const std::string& where() const { return where_; }   ///< what failures begin with
  /// Note a failure: the key holds something else than `expected`.
  void refuse(std::string_view key, std::string_view expected);

 private:
  const toml::node* find(std::string_view key, Need need, std::string_view expected);

  const toml::table& table_;
  std::string where_;
  std::vector<std::string> asked_;
  Status status_;
};

}  // namespace kinemark::io
