// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What acceptance programs share: rows that run.py collects.
#pragma once

#include <filesystem>
#include <string>

namespace kinemark::testing_support {

/// Print "PASS | check | required | measured" (or FAIL) and record a failure.
void print_row(bool passed, const std::string& check, const std::string& asked, const std::string& measured);

/// Print "NOTE | check | - | measured": a number of which nothing is asked, shown in the table and not
/// counted.
void print_note(const std::string& check, const std::string& measured);

/// Print one SKIP row, loudly, for a program that cannot run without the real recordings; returns 0.
[[nodiscard]] int skip_all(const std::string& what);

/// 0 when every row passed, else 1.
[[nodiscard]] int exit_status();

/// A check of an acceptance program, which registers itself: `PROGRAM NAME ARGUMENTS...` runs it.
class AcceptanceCheck {
 public:
  /// Name and arguments in, exit status out.
  using Run = int (*)(int argc, char** argv);
  AcceptanceCheck(std::string name, Run run);
};

/// The main of an acceptance program: runs the check that the first argument names; `--list` prints their
/// names, one a line. Exit status 2 when there is none of that name.
[[nodiscard]] int run_acceptance(int argc, char** argv);

/// A folder for a program's files, inside KINEMARK_SCRATCH or the temporary folder; emptied at both ends.
class ScratchSpace {
 public:
  explicit ScratchSpace(const std::string& name);
  ~ScratchSpace();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace kinemark::testing_support
