# follow_joint_trajectory, where control_msgs is installed. Where it is not, the tests define the same interface, and
# the plugin is built for them alone.
find_package(control_msgs QUIET)

function(ur_ros_rtde_moveit_library kind)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/commands/moveit/*.cpp)
  add_library(ur_ros_rtde_moveit_commands ${kind} ${sources})
  ur_ros_rtde_settings(ur_ros_rtde_moveit_commands)
  target_include_directories(ur_ros_rtde_moveit_commands PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(ur_ros_rtde_moveit_commands PRIVATE ur_ros_rtde_streaming ${ARGN})
endfunction()

if(control_msgs_FOUND)
  ur_ros_rtde_moveit_library(SHARED ${control_msgs_TARGETS})
  ur_ros_rtde_register_plugins(ur_ros_rtde_moveit_commands src/commands/moveit/moveit_commands.xml)
elseif(BUILD_TESTING)
  add_subdirectory(test/control_msgs)
  rosidl_get_typesupport_target(control_msgs_interfaces control_msgs rosidl_typesupport_cpp)
  ur_ros_rtde_moveit_library(MODULE ${control_msgs_interfaces})
  # Where the test finds both.
  set_target_properties(ur_ros_rtde_moveit_commands PROPERTIES
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test/control_msgs)
endif()
