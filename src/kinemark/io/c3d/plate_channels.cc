// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <string_view>

#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/data/plate_component.h"
#include "kinemark/io/c3d/internal/count.h"
#include "kinemark/io/c3d/internal/plate_channels.h"

namespace kinemark::io::internal {
namespace {

/// Components of the channels of a type, in its order, two letters each.
std::string_view components_of(int type) {
  switch (type) {
    case 1:
      return "fxfyfz    mz";  // the point's labels are of many kinds
    case 2:
    case 4:
      return "fxfyfzmxmymz";
    case 3:
    case 5:
    case 7:
      return "fxfxfyfyfzfzfzfz";
    case 6:
      return "fxfyfzfxfyfzfxfyfzfxfyfz";
    default:
      return {};
  }
}

std::size_t rows_of(const C3dParameter* channels) {
  return channels != nullptr && !channels->dims.empty() ? static_cast<std::size_t>(channels->dims[0]) : 0;
}

std::size_t channels_of_type(int type, std::size_t rows) {
  const auto components = components_of(type);
  return components.empty() ? rows : std::min(components.size() / 2, rows);
}

/// A number of the parameter, and the component that this channel must be.
struct Slot {
  double number;
  std::string_view component;  ///< two blanks where labels do not say
};

/// Of all plates; nothing where a plate is of a type whose channels are not known.
std::vector<Slot> slots_of(const C3dParameter* channels, std::span<const double> types) {
  std::vector<Slot> out;
  const std::size_t rows = rows_of(channels);
  for (std::size_t i = 0; i < types.size(); ++i) {
    const auto components = components_of(static_cast<int>(bounded_count(types[i], 1000)));
    if (components.empty() || 2 * rows < components.size()) return {};
    for (std::size_t r = 0; r < components.size() / 2; ++r) {
      const std::size_t at = i * rows + r;
      if (at >= channels->numbers.size()) return {};
      out.push_back({channels->numbers[at], components.substr(2 * r, 2)});
    }
  }
  return out;
}

/// Whether every slot's channel carries the label of its component, counted from `first`.
bool labels_agree(const std::vector<Slot>& slots, const AnalogLabels& analog, double first) {
  return std::ranges::all_of(slots, [&](const Slot& slot) {
    const double at = slot.number - first;
    if (!(at >= 0.0 && at < static_cast<double>(analog.labels.size()))) return false;
    return slot.component == "  " ||
           data::plate_component(analog.labels[static_cast<std::size_t>(at)]) == slot.component;
  });
}

/// 0, 1, 2, ... each once, in any order.
bool counts_up_from_zero(const std::vector<Slot>& slots, std::int64_t channels) {
  std::vector<double> numbers;
  for (const auto& slot : slots) numbers.push_back(slot.number);
  std::ranges::sort(numbers);
  for (std::size_t k = 0; k < numbers.size(); ++k)
    if (numbers[k] != static_cast<double>(k)) return false;
  return std::ssize(numbers) <= channels;
}

}  // namespace

int first_channel_number(const C3dParameter* channels, std::span<const double> types,
                         const AnalogLabels& analog, std::vector<std::string>& warnings) {
  const auto slots = slots_of(channels, types);
  if (slots.empty()) return 1;
  const bool labelled = std::ranges::any_of(
      analog.labels, [](const std::string& label) { return !data::plate_component(label).empty(); });
  const bool from_zero = labelled ? labels_agree(slots, analog, 0.0) && !labels_agree(slots, analog, 1.0)
                                  : counts_up_from_zero(slots, analog.count);
  if (!from_zero) return 1;
  const auto number = static_cast<std::size_t>(slots.front().number);
  warnings.push_back(fmt::format(
      "FORCE_PLATFORM:CHANNEL counts from 0, not from 1 as the format has it ({}); 1 is added to each "
      "number{}",
      labelled ? "so the labels of the channels say" : "0, 1, 2 and so on",
      number < analog.labels.size()
          ? fmt::format(", '{}' is the first channel of plate 1", printable(analog.labels[number], 40))
          : ""));
  return 0;
}

void note_other_labels(const C3dParameter* channels, std::span<const double> types,
                       const AnalogLabels& analog, int first_number, std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < types.size(); ++i) {
    const int type = static_cast<int>(bounded_count(types[i], 1000));
    const auto components = components_of(type);
    const auto found = channels_of_plate(channels, i, type, std::ssize(analog.labels), first_number);
    if (components.empty() || 2 * found.size() != components.size()) continue;
    std::vector<std::string> others;
    bool all_named = true;
    for (std::size_t r = 0; r < found.size(); ++r) {
      const auto wanted = components.substr(2 * r, 2);
      const auto& label = analog.labels[static_cast<std::size_t>(found[r])];
      const auto named = data::plate_component(label);
      if (wanted == "  ") continue;
      all_named = all_named && !named.empty();
      if (named != wanted)
        others.push_back(fmt::format("{}{} is '{}'", static_cast<char>(wanted[0] - 'a' + 'A'), wanted[1],
                                     printable(label, 40)));
    }
    if (all_named && !others.empty())
      warnings.push_back(fmt::format(
          "force plate {}: by FORCE_PLATFORM:CHANNEL its {}; if the labels are right, its forces lie along "
          "other axes",
          i + 1, join_some(others, 3)));
  }
}

std::vector<int> channels_of_plate(const C3dParameter* channels, std::size_t i, int type,
                                   std::int64_t analog_channels, int first_number) {
  const std::size_t rows = rows_of(channels);
  std::vector<int> found;
  for (std::size_t r = 0; r < channels_of_type(type, rows); ++r) {
    const std::size_t at = i * rows + r;
    const double channel = at < channels->numbers.size() ? channels->numbers[at] - first_number : -1.0;
    if (channel == -1.0 && components_of(type).empty()) break;
    if (!(channel >= 0.0 && channel < static_cast<double>(analog_channels))) return {};
    found.push_back(static_cast<int>(channel));
  }
  return found;
}

}  // namespace kinemark::io::internal
