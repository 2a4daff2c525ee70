# A source file that each plugin library contains. Installed beside this file.
set(UR_ROS_RTDE_PLUGIN_ABI "${CMAKE_CURRENT_LIST_DIR}/plugin_abi.cpp")

# ur_ros_rtde_register_plugins(<target> <plugins.xml>)
#
# Makes the plugins of the shared library <target> known to the servers of ur_ros_rtde: installs the library into lib,
# and <plugins.xml> with an entry in the ament index. The installed files and the entry are those of
# pluginlib_export_plugin_description_file(ur_ros_rtde <plugins.xml>); pluginlib itself is not needed.
# Call it once for each library, before ament_package(). The file names of the descriptions must differ.
function(ur_ros_rtde_register_plugins target description)
  if(NOT TARGET ${target})
    message(FATAL_ERROR "ur_ros_rtde_register_plugins: there is no target ${target}")
  endif()
  get_filename_component(name "${description}" NAME)
  if(NOT EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/${description}")
    message(FATAL_ERROR "ur_ros_rtde_register_plugins: there is no file ${CMAKE_CURRENT_SOURCE_DIR}/${description}")
  endif()
  target_sources(${target} PRIVATE "${UR_ROS_RTDE_PLUGIN_ABI}")
  install(TARGETS ${target} LIBRARY DESTINATION lib ARCHIVE DESTINATION lib RUNTIME DESTINATION bin)
  install(FILES "${description}" DESTINATION share/${PROJECT_NAME})

  get_property(first DIRECTORY PROPERTY UR_ROS_RTDE_FIRST_PLUGINS)
  if(NOT first)
    set(first ${target})
    set_property(DIRECTORY PROPERTY UR_ROS_RTDE_FIRST_PLUGINS ${target})
    # Evaluated after all calls.
    ament_index_register_resource(ur_ros_rtde__pluginlib__plugin
      CONTENT "$<JOIN:$<TARGET_PROPERTY:${target},UR_ROS_RTDE_DESCRIPTIONS>,\n>\n")
  endif()
  set_property(TARGET ${first} APPEND PROPERTY UR_ROS_RTDE_DESCRIPTIONS "share/${PROJECT_NAME}/${name}")
endfunction()
