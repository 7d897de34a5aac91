# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
#
# Helpers that make a folder's CMakeLists.txt a list: sources, public links, private links, tests.

add_library(kinemark_flags INTERFACE)
target_include_directories(kinemark_flags INTERFACE ${CMAKE_CURRENT_LIST_DIR}/../src)
# Same bits everywhere: no contraction to fused multiply-add, no fast-math, baseline instruction set.
target_compile_options(kinemark_flags INTERFACE -ffp-contract=off)
if(KINEMARK_DEVELOPER)
  # Only GCC tells a hidden local from a hidden member, which our constructors have.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    set(kinemark_shadow -Wshadow=local)
  endif()
  target_compile_options(kinemark_flags INTERFACE
    -Wall -Wextra -Wpedantic ${kinemark_shadow} -Wnon-virtual-dtor -Wconversion -Wno-sign-conversion -Wno-missing-field-initializers -Werror)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    target_compile_options(kinemark_flags INTERFACE -Wno-shadow)
  else()
    # GCC 12 reports uninitialised and out-of-range reads inside Eigen's own expression templates.
    target_compile_options(kinemark_flags INTERFACE -Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow -Wno-restrict)
  endif()
endif()
if(KINEMARK_SANITIZE_ADDRESS)
  target_compile_options(kinemark_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(kinemark_flags INTERFACE -fsanitize=address,undefined)
endif()
if(KINEMARK_SANITIZE_THREAD)
  target_compile_options(kinemark_flags INTERFACE -fsanitize=thread)
  target_link_options(kinemark_flags INTERFACE -fsanitize=thread)
endif()
if(KINEMARK_FUZZ)
  target_compile_options(kinemark_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()

# kinemark_library(name SOURCES a.cc ... PUBLIC links... PRIVATE links...)  -> target kinemark::name
function(kinemark_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  if(ARG_SOURCES)
    add_library(kinemark_${name} STATIC ${ARG_SOURCES})
    target_link_libraries(kinemark_${name} PUBLIC kinemark_flags ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  else()
    add_library(kinemark_${name} INTERFACE)
    target_link_libraries(kinemark_${name} INTERFACE kinemark_flags ${ARG_PUBLIC})
  endif()
  add_library(kinemark::${name} ALIAS kinemark_${name})
endfunction()

# kinemark_tests(name SOURCES a_test.cc ... LINK links... LABELS ... [UNSANITIZED])  -> program test_name, ctest -R name
# UNSANITIZED: left out where addresses are watched.
function(kinemark_tests name)
  if(NOT KINEMARK_DEVELOPER)
    return()
  endif()
  cmake_parse_arguments(ARG "UNSANITIZED" "" "SOURCES;LINK;LABELS" ${ARGN})
  if(ARG_UNSANITIZED AND KINEMARK_SANITIZE_ADDRESS)
    return()
  endif()
  add_executable(test_${name} ${ARG_SOURCES})
  target_link_libraries(test_${name} PRIVATE kinemark_flags kinemark::testing ${ARG_LINK} GTest::gmock GTest::gtest GTest::gtest_main)
  add_test(NAME ${name} COMMAND test_${name} WORKING_DIRECTORY ${CMAKE_BINARY_DIR})
  set_tests_properties(${name} PROPERTIES TIMEOUT 600 LABELS "unit;${ARG_LABELS}"
    ENVIRONMENT "KINEMARK_TEST_DATA=$ENV{KINEMARK_TEST_DATA}")
endfunction()

# kinemark_benchmark(name SOURCES a_benchmark.cc ... LINK links...)  -> program bench_name
function(kinemark_benchmark name)
  if(NOT KINEMARK_DEVELOPER OR KINEMARK_SANITIZE_ADDRESS OR KINEMARK_SANITIZE_THREAD)
    return()  # timings under sanitizers mean nothing
  endif()
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(bench_${name} ${ARG_SOURCES})
  target_link_libraries(bench_${name} PRIVATE kinemark_flags kinemark::testing ${ARG_LINK} benchmark::benchmark benchmark::benchmark_main)
endfunction()

# kinemark_fuzzer(name SOURCES x_fuzz.cc LINK links...)  -> program fuzz_name (KINEMARK_FUZZ only)
function(kinemark_fuzzer name)
  if(NOT KINEMARK_FUZZ)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(fuzz_${name} ${ARG_SOURCES})
  target_link_libraries(fuzz_${name} PRIVATE kinemark_flags ${ARG_LINK})
  target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
endfunction()
