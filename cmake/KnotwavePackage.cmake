# cpack makes Debian packages of what cmake --install installs: knotwave, the programs and what goes with them,
# knotwave-plugins, and knotwave-dev, to build with the libraries. DebianFiles.cmake adds what Debian wants besides.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME knotwave)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "Knotwave developers <knotwave@example.invalid>")
set(CPACK_COMPONENTS_ALL runtime development)
if(KNOTWAVE_HAVE_CLAP OR KNOTWAVE_HAVE_DPF)
  list(APPEND CPACK_COMPONENTS_ALL plugins)
endif()
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/DebianFiles.cmake)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)

set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has one of its own

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME knotwave)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION sound)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "knotwave-plugins, knotwave-dev")
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "synthesizer whose sounds are NURBS curves
A curve, kept as a few control points in a text file, can be an envelope, an
LFO, one cycle of a waveform, a row of a morphing surface, a crossfade law or
a waveshaper. The programs play such sounds live from MIDI and OSC, render MIDI
files, to the same samples on every machine, and check, draw, edit and fit
curves.")

set(CPACK_DEBIAN_PLUGINS_PACKAGE_NAME knotwave-plugins)
set(CPACK_DEBIAN_PLUGINS_PACKAGE_SECTION sound)
set(CPACK_DEBIAN_PLUGINS_PACKAGE_SUGGESTS knotwave)
set(CPACK_DEBIAN_PLUGINS_PACKAGE_ENHANCES ardour)
set(CPACK_DEBIAN_PLUGINS_DESCRIPTION "NURBS curves as sound, plugins for LV2, CLAP and VST3
A synthesizer whose sounds are NURBS curves, and what else of Knotwave works in
a host, with every patch inside and the same samples as the programs give.")

# The shared library is that of the C interface: none of the programs uses it.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME knotwave-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS knotwave)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "NURBS curves as sound, libraries for C++ and C
Headers and archives of the Knotwave libraries for C++, the shared library of
the curves for C, and what CMake and pkg-config need to find them.")
file(WRITE ${PROJECT_BINARY_DIR}/installed/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/installed/triggers)
# What the archives are linked with.
set(debian_HWY libhwy-dev)
set(debian_SNDFILE libsndfile1-dev)
set(debian_PORTAUDIO portaudio19-dev)
set(debian_JACK libjack-jackd2-dev)
set(debian_RTMIDI librtmidi-dev)
set(debian_LIBLO liblo-dev)
set(KNOTWAVE_HAVE_HWY TRUE)
set(needed pkg-config)
foreach(part HWY SNDFILE PORTAUDIO JACK RTMIDI LIBLO)
  if(KNOTWAVE_HAVE_${part})
    list(APPEND needed ${debian_${part}})
  endif()
endforeach()
list(JOIN needed ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
include(CPack)
