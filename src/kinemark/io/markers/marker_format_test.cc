// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/markers/marker_format.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

namespace kinemark::io {
namespace {

using testing::Contains;
using testing::Not;

TEST(MarkerFormat, EveryRowIsOfUseAndNamedOnce) {
  std::set<std::string_view> names;
  for (const MarkerFormat& f : marker_formats()) {
    SCOPED_TRACE(f.name);
    EXPECT_TRUE(names.insert(f.name).second) << "named twice";
    EXPECT_TRUE(f.read != nullptr || f.write != nullptr);
    EXPECT_TRUE(f.extension.size() > 1 && f.extension.front() == '.');
    EXPECT_EQ(f.write == nullptr, f.precision.empty()) << "who writes says how exactly";
    if (f.write == nullptr) {
      EXPECT_THAT(f.kept, testing::Each(Kept::none));
    }
  }
}

TEST(MarkerFormat, OneFormatIsWrittenUnderAnExtension) {
  std::set<std::string_view> written;
  for (const MarkerFormat& f : marker_formats()) {
    if (f.write == nullptr) continue;
    EXPECT_TRUE(written.insert(f.extension).second) << f.name;
    EXPECT_EQ(written_format(f.extension), &f);
  }
  for (const char* none : {".v3d", ".mot", "c3d", ".C3D", ""})
    EXPECT_EQ(written_format(none), nullptr) << none;
}

TEST(MarkerFormat, ExtensionsAreListedOnce) {
  const auto read = read_extensions(), written = written_extensions();
  for (const auto& list : {read, written})
    EXPECT_EQ(std::set<std::string>(list.begin(), list.end()).size(), list.size());
  for (const char* both : {".c3d", ".trc", ".nwb", ".mat", ".csv"}) {
    EXPECT_THAT(read, Contains(both));
    EXPECT_THAT(written, Contains(both));
  }
  EXPECT_THAT(read, Contains(".v3d"));
  EXPECT_THAT(written, Not(Contains(".v3d")));
}

TEST(MarkerFormat, TheBeginningOfAFileBelongsToOneFormatAtMost) {
  const std::string c3d("\x02\x50\x00\x01", 4);
  for (const std::string& begin :
       {c3d, std::string("PathFileType\t4"), std::string("\xEF\xBB\xBFPathFileType"),
        std::string("\x89HDF\r\n\x1a\n"), std::string("NO_OF_FRAMES\t3\n"),
        std::string("MATLAB 7.3 MAT-file"), std::string("Format Version,1.23,Take Name,a\n"),
        std::string("Trajectories\n100\n"), std::string("frame,time_s,marker\n"), std::string("aPlain text"),
        std::string()}) {
    int known = 0;
    for (const MarkerFormat& f : marker_formats()) known += f.begins != nullptr && f.begins(begin) ? 1 : 0;
    const bool plain = begin.empty() || begin.starts_with("frame") || begin.starts_with("aPlain");
    EXPECT_EQ(known, plain ? 0 : 1) << begin;
  }
}

}  // namespace
}  // namespace kinemark::io
