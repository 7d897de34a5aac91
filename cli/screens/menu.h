// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The menus of acquisition: which screen is shown, what a key does. Knows no terminal.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/screens/canvas.h"
#include "cli/screens/desk.h"
#include "cli/screens/form.h"
#include "cli/screens/key.h"
#include "cli/screens/plan_text.h"

namespace kinemark::screens {

inline constexpr int kLeastRows = 24, kLeastColumns = 80;  ///< that a screen fits into

/// Source, set-up, live view, recording, check: one after the other and back, by keys alone.
class Menu {
 public:
  enum class Screen : std::uint8_t { source, plan, live, recording, check, ended };

  Menu(Desk& desk, Wanted wanted);
  /// What the key does on the screen that is shown.
  void press(const Key& key);
  /// Take the live numbers, and end a trial whose time is up. To be called some ten times a second.
  void tick();
  [[nodiscard]] Screen screen() const { return screen_; }
  /// The screen; below kLeastRows x kLeastColumns a sentence that says so.
  [[nodiscard]] Canvas draw(int rows, int columns) const;
  /// Files of the trials that were kept.
  [[nodiscard]] const std::vector<std::string>& kept() const { return kept_; }

 private:
  void press_source(const Key& key);
  void press_plan(const Key& key);
  void press_live(const Key& key);
  void press_check(const Key& key);
  void look_for_sources();
  void open(const std::string& uri);
  void start();
  void change_intensity(double by);
  void record();
  void stop();
  void keep();
  void discard();
  void leave();
  void interrupt();
  void tell(const Error& error) { message_ = error.message; }

  void draw_source(Canvas& canvas) const;
  void draw_plan(Canvas& canvas) const;
  void draw_live(Canvas& canvas) const;
  void draw_detectors(Canvas& canvas, int rows, int width) const;
  void draw_leds(Canvas& canvas, int row, int column) const;
  void draw_check(Canvas& canvas) const;
  [[nodiscard]] std::string heading() const;
  [[nodiscard]] std::string keys() const;

  Desk& desk_;
  Screen screen_ = Screen::source;
  std::string message_;  ///< of what went wrong, or was done, last
  std::vector<stream::DeviceInfo> sources_;
  std::size_t chosen_source_ = 0;
  Form address_, plan_;
  bool typing_address_ = false, sure_to_discard_ = false;
  std::string uri_;
  stream::DeviceCapabilities device_;
  stream::GrantedPlan granted_;
  std::size_t chosen_led_ = 0;
  LiveView live_;
  double duration_s_ = 0.0;
  std::vector<CheckLine> check_;
  std::vector<std::string> kept_;
};

}  // namespace kinemark::screens
