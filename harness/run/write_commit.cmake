# Writes the commit into a header, at every build, but touches the file only when it changes. Sources that differ from
# the commit are named after it: what another state of them measured is not taken for this one's.
execute_process(COMMAND git -C ${SOURCE_DIR} describe --always --abbrev=12 --dirty=+
                OUTPUT_VARIABLE _commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE _failed)
if(_commit MATCHES "\\+$")
  execute_process(COMMAND git -C ${SOURCE_DIR} diff HEAD -- . ":!*.md" ":!tests" COMMAND git hash-object --stdin
                  OUTPUT_VARIABLE _changes OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  string(SUBSTRING "${_changes}" 0 12 _changes)
  string(APPEND _commit "${_changes}")
endif()
if(_failed OR _commit STREQUAL "")
  set(_commit "unknown")
endif()
set(_text "#define SHADOWBENCH_COMMIT \"${_commit}\"\n")
set(_old "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} _old)
endif()
if(NOT _old STREQUAL _text)
  file(WRITE ${OUTPUT} "${_text}")
endif()
