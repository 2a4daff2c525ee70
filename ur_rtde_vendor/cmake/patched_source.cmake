# patched_source(<archive> <manifest> <patch folder> <out>)
#
# Extracts the files listed in the manifest from the archive, verifies their checksums, applies all *.patch files of the patch
# folder in the order of their names, and returns the folder of the result. The result is updated when the archive, the
# manifest or a patch changes.
#
# The manifest has the format of sha256sum. It lists files instead of the archive because ur_rtde publishes more than one
# archive of a release, and because a hosting service may change how it packs the same files. Other files are not extracted.

function(_extract archive folder out)
  file(MAKE_DIRECTORY "${folder}")
  execute_process(COMMAND "${CMAKE_COMMAND}" -E tar xf "${archive}" WORKING_DIRECTORY "${folder}"
    RESULT_VARIABLE result ERROR_VARIABLE error)
  file(GLOB roots "${folder}/*")
  list(LENGTH roots count)
  if(NOT result EQUAL 0 OR NOT count EQUAL 1)
    file(REMOVE_RECURSE "${folder}")
    message(FATAL_ERROR "${archive} is not an archive with ur_rtde's sources in one folder. Remove it, or set UR_RTDE_ARCHIVE "
      "to the path of another one.\n${error}")
  endif()
  set(${out} "${roots}" PARENT_SCOPE)
endfunction()

function(_reject archive reason)
  message(FATAL_ERROR "${archive}\nis not ur_rtde 1.6.5, or it is damaged: ${reason}\n"
    "Remove it to download it again. If that does not help, use ur_rtde's source archive from the Python registry: "
    "`pip download --no-deps --no-binary ur-rtde ur-rtde==1.6.5`, then build with -DUR_RTDE_ARCHIVE=<path>, or with "
    "UR_RTDE_ARCHIVE=<path> in the environment. `sha256sum --check` with ur_rtde_vendor/sources.sha256 in its unpacked "
    "folder shows the differences.")
endfunction()

function(_copy_verified archive root manifest folder)
  file(STRINGS "${manifest}" lines REGEX "^[0-9a-f]")
  foreach(line IN LISTS lines)
    if(NOT line MATCHES "^([0-9a-f]+)  (.+)$")
      message(FATAL_ERROR "${manifest}: `${line}` does not have the format of sha256sum")
    endif()
    set(expected "${CMAKE_MATCH_1}")
    set(name "${CMAKE_MATCH_2}")
    if(NOT EXISTS "${root}/${name}")
      _reject("${archive}" "it has no ${name}.")
    endif()
    file(SHA256 "${root}/${name}" found)
    if(NOT found STREQUAL expected)
      _reject("${archive}" "the SHA-256 of ${name} is ${found}, expected ${expected}.")
    endif()
    get_filename_component(parent "${folder}/${name}" DIRECTORY)
    file(COPY "${root}/${name}" DESTINATION "${parent}")
  endforeach()
endfunction()

function(_apply_patch patch folder)
  find_package(Git REQUIRED)
  # Inside a repository, git would resolve the paths from the root of that repository.
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

function(patched_source archive manifest patch_folder out)
  file(GLOB patches CONFIGURE_DEPENDS "${patch_folder}/*.patch")
  list(SORT patches)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${manifest}" ${patches})

  # The sources are up to date if the stamp file holds the checksums of all inputs.
  set(state "")
  foreach(file IN ITEMS "${archive}" "${manifest}" ${patches})
    file(SHA256 "${file}" hash)
    string(APPEND state "${hash}\n")
  endforeach()

  set(base "${CMAKE_CURRENT_BINARY_DIR}/source")
  set(stamp "${base}/state.txt")
  set(done "")
  if(EXISTS "${stamp}")
    file(READ "${stamp}" done)
  endif()
  if(NOT done STREQUAL state)
    file(REMOVE_RECURSE "${base}")
    _extract("${archive}" "${base}/archive" root)
    _copy_verified("${archive}" "${root}" "${manifest}" "${base}/ur_rtde")
    file(REMOVE_RECURSE "${base}/archive")
    foreach(patch IN LISTS patches)
      _apply_patch("${patch}" "${base}/ur_rtde")
    endforeach()
    file(WRITE "${stamp}" "${state}")
  endif()
  set(${out} "${base}/ur_rtde" PARENT_SCOPE)
endfunction()
