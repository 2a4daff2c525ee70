# find_package(ur_rtde_vendor) brings the target ur_rtde::rtde, from the prefix this file lies in.
find_package(ur_rtde 1.6.5 REQUIRED CONFIG
  PATHS "${ur_rtde_vendor_DIR}/../../../lib/cmake/ur_rtde" NO_DEFAULT_PATH)
