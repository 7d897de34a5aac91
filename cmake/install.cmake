# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
#
# The door: what `cmake --install` puts where other projects find it, and what find_package(kinemark) gives them.
# docs/decisions/0008-one-door.md tells why it is made like this.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Headers that other projects may include, relative to src/: those of public_headers.txt but version.h, which is made.
# tools/check_public_headers.py holds the list to what the headers include.
function(kinemark_public_headers out)
  set(list ${PROJECT_SOURCE_DIR}/cmake/public_headers.txt)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${list})
  file(STRINGS ${list} headers REGEX "^kinemark/")
  list(TRANSFORM headers REPLACE "[ ]*#.*" "")
  list(REMOVE_ITEM headers kinemark/core/version.h)
  set(${out} ${headers} PARENT_SCOPE)
endfunction()

# Exports the libraries made by kinemark_library() so far: kinemark::NAME for each, kinemark::kinemark for all of them.
function(kinemark_install)
  get_property(components GLOBAL PROPERTY KINEMARK_COMPONENTS)
  kinemark_public_headers(headers)
  foreach(header IN LISTS headers)
    cmake_path(GET header PARENT_PATH folder)
    install(FILES ${PROJECT_SOURCE_DIR}/src/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder})
  endforeach()
  install(FILES ${PROJECT_BINARY_DIR}/src/kinemark/core/include/kinemark/core/version.h
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/kinemark/core)

  if(BUILD_SHARED_LIBS)
    kinemark_shared_library("${components}")
    set(exported kinemark_all)
  else()
    list(TRANSFORM components PREPEND kinemark_ OUTPUT_VARIABLE exported)
  endif()
  install(TARGETS ${exported} EXPORT kinemarkTargets INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

  set(folder ${CMAKE_INSTALL_LIBDIR}/cmake/kinemark)
  install(EXPORT kinemarkTargets NAMESPACE kinemark:: DESTINATION ${folder})
  set(KINEMARK_COMPONENTS ${components})
  set(KINEMARK_WITH_HDF5 OFF)
  if(KINEMARK_NWB AND hdf5_FOUND)
    set(KINEMARK_WITH_HDF5 ON)
  endif()
  set(KINEMARK_WITH_CAIRO OFF)
  if(KINEMARK_PNG AND cairo_FOUND)
    set(KINEMARK_WITH_CAIRO ON)
  endif()
  set(KINEMARK_WITH_COMEDI OFF)
  if(KINEMARK_COMEDI AND comedi_FOUND)
    set(KINEMARK_WITH_COMEDI ON)
  endif()
  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/kinemarkConfig.cmake.in
    ${PROJECT_BINARY_DIR}/kinemarkConfig.cmake INSTALL_DESTINATION ${folder})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/kinemarkConfigVersion.cmake COMPATIBILITY SameMajorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/kinemarkConfig.cmake ${PROJECT_BINARY_DIR}/kinemarkConfigVersion.cmake
          DESTINATION ${folder})
endfunction()

# BUILD_SHARED_LIBS: all components in one libkinemark.so that shows the names of kinemark.map alone.
function(kinemark_shared_library components)
  set(map ${PROJECT_SOURCE_DIR}/cmake/kinemark.map)
  foreach(component IN LISTS components)
    get_target_property(type kinemark_${component} TYPE)
    if(type STREQUAL "STATIC_LIBRARY")
      list(APPEND objects $<TARGET_OBJECTS:kinemark_${component}>)
    endif()
  endforeach()
  add_library(kinemark_all SHARED ${objects})
  find_package(tomlplusplus REQUIRED)
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET libxxhash)
  pkg_check_modules(zlib REQUIRED IMPORTED_TARGET zlib)
  pkg_check_modules(zstd REQUIRED IMPORTED_TARGET libzstd)
  pkg_check_modules(lz4 REQUIRED IMPORTED_TARGET liblz4)
  # What headers need of others is public; the rest stays inside.
  target_link_libraries(kinemark_all PUBLIC Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json tomlplusplus::tomlplusplus
                        PRIVATE TBB::tbb pugixml::pugixml PkgConfig::xxhash PkgConfig::zlib PkgConfig::zstd PkgConfig::lz4)
  if(KINEMARK_NWB AND hdf5_FOUND)
    pkg_check_modules(hdf5 REQUIRED IMPORTED_TARGET hdf5)
    target_link_libraries(kinemark_all PRIVATE PkgConfig::hdf5)
  endif()
  if(KINEMARK_PNG AND cairo_FOUND)
    pkg_check_modules(cairo REQUIRED IMPORTED_TARGET cairo)
    target_link_libraries(kinemark_all PRIVATE PkgConfig::cairo)
  endif()
  if(KINEMARK_COMEDI AND comedi_FOUND)
    pkg_check_modules(comedi REQUIRED IMPORTED_TARGET comedilib)
    target_link_libraries(kinemark_all PRIVATE PkgConfig::comedi)
  endif()
  target_compile_features(kinemark_all PUBLIC cxx_std_23)
  target_link_options(kinemark_all PRIVATE -Wl,--version-script=${map} -Wl,--no-undefined)
  set_target_properties(kinemark_all PROPERTIES OUTPUT_NAME kinemark EXPORT_NAME kinemark LINK_DEPENDS ${map}
                        VERSION ${PROJECT_VERSION} SOVERSION ${KINEMARK_SOVERSION})
endfunction()
