// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/screens/lines.h"

#include <fmt/core.h>

#include <cmath>
#include <optional>
#include <utility>

#include "kinemark/core/number.h"
#include "kinemark/core/utf8.h"
#include "kinemark/pipeline/desk/desk_session.h"

namespace kinemark::screens {
namespace {

constexpr int kTick_ms = 100;  // between two looks at a trial that is recorded

using pipeline::DeskStep;

class Dialogue {
 public:
  Dialogue(pipeline::Desk& desk, const pipeline::Wanted& wanted, const LineTerminal& terminal)
      : session_(desk, wanted), terminal_(terminal) {}

  std::vector<std::string> run() {
    say_message();
    while (choose_source() && set_up() && record_trials()) {
      session_.set_up();
      session_.leave_source();
    }
    session_.leave();
    return state().kept;
  }

 private:
  [[nodiscard]] const pipeline::DeskState& state() const { return session_.state(); }
  // The line that was typed, or what stands in brackets; nothing at the end of the input.
  std::optional<std::string> ask(const std::string& question, const std::string& otherwise) {
    terminal_.write(question + (otherwise.empty() ? "" : " [" + otherwise + "]") + ": ");
    const TypedLine line = terminal_.read(-1);
    if (line.kind != TypedLine::Kind::line) return std::nullopt;
    const std::string text(trim(line.text));
    return text.empty() ? otherwise : text;
  }
  void say(const std::string& sentence) { terminal_.write(printable_sentence(sentence) + "\n"); }
  void say_message() {
    if (!state().message.empty()) say(state().message);
  }

  // false: the person leaves.
  bool choose_source() {
    while (state().step == DeskStep::source) {
      session_.look_for_sources();
      const auto& sources = state().sources;
      for (std::size_t i = 0; i < sources.size(); ++i)
        say(fmt::format("{}  {}  {}", i + 1, sources[i].uri,
                        sources[i].state.empty() ? sources[i].name : sources[i].state));
      const auto typed = ask("Source, a number or an address; q ends", sources.empty() ? "" : "1");
      if (!typed || *typed == "q") return false;
      const auto number = parse_number(*typed);
      const bool listed = number && *number >= 1 && *number <= static_cast<double>(sources.size()) &&
                          *number == std::floor(*number);
      session_.open(listed ? sources[static_cast<std::size_t>(*number) - 1].uri : *typed);
      say_message();
    }
    return true;
  }

  bool set_up() {
    while (state().step == DeskStep::plan) {
      pipeline::Wanted lines = state().wanted;
      for (const auto& [question, value] : {std::pair{"LEDs, how many or their names", &lines.leds},
                                            {"Rate, Hz; empty: the highest", &lines.rate_hz},
                                            {"Duration of a trial, s; empty: until Enter", &lines.duration_s},
                                            {"Subject", &lines.subject}}) {
        const auto typed = ask(question, *value);
        if (!typed) return false;
        *value = *typed;
      }
      session_.start(std::move(lines));
      say_message();
    }
    const auto& plan = state().granted.plan;
    say(fmt::format("{} LEDs, {} cameras, {:.4g} Hz", plan.leds.size(), plan.cameras.size(), plan.rate_hz));
    return true;
  }

  // Whether another source is wanted.
  bool record_trials() {
    while (true) {
      const auto name = ask("Name of the next trial; s another source, q ends", state().wanted.trial);
      if (!name || *name == "q") return false;
      if (*name == "s") return true;
      session_.name_trial(*name);
      session_.record();
      if (state().step == DeskStep::live) say_message();
      if (state().step == DeskStep::recording && !wait_for_its_end()) return false;
      if (state().step == DeskStep::check && !judge()) return false;
    }
  }

  // Whether the input goes on.
  bool wait_for_its_end() {
    say(state().duration_s > 0.0 ? fmt::format("Recording for {:g} s; Enter stops", state().duration_s)
                                 : "Recording; Enter stops");
    std::string said;
    while (state().step == DeskStep::recording) {
      const TypedLine line = terminal_.read(kTick_ms);
      if (line.kind == TypedLine::Kind::closed) return false;
      if (line.kind == TypedLine::Kind::line) session_.stop();
      session_.tick();
      if (state().message != std::exchange(said, state().message)) say_message();
    }
    return true;
  }

  bool judge() {
    for (const auto& note : state().check) say((note.good ? "  " : "! ") + note.text);
    const auto answer = ask("k keep, d discard", "k");
    if (!answer) return false;
    if (*answer == "d")
      session_.discard();
    else
      session_.keep();
    say_message();
    return true;
  }

  pipeline::DeskSession session_;
  const LineTerminal& terminal_;
};

}  // namespace

std::vector<std::string> ask_in_lines(pipeline::Desk& desk, const pipeline::Wanted& wanted,
                                      const LineTerminal& terminal) {
  return Dialogue(desk, wanted, terminal).run();
}

}  // namespace kinemark::screens
