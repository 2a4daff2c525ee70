# follow_joint_trajectory, if control_msgs is installed. Otherwise the tests define the same interface and build the plugin
# for themselves; it is not installed.
function(add_moveit_commands kind)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/moveit/*.cpp)
  add_library(ur_ros_rtde_moveit_commands ${kind} ${sources})
  ur_ros_rtde_commands_settings(ur_ros_rtde_moveit_commands)
  target_link_libraries(ur_ros_rtde_moveit_commands PRIVATE ur_ros_rtde_streaming ${ARGN})
endfunction()

if(control_msgs_FOUND)
  add_moveit_commands(SHARED ${control_msgs_TARGETS})
  ur_ros_rtde_register_plugins(ur_ros_rtde_moveit_commands src/moveit/moveit_commands.xml)
elseif(BUILD_TESTING)
  add_subdirectory(test/control_msgs)
  rosidl_get_typesupport_target(control_msgs_interfaces control_msgs rosidl_typesupport_cpp)
  add_moveit_commands(MODULE ${control_msgs_interfaces})
  # Next to the interface libraries, where the test expects both.
  set_target_properties(ur_ros_rtde_moveit_commands PROPERTIES
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test/control_msgs)
endif()
