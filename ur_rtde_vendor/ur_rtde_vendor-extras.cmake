# Included by find_package(ur_rtde_vendor), before the target ur_rtde::rtde is imported.

# Dependencies of the target.
find_package(Boost REQUIRED COMPONENTS thread)
find_package(Threads REQUIRED)

# If another ur_rtde has defined the target before, CMake would link that library without a message.
if(TARGET ur_rtde::rtde)
  get_target_property(_ur_rtde_vendor_target ur_rtde::rtde UR_RTDE_VENDOR)
  if(NOT _ur_rtde_vendor_target)
    message(FATAL_ERROR
      "The target ur_rtde::rtde belongs to another installation of ur_rtde: ${ur_rtde_DIR}\n"
      "It lacks the patches of the package ur_rtde_vendor, which this project uses. Remove find_package(ur_rtde) from this "
      "project and its dependencies. find_package(ur_rtde_vendor) provides the target ur_rtde::rtde.")
  endif()
  unset(_ur_rtde_vendor_target)
endif()
