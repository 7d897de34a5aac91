// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/desktop.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::server {
namespace {

/// A variable of the environment, as it was again at the end.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    if (value != nullptr)
      ::setenv(name, value, 1);
    else
      ::unsetenv(name);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
  ~Variable() {
    if (before_)
      ::setenv(name_, before_->c_str(), 1);
    else
      ::unsetenv(name_);
  }

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST(Desktop, IsWhereADisplayIs) {
  const Variable no_wayland("WAYLAND_DISPLAY", nullptr);
  {
    const Variable none("DISPLAY", nullptr);
    EXPECT_FALSE(has_desktop());
  }
  {
    const Variable empty("DISPLAY", "");
    EXPECT_FALSE(has_desktop());
  }
  const Variable display("DISPLAY", ":0");
  EXPECT_TRUE(has_desktop());
}

TEST(Desktop, WaylandIsOneToo) {
  const Variable no_display("DISPLAY", nullptr);
  const Variable wayland("WAYLAND_DISPLAY", "wayland-0");
  EXPECT_TRUE(has_desktop());
}

TEST(Desktop, TheBrowserGetsTheAddressAsOneWord) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_text(
      scratch / "xdg-open",
      "#!/bin/sh\nprintf '%s|%s' \"$#\" \"$1\" > \"" + (scratch / "got.part").string() + "\"\nmv \"" +
          (scratch / "got.part").string() + "\" \"" + (scratch / "got").string() + "\"\n",
      false));
  ASSERT_EQ(::chmod((scratch / "xdg-open").c_str(), 0700), 0);
  const Variable path("PATH", (scratch.path().string() + ":/usr/bin:/bin").c_str());
  ASSERT_TRUE(open_browser("http://127.0.0.1:1/?token=a b;echo"));
  for (int i = 0; i < 1000 && !std::filesystem::exists(scratch / "got"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(io::read_text(scratch / "got").value(), "1|http://127.0.0.1:1/?token=a b;echo");
}

TEST(Desktop, WithoutXdgOpenNothingIsOpened) {
  const testing_support::ScratchFolder scratch;
  const Variable path("PATH", scratch.path().c_str());
  EXPECT_FALSE(open_browser("http://127.0.0.1:1/"));
}

}  // namespace
}  // namespace kinemark::server
