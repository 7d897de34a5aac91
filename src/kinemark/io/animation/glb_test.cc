// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The container and the numbers in it, taken apart here by the specification. tests/acceptance has unrelated
// readers.
#include "kinemark/io/animation/glb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstring>
#include <nlohmann/json.hpp>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using Eigen::Vector3d;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

std::uint32_t word(const std::string& bytes, std::size_t offset) {
  std::uint32_t out = 0;
  std::memcpy(&out, bytes.data() + offset, 4);
  return out;
}

/// A GLB taken apart.
struct Scene {
  json root;
  std::string numbers;

  explicit Scene(const std::filesystem::path& path) {
    const std::string bytes = read_text(path).value();
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(word(bytes, 4), 2U);
    EXPECT_EQ(word(bytes, 8), bytes.size());
    const std::uint32_t length = word(bytes, 12);
    EXPECT_EQ(length % 4, 0U);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    root = json::parse(bytes.substr(20, length));
    EXPECT_EQ(bytes.substr(24 + length, 4), std::string("BIN\0", 4));
    numbers = bytes.substr(28 + length);
    EXPECT_EQ(word(bytes, 20 + length), numbers.size());
  }

  [[nodiscard]] std::vector<float> floats(int accessor) const {
    const auto& a = root["accessors"][static_cast<std::size_t>(accessor)];
    const auto& view = root["bufferViews"][a["bufferView"].get<std::size_t>()];
    std::vector<float> out(view["byteLength"].get<std::size_t>() / 4);
    std::memcpy(out.data(), numbers.data() + view["byteOffset"].get<std::size_t>(), 4 * out.size());
    return out;
  }
  [[nodiscard]] int node(const std::string& name) const {
    for (std::size_t i = 0; i < root["nodes"].size(); ++i)
      if (root["nodes"][i]["name"] == name) return static_cast<int>(i);
    return -1;
  }
  /// Times and values of what animates a node; the interpolation, or empty when nothing does.
  struct Motion {
    std::vector<float> times, values;
    std::string interpolation;
  };
  [[nodiscard]] Motion motion(const std::string& name, const std::string& path) const {
    const auto& animation = root["animations"][0];
    for (const auto& channel : animation["channels"])
      if (channel["target"]["node"] == node(name) && channel["target"]["path"] == path) {
        const auto& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
        return {floats(sampler["input"]), floats(sampler["output"]), sampler["interpolation"]};
      }
    return {};
  }
};

/// A is always there, B in frames 1 and 3 of 0 to 4, C never.
data::Trial three() {
  data::Trial trial;
  trial.first_frame = 11;
  trial.markers =
      data::Trajectories::all_missing({"A", "B \xC3\xA9", "C"}, {.rate_hz = 10.0, .t0_s = 1.0, .frames = 5});
  const auto set = [&](std::int64_t f, std::int64_t m, const Vector3d& x) {
    trial.markers.x(f, m) = x;
    trial.markers.state[trial.markers.index(f, m)] = data::SampleState::measured;
  };
  for (int f = 0; f < 5; ++f) set(f, 0, {0.5 * f, 1.0, -2.0});
  set(1, 1, {1, 2, 3});
  set(3, 1, {4, 5, 6});
  return trial;
}

class Glb : public ::testing::Test {
 protected:
  testing_support::ScratchFolder scratch_;
};

TEST_F(Glb, MarkersAreNodesThatMove) {
  ASSERT_TRUE(write_glb(scratch_ / "a.glb", three(), false));
  const Scene scene(scratch_ / "a.glb");
  EXPECT_THAT(scene.root["scenes"][0]["nodes"], ElementsAre(0, 1, 2));
  EXPECT_EQ(scene.root["scenes"][0]["extras"]["first_frame"], 11);
  EXPECT_EQ(scene.root["scenes"][0]["extras"]["t0_s"], 1.0);
  const auto a = scene.motion("A", "translation");
  EXPECT_THAT(a.times, ElementsAre(0.0F, 0.1F, 0.2F, 0.3F, 0.4F));
  EXPECT_EQ(a.interpolation, "LINEAR");
  EXPECT_THAT(std::vector<float>(a.values.begin() + 3, a.values.begin() + 6), ElementsAre(0.5F, 1.0F, -2.0F));
  EXPECT_EQ(scene.motion("A", "scale").interpolation, "") << "it is always there";
}

TEST_F(Glb, MissingSamplesAreHiddenAndNoNumberIsWrittenForThem) {
  ASSERT_TRUE(write_glb(scratch_ / "a.glb", three(), false));
  const Scene scene(scratch_ / "a.glb");
  const auto moved = scene.motion("B \xC3\xA9", "translation"), shown = scene.motion("B \xC3\xA9", "scale");
  EXPECT_THAT(moved.times, ElementsAre(0.1F, 0.3F));
  EXPECT_THAT(moved.values, ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_EQ(shown.interpolation, "STEP");
  EXPECT_THAT(shown.times, ElementsAre(0.0F, 0.1F, 0.2F, 0.3F, 0.4F));
  EXPECT_THAT(shown.values, ElementsAre(0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 1, 1, 0, 0, 0));
  EXPECT_THAT(scene.root["nodes"][2]["scale"], ElementsAre(0.0, 0.0, 0.0)) << "never seen";
  EXPECT_EQ(scene.motion("C", "translation").interpolation, "");
}

TEST_F(Glb, BodiesAreATreeWithRotationsAndBones) {
  const auto turn = [](double rad) { return Eigen::AngleAxisd(rad, Vector3d::UnitZ()).toRotationMatrix(); };
  PoseTree poses{.bodies = {{.name = "thigh"}, {.name = "shank", .parent = 0, .end_in_body = {0, -0.3, 0}}},
                 .time = {.rate_hz = 100.0, .frames = 3},
                 .world_from_body = {}};
  for (const double rad : {0.0, 0.8, 1.6}) {
    poses.world_from_body.push_back({turn(rad), Vector3d(0, 1, 0)});
    poses.world_from_body.push_back({turn(3.0 * rad), Vector3d(0, 1, 0) + turn(rad) * Vector3d(0, -0.4, 0)});
  }
  ASSERT_TRUE(write_glb(scratch_ / "b.glb", poses, false));
  const Scene scene(scratch_ / "b.glb");
  const auto& thigh = scene.root["nodes"][static_cast<std::size_t>(scene.node("thigh"))];
  EXPECT_THAT(thigh["children"],
              testing::UnorderedElementsAre(scene.node("shank"), scene.node("thigh to shank")));
  EXPECT_THAT(scene.root["scenes"][0]["nodes"], ElementsAre(scene.node("thigh")));
  const auto shank = scene.motion("shank", "rotation");
  ASSERT_EQ(shank.values.size(), 12U);
  for (std::size_t f = 0; f < 3; ++f) {
    const double half = static_cast<double>(f) * 0.8;  // it turns by twice the thigh's angle in the thigh
    EXPECT_NEAR(std::abs(shank.values[4 * f + 2] * std::sin(half) + shank.values[4 * f + 3] * std::cos(half)),
                1.0, 1e-6);
  }
  for (std::size_t f = 1; f < 3; ++f) {
    const Eigen::Map<const Eigen::Vector4f> now(shank.values.data() + 4 * f),
        before(shank.values.data() + 4 * f - 4);
    EXPECT_GT(now.dot(before), 0.0F) << "the shorter way";
  }
  EXPECT_EQ(scene.motion("shank", "translation").interpolation, "") << "it does not move in the thigh";
  const auto& bone = scene.root["nodes"][static_cast<std::size_t>(scene.node("shank end"))];
  EXPECT_NEAR(bone["scale"][1].get<double>(), 0.3, 1e-12);
}

TEST_F(Glb, EveryAccessorLiesInItsBufferAndHasItsBounds) {
  ASSERT_TRUE(write_glb(scratch_ / "a.glb", three(), false));
  const Scene scene(scratch_ / "a.glb");
  const std::map<std::string, std::size_t> components{{"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}};
  for (std::size_t i = 0; i < scene.root["accessors"].size(); ++i) {
    const auto& a = scene.root["accessors"][i];
    const auto& view = scene.root["bufferViews"][a["bufferView"].get<std::size_t>()];
    EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(),
              scene.numbers.size());
    const auto values = scene.floats(static_cast<int>(i));
    EXPECT_EQ(values.size(), a["count"].get<std::size_t>() * components.at(a["type"]));
    if (a["type"] != "SCALAR") continue;
    EXPECT_EQ(a["min"][0].get<float>(), *std::ranges::min_element(values));
    EXPECT_EQ(a["max"][0].get<float>(), *std::ranges::max_element(values));
  }
}

TEST_F(Glb, RefusesWhatIsEmptyOrThere) {
  EXPECT_THAT(write_glb(scratch_ / "a.glb",
                        data::Trial{.markers = data::Trajectories::all_missing({}, {.rate_hz = 1.0})}, false)
                  .error()
                  .message,
              HasSubstr("no marker or no frame"));
  EXPECT_EQ(write_glb(scratch_ / "a.glb", PoseTree{}, false).error().code, Code::bad_input);
  ASSERT_TRUE(write_text(scratch_ / "a.glb", "mine", false));
  EXPECT_EQ(write_glb(scratch_ / "a.glb", three(), false).error().code, Code::io);
  EXPECT_EQ(read_text(scratch_ / "a.glb").value(), "mine");
  EXPECT_TRUE(write_glb(scratch_ / "a.glb", three(), true));
}

}  // namespace
}  // namespace kinemark::io
