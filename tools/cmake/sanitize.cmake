# Builds our code, and not the generated interfaces, with a sanitizer: UR_SANITIZE is address, undefined or thread.
# The interfaces are also loaded by an uninstrumented Python, which could not load them then.

if(UR_SANITIZE AND NOT CMAKE_CURRENT_SOURCE_DIR MATCHES "_msgs$")
  add_compile_options(-fsanitize=${UR_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${UR_SANITIZE})
endif()
