// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/measures/emg_channels.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/name_pattern.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/core/text.h"
#include "kinemark/data/plate_component.h"
#include "kinemark/stages/analysis/emg/channel_facts.h"

namespace kinemark::workflow {
namespace {

constexpr std::size_t kNamed = 12;

std::string lowered(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// Volts of 1 in the unit; NaN where it is no voltage.
double volts_of(const std::string& unit) {
  const auto name = lowered(unit);
  const auto is_voltage = [](std::string_view word) {
    return word == "v" || word == "volt" || word == "volts";
  };
  using Prefix = std::pair<std::string_view, double>;
  for (const auto& [prefix, volts] :
       {Prefix{"", 1.0}, Prefix{"milli", 1e-3}, Prefix{"m", 1e-3}, Prefix{"micro", 1e-6}, Prefix{"u", 1e-6},
        Prefix{"\xc2\xb5", 1e-6}, Prefix{"\xce\xbc", 1e-6}})
    if (name.starts_with(prefix) && is_voltage(std::string_view(name).substr(prefix.size()))) return volts;
  return kNaN;
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_upper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }

// Whether a muscle's name may begin at a letter: at the beginning of a word, as a capital behind a small
// letter, behind a side or a part ("LTIB", "RMGAS", "right_tib").
bool begins_a_name(const std::string& name, std::size_t at) {
  auto first = at;
  while (first > 0 && is_letter(name[first - 1])) --first;
  if (first == at || (is_upper(name[at]) && !is_upper(name[at - 1]))) return true;
  const auto before = lowered(name.substr(first, at - first));
  return before == "left" || before == "right" ||
         (before.size() <= 2 && before.find_first_not_of("lrmv") == std::string::npos);
}

// "Electric" is no triceps, and a trigger none.
bool names_a_muscle(const std::string& name) {
  constexpr std::array kParts{"quad", "ham",  "tib", "gas",  "sol",  "vas", "rec",  "bic",
                              "tri",  "delt", "glu", "sem",  "calf", "add", "pero", "trap",
                              "pect", "lat",  "abd", "obli", "erec", "ilio"};
  const auto text = lowered(name);
  return std::ranges::any_of(kParts, [&](const char* part) {
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
      if (begins_a_name(name, at) && text.substr(at, 4) != "trig") return true;
    return false;
  });
}

analysis::EmgStretch emg_stretch_of(const data::Region& region, const data::Trial& trial) {
  const auto& time = trial.markers.time;
  const double per_frame = trial.analog.rate_hz / time.rate_hz;
  const auto sample = [&](std::int64_t number) {
    return std::llround(static_cast<double>(number - time.number(0)) * per_frame);
  };
  analysis::EmgStretch out{.name = region.name,
                           .first = sample(region.first_frame),
                           .count = sample(region.last_frame + 1) - sample(region.first_frame)};
  for (const char* side : {"Left", "Right"}) {
    const auto at = region.name.rfind(fmt::format(" {} ", side));
    if (at == std::string::npos) continue;
    const auto number = region.name.substr(at + std::string_view(side).size() + 2);
    std::int64_t cycle = 0;
    if (std::from_chars(number.data(), number.data() + number.size(), cycle).ec != std::errc{}) continue;
    out.context = side;
    out.cycle = cycle - 1;
  }
  return out;
}

std::vector<analysis::EmgChannel> channels_of(const data::Trial& trial,
                                              const std::vector<std::size_t>& which) {
  std::vector<analysis::EmgChannel> out;
  const auto& analog = trial.analog;
  const auto k = analog.names.size();
  for (const auto c : which) {
    analysis::EmgChannel channel{.name = analog.names[c], .volts = Eigen::VectorXd(analog.samples)};
    const double unit = volts_of(analog.units[c]);
    for (std::int64_t s = 0; s < analog.samples; ++s)
      channel.volts[s] = (std::isnan(unit) ? 1.0 : unit) * analog.values[at(s) * k + c];
    out.push_back(std::move(channel));
  }
  return out;
}

// The largest envelope of each channel in another recording.
Status put_maxima(const EmgChoice& choice, std::vector<analysis::EmgChannel>& channels,
                  const analysis::EmgOptions& options) {
  const auto& analog = choice.maximum->analog;
  for (auto& channel : channels) {
    const auto found = std::ranges::find(analog.names, channel.name);
    if (found == analog.names.end())
      return fail(Code::bad_input, fmt::format("{}: has no analog channel '{}' for its maximum",
                                               choice.maximum_name, channel.name));
    auto alone = options;
    alone.refits = 0;
    alone.stretches.clear();
    const auto index = static_cast<std::size_t>(found - analog.names.begin());
    const auto measured =
        analysis::measure_emg(channels_of(*choice.maximum, {index}), analog.rate_hz, 0.0, alone);
    if (!measured) return fail_at(choice.maximum_name, measured.error());
    channel.most_volts = measured->envelopes.front().maxCoeff();
    if (!(channel.most_volts > 0.0))
      return fail(Code::bad_input,
                  fmt::format("{}: '{}' holds no signal", choice.maximum_name, channel.name));
  }
  return {};
}

}  // namespace

Result<std::vector<std::size_t>> emg_channels(const data::Trial& trial,
                                              const std::vector<std::string>& named) {
  const auto& names = trial.analog.names;
  std::vector<std::size_t> out;
  for (const auto& pattern : named) {
    bool any = false;
    for (std::size_t c = 0; c < names.size(); ++c) {
      if (!matches_name_pattern(pattern, names[c])) continue;
      any = true;
      if (std::ranges::find(out, c) == out.end()) out.push_back(c);
    }
    if (any) continue;
    const auto nearest = nearest_names(pattern, names);
    return fail(Code::usage,
                fmt::format("there is no analog channel '{}'{}", pattern,
                            nearest.empty() ? "" : fmt::format(" (nearest: {})", join(nearest))));
  }
  if (!named.empty()) return out;
  std::set<std::size_t> of_plates;
  for (const auto& plate : trial.force_plates)
    for (const int c : plate.channel_idx) of_plates.insert(static_cast<std::size_t>(c));
  const auto take = [&](const auto& is_one) {
    for (std::size_t c = 0; c < names.size(); ++c)
      if (!std::isnan(volts_of(trial.analog.units[c])) && !of_plates.contains(c) &&
          data::plate_component(names[c]).empty() && is_one(names[c]))
        out.push_back(c);
  };
  take([](const std::string& name) { return lowered(name).find("emg") != std::string::npos; });
  if (out.empty()) take(names_a_muscle);
  return out;
}

std::vector<std::string> contradicted_channels(const data::Trial& trial) {
  std::vector<std::string> out;
  const auto which = emg_channels(trial);
  if (!which) return out;
  for (const auto& channel : channels_of(trial, *which))
    if (auto why = analysis::why_rectified(channel); !why.empty()) out.push_back(std::move(why));
  return out;
}

Result<analysis::EmgMeasures> measure_channels(const data::Trial& trial, const EmgChoice& choice,
                                               const std::vector<data::Region>& regions,
                                               analysis::EmgOptions options) {
  const auto which = emg_channels(trial, choice.channels);
  if (!which) return std::unexpected(which.error());
  if (which->empty() && trial.analog.names.empty())
    return fail(Code::bad_input, "there are no analog channels, and so no EMG");
  if (which->empty())
    return fail(
        Code::bad_input,
        fmt::format("no analog channel is known for an EMG by its name; name the channels, of which there "
                    "are {}",
                    join_some(trial.analog.names, kNamed)));
  auto channels = channels_of(trial, *which);
  options.envelope = choice.envelope;
  options.to_maximum = choice.to_maximum && choice.maximum == nullptr;
  for (const auto& region : regions) options.stretches.push_back(emg_stretch_of(region, trial));
  if (choice.maximum != nullptr)
    if (auto s = put_maxima(choice, channels, options); !s) return std::unexpected(s.error());
  return analysis::measure_emg(channels, trial.analog.rate_hz, trial.markers.time.t0_s, options);
}

}  // namespace kinemark::workflow
