// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/force_unit.h"

#include <gtest/gtest.h>

namespace kinemark {
namespace {

TEST(ForceUnit, WordsOfForce) {
  for (const char* word : {"N", "n", "Nt", "nt", "Newton", "Newtons", " N "})
    EXPECT_EQ(newtons_per_unit(word), 1.0) << word;
  EXPECT_EQ(newtons_per_unit("kN"), 1e3);
  EXPECT_EQ(newtons_per_unit("dN"), 0.1);
  EXPECT_EQ(newtons_per_unit("mN"), 1e-3);
  EXPECT_EQ(newtons_per_unit("kgf"), 9.80665);
  EXPECT_NEAR(*newtons_per_unit("lbf"), 4.4482216, 1e-7);
  for (const char* word : {"", "V", "ADC", "MN", "Nm", "furlong", "bits"})
    EXPECT_FALSE(newtons_per_unit(word)) << word;
}

TEST(ForceUnit, WordsOfMoment) {
  for (const char* word :
       {"Nm", "N.m", "N m", "N*m", "Nxm", "N-m", "Newton-meters", "Newton metres", "ntm", "Joule", "J"})
    EXPECT_TRUE(newton_metres_per_unit(word)) << word;
  for (const char* word : {"Nm", "N.m", "Nxm", "Newton-meters", "Joule"})
    EXPECT_EQ(newton_metres_per_unit(word), 1.0) << word;
  EXPECT_EQ(newton_metres_per_unit("ntmm"), 1e-3);
  EXPECT_EQ(newton_metres_per_unit("Nmm"), 1e-3);
  EXPECT_EQ(newton_metres_per_unit("Ncm"), 1e-2);
  EXPECT_EQ(newton_metres_per_unit("kN.m"), 1e3);
  EXPECT_DOUBLE_EQ(newton_metres_per_unit("kNmm").value(), 1.0);
  EXPECT_DOUBLE_EQ(newton_metres_per_unit("kgf.m").value(), 9.80665);
  EXPECT_NEAR(newton_metres_per_unit("ft-lb").value(), 1.3558179, 1e-7);
  EXPECT_NEAR(newton_metres_per_unit("lbf.in").value(), 0.1129848, 1e-7);
  for (const char* word : {"", "N", "V", "m", "MNm", "furlong"})
    EXPECT_FALSE(newton_metres_per_unit(word)) << word;
}

}  // namespace
}  // namespace kinemark
