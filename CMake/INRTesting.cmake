include(GoogleTest)

# inr_add_core_test(NAME SOURCES...): a GoogleTest program over Core, every case a ctest of label core.
function (inr_add_core_test name)
  add_executable(${name} ${ARGN})
  target_link_libraries(${name} PRIVATE INRVolume::Core inr_options GTest::gtest_main)
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}")
  target_compile_options(${name} PRIVATE -O1) # tests take longer to compile than to run
  target_compile_definitions(${name} PRIVATE INR_TEST_DATA="${PROJECT_SOURCE_DIR}/Testing/Data")
  gtest_discover_tests(${name} NO_PRETTY_VALUES DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS core TIMEOUT 300)
endfunction ()
