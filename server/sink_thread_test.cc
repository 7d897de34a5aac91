// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/sink_thread.h"

#include <gtest/gtest.h>

#include <vector>

namespace kinemark::server {
namespace {

FrameQueue::FramePtr frame_of(std::int64_t number) {
  auto out = std::make_shared<stream::Frame>();
  out->number = number;
  return out;
}

/// Notes what it gets, and fails from frame `fails_at` on.
class Noting final : public stream::Sink {
 public:
  Noting(std::vector<std::int64_t>& got, std::int64_t fails_at) : got_(got), fails_at_(fails_at) {}
  Status push(const stream::Frame& frame) override {
    if (frame.number >= fails_at_) return fail(Code::io, "full");
    got_.push_back(frame.number);
    return {};
  }
  Status finish() override {
    got_.push_back(-1);
    return {};
  }

 private:
  std::vector<std::int64_t>& got_;
  std::int64_t fails_at_;
};

TEST(FrameQueue, GivesInOrderAndCountsWhatItDrops) {
  FrameQueue queue(2);
  for (int f = 0; f < 5; ++f) queue.push(frame_of(f));
  EXPECT_EQ(queue.dropped(), 3);
  queue.finish();
  EXPECT_EQ(queue.pop()->number, 3);
  EXPECT_EQ(queue.pop()->number, 4);
  EXPECT_EQ(queue.pop(), nullptr);
  FrameQueue all(0);
  for (int f = 0; f < 5000; ++f) all.push(frame_of(f));
  EXPECT_EQ(all.dropped(), 0);
  EXPECT_EQ(all.pop()->number, 0);
}

TEST(SinkThread, TakesAllThatCameBeforeItsEnd) {
  std::vector<std::int64_t> got;
  SinkThread sink(std::make_unique<Noting>(got, 100), 0, [](const Error&) { ADD_FAILURE(); });
  for (int f = 0; f < 50; ++f) sink.push(frame_of(f));
  sink.finish();
  sink.join();
  ASSERT_EQ(got.size(), 51U);
  EXPECT_EQ(got[49], 49);
  EXPECT_EQ(got[50], -1) << "its end";
}

TEST(SinkThread, AFailureIsSaidOnceAndEndsIt) {
  std::vector<std::int64_t> got;
  std::vector<std::string> said;
  {
    SinkThread sink(std::make_unique<Noting>(got, 2), 0,
                    [&said](const Error& e) { said.push_back(e.message); });
    for (int f = 0; f < 5; ++f) sink.push(frame_of(f));
  }
  EXPECT_EQ(got, (std::vector<std::int64_t>{0, 1}));
  EXPECT_EQ(said, std::vector<std::string>{"full"});
}

}  // namespace
}  // namespace kinemark::server
