// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The menus of acquisition: which screen is shown, what a key does. Knows no terminal.
#pragma once

#include <cstddef>
#include <string>

#include "cli/screens/canvas.h"
#include "cli/screens/form.h"
#include "cli/screens/key.h"
#include "kinemark/pipeline/desk/desk_session.h"

namespace kinemark::screens {

inline constexpr int kLeastRows = 24, kLeastColumns = 80;  ///< that a screen fits into

/// A session of acquisition by keys alone: source, set-up, live view, recording, check.
class Menu {
 public:
  Menu(pipeline::Desk& desk, pipeline::Wanted wanted);
  /// What the key does on the screen that is shown.
  void press(const Key& key);
  /// See pipeline::DeskSession::tick().
  void tick() { session_.tick(); }
  [[nodiscard]] const pipeline::DeskState& state() const { return session_.state(); }  ///< what is shown
  /// The screen; below kLeastRows x kLeastColumns a sentence that says so.
  [[nodiscard]] Canvas draw(int rows, int columns) const;

 private:
  void open(const std::string& uri);
  void press_source(const Key& key);
  void press_plan(const Key& key);
  void press_live(const Key& key);
  void press_check(const Key& key);
  void change_intensity(double by);

  void draw_source(Canvas& canvas) const;
  void draw_plan(Canvas& canvas) const;
  void draw_live(Canvas& canvas) const;
  void draw_detectors(Canvas& canvas, int rows, int width) const;
  void draw_leds(Canvas& canvas, int row, int column) const;
  void draw_check(Canvas& canvas) const;
  [[nodiscard]] std::string heading() const;
  [[nodiscard]] std::string keys() const;

  pipeline::DeskSession session_;
  Form address_, plan_;
  bool typing_address_ = false, sure_to_discard_ = false;
  std::size_t chosen_source_ = 0, chosen_led_ = 0;
};

}  // namespace kinemark::screens
