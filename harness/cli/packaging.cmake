# What `cmake --install` and `cpack -G DEB` give users: the program, its files, manual pages and completions.
include(GNUInstallDirs)

# Who publishes a package gives an address of their own: -DSHADOWBENCH_MAINTAINER="NAME <ADDRESS>".
set(SHADOWBENCH_MAINTAINER "The Shadowbench authors <shadowbench@localhost>" CACHE STRING "Maintainer of the Debian package")

# Debian asks for a changelog of its own form.
string(TIMESTAMP _date "%a, %d %b %Y 00:00:00 +0000" UTC)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/changelog @ONLY CONTENT "shadowbench (${PROJECT_VERSION}) stable; urgency=low

  * CHANGELOG.md beside this file says what changed.

 -- ${SHADOWBENCH_MAINTAINER}  ${_date}
")

# Manual pages are made of what the program's --help prints.
find_program(SHADOWBENCH_HELP2MAN help2man REQUIRED)
set(_manual ${PROJECT_BINARY_DIR}/manual)
add_custom_command(
  OUTPUT ${_manual}/written
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${_manual}
  COMMAND ${CMAKE_COMMAND} -E env --unset=SHADOWBENCH_ROOT ASAN_OPTIONS=detect_leaks=0:intercept_tls_get_addr=0
          ${CMAKE_CURRENT_LIST_DIR}/manual.sh $<TARGET_FILE:shadowbench> ${_manual}/pages
  COMMAND gzip -9nc ${PROJECT_BINARY_DIR}/changelog > ${_manual}/changelog.gz
  COMMAND ${CMAKE_COMMAND} -E touch ${_manual}/written
  DEPENDS shadowbench ${CMAKE_CURRENT_LIST_DIR}/manual.sh ${PROJECT_BINARY_DIR}/changelog
  COMMENT "Writing manual pages"
  VERBATIM)
add_custom_target(shadowbench_manual ALL DEPENDS ${_manual}/written)

set(_share ${CMAKE_INSTALL_DATADIR}/shadowbench)
install(TARGETS shadowbench RUNTIME COMPONENT program)
install(TARGETS shadowbench_openimageio LIBRARY DESTINATION lib/shadowbench COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/filters/ DESTINATION ${_share}/filters COMPONENT program FILES_MATCHING PATTERN "*.glsl"
        PATTERN presets.toml)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/shaders/ DESTINATION ${_share}/shaders COMPONENT program PATTERN "*.md" EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/data/ DESTINATION ${_share}/data COMPONENT program PATTERN "*.md" EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/harness/engines/ DESTINATION ${_share}/engines COMPONENT program FILES_MATCHING PATTERN "*.mjs"
        PATTERN "*.js" PATTERN "*.json" PATTERN "*.toml" PATTERN node_modules EXCLUDE)
install(DIRECTORY ${_manual}/pages/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program FILES_MATCHING PATTERN "*.1.gz")
install(PROGRAMS ${PROJECT_SOURCE_DIR}/harness/slurm.sh DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/harness/cli/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME shadowbench
        COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/harness/cli/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions RENAME _shadowbench
        COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${_manual}/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGE_NAME shadowbench)
set(CPACK_PACKAGE_VENDOR "The Shadowbench authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "compares soft-shadow filters: pictures, cost and error of each")
set(CPACK_PACKAGE_DESCRIPTION
    "Shadowbench draws a scene with each of many shadow-map filters, measures what
each costs and how far each is from ray-traced truth, says where the error
comes from, and writes a report of pictures, charts and tables. A filter is one
GLSL file; a file of your own gets all that a built-in one gets. It draws on a
GPU or in software, and its runs can be compared with a baseline on a build
server.")
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
# A package runs on the release that it was made on: its name says which.
cmake_host_system_information(RESULT _release QUERY DISTRIB_INFO)
string(REGEX REPLACE "[^a-z0-9.]" "" _release_name "${_release_ID}${_release_VERSION_ID}")
set(CPACK_DEBIAN_PACKAGE_RELEASE "${_release_name}")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${SHADOWBENCH_MAINTAINER}")
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What the program opens only at run time: the font of its pictures, the drivers behind EGL and GLFW, and OSMesa.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "fonts-dejavu-core, libgl1, libgl1-mesa-dri")
if(SHADOWBENCH_HAS_OSMESA)
  string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", libosmesa6")
endif()
# Costs on GPUs are left out where there is no compiler for them.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libvulkan1, mesa-vulkan-drivers")
# A package lacks a part only where somebody has said so.
get_property(_not_found GLOBAL PROPERTY SHADOWBENCH_NOT_FOUND)
set(_check ${PROJECT_BINARY_DIR}/package_is_complete.cmake)
file(WRITE ${_check} "")
foreach(_part IN LISTS _not_found)
  file(APPEND ${_check} "message(FATAL_ERROR \"The package would lack a part whose libraries were not found: install them, \"
    \"or configure with -DSHADOWBENCH_WITH_${_part}=OFF\")\n")
endforeach()
set(CPACK_PROJECT_CONFIG_FILE ${_check})
include(CPack)
