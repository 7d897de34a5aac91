// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::pipeline {

/// The address of a live source or a device, "sim:rig?leds=8&fast": scheme "sim", what "rig", then settings.
/// Each setting is asked for once, with its range; check() then names one that nobody asked for.
class AddressSettings {
 public:
  /// Splits at the first ':' and at the last '?'.
  explicit AddressSettings(std::string_view uri);
  [[nodiscard]] const std::string& uri() const { return uri_; }        ///< as given
  [[nodiscard]] const std::string& scheme() const { return scheme_; }  ///< empty: there was no ':'
  [[nodiscard]] const std::string& what() const { return what_; }      ///< between ':' and '?'
  /// The settings belong to the name, which holds a '?' of its own.
  void take_all_as_name();

  /// The number of a setting, or `otherwise` where it was not given. What is wrong is kept for check().
  [[nodiscard]] double number(std::string_view name, double otherwise, double low, double high);
  /// A whole number.
  [[nodiscard]] int whole(std::string_view name, int otherwise, int low, int high);
  /// Its text; empty: given without a value.
  [[nodiscard]] std::optional<std::string> text(std::string_view name);
  /// Whether a name without a value, or with 1, was given.
  [[nodiscard]] bool flag(std::string_view name);
  /// Code::usage for the first value that was wrong, or for a setting that is none.
  [[nodiscard]] Status check() const;

 private:
  struct Setting {
    std::string name, value;
    bool asked = false;
  };
  [[nodiscard]] Setting* find(std::string_view name);
  void wrong(std::string message);

  std::string uri_, scheme_, what_, query_;
  std::vector<Setting> settings_;
  std::vector<std::string> known_;
  std::string first_wrong_;
};

}  // namespace kinemark::pipeline
