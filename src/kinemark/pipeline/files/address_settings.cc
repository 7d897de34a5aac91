// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/address_settings.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/number.h"
#include "kinemark/core/text.h"

namespace kinemark::pipeline {

AddressSettings::AddressSettings(std::string_view uri) : uri_(uri) {
  const auto colon = uri.find(':');
  if (colon != std::string_view::npos) scheme_ = uri.substr(0, colon);
  auto rest = colon == std::string_view::npos ? uri : uri.substr(colon + 1);
  const auto question = rest.rfind('?');
  what_ = rest.substr(0, question);
  if (question == std::string_view::npos) return;
  query_ = rest.substr(question + 1);
  std::string_view text = query_;
  while (!text.empty()) {
    const auto end = std::min(text.find('&'), text.size());
    const auto one = text.substr(0, end);
    const auto equals = std::min(one.find('='), one.size());
    settings_.push_back({.name = std::string(one.substr(0, equals)),
                         .value = std::string(one.substr(std::min(equals + 1, one.size())))});
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

void AddressSettings::take_all_as_name() {
  if (!query_.empty()) what_ += "?" + query_;
  query_.clear();
  settings_.clear();
}

AddressSettings::Setting* AddressSettings::find(std::string_view name) {
  known_.emplace_back(name);
  Setting* last = nullptr;
  for (auto& setting : settings_)
    if (setting.name == name) {
      setting.asked = true;
      last = &setting;
    }
  return last;
}

void AddressSettings::wrong(std::string message) {
  if (first_wrong_.empty()) first_wrong_ = std::move(message);
}

double AddressSettings::number(std::string_view name, double otherwise, double low, double high) {
  const auto* setting = find(name);
  if (setting == nullptr) return otherwise;
  const auto value = parse_number(setting->value);
  if (value && *value >= low && *value <= high) return *value;
  wrong(fmt::format("{}: {} must be a number from {:g} to {:g}", uri_, name, low, high));
  return otherwise;
}

int AddressSettings::whole(std::string_view name, int otherwise, int low, int high) {
  const double value = number(name, otherwise, low, high);
  if (value == std::round(value)) return static_cast<int>(value);
  wrong(fmt::format("{}: {} must be a whole number from {} to {}", uri_, name, low, high));
  return otherwise;
}

std::optional<std::string> AddressSettings::text(std::string_view name) {
  const auto* setting = find(name);
  if (setting == nullptr) return std::nullopt;
  return setting->value;
}

bool AddressSettings::flag(std::string_view name) {
  const auto value = text(name);
  if (!value || *value == "0") return false;
  if (!value->empty() && *value != "1") wrong(fmt::format("{}: {} is given, or not", uri_, name));
  return true;
}

Status AddressSettings::check() const {
  if (!first_wrong_.empty()) return fail(Code::usage, first_wrong_);
  const auto unknown = std::ranges::find(settings_, false, &Setting::asked);
  if (unknown == settings_.end()) return {};
  return fail(Code::usage,
              fmt::format("{}: '{}' is no setting of it; those are {}", uri_, unknown->name, join(known_)));
}

}  // namespace kinemark::pipeline
