// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/screens/lines.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "kinemark/core/number.h"
#include "kinemark/core/utf8.h"
#include "kinemark/pipeline/desk/plan_text.h"

namespace kinemark::screens {
namespace {

constexpr int kTick_ms = 100;  // between two looks at a trial that is recorded

class Dialogue {
 public:
  Dialogue(pipeline::Desk& desk, pipeline::Wanted wanted, const LineTerminal& terminal)
      : desk_(desk), wanted_(std::move(wanted)), terminal_(terminal) {}

  std::vector<std::string> run() {
    while (open() && set_up())
      if (!trials()) break;
    desk_.close();
    return kept_;
  }

 private:
  // The line that was typed, or what stands in brackets; nothing at the end of the input.
  std::optional<std::string> ask(const std::string& question, const std::string& otherwise) {
    terminal_.write(question + (otherwise.empty() ? "" : " [" + otherwise + "]") + ": ");
    const TypedLine line = terminal_.read(-1);
    if (line.kind != TypedLine::Kind::line) return std::nullopt;
    const std::string text(trim(line.text));
    return text.empty() ? otherwise : text;
  }
  void say(const std::string& sentence) { terminal_.write(printable_sentence(sentence) + "\n"); }

  bool open() {
    std::string uri = std::exchange(wanted_.source, {});
    while (true) {
      if (uri.empty()) {
        const auto sources = desk_.sources();
        for (std::size_t i = 0; i < sources.size(); ++i)
          say(fmt::format("{}  {}  {}", i + 1, sources[i].uri,
                          sources[i].state.empty() ? sources[i].name : sources[i].state));
        const auto typed = ask("Source, a number or an address; q ends", sources.empty() ? "" : "1");
        if (!typed || *typed == "q") return false;
        const auto number = parse_number(*typed);
        const bool listed = number && *number >= 1 && *number <= static_cast<double>(sources.size()) &&
                            *number == std::floor(*number);
        uri = listed ? sources[static_cast<std::size_t>(*number) - 1].uri : *typed;
      }
      const auto device = desk_.open(uri);
      if (device) {
        device_ = *device;
        if (wanted_.leds.empty()) wanted_.leds = std::to_string(std::max(device_.most_leds, 1));
        return true;
      }
      say(device.error().message);
      uri.clear();
    }
  }

  bool set_up() {
    while (true) {
      for (const auto& [question, value] :
           {std::pair{"LEDs, how many or their names", &wanted_.leds},
            {"Rate, Hz; empty: the highest", &wanted_.rate_hz},
            {"Duration of a trial, s; empty: until Enter", &wanted_.duration_s},
            {"Subject", &wanted_.subject}}) {
        const auto typed = ask(question, *value);
        if (!typed) return false;
        *value = *typed;
      }
      const auto plan = pipeline::plan_of(wanted_, device_);
      const auto granted = plan ? desk_.run(plan->scan) : std::unexpected(plan.error());
      if (granted) {
        duration_s_ = plan->duration_s;
        say(fmt::format("{} LEDs, {} cameras, {:.4g} Hz", granted->plan.leds.size(),
                        granted->plan.cameras.size(), granted->plan.rate_hz));
        return true;
      }
      say(granted.error().message);
    }
  }

  // Whether another source is wanted.
  bool trials() {
    while (true) {
      const auto name = ask("Name of the next trial; s another source, q ends", wanted_.trial);
      if (!name || *name == "q") return false;
      if (*name == "s") return true;
      wanted_.trial = *name;
      if (const auto begun = desk_.record({wanted_.subject, wanted_.trial, duration_s_}); !begun) {
        say(begun.error().message);
        continue;
      }
      if (!record()) return false;
    }
  }

  // Whether the input goes on.
  bool record() {
    say(duration_s_ > 0.0 ? fmt::format("Recording for {:g} s; Enter stops", duration_s_)
                          : "Recording; Enter stops");
    TypedLine line;
    while (line.kind == TypedLine::Kind::nothing) {
      const pipeline::LiveView live = desk_.live();
      if (live.ended || (duration_s_ > 0.0 && live.recorded_s >= duration_s_)) break;
      line = terminal_.read(kTick_ms);
    }
    const auto check = desk_.stop();
    if (!check) say(check.error().message);
    if (check)
      for (const pipeline::CheckLine& found : *check) say((found.good ? "  " : "! ") + found.text);
    if (line.kind == TypedLine::Kind::closed) return keep(), false;
    const auto answer = ask("k keep, d discard", "k");
    if (answer && *answer == "d")
      discard();
    else
      keep();
    return answer.has_value();
  }

  void keep() {
    const auto file = desk_.keep();
    if (!file) return say(file.error().message);
    kept_.push_back(*file);
    say("Kept: " + *file);
    wanted_.trial = pipeline::next_trial(wanted_.trial);
  }
  void discard() {
    const auto gone = desk_.discard();
    say(gone ? "Discarded: " + wanted_.trial : gone.error().message);
  }

  pipeline::Desk& desk_;
  pipeline::Wanted wanted_;
  const LineTerminal& terminal_;
  stream::DeviceCapabilities device_;
  double duration_s_ = 0.0;
  std::vector<std::string> kept_;
};

}  // namespace

std::vector<std::string> ask_in_lines(pipeline::Desk& desk, const pipeline::Wanted& wanted,
                                      const LineTerminal& terminal) {
  return Dialogue(desk, wanted, terminal).run();
}

}  // namespace kinemark::screens
