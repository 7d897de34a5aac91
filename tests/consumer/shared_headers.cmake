# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
# For CMAKE_PROJECT_TOP_LEVEL_INCLUDES: the programs of a project share one precompiled front header, without a word of it in the project.
function(share_headers)
  get_property(programs DIRECTORY PROPERTY BUILDSYSTEM_TARGETS)
  list(POP_FRONT programs first)
  target_compile_options(${first} PRIVATE -Xclang -fno-pch-timestamp)
  target_precompile_headers(${first} PRIVATE <kinemark/kinemark.h>)
  foreach(program IN LISTS programs)
    target_compile_options(${program} PRIVATE -Xclang -fno-pch-timestamp)
    target_precompile_headers(${program} REUSE_FROM ${first})
  endforeach()
endfunction()
cmake_language(DEFER CALL share_headers)
