# Adds the Python tests of the current folder to CTest, one process per file. `./ur test` runs the files itself. Included by the packages
# whose tests use those helpers of the driver's tests that are beside this file.
find_package(ament_cmake_pytest REQUIRED)
file(GLOB_RECURSE files CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} test_*.py)
foreach(file IN LISTS files)
  string(REGEX REPLACE "[/.]" "_" name ${file})
  ament_add_pytest_test(${name} ${file} TIMEOUT 1200 ENV ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST)
endforeach()
