// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <utility>

#include "kinemark/core/result.h"
#include "kinemark/io/file.h"

namespace kinemark::io {

/// Bytes that can be read at any offset: a file, or memory. read_at() may be called from several threads.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  [[nodiscard]] virtual std::size_t size() const = 0;  ///< bytes in all
  /// The file's name, with which error messages begin.
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// Fill `out` from `offset`; returns how many bytes there were (fewer only at the end).
  [[nodiscard]] virtual Result<std::size_t> read_at(std::size_t offset, std::span<std::byte> out) const = 0;
};

/// An open file as a source of bytes.
class FileSource final : public ByteSource {
 public:
  explicit FileSource(InputFile file) : file_(std::move(file)) {}           ///< takes the file over
  [[nodiscard]] std::size_t size() const override { return file_.size(); }  ///< bytes of the file
  [[nodiscard]] const std::string& name() const override { return file_.name(); }
  [[nodiscard]] Result<std::size_t> read_at(std::size_t offset, std::span<std::byte> out) const override {
    return file_.read_at(offset, out);
  }

 private:
  InputFile file_;
};

/// Bytes that the caller keeps alive.
class MemorySource final : public ByteSource {
 public:
  /// `name` begins messages
  MemorySource(std::span<const std::byte> bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}
  [[nodiscard]] std::size_t size() const override { return bytes_.size(); }  ///< bytes given
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] Result<std::size_t> read_at(std::size_t offset, std::span<std::byte> out) const override {
    const std::size_t n = offset < bytes_.size() ? std::min(out.size(), bytes_.size() - offset) : 0;
    if (n > 0) std::memcpy(out.data(), bytes_.data() + offset, n);
    return n;
  }

 private:
  std::span<const std::byte> bytes_;
  std::string name_;
};

}  // namespace kinemark::io
