include(GoogleTest)

# Tests take longer to compile than to run.
set(INR_TEST_OPTIONS -O1)
if (INR_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  list(APPEND INR_TEST_OPTIONS "-fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/Testing/unsanitized.txt")
endif ()

# Of tests in several processes. One that waits for another lets a third work meanwhile; otherwise it would
# keep a core for itself, as long as there are as many cores as processes.
set(INR_MPI_ENVIRONMENT OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  OMPI_MCA_mpi_yield_when_idle=1)

# inr_add_core_test(NAME SOURCES...): a GoogleTest program over Core, every case a ctest of label core. Its
# files are compiled by sixteens where CMAKE_UNITY_BUILD is on, so what is in a test's file is in a namespace
# of that file's name.
function (inr_add_core_test name)
  add_executable(${name} ${ARGN})
  target_link_libraries(${name} PRIVATE INRVolume::Core inr_options GTest::gtest_main)
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}")
  set_target_properties(${name} PROPERTIES UNITY_BUILD "${INR_UNITY_TESTS}" UNITY_BUILD_BATCH_SIZE 16)
  target_compile_options(${name} PRIVATE ${INR_TEST_OPTIONS})
  target_compile_definitions(${name} PRIVATE INR_TEST_DATA="${PROJECT_SOURCE_DIR}/Testing/Data")
  gtest_discover_tests(${name} NO_PRETTY_VALUES DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS core TIMEOUT 300)
endfunction ()

# inr_label_cases(NAME LABEL PATTERN...): the labels core and LABEL, and no other, for those
# cases of such a program that match one of the regular expressions. One that none matches is a test that
# fails.
function (inr_label_cases name label)
  set(quoted)
  foreach (pattern IN LISTS ARGN)
    string(APPEND quoted " [==[${pattern}]==]")
  endforeach ()
  set(file "${CMAKE_CURRENT_BINARY_DIR}/${name}_${label}.cmake")
  configure_file("${PROJECT_SOURCE_DIR}/CMake/INRLabelCases.cmake.in" "${file}" @ONLY)
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${file}")
endfunction ()

# inr_repeats(NAME PATTERN...): what takes long and executes the same lines as other cases do,
# over and over again. Left out where there is a sanitizer.
function (inr_repeats name)
  inr_label_cases(${name} repeated ${ARGN})
endfunction ()
