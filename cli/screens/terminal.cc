// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#define NCURSES_WIDECHAR 1  // before its header: characters beyond ASCII
#include <curses.h>
#include <fmt/core.h>
#include <unistd.h>

#include <array>
#include <clocale>
#include <cstdlib>

#include "cli/screens/terminal.h"

namespace kinemark::screens {
namespace {

constexpr wint_t kInterrupt = 3, kEscape = 27, kDelete = 127;

// Whether this terminal's characters reach beyond ASCII; else lines and braille are drawn by what is there.
char32_t plain_glyph(char32_t glyph) {
  if (glyph < 0x80) return glyph;
  if (glyph >= 0x2800 && glyph <= 0x28FF) return U'.';
  switch (glyph) {
    case U'\u2588':
      return U'#';
    case U'\u00B7':
      return U'.';
    case U'\u2500':
      return U'-';
    case U'\u2502':
      return U'|';
    case U'\u2191':
      return U'^';
    case U'\u2193':
      return U'v';
    default:
      return U'+';
  }
}

attr_t attribute(Ink ink) {
  switch (ink) {
    case Ink::bold:
      return A_BOLD;
    case Ink::dim:
      return A_DIM;
    case Ink::chosen:
      return A_REVERSE;
    case Ink::plain:
      break;
  }
  return A_NORMAL;
}

class Curses final : public Terminal {
 public:
  explicit Curses(SCREEN* screen) : screen_(screen) {
    raw();  // Ctrl-C is a key: a trial that is recorded is ended first
    noecho();
    keypad(stdscr, TRUE);
    set_escdelay(50);
    curs_set(0);
  }
  ~Curses() override {
    endwin();
    delscreen(screen_);
  }
  Curses(const Curses&) = delete;
  Curses& operator=(const Curses&) = delete;

  [[nodiscard]] int rows() const override { return LINES; }
  [[nodiscard]] int columns() const override { return COLS; }

  void show(const Canvas& canvas) override {
    erase();
    for (int row = 0; row < canvas.rows() && row < LINES; ++row)
      for (int column = 0; column < canvas.columns() && column < COLS; ++column)
        put(row, column, canvas.at(row, column));
    refresh();
  }

  [[nodiscard]] Key wait(int milliseconds) override {
    timeout(milliseconds);
    wint_t code = 0;
    const int kind = get_wch(&code);
    if (kind == ERR) return {};
    return kind == KEY_CODE_YES ? named(code) : typed(code);
  }

 private:
  void put(int row, int column, const Cell& cell) const {
    const wchar_t glyph = static_cast<wchar_t>(wide_ ? cell.glyph : plain_glyph(cell.glyph));
    const std::array<wchar_t, 2> text = {glyph, L'\0'};
    cchar_t character;
    if (setcchar(&character, text.data(), attribute(cell.ink), 0, nullptr) == OK)
      mvadd_wch(row, column, &character);
  }
  static Key named(wint_t code) {
    switch (code) {
      case KEY_UP:
        return {Key::Kind::up};
      case KEY_DOWN:
        return {Key::Kind::down};
      case KEY_LEFT:
        return {Key::Kind::left};
      case KEY_RIGHT:
        return {Key::Kind::right};
      case KEY_ENTER:
        return {Key::Kind::enter};
      case KEY_BACKSPACE:
      case KEY_DC:
        return {Key::Kind::backspace};
      default:
        return {};
    }
  }
  static Key typed(wint_t code) {
    if (code == L'\n' || code == L'\r') return {Key::Kind::enter};
    if (code == kInterrupt) return {Key::Kind::interrupt};
    if (code == kEscape) return {Key::Kind::escape};
    if (code == kDelete || code == L'\b') return {Key::Kind::backspace};
    if (code < L' ') return {};
    return Key::of(static_cast<char32_t>(code));
  }

  SCREEN* screen_;
  bool wide_ = MB_CUR_MAX > 1;
};

}  // namespace

Result<std::unique_ptr<Terminal>> Terminal::open() {
  if (isatty(STDIN_FILENO) == 0 || isatty(STDOUT_FILENO) == 0)
    return fail(Code::usage, "the menus need a terminal; without one, give a source and -o FILE");
  const char* kind = std::getenv("TERM");
  if (kind == nullptr || *kind == '\0')
    return fail(Code::usage, "TERM is not set, so that the menus cannot be drawn; give a source and -o FILE");
  std::setlocale(LC_CTYPE, "");
  SCREEN* screen = newterm(kind, stdout, stdin);
  if (screen == nullptr)
    return fail(
        Code::usage,
        fmt::format("the menus cannot be drawn on a terminal of the kind '{}'; give a source and -o FILE",
                    kind));
  return std::make_unique<Curses>(screen);
}

}  // namespace kinemark::screens
