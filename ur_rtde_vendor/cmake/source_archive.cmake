# source_archive(<url> <out>)
#
# Returns the path of the archive with ur_rtde's sources: that of the CMake or environment variable UR_RTDE_ARCHIVE if it is
# set, otherwise that of a file which is downloaded to the build folder once. patched_source() verifies the contents.

function(_download url archive)
  set(part "${archive}.part")
  foreach(pause IN ITEMS 0 2 4)
    execute_process(COMMAND "${CMAKE_COMMAND}" -E sleep ${pause})
    message(STATUS "Downloading ${url}")
    file(DOWNLOAD "${url}" "${part}" STATUS result TLS_VERIFY ON INACTIVITY_TIMEOUT 30 TIMEOUT 300)
    list(GET result 0 code)
    if(code EQUAL 0)
      file(RENAME "${part}" "${archive}")
      return()
    endif()
    file(REMOVE "${part}")
  endforeach()
  list(GET result 1 reason)
  message(FATAL_ERROR "ur_rtde's sources cannot be downloaded from\n  ${url}\n${reason}.\n"
    "Download this archive on another machine, or ur_rtde's source archive from the Python registry "
    "(`pip download --no-deps --no-binary ur-rtde ur-rtde==1.6.5`), and build again with -DUR_RTDE_ARCHIVE=<path>, or with "
    "UR_RTDE_ARCHIVE=<path> in the environment.")
endfunction()

function(source_archive url out)
  if(NOT UR_RTDE_ARCHIVE)
    set(UR_RTDE_ARCHIVE "$ENV{UR_RTDE_ARCHIVE}")
  endif()
  if(UR_RTDE_ARCHIVE)
    if(NOT EXISTS "${UR_RTDE_ARCHIVE}" OR IS_DIRECTORY "${UR_RTDE_ARCHIVE}" OR NOT IS_ABSOLUTE "${UR_RTDE_ARCHIVE}")
      message(FATAL_ERROR "UR_RTDE_ARCHIVE must be the absolute path of an archive with ur_rtde's sources, it is "
        "`${UR_RTDE_ARCHIVE}`, and there is no such file.")
    endif()
    set(${out} "${UR_RTDE_ARCHIVE}" PARENT_SCOPE)
    return()
  endif()
  get_filename_component(name "${url}" NAME)
  set(archive "${CMAKE_CURRENT_BINARY_DIR}/download/${name}")
  if(NOT EXISTS "${archive}")
    _download("${url}" "${archive}")
  endif()
  set(${out} "${archive}" PARENT_SCOPE)
endfunction()
