# cmake -DWORDS="PROGRAM;WORD;..." -DCODE=0 -DTEXT=REGEX -P expect.cmake: the program must end with
# CODE, and what it prints must match TEXT.
execute_process(COMMAND ${WORDS} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE err)
if(NOT code STREQUAL CODE OR NOT "${out}${err}" MATCHES "${TEXT}")
  message(FATAL_ERROR "ended with ${code}, not ${CODE}, or did not print ${TEXT}:\n${out}${err}")
endif()
