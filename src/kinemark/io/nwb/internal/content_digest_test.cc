// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/content_digest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/core/random.h"
#include "kinemark/io/file.h"
#include "kinemark/io/nwb/internal/content_list.h"
#include "kinemark/io/nwb/internal/reader.h"
#include "kinemark/io/nwb/testing/sample.h"
#include "support/scratch.h"

namespace kinemark::io::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A file of ours; `change` is made to it with its digest as it was.
template <class Change>
Result<NwbFile> changed(const Change& change, bool keep_digest = true) {
  const testing_support::ScratchFolder scratch;
  const Quiet quiet;
  const auto t = testing::sample_trajectories(12);
  const auto d = testing::sample_derivatives(t);
  EXPECT_TRUE(write_nwb(scratch / "a.nwb", t, &d, testing::sample_metadata()));
  {
    const Handle file(H5Fopen((scratch / "a.nwb").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    if (!keep_digest) H5Adelete(file.id(), kDigestAttribute);
    change(file.id());
  }
  return read_nwb_here(scratch / "a.nwb");
}

void set_text(hid_t file, const char* path, const char* value) {
  const Handle dataset(H5Dopen2(file, path, H5P_DEFAULT), H5Dclose);
  const Handle type(H5Dget_type(dataset.id()), H5Tclose);
  const void* pointer = static_cast<const void*>(&value);
  ASSERT_GE(H5Dwrite(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointer), 0);
}

TEST(ContentDigest, FitsWhatWasWritten) {
  const auto file = changed([](hid_t) {});
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_THAT(file->warnings, ElementsAre());
}

TEST(ContentDigest, AnyChangeIsRefused) {
  const auto expect_refused = [](const auto& change) {
    const auto file = changed(change);
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().code, Code::bad_input);
    EXPECT_THAT(file.error().message,
                HasSubstr("a.nwb: its content is not what was written: the digest does not fit"));
  };
  expect_refused([](hid_t file) { H5Ldelete(file, "/processing/behavior/Covariance", H5P_DEFAULT); });
  expect_refused([](hid_t file) { H5Ldelete(file, "/processing/behavior/VelocitySD", H5P_DEFAULT); });
  expect_refused([](hid_t file) { H5Ldelete(file, "/processing/behavior/sources", H5P_DEFAULT); });
  expect_refused([](hid_t file) { set_text(file, "/session_description", "reachinG"); });
  expect_refused([](hid_t file) { set_text(file, "/general/subject/subject_id", "M2"); });
  expect_refused([](hid_t file) {
    const Handle data(H5Dopen2(file, "/processing/behavior/Position/a_b/data", H5P_DEFAULT), H5Dclose);
    std::vector<double> numbers(36, 0.25);
    ASSERT_GE(H5Dwrite(data.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), 0);
  });
  expect_refused([](hid_t file) {
    const Handle data(H5Dopen2(file, "/processing/behavior/Position/a_b/data", H5P_DEFAULT), H5Dclose);
    const Handle unit(H5Aopen(data.id(), "conversion", H5P_DEFAULT), H5Aclose);
    const double thousandth = 0.001;
    ASSERT_GE(H5Awrite(unit.id(), H5T_NATIVE_DOUBLE, &thousandth), 0);
  });
  expect_refused([](hid_t file) { H5Adelete(file, kContentAttribute); });
}

TEST(ContentDigest, WhatOthersAddIsNoneOfOurs) {
  const auto file = changed([](hid_t hdf5) {
    H5Gclose(H5Gcreate2(hdf5, "/units", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Gclose(H5Gcreate2(hdf5, "/processing/behavior/pupil", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Ldelete(hdf5, "/analysis", H5P_DEFAULT);  // which is empty, and of NWB's
  });
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_THAT(file->warnings, ElementsAre());
}

TEST(ContentDigest, OfAnOlderFileIsOfEverything) {
  const testing_support::ScratchFolder scratch;
  const Quiet quiet;
  ASSERT_TRUE(write_nwb(scratch / "a.nwb", testing::sample_trajectories(12)));
  const auto with_digest = [&](const auto& change) {
    {
      Output out(Handle(H5Fopen((scratch / "a.nwb").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose), "");
      for (const char* name : {kContentAttribute, kDigestAttribute})
        if (H5Aexists(out.file(), name) > 0) H5Adelete(out.file(), name);
      auto whole = Input::of(out.file());
      out.attribute(out.file(), kDigestAttribute, *content_digest(whole));
      change(out);
    }
    return read_nwb_here(scratch / "a.nwb");
  };
  EXPECT_TRUE(with_digest([](const Output&) {}));
  EXPECT_FALSE(with_digest([](Output& out) { out.group(out.file(), "new"); }));
}

TEST(ContentDigest, AFileOfOursWithoutOneIsReadWithAWarning) {
  const auto file = changed([](hid_t) {}, false);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_THAT(file->warnings, ElementsAre(HasSubstr("holds no digest of its content")));
}

TEST(ContentDigest, IsTheSameForTheFileBeingWrittenAndForOneReadBefore) {
  const testing_support::ScratchFolder scratch;
  const Quiet quiet;
  const auto t = testing::sample_trajectories(5000);  // more than a block
  ASSERT_TRUE(write_nwb(scratch / "a.nwb", t));
  auto in = Input::open(scratch / "a.nwb").value();
  const auto written = in.text_attribute(in.file(), kDigestAttribute);
  EXPECT_EQ(content_digest(in), written);
  ASSERT_TRUE(read_nwb(in));
  EXPECT_EQ(content_digest(in), written) << "from the digests of samples that were read";
}

TEST(ContentDigest, BitsFlippedAnywhereAreNoticed) {
  const testing_support::ScratchFolder scratch;
  const Quiet quiet;
  ASSERT_TRUE(
      write_nwb(scratch / "a.nwb", testing::sample_trajectories(12), nullptr, testing::sample_metadata()));
  const std::string whole = read_text(scratch / "a.nwb").value();
  // Texts lie in the one structure of HDF5 without a checksum, and flips there harm nothing.
  const std::size_t heap = whole.find("GCOL");
  ASSERT_NE(heap, std::string::npos);
  const std::size_t text = whole.find("reaching");
  ASSERT_NE(text, std::string::npos);
  for (std::size_t k = 0; k < 8; ++k) {
    std::string broken = whole;
    broken[text + k] = static_cast<char>(broken[text + k] ^ 1);
    auto in = Input::open(std::as_bytes(std::span(broken)), "image.nwb");
    ASSERT_TRUE(in);
    EXPECT_THAT(read_nwb(*in).error().message, HasSubstr("the digest does not fit")) << k;
  }
}

}  // namespace
}  // namespace kinemark::io::internal
