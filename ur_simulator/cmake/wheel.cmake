# The Python wheel (pyproject.toml) contains the program alone. It needs no library of the build machine except the
# C library and tinyxml2, which has no static library on Debian and which auditwheel adds for other machines: fmt is
# compiled in, yaml-cpp and the C++ library are linked statically.
set(BUILD_TESTING OFF)
set(wheel_program_folder ${SKBUILD_PLATLIB_DIR}/ur_simulator/bin)
set(UR_SIMULATOR_PROGRAM "" CACHE FILEPATH "Program to package instead of building one: for tests of the wheel")
if(UR_SIMULATOR_PROGRAM)
  add_custom_target(ur_simulator_app)
  install(PROGRAMS ${UR_SIMULATOR_PROGRAM} DESTINATION ${wheel_program_folder} COMPONENT wheel)
  return()
endif()

set(fmt_library fmt::fmt-header-only)
find_library(UR_SIMULATOR_YAML_LIBRARY libyaml-cpp.a REQUIRED)
set(yaml_library ${UR_SIMULATOR_YAML_LIBRARY})
# Without unused sections and with a shared libgcc, which every Linux has, the program needs glibc 2.34, not that
# of the build machine. A section is used if a shared library could refer to it: the program exports nothing.
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/no_exports.map "{ local: *; };\n")
add_link_options(-static-libstdc++ LINKER:--gc-sections LINKER:--strip-all
                 LINKER:--version-script=${CMAKE_CURRENT_BINARY_DIR}/no_exports.map)
