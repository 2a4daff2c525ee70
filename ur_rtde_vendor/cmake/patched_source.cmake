# patched_source(<archive> <patch folder> <out>): folder of the unpacked archive with every *.patch applied, in the
# order of their names. It is made anew when the archive or a patch changes, and left alone otherwise.

function(_apply_patch patch folder)
  find_package(Git REQUIRED)
  # git looks for a repository in the folders above, and inside one takes paths from that repository's root.
  get_filename_component(parent "${folder}" DIRECTORY)
  execute_process(
    COMMAND "${CMAKE_COMMAND}" -E env "GIT_CEILING_DIRECTORIES=${parent}" --unset=GIT_DIR --unset=GIT_WORK_TREE
      "${GIT_EXECUTABLE}" apply --whitespace=nowarn "${patch}"
    WORKING_DIRECTORY "${folder}"
    RESULT_VARIABLE result
    ERROR_VARIABLE error)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "The patch ${patch} does not apply to ur_rtde:\n${error}")
  endif()
endfunction()

function(patched_source archive patch_folder out)
  file(GLOB patches CONFIGURE_DEPENDS "${patch_folder}/*.patch")
  list(SORT patches)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${patches})

  file(SHA256 "${archive}" state)
  foreach(patch IN LISTS patches)
    file(SHA256 "${patch}" hash)
    string(APPEND state "\n${hash}")
  endforeach()

  get_filename_component(name "${archive}" NAME)
  string(REGEX REPLACE "\\.tar\\.gz$" "" name "${name}")
  set(base "${CMAKE_CURRENT_BINARY_DIR}/source")
  set(stamp "${base}/state.txt")
  set(done "")
  if(EXISTS "${stamp}")
    file(READ "${stamp}" done)
  endif()
  if(NOT done STREQUAL state)
    file(REMOVE_RECURSE "${base}")
    file(ARCHIVE_EXTRACT INPUT "${archive}" DESTINATION "${base}")
    foreach(patch IN LISTS patches)
      _apply_patch("${patch}" "${base}/${name}")
    endforeach()
    file(WRITE "${stamp}" "${state}")
  endif()
  set(${out} "${base}/${name}" PARENT_SCOPE)
endfunction()
