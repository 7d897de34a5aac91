// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "support/acceptance.h"

#include <fmt/core.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <utility>

namespace kinemark::testing_support {
namespace {

bool failed = false;

/// Filled before main() begins, in whatever order the files were linked.
std::map<std::string, AcceptanceCheck::Run>& checks() {
  static std::map<std::string, AcceptanceCheck::Run> all;
  return all;
}

}  // namespace

void print_row(bool passed, const std::string& check, const std::string& asked, const std::string& measured) {
  fmt::print("{} | {} | {} | {}\n", passed ? "PASS" : "FAIL", check, asked, measured);
  std::fflush(stdout);
  failed = failed || !passed;
}

void print_note(const std::string& check, const std::string& measured) {
  fmt::print("NOTE | {} | - | {}\n", check, measured);
  std::fflush(stdout);
}

int skip_all(const std::string& what) {
  fmt::print("SKIP | {} | - | NOT TESTED: the real recordings are absent; set KINEMARK_TEST_DATA\n", what);
  return 0;
}

int exit_status() { return failed ? 1 : 0; }

AcceptanceCheck::AcceptanceCheck(std::string name, Run run) { checks().emplace(std::move(name), run); }

int run_acceptance(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  if (name == "--list") {
    for (const auto& [listed, run] : checks()) fmt::print("{}\n", listed);
    return 0;
  }
  const auto found = checks().find(name);
  if (found == checks().end()) {
    fmt::print(stderr, "{}: no check '{}'; --list names them\n", argv[0], name);
    return 2;
  }
  return found->second(argc - 1, argv + 1);
}

ScratchSpace::ScratchSpace(const std::string& name) {
  const char* base = std::getenv("KINEMARK_SCRATCH");
  path_ = (base != nullptr ? std::filesystem::path(base) : std::filesystem::temp_directory_path()) /
          ("kinemark-" + name);
  std::filesystem::remove_all(path_);
  std::filesystem::create_directories(path_);
}

ScratchSpace::~ScratchSpace() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace kinemark::testing_support
