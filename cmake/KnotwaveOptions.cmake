# What a user may switch, and the flags every target of ours is built with.
set(KNOTWAVE_MODULES all CACHE STRING
  "all, or some of base;curves;dsp;engine;io: what they use comes along, nothing else is built or needed")
set(module_used_by_base "")
set(module_used_by_curves base)
set(module_used_by_dsp base curves)
set(module_used_by_engine base curves dsp)
set(module_used_by_io base)
set(KNOTWAVE_BUILT_MODULES "")
if(KNOTWAVE_MODULES STREQUAL "all")
  set(KNOTWAVE_BUILT_MODULES base curves dsp engine io)
else()
  foreach(module IN LISTS KNOTWAVE_MODULES)
    if(NOT DEFINED module_used_by_${module})
      message(FATAL_ERROR "KNOTWAVE_MODULES: there is no '${module}'; all, or some of base;curves;dsp;engine;io")
    endif()
    list(APPEND KNOTWAVE_BUILT_MODULES ${module} ${module_used_by_${module}})
  endforeach()
  list(REMOVE_DUPLICATES KNOTWAVE_BUILT_MODULES)
endif()
set(whole FALSE)
if(PROJECT_IS_TOP_LEVEL AND KNOTWAVE_MODULES STREQUAL "all")
  set(whole TRUE)
endif()
option(KNOTWAVE_BUILD_TESTS "Build the tests" ${whole})
option(KNOTWAVE_BUILD_APPS "Build the programs" ${whole})
option(KNOTWAVE_BUILD_PLUGINS "Build the plugins" ${whole})
option(KNOTWAVE_BUILD_EXAMPLES "Build the tutorial" ${whole})
option(KNOTWAVE_BUILD_BENCH "Build the benchmarks" OFF)
foreach(part TESTS APPS PLUGINS EXAMPLES BENCH)
  if(KNOTWAVE_BUILD_${part} AND NOT KNOTWAVE_MODULES STREQUAL "all")
    message(FATAL_ERROR "KNOTWAVE_BUILD_${part} needs KNOTWAVE_MODULES=all, not ${KNOTWAVE_MODULES}")
  endif()
endforeach()
option(KNOTWAVE_ASSERTS "Keep KNOTWAVE_ASSERT on" ON)
set(KNOTWAVE_SANITIZE "" CACHE STRING "Value for -fsanitize= (address,undefined or thread)")
option(KNOTWAVE_FUZZ "Build tests/fuzz with libFuzzer (clang)" OFF)
option(KNOTWAVE_RTSAN "Link the real-time sanitizer runtime into the tests" OFF)
foreach(part SNDFILE PORTAUDIO JACK RTMIDI LIBLO PYTHON CLAP DPF)
  set(KNOTWAVE_WITH_${part} AUTO CACHE STRING "AUTO, ON or OFF")
  set_property(CACHE KNOTWAVE_WITH_${part} PROPERTY STRINGS AUTO ON OFF)
endforeach()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_VERIFY_INTERFACE_HEADER_SETS ${PROJECT_IS_TOP_LEVEL})
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()

# Linked PRIVATE by every target of ours.
add_library(knotwave_flags INTERFACE)
target_compile_options(knotwave_flags INTERFACE
  -Wall -Wextra -Wconversion -Wshadow -Wnon-virtual-dtor -Werror
  # A configuration written with designated initialisers names what differs from the defaults.
  -Wno-missing-field-initializers
  # gcc 12 sees overflows in std::vector and std::string that are not there (GCC bugs 105562, 107852).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow -Wno-array-bounds -Wno-restrict -Wno-stringop-overread>
  # The same bits from gcc and clang, at any -O level: see docs/architecture.md, Determinism.
  -ffp-contract=off -fno-fast-math
  # These two change no value: without them gcc turns neither a select nor a sqrt into vector code.
  -fno-trapping-math -fno-math-errno)
if(KNOTWAVE_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(knotwave_flags INTERFACE -Wno-maybe-uninitialized)  # in <regex>: GCC bug 105562
endif()
if(KNOTWAVE_ASSERTS)
  target_compile_definitions(knotwave_flags INTERFACE KNOTWAVE_ASSERTS=1)
endif()
if(KNOTWAVE_SANITIZE)
  target_compile_options(knotwave_flags INTERFACE -fsanitize=${KNOTWAVE_SANITIZE}
    -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${KNOTWAVE_SANITIZE})
endif()
if(KNOTWAVE_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "KNOTWAVE_FUZZ needs clang: cmake --preset fuzz")
  endif()
  target_compile_options(knotwave_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()

# The same for what is written in C.
add_library(knotwave_c_flags INTERFACE)
target_compile_features(knotwave_c_flags INTERFACE c_std_11)
target_compile_options(knotwave_c_flags INTERFACE -pedantic -Wall -Wextra -Wconversion -Wshadow -Wstrict-prototypes -Werror)
