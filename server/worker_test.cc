// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/worker.h"

#include <gmock/gmock.h>

#include <atomic>
#include <future>
#include <vector>

namespace kinemark::server {
namespace {

using ::testing::ElementsAre;

TEST(WorkerThread, DoesOneAfterTheOtherOnAThreadOfItsOwn) {
  std::vector<int> order;
  std::promise<std::thread::id> last;
  Worker worker(10);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(worker.post([&order, i] { order.push_back(i); }));
  ASSERT_TRUE(worker.post([&] { last.set_value(std::this_thread::get_id()); }));
  EXPECT_NE(last.get_future().get(), std::this_thread::get_id());
  EXPECT_THAT(order, ElementsAre(0, 1, 2));
}

TEST(WorkerThread, RefusesWhatIsTooMuch) {
  std::promise<void> begun, go;
  Worker worker(2);
  ASSERT_TRUE(worker.post([&] {
    begun.set_value();
    go.get_future().wait();
  }));
  begun.get_future().wait();
  EXPECT_TRUE(worker.post([] {}));
  EXPECT_TRUE(worker.post([] {}));
  EXPECT_FALSE(worker.post([] {}));
  std::promise<void> done;
  go.set_value();
  while (!worker.post([&] { done.set_value(); })) std::this_thread::yield();
  done.get_future().wait();
}

TEST(WorkerThread, EndsWithWhatItIsDoing) {
  std::promise<void> begun, go;
  bool first = false;
  {
    Worker worker(10);
    ASSERT_TRUE(worker.post([&] {
      begun.set_value();
      go.get_future().wait();
      first = true;
    }));
    begun.get_future().wait();
    go.set_value();
  }
  EXPECT_TRUE(first);
}

TEST(WorkerThread, LetsGoOfWorkWhenItIsDone) {
  Worker worker(10);
  auto held = std::make_shared<int>(1);
  std::promise<void> done;
  ASSERT_TRUE(worker.post([held] {}));
  ASSERT_TRUE(worker.post([&done] { done.set_value(); }));
  done.get_future().wait();
  EXPECT_EQ(held.use_count(), 1);
}

TEST(WorkerThread, DoesWhatComesAgainBesideWhatIsAsked) {
  std::promise<void> asked, third;
  int times = 0;
  Worker worker(10, {.every = std::chrono::milliseconds(1), .work = [&] {
                       if (++times == 3) third.set_value();
                     }});
  third.get_future().wait();
  ASSERT_TRUE(worker.post([&] { asked.set_value(); }));
  asked.get_future().wait();
}

TEST(WorkerThread, WhatComesAgainHasItsTurnWhereOthersAlwaysWait) {
  std::promise<void> turn;
  std::atomic<bool> had = false;
  Worker worker(2, {.every = std::chrono::milliseconds(1), .work = [&] {
                      if (!had.exchange(true)) turn.set_value();
                    }});
  while (!had) (void)worker.post([] {});
  turn.get_future().wait();
}

}  // namespace
}  // namespace kinemark::server
