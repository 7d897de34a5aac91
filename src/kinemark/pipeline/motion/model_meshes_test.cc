// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/model_meshes.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "kinemark/io/file.h"
#include "kinemark/io/mesh/testing/shapes.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/pipeline/motion/internal/motion_page.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;
namespace shapes = io::testing;
using ::testing::HasSubstr;
using ::testing::Not;

/// A body "arm" on a pin, and a massless "cap" on it, with the meshes named.
class ModelMeshFiles : public ::testing::Test {
 protected:
  void write_model(const std::string& arm_meshes, const std::string& cap_meshes = "") {
    const auto body = [](const char* name, double mass, const std::string& meshes) {
      return fmt::format(
          "<Body name=\"{}\"><mass>{}</mass><mass_center>0 -0.1 0</mass_center><attached_geometry>{}"
          "</attached_geometry></Body>",
          name, mass, meshes);
    };
    const std::string joint =
        "<{0} name=\"{1}\"><socket_parent_frame>{2}</socket_parent_frame><socket_child_frame>/bodyset/{3}"
        "</socket_child_frame>{4}</{0}>";
    ASSERT_TRUE(io::write_text(
        osim(),
        fmt::format(
            "<OpenSimDocument Version=\"40000\"><Model name=\"m\"><BodySet name=\"bodyset\"><objects>{}{}"
            "</objects></BodySet><JointSet name=\"jointset\"><objects>{}{}</objects></JointSet></Model>"
            "</OpenSimDocument>",
            body("arm", 2.0, arm_meshes), body("cap", 0.0, cap_meshes),
            fmt::format(fmt::runtime(joint), "PinJoint", "pin", "/ground", "arm",
                        "<coordinates><Coordinate name=\"swing\"/></coordinates>"),
            fmt::format(fmt::runtime(joint), "WeldJoint", "weld", "/bodyset/arm", "cap", "")),
        true));
  }
  static std::string mesh(const std::string& file, const char* scale = "1 1 1") {
    return fmt::format("<Mesh><scale_factors>{}</scale_factors><mesh_file>{}</mesh_file></Mesh>", scale,
                       file);
  }
  void put(const fs::path& file, const data::TriangleMesh& shape) const {
    fs::create_directories((scratch_ / file.string()).parent_path());
    ASSERT_TRUE(io::write_text(scratch_ / file.string(), shapes::vtp_of(shape), true));
  }
  [[nodiscard]] fs::path osim() const { return scratch_ / "m.osim"; }
  [[nodiscard]] ModelMeshes read(const std::vector<fs::path>& folders = {}) const {
    return read_model_meshes(osim(), io::read_osim(osim()).value(), folders);
  }

  testing_support::ScratchFolder scratch_;
};

TEST_F(ModelMeshFiles, AreFoundBesideInGeometryAndInFoldersInThisOrder) {
  write_model(mesh("beside.vtp") + mesh("in_geometry.vtp") + mesh("given.vtp") + mesh("both.vtp"));
  put("beside.vtp", shapes::cube(0.1));
  put("Geometry/in_geometry.vtp", shapes::cube(0.1));
  put("elsewhere/given.vtp", shapes::cube(0.1));
  put("both.vtp", shapes::cube(0.1));
  put("elsewhere/both.vtp", shapes::ellipsoid({0.1, 0.1, 0.1}, 8, 5));
  const auto found = read({scratch_ / "elsewhere"});
  ASSERT_EQ(found.of_body.size(), 1U);
  EXPECT_EQ(found.of_body.at("arm").triangles.size(), 48U) << "four cubes";
  EXPECT_EQ(found.note, "1 body drawn from the model's meshes");
  EXPECT_THAT(found.note, Not(HasSubstr("mesh files")));
  EXPECT_THAT(read().note, HasSubstr("1 of the 4 mesh files that the model names was not found"));
  EXPECT_THAT(read().note, Not(HasSubstr("none of the")));
}

TEST_F(ModelMeshFiles, WithoutAnyTheNoteSaysWhereToPutThem) {
  write_model(mesh("a.vtp") + mesh("b.vtp") + mesh("c.vtp") + mesh("d.vtp") + mesh("e.vtp"));
  const auto none = read();
  EXPECT_TRUE(none.of_body.empty());
  EXPECT_THAT(none.note, HasSubstr("none of the 5 mesh files that the model names was found beside it, in "
                                   "Geometry/ there, or with --geometry FOLDER"));
  write_model(mesh("a.vtp"));
  EXPECT_THAT(read().note, HasSubstr("the mesh file that the model names was not found beside it"));
  write_model("");
  EXPECT_EQ(read().note, "") << "a model that names none";
}

TEST_F(ModelMeshFiles, LettersOfAnotherCaseAndSeparatorsOfAnotherSystemWillDo) {
  write_model(mesh("Bones\\Arm.VTP"));
  put("Geometry/Bones/arm.vtp", shapes::cube(0.1));
  EXPECT_EQ(read().of_body.size(), 1U);
}

TEST_F(ModelMeshFiles, ADamagedFileIsASentenceAndTheBodyKeepsItsPlainShape) {
  write_model(mesh("good.vtp"), mesh("bad.vtp"));
  put("good.vtp", shapes::cube(0.1));
  ASSERT_TRUE(io::write_text(scratch_ / "bad.vtp", "<VTKFile>", true));
  const auto read_both = read();
  EXPECT_EQ(read_both.of_body.size(), 1U);
  EXPECT_FALSE(read_both.of_body.contains("cap"));
  EXPECT_THAT(read_both.note, HasSubstr("bad.vtp: is not XML"));
  EXPECT_THAT(read_both.note, Not(HasSubstr("more files cannot be read)")));
  EXPECT_THAT(read_both.note, Not(HasSubstr("triangles together, more than are read")));
  write_model(mesh("good.vtp") + mesh("bad.vtp"), mesh("worse.vtp") + mesh("worst.vtp"));
  for (const char* file : {"worse.vtp", "worst.vtp"})
    ASSERT_TRUE(io::write_text(scratch_ / file, "<VTKFile>", true));
  EXPECT_THAT(read().note, HasSubstr("bad.vtp: is not XML"));
  EXPECT_THAT(read().note, HasSubstr(" (2 more files cannot be read)"));
}

TEST_F(ModelMeshFiles, AfterTooManyTrianglesNoFurtherFileIsRead) {
  write_model(mesh("a.vtp") + mesh("b.vtp"), mesh("c.vtp"));
  for (const char* file : {"a.vtp", "b.vtp", "c.vtp"}) put(file, shapes::cube(0.1));
  const auto description = io::read_osim(osim()).value();
  const auto two = read_model_meshes(osim(), description, {}, 20);
  EXPECT_EQ(
      two.note,
      "1 body drawn from the model's meshes; c.vtp: the meshes before it have 24 triangles together, more "
      "than are read");
  EXPECT_FALSE(two.of_body.contains("cap"));
  EXPECT_TRUE(read_model_meshes(osim(), description, {}, 24).of_body.contains("cap"));
}

TEST_F(ModelMeshFiles, ScaleAndMirrorKeepTheOutsideOutside) {
  write_model(mesh("a.vtp", "2 1 -1"));
  put("a.vtp", shapes::ellipsoid({0.1, 0.1, 0.2}, 40, 30));
  const auto arm = read().of_body.at("arm");
  EXPECT_NEAR(shapes::volume(arm), 4.0 / 3.0 * std::numbers::pi * 0.2 * 0.1 * 0.2, 2e-4);
}

TEST_F(ModelMeshFiles, TooFineMeshesAreMadeCoarser) {
  write_model(mesh("a.vtp"), mesh("a.vtp"));
  put("a.vtp", shapes::ellipsoid({0.1, 0.1, 0.2}, 120, 90));
  const auto coarse = read();
  const auto triangles =
      coarse.of_body.at("arm").triangles.size() + coarse.of_body.at("cap").triangles.size();
  EXPECT_LE(triangles, 12'000U);
  EXPECT_GE(triangles, 9'000U);
  EXPECT_EQ(
      coarse.note,
      fmt::format("2 bodies drawn from the model's meshes, with {} of their 43200 triangles", triangles));
}

TEST_F(ModelMeshFiles, FoldersThatAreNotThereAreRefused) {
  EXPECT_TRUE(check_geometry({}));
  const auto absent = check_geometry(std::vector<fs::path>{scratch_ / "none"});
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, Code::io);
}

TEST_F(ModelMeshFiles, BodiesTurnWithTheModelAndMasslessOnesWithAMeshAreDrawn) {
  write_model("", mesh("cap.vtp"));
  put("cap.vtp", shapes::cube(0.1));
  const auto description = io::read_osim(osim()).value();
  const auto model = model::Model::compile(description).value();
  data::JointMotion motion;
  motion.coordinates = {"swing"};
  motion.is_rotation = {true};
  motion.time = {.rate_hz = 100.0, .t0_s = 0.0, .frames = 2};
  motion.q.assign(2, 0.0);
  motion.q[1] = std::numbers::pi / 2.0;
  const auto bodies = internal::body_positions(model, motion, read());
  EXPECT_EQ(bodies.names, (std::vector<std::string>{"arm", "cap"}));
  ASSERT_EQ(bodies.meshes.size(), 2U);
  EXPECT_TRUE(bodies.meshes[0].empty());
  EXPECT_EQ(bodies.meshes[1].triangles.size(), 12U);
  ASSERT_EQ(bodies.world_from_body.size(), 16U);
  EXPECT_NEAR(bodies.world_from_body[4], 1.0, 1e-12) << "the cap in the first frame";
  EXPECT_NEAR(std::abs(bodies.world_from_body[12]), std::sqrt(0.5), 1e-12) << "a quarter of a turn";
  EXPECT_NEAR(std::abs(bodies.world_from_body[15]), std::sqrt(0.5), 1e-12) << "about z";
  EXPECT_TRUE(internal::body_positions(model, motion).meshes.empty());
}

}  // namespace
}  // namespace kinemark::pipeline
