# The target `coverage`, what the build preset of that name builds: runs tests and prints the line coverage of the folders that decide
# results; fails below 90 %. gcovr 5.2 does not know all that gcov 12 writes, and would end there. Tests that need no context, and of the others those that draw every filter and write reports.
option(SHADOWBENCH_COVERAGE "Add the target `coverage` (preset `coverage`)" OFF)
if(NOT SHADOWBENCH_COVERAGE)
  return()
endif()

find_program(SHADOWBENCH_GCOVR gcovr REQUIRED)
set(_measured filters reference report)
list(TRANSFORM _measured REPLACE "(.+)" "--filter;${PROJECT_SOURCE_DIR}/\\1/" OUTPUT_VARIABLE _filters)
get_property(_programs DIRECTORY PROPERTY BUILDSYSTEM_TARGETS)
list(FILTER _programs INCLUDE REGEX "_test$|^fuzz_")

add_custom_target(coverage
  COMMAND find ${PROJECT_BINARY_DIR} -name "*.gcda" -delete
  COMMAND xvfb-run -a ${CMAKE_CTEST_COMMAND} -j2 --output-on-failure -L cpu
  COMMAND xvfb-run -a ${CMAKE_CTEST_COMMAND} -j2 --output-on-failure -R "harness/render.gl|[.]Regress$|[.]Sweep$"
  COMMAND ${SHADOWBENCH_GCOVR} --root ${PROJECT_SOURCE_DIR} ${_filters} --object-directory ${PROJECT_BINARY_DIR} --exclude-throw-branches
          --gcov-ignore-parse-errors --print-summary --fail-under-line 90 ${PROJECT_BINARY_DIR}
  WORKING_DIRECTORY ${PROJECT_BINARY_DIR}
  DEPENDS ${_programs} shadowbench
  USES_TERMINAL VERBATIM)
