# Adds the test fuzz.<name>: the target fuzz/fuzz_<name>.cpp of this package on its corpus and on mutations of it, with
# any compiler. libFuzzer itself is used by ./ur fuzz. All mutations (UR_TEST_THOROUGH) should take about 30 s of
# processor time.
function(add_fuzz_replay name mutations)
  set(fuzz ${PROJECT_SOURCE_DIR}/fuzz)
  add_executable(replay_${name} ${fuzz}/fuzz_${name}.cpp ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/replay.cpp)
  set_target_properties(replay_${name} PROPERTIES UNITY_BUILD OFF)
  target_compile_features(replay_${name} PRIVATE cxx_std_20)
  target_include_directories(replay_${name} PRIVATE ${CMAKE_CURRENT_FUNCTION_LIST_DIR})
  target_compile_options(replay_${name} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
  target_link_libraries(replay_${name} PRIVATE ${ARGN})
  add_test(NAME fuzz.${name} COMMAND replay_${name} ${fuzz}/corpus/${name} ${mutations})
  set_tests_properties(fuzz.${name} PROPERTIES TIMEOUT 600 LABELS last)
endfunction()
