# One standard, hidden symbols and strict warnings for everything that is ours.
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

find_program(INR_CCACHE ccache)
if (INR_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${INR_CCACHE}")
endif ()

# What infers and draws is optimised in every configuration: a debug build that infers a hundred times
# slower helps nobody. With what sanitizers add to it, -O3 takes too long to compile.
set(INR_OPTIMISE -O3)
if (INR_SANITIZE)
  set(INR_OPTIMISE -O2)
endif ()

# Carried by every target of ours, never by generated (wrapping) code.
add_library(inr_options INTERFACE)
# Results that are compared must not depend on where a compiler fuses multiplications and additions.
target_compile_options(inr_options INTERFACE
  "$<$<COMPILE_LANGUAGE:C,CXX>:-Wall;-Wextra;-ffp-contract=off>"
  "$<$<AND:$<COMPILE_LANGUAGE:C,CXX>,$<BOOL:${INR_WERROR}>>:-Werror>"
  "$<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-Wall,-Wextra,-ffp-contract=off;--fmad=false>"
  "$<$<AND:$<COMPILE_LANGUAGE:CUDA>,$<BOOL:${INR_WERROR}>>:-Xcompiler=-Werror;--Werror=all-warnings>")
# Where a compiler sees several files in one, what is in an unnamed namespace looks to it like a header's.
if (CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(inr_options INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>")
endif ()
if (INR_SANITIZE)
  target_compile_options(inr_options INTERFACE
    -fsanitize=${INR_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(inr_options INTERFACE -fsanitize=${INR_SANITIZE})
  if (INR_SANITIZE_EXCEPT)
    target_compile_options(inr_options INTERFACE -fno-sanitize=${INR_SANITIZE_EXCEPT})
  endif ()
  # Each compiler has other words of its own for it.
  target_compile_definitions(inr_options INTERFACE INR_SANITIZED)
  if (INR_SANITIZE MATCHES "thread")
    target_compile_definitions(inr_options INTERFACE INR_SANITIZED_THREADS)
  endif ()
elseif (CMAKE_SYSTEM_NAME STREQUAL "Linux")
  # A library that misses a function is found out here, not by who loads it: those of the plugin share
  # nothing but classes.
  target_link_options(inr_options INTERFACE -Wl,-z,defs)
endif ()
if (INR_BUILD_FUZZERS)
  if (NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "INR_BUILD_FUZZERS needs Clang, whose libFuzzer it uses: configure with preset fuzz.")
  endif ()
  target_compile_options(inr_options INTERFACE -fsanitize=fuzzer-no-link)
endif ()
