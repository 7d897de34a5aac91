# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
#
# Helpers that make a folder's CMakeLists.txt a list: sources, public links, private links, tests.

# Presets that build everything from nothing (release, ci, asan, tsan) join the sources of a target.
set(CMAKE_UNITY_BUILD_BATCH_SIZE 12)

add_library(kinemark_flags INTERFACE)
target_include_directories(kinemark_flags INTERFACE ${CMAKE_CURRENT_LIST_DIR}/../src)
# Same bits everywhere: no contraction to fused multiply-add, no fast-math, baseline instruction set.
target_compile_options(kinemark_flags INTERFACE -ffp-contract=off)
# Programs name sources by their place in the project, not in the folder of whoever built them.
target_compile_options(kinemark_flags INTERFACE -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
if(KINEMARK_DEVELOPER)
  # Only GCC tells a hidden local from a hidden member, which our constructors have.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    set(kinemark_shadow -Wshadow=local)
  endif()
  target_compile_options(kinemark_flags INTERFACE
    -Wall -Wextra -Wpedantic ${kinemark_shadow} -Wnon-virtual-dtor -Wconversion -Wno-sign-conversion -Wno-missing-field-initializers -Werror)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    # Precompiled, libstdc++'s own use of what it deprecates is no longer seen as the system's.
    target_compile_options(kinemark_flags INTERFACE -Wno-shadow -Wno-deprecated-declarations)
  else()
    # GCC 12 reports uninitialised and out-of-range reads inside Eigen's own expression templates.
    target_compile_options(kinemark_flags INTERFACE -Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread -Wno-restrict)
    # In unity builds every source is included: what is local to it looks shared.
    if(CMAKE_UNITY_BUILD)
      target_compile_options(kinemark_flags INTERFACE -Wno-subobject-linkage)
    endif()
  endif()
elseif(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  # The same that is on without being asked for.
  target_compile_options(kinemark_flags INTERFACE -Wno-deprecated-declarations)
elseif(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Likewise.
  target_compile_options(kinemark_flags INTERFACE -Wno-stringop-overflow -Wno-stringop-overread -Wno-restrict)
  if(CMAKE_UNITY_BUILD)
    target_compile_options(kinemark_flags INTERFACE -Wno-subobject-linkage)
  endif()
endif()
# What a compiler and linker can do against a file made to hurt: checked reads of containers, guarded stacks, indirect jumps
# only to where functions begin, addresses settled and sealed before the program starts (tools/check_hardened reads them
# back from the program). Sanitizers see more, and do not go with fortified functions.
option(KINEMARK_HARDENED "Compile with the guards of compiler, linker and standard library" ${PROJECT_IS_TOP_LEVEL})
if(KINEMARK_HARDENED)
  target_compile_definitions(kinemark_flags INTERFACE _GLIBCXX_ASSERTIONS)
  if(NOT KINEMARK_SANITIZE_ADDRESS AND NOT KINEMARK_SANITIZE_THREAD)
    target_compile_options(kinemark_flags INTERFACE -fstack-protector-strong -fstack-clash-protection
      "$<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=2>")
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
      target_compile_options(kinemark_flags INTERFACE -fcf-protection=full)
    endif()
    target_link_options(kinemark_flags INTERFACE -Wl,-z,relro,-z,now,-z,noexecstack)
  endif()
endif()
if(KINEMARK_SANITIZE_ADDRESS)
  target_compile_options(kinemark_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  # Null, misaligned and mistyped reads are looked for where bytes become numbers. Elsewhere these checks stand at every
  # access of Eigen's templates and double the time of the build; a null read ends the program there all the same.
  target_compile_options(kinemark_flags INTERFACE
    $<$<NOT:$<BOOL:$<TARGET_PROPERTY:KINEMARK_READS_BYTES>>>:-fno-sanitize=null,alignment,object-size,vptr,function>)
  target_link_options(kinemark_flags INTERFACE -fsanitize=address,undefined)
endif()
# Sanitized test programs are many and large; lld links them.
if((KINEMARK_SANITIZE_ADDRESS OR KINEMARK_SANITIZE_THREAD) AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  include(CheckLinkerFlag)
  check_linker_flag(CXX -fuse-ld=lld KINEMARK_LLD)
  if(KINEMARK_LLD)
    target_link_options(kinemark_flags INTERFACE -fuse-ld=lld)
  endif()
endif()
if(KINEMARK_SANITIZE_ADDRESS OR KINEMARK_SANITIZE_THREAD)
  # Eigen unrolls its loops by templates, each step of which sanitizers then watch: half of clang's time.
  target_compile_definitions(kinemark_flags INTERFACE EIGEN_UNROLLING_LIMIT=8)
endif()
if(KINEMARK_SANITIZE_THREAD)
  target_compile_options(kinemark_flags INTERFACE -fsanitize=thread)
  target_compile_definitions(kinemark_flags INTERFACE KINEMARK_SANITIZE_THREAD)
  add_custom_target(threads)  # the tests that run several threads
  target_link_options(kinemark_flags INTERFACE -fsanitize=thread)
endif()

# Names stay inside the library that holds them, unless all are to be one shared library: then cmake/kinemark.map says
# what it shows. An interface may break with every minor version before 1.0.
option(BUILD_SHARED_LIBS "Make one libkinemark.so; else a static library for each component" OFF)
if(BUILD_SHARED_LIBS)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
else()
  set(CMAKE_CXX_VISIBILITY_PRESET hidden)
endif()
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(KINEMARK_SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})

# Precompiled headers: what nearly every file reads, parsed once for the library and once for tests and programs.
# Off where files must stand on their own includes (clang-tidy), and where there is nothing to gain.
option(KINEMARK_PRECOMPILED "Precompile the headers that nearly every file reads" ${PROJECT_IS_TOP_LEVEL})
# kinemark_precompile(target [set]): what is precompiled with the options of the target; kinemark_headers if none is named.
function(kinemark_precompile target)
  set(set kinemark_headers)
  if(ARGC GREATER 1 AND TARGET ${ARGV1})
    set(set ${ARGV1})
  endif()
  if(KINEMARK_PRECOMPILED AND NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
    target_precompile_headers(${target} REUSE_FROM ${set})
  endif()
endfunction()

# Options of the libraries that fuzzers are led by: what they reach in there is counted.
set(KINEMARK_FUZZED_OPTIONS)
if(KINEMARK_FUZZ)
  set(KINEMARK_FUZZED_OPTIONS -fsanitize=fuzzer-no-link)
endif()

# Where sanitizers watch, code that takes no time when it runs is not optimised: that takes most of the time of its build.
set(KINEMARK_PLAIN_OPTIONS)
if(KINEMARK_SANITIZE_ADDRESS)
  set(KINEMARK_PLAIN_OPTIONS -O0)
endif()

# kinemark_apart(a.cc ...): files that unity builds (CMAKE_UNITY_BUILD) leave alone, as their local names are another file's too.
function(kinemark_apart)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# kinemark_library(name SOURCES a.cc ... PUBLIC links... PRIVATE links... [FUZZED] [PLAIN])  -> target kinemark::name
# FUZZED: fuzzers are led by what they reach in it, as in all readers. PLAIN: little to run, much to compile; not optimised
# in the sanitized build.
function(kinemark_library name)
  cmake_parse_arguments(ARG "FUZZED;PLAIN" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  if(ARG_SOURCES)
    add_library(kinemark_${name} STATIC ${ARG_SOURCES})
    target_link_libraries(kinemark_${name} PUBLIC $<BUILD_INTERFACE:kinemark_flags> ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
    target_compile_features(kinemark_${name} PUBLIC cxx_std_23)
    if(name MATCHES "^(core|data|io|stream)(_|$)")
      set_target_properties(kinemark_${name} PROPERTIES KINEMARK_READS_BYTES ON)
      set(ARG_FUZZED ON)
    endif()
    if(ARG_FUZZED)
      target_compile_options(kinemark_${name} PRIVATE ${KINEMARK_FUZZED_OPTIONS})
      kinemark_precompile(kinemark_${name} kinemark_fuzzed_headers)
    elseif(ARG_PLAIN)
      target_compile_options(kinemark_${name} PRIVATE ${KINEMARK_PLAIN_OPTIONS})
      kinemark_precompile(kinemark_${name} kinemark_plain_headers)
    else()
      kinemark_precompile(kinemark_${name})
    endif()
  else()
    add_library(kinemark_${name} INTERFACE)
    target_link_libraries(kinemark_${name} INTERFACE $<BUILD_INTERFACE:kinemark_flags> ${ARG_PUBLIC})
  endif()
  add_library(kinemark::${name} ALIAS kinemark_${name})
  set_target_properties(kinemark_${name} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY KINEMARK_COMPONENTS ${name})
endfunction()

# kinemark_tests(name SOURCES a_test.cc ... LINK links... THREADS b_test.cc ... LABELS ... [UNSANITIZED] [ACCEPTANCE] [LONG])
# -> program test_name, ctest -R name. UNSANITIZED: left out where addresses are watched, as are tests whose name ends in
# "TakesLong"; KINEMARK_UNIT_TESTS=OFF leaves out all others but ACCEPTANCE, whose figures are rows of that table. LONG:
# optimised like the library where KINEMARK_TEST_OPTIONS says that tests are not. THREADS: the sources, with what they need,
# of tests that run several threads: those with "Thread" or "thread" in their name, and nothing else, are what the thread
# sanitizer's build makes and runs (target threads).
function(kinemark_tests name)
  if(NOT KINEMARK_DEVELOPER)
    return()
  endif()
  cmake_parse_arguments(ARG "UNSANITIZED;LONG;ACCEPTANCE" "" "SOURCES;THREADS;LINK;LABELS" ${ARGN})
  if(ARG_UNSANITIZED AND KINEMARK_SANITIZE_ADDRESS)
    return()
  endif()
  if(NOT KINEMARK_UNIT_TESTS AND NOT ARG_UNSANITIZED AND NOT ARG_ACCEPTANCE)
    return()
  endif()
  if(KINEMARK_SANITIZE_THREAD)
    if(NOT ARG_THREADS)
      return()
    endif()
    add_dependencies(threads test_${name})
    set(ARG_SOURCES)
    set(only --gtest_filter=*Thread*:*thread*)
  elseif(KINEMARK_SANITIZE_ADDRESS)
    set(only --gtest_filter=-*TakesLong)
  endif()
  add_executable(test_${name} ${ARG_SOURCES} ${ARG_THREADS})
  target_link_libraries(test_${name} PRIVATE kinemark_flags kinemark::testing ${ARG_LINK} GTest::gmock GTest::gtest GTest::gtest_main)
  if(NOT ARG_LONG)
    target_compile_options(test_${name} PRIVATE ${KINEMARK_TEST_OPTIONS})
    kinemark_precompile(test_${name} kinemark_test_headers)
  elseif(KINEMARK_TEST_OPTIONS)
    kinemark_precompile(test_${name})  # the tests' headers are made with those options
  else()
    kinemark_precompile(test_${name} kinemark_test_headers)
  endif()
  if(ARG_THREADS)
    list(APPEND ARG_LABELS threads)
  endif()
  add_test(NAME ${name} COMMAND test_${name} ${only} WORKING_DIRECTORY ${CMAKE_BINARY_DIR})
  set_tests_properties(${name} PROPERTIES TIMEOUT 600 LABELS "unit;${ARG_LABELS}"
    ENVIRONMENT "KINEMARK_TEST_DATA=$ENV{KINEMARK_TEST_DATA}")
endfunction()

# kinemark_benchmark(name SOURCES a_benchmark.cc ... LINK links...)  -> program bench_name
function(kinemark_benchmark name)
  if(NOT KINEMARK_DEVELOPER OR NOT KINEMARK_BENCHMARKS OR KINEMARK_SANITIZE_ADDRESS OR KINEMARK_SANITIZE_THREAD)
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

# A set of precompiled headers: what a library reads, made with these options.
function(kinemark_header_set name)
  set(empty ${CMAKE_CURRENT_BINARY_DIR}/precompiled.cc)
  file(CONFIGURE OUTPUT ${empty} CONTENT "namespace kinemark {}\n")
  add_library(${name} OBJECT ${empty})
  target_compile_options(${name} PRIVATE ${ARGN})
  target_link_libraries(${name} PUBLIC kinemark_flags Eigen3::Eigen fmt::fmt)
endfunction()

# The sets of precompiled headers, one for each set of options; after the packages are found.
function(kinemark_precompiled_headers)
  if(NOT KINEMARK_PRECOMPILED)
    return()
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(kinemark_flags INTERFACE -fpch-preprocess)  # so that ccache can tell what a file depends on
  else()
    target_compile_options(kinemark_flags INTERFACE -Xclang -fno-pch-timestamp)
  endif()
  set(headers ${PROJECT_SOURCE_DIR}/cmake/precompiled.h)
  kinemark_header_set(kinemark_headers)
  target_precompile_headers(kinemark_headers PRIVATE ${headers})
  if(KINEMARK_FUZZED_OPTIONS)
    kinemark_header_set(kinemark_fuzzed_headers ${KINEMARK_FUZZED_OPTIONS})
    target_precompile_headers(kinemark_fuzzed_headers PRIVATE ${headers})
  endif()
  if(KINEMARK_PLAIN_OPTIONS)
    kinemark_header_set(kinemark_plain_headers ${KINEMARK_PLAIN_OPTIONS})
    target_precompile_headers(kinemark_plain_headers PRIVATE ${headers})
  endif()
  if(KINEMARK_DEVELOPER)
    kinemark_header_set(kinemark_test_headers ${KINEMARK_TEST_OPTIONS})
    target_link_libraries(kinemark_test_headers PUBLIC GTest::gmock GTest::gtest)
    target_precompile_headers(kinemark_test_headers PRIVATE ${PROJECT_SOURCE_DIR}/cmake/precompiled_tests.h)
  endif()
endfunction()
