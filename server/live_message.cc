// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/live_message.h"

#include <bit>
#include <limits>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/units.h"

namespace kinemark::server {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kDroppedAt = 4, kAnswerAt = 32;
constexpr double kMostCounted = 9e15;  // whole numbers that a float64 holds

template <class Bits>
void set_bits(std::string& out, std::size_t at, Bits bits) {
  for (std::size_t i = 0; i < sizeof(Bits); ++i) out[at + i] = static_cast<char>(bits >> (8 * i) & 0xFFU);
}

template <class Bits>
void put_bits(std::string& out, Bits bits) {
  out.resize(out.size() + sizeof(Bits));
  set_bits(out, out.size() - sizeof(Bits), bits);
}

void put(std::string& out, double value) { put_bits(out, std::bit_cast<std::uint64_t>(value)); }
void put(std::string& out, float value) { put_bits(out, std::bit_cast<std::uint32_t>(value)); }

std::string head(LiveKind kind, std::size_t count, double frame, double time_s, double due_s,
                 std::size_t body_bytes) {
  std::string out{static_cast<char>(kind), static_cast<char>(kVersion)};
  out.reserve(kLiveHeadBytes + body_bytes);
  put_bits(out, static_cast<std::uint16_t>(count));
  put_bits(out, std::uint32_t{0});
  put(out, frame);
  put(out, time_s);
  put(out, due_s);
  put(out, std::numeric_limits<float>::quiet_NaN());
  put_bits(out, std::uint32_t{0});
  return out;
}

}  // namespace

std::string markers_message(std::int64_t frame, double time_s, double due_s, std::span<const double> x,
                            std::span<const data::SampleState> state) {
  auto out = head(LiveKind::markers, state.size(), static_cast<double>(frame), time_s, due_s,
                  4 * x.size() + state.size());
  for (const double value : x) put(out, static_cast<float>(value));
  for (const auto one : state) out += static_cast<char>(one);
  return out;
}

std::vector<double> message_units(const model::Model& model) {
  constexpr double kMmPerM = 1e3;
  std::vector<double> out;
  for (const auto& coordinate : model.description().coordinates)
    out.push_back(coordinate.is_rotation ? kDegPerRad : kMmPerM);
  return out;
}

std::string angles_message(const motion::LivePose& pose, std::span<const double> units, double due_s) {
  const auto count = units.size();
  check(std::cmp_equal(pose.q.size(), count) && pose.q_sd.size() == pose.q.size() &&
            pose.determined.size() == count,
        "angles and their deviations, one of each coordinate");
  auto out = head(LiveKind::angles, count, static_cast<double>(pose.frame), pose.time_s, due_s, 9 * count);
  for (const auto* numbers : {&pose.q, &pose.q_sd})
    for (std::size_t c = 0; c < count; ++c)
      put(out, static_cast<float>(units[c] * (*numbers)[static_cast<Eigen::Index>(c)]));
  for (const auto one : pose.determined) out += static_cast<char>(one);
  return out;
}

std::string sentence_message(std::string_view sentence, double due_s) {
  sentence = sentence.substr(0, std::numeric_limits<std::uint16_t>::max());
  return head(LiveKind::sentence, sentence.size(), 0.0, 0.0, due_s, sentence.size()).append(sentence);
}

void set_viewer_fields(std::string& message, std::uint32_t dropped, float answer_s) {
  set_bits(message, kDroppedAt, dropped);
  set_bits(message, kAnswerAt, std::bit_cast<std::uint32_t>(answer_s));
}

std::optional<std::uint64_t> drawn_count(std::string_view bytes) {
  if (bytes.size() != sizeof(double)) return std::nullopt;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  const auto count = std::bit_cast<double>(bits);
  if (!(count >= 0.0 && count <= kMostCounted)) return std::nullopt;
  const auto whole = static_cast<std::uint64_t>(count);
  if (static_cast<double>(whole) != count) return std::nullopt;
  return whole;
}

}  // namespace kinemark::server
