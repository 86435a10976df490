# Each tutorial program is run as its first lines say, and its exit code and words are checked.
set(curves ${PROJECT_SOURCE_DIR}/examples/curves)
function(tutorial_test name code text program)
  add_test(NAME tutorial.${name} COMMAND ${CMAKE_COMMAND} "-DWORDS=$<TARGET_FILE:${program}>;${ARGN}"
    -DCODE=${code} "-DTEXT=${text}" -P ${CMAKE_CURRENT_SOURCE_DIR}/expect.cmake)
  set_tests_properties(tutorial.${name} PROPERTIES LABELS apps TIMEOUT 60)
endfunction()
tutorial_test(01 0 "1\\.0000 +0\\.001000 +-60\\.00" 01_read_a_curve ${curves}/decay.toml)
tutorial_test(02 0 "tutorial_02.wav: 2 s of 440 Hz"
  02_hear_it_as_an_envelope ${curves}/decay.toml tutorial_02.wav)
tutorial_test(03 0 "24 levels, the richest has 375 harmonics.*tutorial_03.wav: 55 Hz to 3520 Hz"
  03_hear_it_as_a_wave ${curves}/waves.toml tutorial_03.wav)
tutorial_test(04 0 "tutorial_04.wav: 3 notes" 04_write_a_patch tutorial_04.wav)
if(TARGET 05_in_your_own_callback)
  # ALSA's null device takes the sound and lets nobody hear it. Systems without ALSA play it.
  set(null_device ${CMAKE_CURRENT_BINARY_DIR}/null_device.conf)
  file(WRITE ${null_device} "pcm.!default { type null }\nctl.!default { type null }\n")
  tutorial_test(05 0 "no sound device here|playing for five seconds"
    05_in_your_own_callback ${curves}/decay.toml)
  tutorial_test(05_without_a_file 1 "none.toml: error: no such file" 05_in_your_own_callback none.toml)
  set_tests_properties(tutorial.05 PROPERTIES
    ENVIRONMENT "ALSA_CONFIG_PATH=${null_device};JACK_NO_START_SERVER=1")
endif()
