# Fails unless every library in FOLDER exports kolize_plugin and nothing else, as NM sees it.
file(GLOB libraries ${FOLDER}/*.so)
if(NOT libraries)
  message(FATAL_ERROR "no library in ${FOLDER}")
endif()
foreach(library IN LISTS libraries)
  execute_process(COMMAND ${NM} --dynamic --defined-only --format=just-symbols ${library}
    OUTPUT_VARIABLE symbols OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  if(NOT symbols STREQUAL "kolize_plugin")
    message(SEND_ERROR "${library} exports:\n${symbols}")
  endif()
endforeach()
