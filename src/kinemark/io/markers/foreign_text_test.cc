// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/markers/foreign_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::io {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(ForeignText, IsKnownByItsWords) {
  for (const char* text :
       {"#Kinovea Trajectory data export\n#T X Y\n", "Time (ms);Trajectory 1/0/X;Trajectory 1/0/Y\n",
        "<?xml version=\"1.0\"?>\n<KinoveaVideoAnalysis>\n"})
    EXPECT_THAT(foreign_text(text), HasSubstr("Kinovea followed in the image of one camera")) << text;
  EXPECT_THAT(foreign_text("<?xml version=\"1.0\"?>\n<mvnx version=\"4\">"), HasSubstr("MVNX file of Xsens"));
  EXPECT_THAT(foreign_text("BioWare Version 5.6.1.0 Export\nDevice:\tA\n"), HasSubstr("export them as C3D"));
  for (const char* text :
       {"Time (s),W,X,Y,Z\n0,1,0,0,0\n", "t,q0,q1,q2,q3\n0 , 1,0,0,0\n", "time;qw;qx;qy;qz\n0,5;1;0;0;0\n",
        "// Start Time: 0\nCounter\tAcc_X\tGyr_X\tQuat_w\tQuat_x\n 2552\t4.3\t0.05\t0.5\t0.7\t\n"})
    EXPECT_THAT(foreign_text(text), HasSubstr("ik --orientations' takes a table")) << text;
  EXPECT_THAT(foreign_text("Counter\tAcc_X\tAcc_Y\tGyr_X\n1\t2\t3\t4\n"),
              HasSubstr("orientations made of them"));
  EXPECT_THAT(foreign_text("X [s],Sensor 1: EMG 1 [V]\n0.0,1e-5\n"), HasSubstr("it holds EMG"));
}

TEST(ForeignText, ArchivesPagesAndPointersAreKnownByHowTheyBegin) {
  EXPECT_THAT(foreign_text("PK\x03\x04\x14"),
              HasSubstr("a workbook of Excel is: unpack it, or save its sheet as CSV"));
  EXPECT_THAT(foreign_text("\x1F\x8B\x08"), HasSubstr("compressed by gzip: unpack it first"));
  EXPECT_THAT(foreign_text("version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12\n"),
              HasSubstr("'git lfs pull' brings that"));
  for (const char* text : {"<!DOCTYPE html>\n<html>", "<html lang=\"en\">"})
    EXPECT_THAT(foreign_text(text), HasSubstr("it is a web page")) << text;
  for (const char* text : {"PK marker,x\n1,2\n", "version 1\n", "<?xml version=\"1.0\"?>\n<Document>"})
    EXPECT_THAT(foreign_text(text), IsEmpty()) << text;
}

TEST(ForeignText, ModelsAndSetupsOfOpenSimAreNoRecordings) {
  EXPECT_THAT(foreign_text("<?xml version=\"1.0\"?>\n<OpenSimDocument Version=\"40000\">\n<Model>"),
              HasSubstr("a model is given by --model"));
}

TEST(ForeignText, OtherTextsAreNotSpokenOf) {
  for (const char* text :
       {"", "time,LASI_X,LASI_Y,LASI_Z\n", "trajectory of a comet\n1,2\n", "w,x,y\n", "accession,number\n",
        "A case, with EMG, and words on Kinovea\n\nThe quaternions w, x, y, z\n", "a,b,c\n1,2,3\n",
        "time,hip,knee\n"})
    EXPECT_THAT(foreign_text(text), IsEmpty()) << text;
}

}  // namespace
}  // namespace kinemark::io
