# Builds our code with a sanitizer: UR_SANITIZE is address (with undefined), undefined or thread. The generated interfaces are not
# instrumented, because an uninstrumented Python loads them too; interface packages are optimised for compile time.

if(UR_SANITIZE)
  if(CMAKE_CURRENT_SOURCE_DIR MATCHES "_msgs$")
    set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O0 -DNDEBUG")
    set(CMAKE_C_FLAGS_RELWITHDEBINFO "-O1 -DNDEBUG")  # removes references to Python, which programs are not linked with
  else()
    string(REPLACE "address" "address,undefined" ur_sanitizers "${UR_SANITIZE}")
    set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1 -DNDEBUG")
    set(CMAKE_C_FLAGS_RELWITHDEBINFO "-O1 -g1 -DNDEBUG")
    set(ur_ours "$<BOOL:$<FILTER:$<TARGET_PROPERTY:NAME>,EXCLUDE,__>>")  # rosidl's targets are <package>__<generator>
    add_compile_options("$<${ur_ours}:-fsanitize=${ur_sanitizers}>" "$<${ur_ours}:-fno-omit-frame-pointer>"
                        "$<${ur_ours}:-fno-sanitize-recover=all>")
    add_link_options("$<${ur_ours}:-fsanitize=${ur_sanitizers}>")
  endif()
endif()
