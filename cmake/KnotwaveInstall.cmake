# find_package(knotwave COMPONENTS ...) and pkg-config for every module, the programs, and nothing else.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/knotwave)
set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH pkgconfig_to_prefix /prefix/${pkgconfig_dir} /prefix)
string(REGEX REPLACE "/$" "" pkgconfig_to_prefix "${pkgconfig_to_prefix}")

# What `pkg-config --libs knotwave-MODULE` must name: of an archive, all it uses.
function(knotwave_write_pkgconfig module)
  string(REPLACE _ - name ${module})
  set(requires "")
  set(libs "-L\${libdir} -lknotwave_${module}")
  set(cflags "-I\${includedir} -ffp-contract=off")
  get_target_property(used knotwave_${module} LINK_LIBRARIES)
  get_target_property(type knotwave_${module} TYPE)
  if(type STREQUAL "SHARED_LIBRARY")  # holds all it uses, and its headers no code
    set(used "")
    set(cflags "-I\${includedir}")
  endif()
  foreach(library IN LISTS used)
    if(library MATCHES "^knotwave::(.*)$")
      list(APPEND requires knotwave-${CMAKE_MATCH_1})
    elseif(library MATCHES "^PkgConfig::(.*)$")
      list(APPEND requires ${KNOTWAVE_PKGCONFIG_${CMAKE_MATCH_1}})
    elseif(library STREQUAL "hwy")
      list(APPEND requires libhwy)
    elseif(library STREQUAL "Threads::Threads")
      string(APPEND libs " -pthread")
    endif()
  endforeach()
  list(JOIN requires " " requires)
  set(file ${PROJECT_BINARY_DIR}/pkgconfig/knotwave-${name}.pc)
  file(WRITE ${file}
"prefix=\${pcfiledir}/${pkgconfig_to_prefix}
libdir=\${prefix}/${CMAKE_INSTALL_LIBDIR}
includedir=\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}

Name: knotwave-${name}
Description: ${PROJECT_DESCRIPTION}: ${name}
Version: ${PROJECT_VERSION}
Requires: ${requires}
Libs: ${libs}
Cflags: ${cflags}
")
  install(FILES ${file} DESTINATION ${pkgconfig_dir})
endfunction()

get_property(modules GLOBAL PROPERTY KNOTWAVE_MODULES)
foreach(module IN LISTS modules)
  install(TARGETS knotwave_${module} EXPORT knotwave_targets FILE_SET HEADERS)
  knotwave_write_pkgconfig(${module})
endforeach()
install(EXPORT knotwave_targets NAMESPACE knotwave:: DESTINATION ${package_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/knotwave-config.cmake.in
  ${PROJECT_BINARY_DIR}/knotwave-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/knotwave-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/knotwave-config.cmake
  ${PROJECT_BINARY_DIR}/knotwave-config-version.cmake DESTINATION ${package_dir})

get_property(apps GLOBAL PROPERTY KNOTWAVE_APPS)
if(apps)
  install(TARGETS ${apps} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  add_custom_target(programs DEPENDS ${apps})
endif()
