# knotwave_module(NAME SOURCES ... HEADERS ... [PUBLIC ...] [PRIVATE ...])
# One library per module. It shows only its own include folder, so a module that may not see another
# cannot include it. SOURCES are relative to src/, HEADERS to include/knotwave/NAME/.
function(knotwave_module name)
  cmake_parse_arguments(arg "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  list(TRANSFORM arg_SOURCES PREPEND src/)
  list(TRANSFORM arg_HEADERS PREPEND include/knotwave/${name}/)
  add_library(knotwave_${name} STATIC ${arg_SOURCES})
  add_library(knotwave::${name} ALIAS knotwave_${name})
  set_target_properties(knotwave_${name} PROPERTIES EXPORT_NAME ${name})
  target_sources(knotwave_${name} PUBLIC FILE_SET HEADERS BASE_DIRS include FILES ${arg_HEADERS})
  target_compile_features(knotwave_${name} PUBLIC cxx_std_20)
  # Headers hold per-sample code, so a program that includes them needs this flag as well.
  target_compile_options(knotwave_${name} PUBLIC -ffp-contract=off)
  target_link_libraries(knotwave_${name}
    PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:knotwave_flags>)
  set_property(GLOBAL APPEND PROPERTY KNOTWAVE_MODULES ${name})
endfunction()

# knotwave_app(PROGRAM SOURCES ... LIBS ...)
function(knotwave_app name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LIBS} knotwave_flags)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  set_property(GLOBAL APPEND PROPERTY KNOTWAVE_APPS ${name})
endfunction()

# knotwave_test(MODULE [ALONE] SOURCES ... [LIBS ...])
# One test program a module, tests/MODULE/*_test.cpp, each test labelled with the module; suites
# named *Stress are long and labelled stress instead. ALONE: nothing else runs beside them, since a sound
# server lets go of clients that are kept waiting.
function(knotwave_test module)
  cmake_parse_arguments(arg "ALONE" "" "SOURCES;LIBS" ${ARGN})
  add_executable(test_${module} ${arg_SOURCES})
  target_link_libraries(test_${module} PRIVATE
    ${arg_LIBS} knotwave_test_support GTest::gmock GTest::gtest_main knotwave_flags)
  # Only a source that names a folder is told it, so that the objects of the others are the same in
  # every checkout and ccache finds them.
  foreach(source IN LISTS arg_SOURCES)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
    file(STRINGS ${source} uses_folder REGEX "KNOTWAVE_(SOURCE|BIN)_DIR")
    if(uses_folder)
      set_source_files_properties(${source} PROPERTIES COMPILE_DEFINITIONS
        "KNOTWAVE_SOURCE_DIR=\"${PROJECT_SOURCE_DIR}\";KNOTWAVE_BIN_DIR=\"${PROJECT_BINARY_DIR}/bin\"")
    endif()
  endforeach()
  gtest_discover_tests(test_${module} TEST_FILTER "-*Stress.*"
    PROPERTIES LABELS ${module} TIMEOUT 300 RUN_SERIAL ${arg_ALONE} DISCOVERY_TIMEOUT 60)
  gtest_discover_tests(test_${module} TEST_FILTER "*Stress.*" TEST_LIST test_${module}_STRESS
    PROPERTIES LABELS stress TIMEOUT 3600 DISCOVERY_TIMEOUT 60)
endfunction()

# knotwave_bench(FILE LIBS ...): bench/FILE.cpp as the program bench/FILE (Google Benchmark).
function(knotwave_bench name)
  cmake_parse_arguments(arg "" "" "LIBS" ${ARGN})
  add_executable(${name} ${name}.cpp)
  target_link_libraries(${name} PRIVATE ${arg_LIBS} benchmark::benchmark_main knotwave_flags)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bench)
  if(NOT TARGET benchmarks)
    add_custom_target(benchmarks)
  endif()
  add_dependencies(benchmarks ${name})
endfunction()
