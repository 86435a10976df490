# cmake --install, in components. plugins: see plugins/CMakeLists.txt. development: find_package(knotwave COMPONENTS ...) and pkg-config for
# every module. runtime, where the programs are built: these, and what goes with them.
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
  install(FILES ${file} DESTINATION ${pkgconfig_dir} COMPONENT development)
endfunction()

get_property(modules GLOBAL PROPERTY KNOTWAVE_MODULES)
foreach(module IN LISTS modules)
  install(TARGETS knotwave_${module} EXPORT knotwave_targets
    ARCHIVE COMPONENT development LIBRARY COMPONENT development FILE_SET HEADERS COMPONENT development)
  knotwave_write_pkgconfig(${module})
endforeach()
install(EXPORT knotwave_targets NAMESPACE knotwave:: DESTINATION ${package_dir}
  COMPONENT development)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/knotwave-config.cmake.in
  ${PROJECT_BINARY_DIR}/knotwave-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/knotwave-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/knotwave-config.cmake
  ${PROJECT_BINARY_DIR}/knotwave-config-version.cmake DESTINATION ${package_dir} COMPONENT development)

# All that the components install.
add_custom_target(installable)
list(TRANSFORM modules PREPEND knotwave_ OUTPUT_VARIABLE libraries)
add_dependencies(installable ${libraries})
if(TARGET plugins)
  add_dependencies(installable plugins)
endif()

get_property(apps GLOBAL PROPERTY KNOTWAVE_APPS)
if(NOT apps)
  return()
endif()
add_custom_target(programs DEPENDS ${apps})
add_dependencies(installable programs)
install(TARGETS ${apps} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)

# knotwave_install(DESTINATION FILES...): below share/, with the programs.
function(knotwave_install destination)
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/)
  install(FILES ${ARGN} DESTINATION ${CMAKE_INSTALL_DATADIR}/${destination} COMPONENT runtime)
endfunction()
foreach(app IN LISTS apps)  # made by tools/program_pages.py
  knotwave_install(man/man1 docs/man/${app}.1)
  knotwave_install(bash-completion/completions completions/bash/${app})
  knotwave_install(zsh/vendor-completions completions/zsh/_${app})
  knotwave_install(fish/vendor_completions.d completions/fish/${app}.fish)
endforeach()
if(knotwave-synth IN_LIST apps)
  knotwave_install(applications apps/desktop/knotwave-synth.desktop)
  knotwave_install(icons/hicolor/scalable/apps apps/desktop/knotwave-synth.svg)
endif()

# The folders stay beside each other: files name one another as ../patches/bell.toml.
set(examples_dir ${CMAKE_INSTALL_DATADIR}/knotwave/examples)
foreach(folder banks calibration curves envelopes musicians patches plugins scores sounds tunings)
  if(EXISTS ${PROJECT_SOURCE_DIR}/examples/${folder})
    install(DIRECTORY examples/${folder} DESTINATION ${examples_dir} COMPONENT runtime FILES_MATCHING
      PATTERN "*.toml" PATTERN "*.mid" PATTERN "*.scl" PATTERN "*.kbm" PATTERN "*.wav" PATTERN "*.flac")
  endif()
endforeach()
install(DIRECTORY examples/tutorial examples/c examples/gallery DESTINATION ${examples_dir}
  COMPONENT development FILES_MATCHING PATTERN "*.cpp" PATTERN "*.c" PATTERN "*.h")

# The pages as they are in the repository, the examples at ../examples of them.
knotwave_install(doc/knotwave README.md CHANGELOG.md LICENSE)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/knotwave COMPONENT runtime FILES_MATCHING
  PATTERN "*.md" PATTERN "*.svg" PATTERN "*.toml" PATTERN man EXCLUDE)
set(link ${PROJECT_BINARY_DIR}/installed/examples)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/installed)
file(CREATE_LINK ../../knotwave/examples ${link} SYMBOLIC)
install(FILES ${link} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/knotwave COMPONENT runtime)

if(PROJECT_IS_TOP_LEVEL)
  include(KnotwavePackage)
endif()
