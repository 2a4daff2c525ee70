# fetch_archive(<pin file> <out>): path of the source archive the pin file names, downloaded if need be.
#
# The pin file is a pip requirement file of one line, `name==version --hash=sha256:…`; pip knows where the machine's
# package registry is. The archive is looked for, and kept, in UR_RTDE_DOWNLOAD_DIR (a CMake or environment
# variable; default: `download` in the build folder): put it there by hand on a machine without a network.

function(_archive_matches file sha256 out)
  set(${out} FALSE PARENT_SCOPE)
  if(EXISTS "${file}")
    file(SHA256 "${file}" found)
    if(found STREQUAL sha256)
      set(${out} TRUE PARENT_SCOPE)
    else()
      message(WARNING "${file} is damaged: its sha256 is ${found}, expected ${sha256}. It is downloaded anew.")
      file(REMOVE "${file}")
    endif()
  endif()
endfunction()

function(_download pin_file folder)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  # Only the named package is kept from being a wheel: pip prepares the archive's metadata with build tools, and
  # building those from source too would take minutes.
  set(command "${Python3_EXECUTABLE}" -m pip download --quiet --disable-pip-version-check --no-deps
    --no-binary ur-rtde --require-hashes --requirement "${pin_file}" --dest "${folder}")
  foreach(attempt RANGE 1 3)
    message(STATUS "Downloading the source archive of ur_rtde (attempt ${attempt} of 3)")
    execute_process(COMMAND ${command} RESULT_VARIABLE result ERROR_VARIABLE error OUTPUT_VARIABLE error TIMEOUT 300)
    if(result EQUAL 0)
      return()
    endif()
    math(EXPR pause "${attempt} * 2")
    execute_process(COMMAND "${CMAKE_COMMAND}" -E sleep ${pause})
  endforeach()
  string(REPLACE ";" " " command "${command}")
  message(FATAL_ERROR
    "The source archive of ur_rtde could not be downloaded. The command was\n  ${command}\nand it said\n${error}\n"
    "Is there a network, and does `${Python3_EXECUTABLE} -m pip --version` work (package python3-pip)? "
    "Without a network, put the archive into ${folder} and build again.")
endfunction()

function(fetch_archive pin_file out)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${pin_file}")
  file(STRINGS "${pin_file}" pin REGEX "==")
  if(NOT pin MATCHES "^([a-z-]+)==([0-9.]+) --hash=sha256:([0-9a-f]+)$")
    message(FATAL_ERROR "${pin_file} must hold one line `name==version --hash=sha256:…`, it holds `${pin}`")
  endif()
  set(sha256 "${CMAKE_MATCH_3}")
  string(REPLACE "-" "_" name "${CMAKE_MATCH_1}-${CMAKE_MATCH_2}")
  string(REGEX REPLACE "_([0-9.]+)$" "-\\1" name "${name}")

  if(NOT UR_RTDE_DOWNLOAD_DIR)
    set(UR_RTDE_DOWNLOAD_DIR "$ENV{UR_RTDE_DOWNLOAD_DIR}")
  endif()
  if(NOT UR_RTDE_DOWNLOAD_DIR)
    set(UR_RTDE_DOWNLOAD_DIR "${CMAKE_CURRENT_BINARY_DIR}/download")
  endif()
  set(archive "${UR_RTDE_DOWNLOAD_DIR}/${name}.tar.gz")

  _archive_matches("${archive}" "${sha256}" present)
  if(NOT present)
    _download("${pin_file}" "${UR_RTDE_DOWNLOAD_DIR}")
    _archive_matches("${archive}" "${sha256}" present)
  endif()
  if(NOT present)
    message(FATAL_ERROR "The download of ur_rtde left no ${archive} with the expected checksum ${sha256}")
  endif()
  set(${out} "${archive}" PARENT_SCOPE)
endfunction()
