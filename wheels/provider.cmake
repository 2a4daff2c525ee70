# Adapts a build to the ROS 2 wheels; an installed ROS 2 does not need it. Every package is configured with
# -DCMAKE_PROJECT_TOP_LEVEL_INCLUDES=<this file>; the packages themselves do not refer to it. Requires CMake >= 3.24.
#
# The CMake or environment variable ROS_WHEELS_PREFIX is the prefix of the wheels, their virtual environment.

if(NOT ROS_WHEELS_PREFIX)
  set(ROS_WHEELS_PREFIX "$ENV{ROS_WHEELS_PREFIX}")
endif()
if(NOT EXISTS "${ROS_WHEELS_PREFIX}/share/rcl/cmake/rclConfig.cmake")
  message(FATAL_ERROR "ROS_WHEELS_PREFIX is `${ROS_WHEELS_PREFIX}`: it must be the virtual environment with the ROS 2 wheels")
endif()
set(ROS_WHEELS_PREFIX "${ROS_WHEELS_PREFIX}" CACHE PATH "Virtual environment with the ROS 2 wheels")
file(STRINGS "${ROS_WHEELS_PREFIX}/share/rcl/cmake/rclConfig-version.cmake" _ros_wheels_rcl_version REGEX "PACKAGE_VERSION \"")
string(REGEX MATCH "[0-9.]+" _ros_wheels_rcl_version "${_ros_wheels_rcl_version}")

# --- 1. Imported targets with paths of the machine on which the wheels were built -----------------------------------

function(_ros_wheels_without target)
  get_target_property(libraries ${target} INTERFACE_LINK_LIBRARIES)
  if(libraries)
    list(REMOVE_ITEM libraries ${ARGN})
    set_target_properties(${target} PROPERTIES INTERFACE_LINK_LIBRARIES "${libraries}")
  endif()
endfunction()

function(_ros_wheels_repair_targets)
  get_property(targets DIRECTORY PROPERTY IMPORTED_TARGETS)
  foreach(target IN LISTS targets)
    if(target MATCHES "__rosidl_generator_py$")
      # Include folders of Python and numpy on that machine.
      set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "")
    elseif(target MATCHES "^fast(dds|rtps)$")
      _ros_wheels_without(${target} /usr/lib64/libtinyxml2.so)
    elseif(target STREQUAL "tracetools::tracetools")
      # The wheels bundle lttng-ust under a mangled name, which libtracetools.so refers to.
      _ros_wheels_without(${target} lttng-ust lttng-ust::lttng-ust)
    endif()
  endforeach()
endfunction()

# A macro uses the policies of its definition. CMP0167: use the package file of Boost, as FindBoost is removed.
cmake_policy(PUSH)
if(POLICY CMP0167)
  cmake_policy(SET CMP0167 NEW)
endif()

# A macro, so that the variables that find_package() sets are visible to its caller.
macro(_ros_wheels_find_package _ros_wheels_method _ros_wheels_package)
  find_package(${_ros_wheels_package} ${ARGN} BYPASS_PROVIDER)
  _ros_wheels_repair_targets()
  if(_ros_wheels_rcl_version VERSION_GREATER_EQUAL 10)
    # The only middleware among the wheels is Fast DDS. Since Kilted, rcl_cxx passes it its own type supports, so it does not ask
    # for the introspection type supports for C++, which take a sixth of the time to build interfaces.
    list(FILTER AMENT_EXTENSIONS_rosidl_generate_idl_interfaces EXCLUDE REGEX "rosidl_typesupport_introspection_cpp")
  endif()
endmacro()

cmake_policy(POP)

cmake_language(SET_DEPENDENCY_PROVIDER _ros_wheels_find_package SUPPORTED_METHODS FIND_PACKAGE)

# --- 2. Python's symbols in C++ programs ----------------------------------------------------------------------------
# librcl.so depends on the *__rosidl_generator_py.so, which use symbols of the Python interpreter without linking it. C++
# programs never call them: linking a library that defines these symbols as zeros lets the programs link and load.
# Shared libraries are not linked with it, so that a Python process uses the symbols of the interpreter.

function(_ros_wheels_build_python_symbols library)
  find_program(ROS_WHEELS_NM nm REQUIRED)
  find_program(ROS_WHEELS_CC NAMES $ENV{CC} cc gcc clang REQUIRED)
  file(GLOB users "${ROS_WHEELS_PREFIX}/lib/lib*__rosidl_generator_py.so")
  execute_process(COMMAND "${ROS_WHEELS_NM}" -D --undefined-only ${users}
    OUTPUT_VARIABLE undefined COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "U _?Py[A-Za-z0-9_]+" symbols "${undefined}")
  # Of the interface packages that are built here, if they are compiled without optimization or with a sanitizer.
  list(APPEND symbols "U PyCapsule_GetPointer" "U PyCapsule_Type" "U PyErr_Clear" "U PyErr_ExceptionMatches" "U PyErr_Format"
    "U PyExc_ModuleNotFoundError")
  list(REMOVE_DUPLICATES symbols)
  set(code "")
  foreach(symbol IN LISTS symbols)
    string(REGEX REPLACE "^U (.+)$" "char \\1[64];\n" line "${symbol}")
    string(APPEND code "${line}")
  endforeach()
  file(WRITE "${CMAKE_BINARY_DIR}/ros_wheels/python_symbols.c" "${code}")
  execute_process(
    COMMAND "${ROS_WHEELS_CC}" -shared -fPIC -Wl,-soname,libros_wheels_python_symbols.so
      -o "${CMAKE_BINARY_DIR}/ros_wheels/python_symbols.so" "${CMAKE_BINARY_DIR}/ros_wheels/python_symbols.c"
    COMMAND_ERROR_IS_FATAL ANY)
  # An atomic rename: several packages may be configured at the same time.
  string(RANDOM LENGTH 8 suffix)
  file(COPY_FILE "${CMAKE_BINARY_DIR}/ros_wheels/python_symbols.so" "${library}.${suffix}")
  file(RENAME "${library}.${suffix}" "${library}")
endfunction()

set(_ros_wheels_python_symbols "${ROS_WHEELS_PREFIX}/lib/libros_wheels_python_symbols.so")
if(NOT EXISTS "${_ros_wheels_python_symbols}")
  _ros_wheels_build_python_symbols("${_ros_wheels_python_symbols}")
endif()
set(_ros_wheels_is_program "$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>")
add_link_options(
  "$<${_ros_wheels_is_program}:-Wl,--push-state,--no-as-needed,${_ros_wheels_python_symbols},--pop-state>")

# --- 3. Search paths of the wheels' libraries at link time and run time ------------------------------------------------
# DT_RPATH, unlike RUNPATH, also applies to indirect dependencies and to libraries that are opened at run time. Programs
# then need no environment variable.

file(GLOB _ros_wheels_bundled LIST_DIRECTORIES true "${ROS_WHEELS_PREFIX}/lib/python3.*/site-packages/ros_*.libs")
set(_ros_wheels_folders "${ROS_WHEELS_PREFIX}/lib" ${_ros_wheels_bundled})
add_link_options(-Wl,--disable-new-dtags)
foreach(_ros_wheels_folder IN LISTS _ros_wheels_folders)
  add_link_options("-Wl,-rpath-link,${_ros_wheels_folder}")
endforeach()
set(CMAKE_BUILD_RPATH ${_ros_wheels_folders})
# Programs are installed in lib/<package> and bin, libraries in lib.
set(CMAKE_INSTALL_RPATH "$ORIGIN" "$ORIGIN/.." "$ORIGIN/../lib" ${_ros_wheels_folders})
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
