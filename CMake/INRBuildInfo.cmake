# Version and build information that the plugin manager and the benchmark results show.
find_package(Git QUIET)
set(INR_COMMIT "unknown")
if (Git_FOUND)
  execute_process(COMMAND "${GIT_EXECUTABLE}" describe --always --dirty --exclude=*
    WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}"
    OUTPUT_VARIABLE inr_commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
    RESULT_VARIABLE inr_git_result)
  if (inr_git_result EQUAL 0)
    set(INR_COMMIT "${inr_commit}")
  endif ()
endif ()

configure_file("${CMAKE_CURRENT_SOURCE_DIR}/Core/BuildInfo.h.in"
  "${CMAKE_CURRENT_BINARY_DIR}/Generated/Core/BuildInfo.h" @ONLY)
