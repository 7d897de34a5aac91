// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Values through a pipe between two processes, in the order that both ends know: the same `pass` writes and
// reads.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <concepts>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "kinemark/core/array.h"

namespace kinemark::io::internal {

inline constexpr std::size_t kPipeBuffer = 1 << 16;

/// Bytes out, gathered into large pieces.
class Sink {
 public:
  explicit Sink(int fd) : fd_(fd) {}

  void bytes(const void* from, std::size_t size) {
    if (size < kPipeBuffer) {
      buffer_.append(static_cast<const char*>(from), size);
      if (buffer_.size() >= kPipeBuffer) flush();
    } else {
      flush();
      put(static_cast<const char*>(from), size);
    }
  }
  bool flush() {
    put(buffer_.data(), buffer_.size());
    buffer_.clear();
    return good_;
  }

 private:
  void put(const char* from, std::size_t size) {
    while (good_ && size > 0) {
      const ssize_t n = ::write(fd_, from, size);
      if (n < 0 && errno == EINTR) continue;
      good_ = n > 0;
      from += n;
      size -= static_cast<std::size_t>(n);
    }
  }

  int fd_;
  bool good_ = true;
  std::string buffer_;
};

/// Bytes in, at most so many. After a failure everything reads as zero.
class Source {
 public:
  Source(int fd, std::size_t most_bytes) : fd_(fd), left_(most_bytes), buffer_(kPipeBuffer) {}

  void bytes(void* out, std::size_t size) {
    auto* to = static_cast<char*>(out);
    while (good_ && size > 0) {
      if (at_ < filled_) {
        const std::size_t n = std::min(size, filled_ - at_);
        std::copy_n(buffer_.data() + at_, n, to);
        at_ += n;
        to += n;
        size -= n;
      } else if (size >= kPipeBuffer) {
        const std::size_t n = get(to, size);
        to += n;
        size -= n;
      } else {
        filled_ = get(buffer_.data(), kPipeBuffer);
        at_ = 0;
      }
    }
    std::fill_n(to, size, '\0');
  }
  /// A number of elements of that size, no more than may still come.
  std::size_t count(std::size_t element_bytes) {
    std::uint64_t n = 0;
    bytes(&n, sizeof n);
    if (n > left_ / element_bytes) good_ = false;
    if (!good_) return 0;
    left_ -= n * element_bytes;
    return n;
  }
  [[nodiscard]] bool good() const { return good_; }

 private:
  std::size_t get(char* to, std::size_t size) {
    while (true) {
      const ssize_t n = ::read(fd_, to, size);
      if (n < 0 && errno == EINTR) continue;
      good_ = n > 0;
      return n > 0 ? static_cast<std::size_t>(n) : 0;
    }
  }

  int fd_;
  std::size_t left_;
  bool good_ = true;
  std::vector<char> buffer_;
  std::size_t at_ = 0, filled_ = 0;
};

/// The order of everything is written once: `pass` is the same code for both directions.
inline void pass(Sink& out, const std::string& text) {
  const std::uint64_t size = text.size();
  out.bytes(&size, sizeof size);
  out.bytes(text.data(), text.size());
}
inline void pass(Source& in, std::string& text) {
  text.resize(in.count(1));
  in.bytes(text.data(), text.size());
}

template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

template <Plain T>
void pass(Sink& out, const T& value) {
  out.bytes(&value, sizeof value);
}
template <Plain T>
void pass(Source& in, T& value) {
  in.bytes(&value, sizeof value);
}

template <Plain T>
void pass(Sink& out, const Array<T>& values) {
  const std::uint64_t size = values.size();
  out.bytes(&size, sizeof size);
  out.bytes(values.data(), size * sizeof(T));
}
template <Plain T>
void pass(Source& in, Array<T>& values) {
  values.resize(in.count(sizeof(T)));
  in.bytes(values.data(), values.size() * sizeof(T));
}

template <class Pipe, class List, class Each>
void pass_each(Pipe& pipe, List& list, const Each& each) {
  if constexpr (std::is_same_v<Pipe, Sink>) {
    const std::uint64_t size = list.size();
    pipe.bytes(&size, sizeof size);
    for (auto& element : list) each(element);
  } else {
    for (std::size_t left = pipe.count(1); left > 0 && pipe.good(); --left) each(list.emplace_back());
  }
}

template <class Pipe, class Texts>
void pass_texts(Pipe& pipe, Texts& texts) {
  pass_each(pipe, texts, [&](auto& text) { pass(pipe, text); });
}

}  // namespace kinemark::io::internal
