# find_package(ur_rtde_vendor) brings the target ur_rtde::rtde, which links these.
find_package(Boost REQUIRED COMPONENTS thread)
find_package(Threads REQUIRED)
