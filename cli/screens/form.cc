// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/screens/form.h"

#include <algorithm>

#include "cli/screens/glyphs.h"

namespace kinemark::screens {
namespace {

constexpr std::size_t kLongest = 200;  // bytes of a value: longer ones are no names

}  // namespace

bool Form::press(const Key& key) {
  std::string& value = fields_[chosen_].value;
  switch (key.kind) {
    case Key::Kind::up:
      chosen_ = chosen_ == 0 ? fields_.size() - 1 : chosen_ - 1;
      return true;
    case Key::Kind::down:
      chosen_ = (chosen_ + 1) % fields_.size();
      return true;
    case Key::Kind::backspace:
      while (!value.empty() && (static_cast<unsigned char>(value.back()) & 0xC0U) == 0x80U) value.pop_back();
      if (!value.empty()) value.pop_back();
      return true;
    case Key::Kind::character:
      if (value.size() < kLongest) append_utf8(key.character, value);
      return true;
    case Key::Kind::none:
    case Key::Kind::enter:
    case Key::Kind::escape:
    case Key::Kind::left:
    case Key::Kind::right:
    case Key::Kind::interrupt:
      return false;
  }
  return false;
}

void Form::draw(Canvas& canvas, int row, int column) const {
  std::size_t widest = 0;
  for (const Field& field : fields_) widest = std::max(widest, field.label.size());
  const int values = column + 2 + static_cast<int>(widest) + 2;
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const int at = row + static_cast<int>(f);
    const bool chosen = f == chosen_;
    canvas.text(at, column, chosen ? "> " : "  ", Ink::bold);
    canvas.text(at, column + 2, fields_[f].label, chosen ? Ink::bold : Ink::plain);
    canvas.text(at, values, fields_[f].value + (chosen ? "_" : ""), chosen ? Ink::bold : Ink::plain);
  }
  canvas.text(row + static_cast<int>(fields_.size()) + 1, column + 2, fields_[chosen_].hint, Ink::dim);
}

}  // namespace kinemark::screens
