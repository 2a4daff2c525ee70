# Builds our code with a sanitizer: UR_SANITIZE is address (with undefined), undefined or thread. Not the generated interfaces, which
# are also loaded by an uninstrumented Python; those are compiled as fast as can be.

if(UR_SANITIZE)
  if(CMAKE_CURRENT_SOURCE_DIR MATCHES "_msgs$")
    set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O0 -DNDEBUG")
    set(CMAKE_C_FLAGS_RELWITHDEBINFO "-O0 -DNDEBUG")
  else()
    string(REPLACE "address" "address,undefined" ur_sanitizers "${UR_SANITIZE}")
    set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1 -DNDEBUG")
    set(CMAKE_C_FLAGS_RELWITHDEBINFO "-O1 -g1 -DNDEBUG")
    add_compile_options(-fsanitize=${ur_sanitizers} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    add_link_options(-fsanitize=${ur_sanitizers})
  endif()
endif()
