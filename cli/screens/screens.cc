// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/screens/screens.h"

#include <fmt/core.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cstdio>

#include "cli/screens/lines.h"
#include "cli/screens/menu.h"

namespace kinemark::screens {
namespace {

constexpr int kLook_ms = 100;               // between two looks at the device
constexpr std::size_t kLongestLine = 4096;  // bytes of a line: a longer one is none that a person typed

// Lines of standard input, without waiting longer than asked.
class StandardInput {
 public:
  explicit StandardInput(const Stopped& stopped) : stopped_(stopped) {}
  TypedLine read(int milliseconds) {
    while (true) {
      if (const std::size_t end = waiting_.find('\n'); end != std::string::npos) {
        TypedLine line{TypedLine::Kind::line, waiting_.substr(0, end)};
        waiting_.erase(0, end + 1);
        return line;
      }
      if (stopped_()) return {TypedLine::Kind::closed, {}};
      pollfd input{STDIN_FILENO, POLLIN, 0};
      const int ready = ::poll(&input, 1, milliseconds < 0 ? kLook_ms : milliseconds);
      if (ready <= 0 && milliseconds < 0) continue;
      if (ready <= 0) return {};
      std::array<char, 512> bytes;
      const ssize_t count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
      if (count <= 0 || waiting_.size() > kLongestLine) return {TypedLine::Kind::closed, {}};
      waiting_.append(bytes.data(), static_cast<std::size_t>(count));
    }
  }

 private:
  const Stopped& stopped_;
  std::string waiting_;
};

}  // namespace

std::vector<std::string> show_menus(pipeline::Desk& desk, const pipeline::Wanted& wanted, Terminal& terminal,
                                    const Stopped& stopped) {
  Menu menu(desk, wanted);
  while (menu.state().step != pipeline::DeskStep::ended) {
    terminal.show(menu.draw(terminal.rows(), terminal.columns()));
    menu.press(stopped() ? Key{Key::Kind::interrupt, 0} : terminal.wait(kLook_ms));
    menu.tick();
  }
  return menu.state().kept;
}

std::vector<std::string> acquire_by_hand(pipeline::Desk& desk, const pipeline::Wanted& wanted,
                                         const Stopped& stopped) {
  if (auto terminal = Terminal::open()) {
    if ((*terminal)->rows() >= kLeastRows && (*terminal)->columns() >= kLeastColumns)
      return show_menus(desk, wanted, **terminal, stopped);
    const int columns = (*terminal)->columns(), rows = (*terminal)->rows();
    terminal->reset();
    fmt::print("This terminal is {} x {}; the menus need {} x {}. In lines, then.\n", columns, rows,
               kLeastColumns, kLeastRows);
  }
  StandardInput input(stopped);
  return ask_in_lines(desk, wanted,
                      {[&](int milliseconds) { return input.read(milliseconds); },
                       [](const std::string& text) {
                         fmt::print("{}", text);
                         std::fflush(stdout);
                       }});
}

}  // namespace kinemark::screens
