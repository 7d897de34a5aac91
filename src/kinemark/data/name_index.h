// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One rule for marker names: as a model, a setup or a segments file writes them, looked up among those of a
// recording, which may carry a subject's prefix ("Ann:LASI").
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinemark::data {

/// The name behind a subject's prefix: what follows the last ':'; the whole name where there is none.
[[nodiscard]] std::string_view without_prefix(std::string_view name);

/// The names of a recording, found exactly or behind a prefix.
///
/// A name that is there as it is wins. Else it is the only one whose part behind the last ':' equals it. When
/// several subjects carry it, none is taken: a guess would mix two people.
class NameIndex {
 public:
  /// @param names  unique; copied
  explicit NameIndex(const std::vector<std::string>& names);

  /// Index of the name, or -1 where it is not there or several subjects carry it. O(log names).
  [[nodiscard]] std::int64_t find(std::string_view name) const;
  /// Whether several subjects carry the name and none has it exactly.
  [[nodiscard]] bool ambiguous(std::string_view name) const;
  /// What is there instead of a name that was not found, for the end of a sentence: the carriers of an
  /// ambiguous one, "Ann:LASI, Bob:LASI (several subjects: need the full name)"; else all names, 12 at most.
  [[nodiscard]] std::string instead_of(std::string_view name) const;

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::int64_t, std::less<>> exact_;
  std::map<std::string, std::vector<std::int64_t>, std::less<>> behind_prefix_;
};

}  // namespace kinemark::data
