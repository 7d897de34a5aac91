// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/blank_rows.h"

#include <gtest/gtest.h>

namespace kinemark::io {
namespace {

TEST(BlankRows, BetweenRowsOfNumbersGo) {
  EXPECT_EQ(without_blank_rows("t,x\n0,1\n\n1,2\n"), "t,x\n0,1\n1,2\n");
  EXPECT_EQ(without_blank_rows("t\tx\r\n0\t1\r\n\r\n\t\r\n1\t2\r\n"), "t\tx\r\n0\t1\r\n1\t2\r\n");
  EXPECT_EQ(without_blank_rows("0;1\n;\n1;2\n \n2;\"3\"\n"), "0;1\n1;2\n2;\"3\"\n");
  EXPECT_EQ(without_blank_rows("0,1,\n,,\n1,,2\n"), "0,1,\n1,,2\n") << "cells may be empty";
}

TEST(BlankRows, ThatEndATableOrStandAboveItStay) {
  for (const std::string text : {"", "\n", "t,x\n\n0,1\n1,2\n", "0,1\n1,2\n\n", "0,1\n\nDevices\n1000\n",
                                 "0,1\n\n1,2,3\n", "0,1\n\n1\n", "0,1\n\nFrame,2\n",
                                 "Trajectories\n100\n\n1,2\n", "0,1\n\n,2\n", "0,1\n1,2\n", "a\n\n\nb\n"})
    EXPECT_EQ(without_blank_rows(text), text) << text;
}

}  // namespace
}  // namespace kinemark::io
