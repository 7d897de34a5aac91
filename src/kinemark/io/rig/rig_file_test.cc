// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/rig/rig_file.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

#include "kinemark/core/random.h"
#include "kinemark/math/euler.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Two lateral-effect cameras and a pinhole camera with odd numbers everywhere.
data::Rig odd_rig() {
  Random random(5, 1);
  const auto g = [&random] { return random.gaussian(); };
  data::Rig rig;
  rig.id = "lab \"2\" \\ t\tab";
  rig.method = "bundle";
  rig.chi2_per_dof = 0.73;
  rig.electronics.bits = 11;
  rig.electronics.time_constant_s = 1.0 / 30000.0;
  rig.timing.dark_slot = true;
  for (const char* name : {"A", "B", "video"}) {
    auto& camera = rig.cameras.emplace_back();
    camera.name = name;
    const double x = g();
    const double y = g();
    const double z = g();
    camera.cam_from_world.rotation = math::exp_so3({x, y, z});
    camera.cam_from_world.translation << z, x, y;
    camera.focal = 4.9 + 0.1 * g();
    camera.distortion = {.k1 = -0.2, .k2 = 1e-17 * g(), .k3 = 0.0, .p1 = g(), .p2 = 1e22};
    camera.principal_point << 0.01, -0.0;
  }
  rig.cameras[2].kind = data::CameraKind::pinhole;
  auto& warped = rig.cameras[0].detector;
  warped.warp_degree = 3;
  for (int n = 0; n < 7; ++n) {
    warped.warp_x.push_back(0.003 * g());
    warped.warp_y.push_back(0.003 * g());
  }
  warped.crosstalk(2, 1) = 0.02;
  auto& generic = rig.cameras[1].detector;
  generic.kind = data::DetectorKind::generic;
  generic.generic_degree = 1;
  for (int n = 0; n < 9; ++n) generic.generic.push_back(g());
  auto& table = rig.cameras[0].table;
  table = {.nodes = 3, .spacing_m = 0.5, .distance_m = 3.0, .uv = {}};
  for (int n = 0; n < 18; ++n) table.uv.push_back(g());
  const int n = rig.parameter_count();
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(n, 5);
  for (const int row : {0, 4, 6, 20, n - 1})
    for (int k = 0; k < 5; ++k) root(row, k) = 1e-3 * g();
  rig.covariance = root * root.transpose();
  rig.covariance = 0.5 * (rig.covariance + rig.covariance.transpose().eval());
  return rig;
}

std::string message(const std::string& text) {
  const auto rig = parse_rig(text, "rig.toml");
  return rig ? "read" : rig.error().message;
}

/// The odd rig's text with one piece replaced.
std::string spoilt(const std::string& from, const std::string& to) {
  std::string text = format_rig(odd_rig());
  const auto at = text.find(from);
  if (at == std::string::npos) return "there is no " + from;
  return text.replace(at, from.size(), to);
}

TEST(RigFile, ReadsBackToTheSameBits) {
  const testing_support::ScratchFolder scratch;
  const auto rig = odd_rig();
  ASSERT_TRUE(rig.validate()) << rig.validate().error().message;
  ASSERT_TRUE(write_rig(scratch / "rig.toml", rig, false));
  const auto back = read_rig(scratch / "rig.toml");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->id, rig.id);
  EXPECT_EQ(back->chi2_per_dof, rig.chi2_per_dof);
  EXPECT_EQ(back->electronics.bits, 11);
  EXPECT_EQ(back->electronics.time_constant_s, rig.electronics.time_constant_s);
  EXPECT_TRUE(back->timing.dark_slot);
  ASSERT_EQ(back->cameras.size(), 3U);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto &a = back->cameras[c], &b = rig.cameras[c];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.cam_from_world.rotation, b.cam_from_world.rotation);
    EXPECT_EQ(a.cam_from_world.translation, b.cam_from_world.translation);
    EXPECT_EQ(a.focal, b.focal);
    EXPECT_EQ(a.distortion.k2, b.distortion.k2);
    EXPECT_EQ(a.distortion.p2, b.distortion.p2);
    EXPECT_EQ(a.detector.kind, b.detector.kind);
    EXPECT_EQ(a.detector.warp_x, b.detector.warp_x);
    EXPECT_EQ(a.detector.crosstalk, b.detector.crosstalk);
    EXPECT_EQ(a.detector.generic, b.detector.generic);
    EXPECT_EQ(a.table.uv, b.table.uv);
  }
  EXPECT_EQ(back->covariance, rig.covariance);
  EXPECT_EQ(format_rig(*back), format_rig(rig));
}

TEST(RigFile, KeepsDarkCountsAndTheConstantOfTheLightWhereTheyAreKnown) {
  auto rig = odd_rig();
  EXPECT_EQ(format_rig(rig).find("dark_counts"), std::string::npos);
  EXPECT_EQ(format_rig(rig).find("light_counts"), std::string::npos);
  const auto lateral = std::ranges::find(rig.cameras, data::CameraKind::lateral_effect, &data::Camera::kind);
  lateral->detector.dark_counts << 16.25, 17.0, 15.5, 16.0;
  lateral->detector.dark_sd_counts = 0.04;
  lateral->detector.light_counts = 26179.7;
  const auto back = parse_rig(format_rig(rig), "rig.toml");
  ASSERT_TRUE(back) << back.error().message;
  const auto& found = back->cameras[static_cast<std::size_t>(lateral - rig.cameras.begin())].detector;
  EXPECT_EQ(found.dark_counts, lateral->detector.dark_counts);
  EXPECT_EQ(found.dark_sd_counts, 0.04);
  EXPECT_EQ(found.light_counts, 26179.7);
}

TEST(RigFile, AHandWrittenRigNeedsLittle) {
  const auto rig = parse_rig(R"(
format = "kinemark-rig"
version = 1
[[camera]]
name = "left"
kind = "lateral-effect"
rotation = [[1, 0, 0], [0, -1, 0], [0, 0, -1]]
translation_m = [0, 0, 3]
focal = 5
)",
                             "rig.toml");
  ASSERT_TRUE(rig) << rig.error().message;
  EXPECT_EQ(rig->cameras[0].centre_in_world(), Eigen::Vector3d(0, 0, 3));
  EXPECT_EQ(rig->cameras[0].detector.kind, data::DetectorKind::tetra_lateral);
  EXPECT_EQ(rig->electronics.bits, 12);
}

TEST(RigFile, ExistingFilesStayAndInvalidRigsAreNotWritten) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_rig(scratch / "rig.toml", odd_rig(), false));
  EXPECT_EQ(write_rig(scratch / "rig.toml", odd_rig(), false).error().code, Code::io);
  EXPECT_TRUE(write_rig(scratch / "rig.toml", odd_rig(), true));
  EXPECT_EQ(write_rig(scratch / "none.toml", {}, false).error().code, Code::usage);
  EXPECT_EQ(read_rig(scratch / "none.toml").error().code, Code::io);
}

TEST(RigFile, FailuresAreOneLineWhateverTheFileHolds) {
  for (const std::string& text : {std::string(R"(format = "a\nb")") + "\nversion = 1",
                                  spoilt("name = \"A\"", R"(name = "A\nB")"
                                                         "\nfocl = 1"),
                                  spoilt("aspect", R"("asp\nct")")}) {
    EXPECT_THAT(message(text), StartsWith("rig.toml: "));
    EXPECT_EQ(message(text).find('\n'), std::string::npos) << message(text);
  }
}

TEST(RigFile, FailuresNameThePlace) {
  EXPECT_THAT(message("format = \"kinemark-rig\nversion"), StartsWith("rig.toml: line 1, column "));
  EXPECT_THAT(message(""), "rig.toml: format is missing; need text in quotes");
  EXPECT_THAT(message("format = \"pipeline\"\nversion = 1"), HasSubstr("no rig; its format is 'pipeline'"));
  EXPECT_THAT(message("format = \"kinemark-rig\"\nversion = 2"), HasSubstr("version 2"));
  EXPECT_THAT(message("format = \"kinemark-rig\"\nversion = 1"), "rig.toml: the rig has no camera");
  EXPECT_THAT(message("format = \"kinemark-rig\"\nversion = 1\ncamera = 3"), HasSubstr("[[camera]]"));
  EXPECT_THAT(message(spoilt("focal", "focl")),
              "rig.toml: camera 'A': focal is missing; need a finite number");
  EXPECT_THAT(message(spoilt("aspect", "aspct")), "rig.toml: camera 'A': unknown key 'aspct'");
  EXPECT_THAT(message(spoilt("bits = 11", "bits = 11.5")), HasSubstr("electronics: bits must be an integer"));
  EXPECT_THAT(message(spoilt("dark_slot = true", "dark_slot = 1")),
              HasSubstr("timing: dark_slot must be true or"));
  EXPECT_THAT(message(spoilt("kind = \"pinhole\"", "kind = \"fisheye\"")),
              HasSubstr("camera 'video': there is no kind of camera 'fisheye'; there are"));
  EXPECT_THAT(message(spoilt("kind = \"generic\"", "kind = \"ccd\"")),
              HasSubstr("camera 'B', detector: there is no kind of detector 'ccd'; there are"));
  EXPECT_THAT(message(spoilt("warp_degree = 3", "warp_degree = 4")), HasSubstr("has 7 terms; need 12"));
  EXPECT_THAT(message(spoilt("gain = [1.0,", "gain = [")), HasSubstr("gain must be a list of 4 numbers"));
  EXPECT_THAT(message(spoilt("rotation = [", "rotation = [[1, 0, 0], ")), HasSubstr("3 lists of 3 numbers"));
  EXPECT_THAT(message(spoilt("name = \"A\"", "name = \"B\"")), HasSubstr("'B' occurs twice"));
  EXPECT_THAT(message(spoilt("nodes = 3", "nodes = 4")), HasSubstr("need 32"));
  EXPECT_THAT(message(spoilt("free = [0,", "free = [")),
              HasSubstr("lower holds 15 numbers for 4 parameters; need 10"));
  EXPECT_THAT(message(spoilt("free = [0, 4", "free = [5, 4")), HasSubstr("free holds 4 after 5"));
  EXPECT_THAT(message(spoilt("id = ", "id = 3 #")), HasSubstr("id must be text"));
}

TEST(RigFile, DeepAndBrokenTextIsRefused) {
  EXPECT_THAT(message("a = " + std::string(100'000, '[')), StartsWith("rig.toml: line 1"));
  EXPECT_THAT(message("id = \"\xff\xfe\""), StartsWith("rig.toml: line 1"));
  const std::string whole = format_rig(odd_rig());
  for (std::size_t end = 0; end < whole.size(); end += 97) {
    const auto rig = parse_rig(whole.substr(0, end), "cut.toml");
    if (rig) continue;
    EXPECT_THAT(rig.error().message, StartsWith("cut.toml")) << end;
  }
}

}  // namespace
}  // namespace kinemark::io
