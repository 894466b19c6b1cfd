# The CUDA compiler, where it is wanted. Sets CMAKE_CUDA_COMPILER and INR_CUDA_TARGETS.
#
# By default there is code for one generation only, compute capability 8.0, which 8.x run as it is,
# and PTX, from which drivers make code for all later ones when a program first runs on them: one
# pass of the compiler. `all` is for what is given to others: everything from 7.5 on that the
# compiler knows, and PTX of the last.
set(INR_CUDA AUTO CACHE STRING "Build for NVIDIA GPUs: AUTO (when nvcc is found), ON or OFF")
set_property(CACHE INR_CUDA PROPERTY STRINGS AUTO ON OFF)
set(INR_CUDA_ARCHITECTURES "80" CACHE STRING
  "Compute capabilities to build for, without a dot and with ; between them, or all")

set(INR_CUDA_TARGETS "")
if (NOT INR_CUDA)
  message(STATUS "CUDA: switched off; INRVolume computes on the CPU")
  unset(CMAKE_CUDA_COMPILER CACHE) # of a time when it was on
  return ()
endif ()

# What is missing ends here, or stops the configuration where CUDA was asked for.
macro (inr_without_cuda reason)
  if (NOT INR_CUDA STREQUAL "AUTO")
    message(FATAL_ERROR "INR_CUDA is ON, but ${reason}. Install the CUDA toolkit (12 or newer), set "
      "CMAKE_CUDA_COMPILER to its bin/nvcc, or configure with -DINR_CUDA=OFF.")
  endif ()
  message(STATUS "CUDA: ${reason}; INRVolume computes on the CPU")
  unset(CMAKE_CUDA_COMPILER CACHE)
  return ()
endmacro ()

# CMake looks along PATH; the toolkit's own folder is often not in it.
if (NOT CMAKE_CUDA_COMPILER)
  find_program(INR_NVCC nvcc HINTS ENV CUDACXX ENV CUDA_PATH PATHS /usr/local/cuda PATH_SUFFIXES bin)
  if (NOT INR_NVCC)
    inr_without_cuda("there is no nvcc")
  endif ()
  file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/probe.cu"
    "#include <cuda_runtime.h>\n#if __CUDACC_VER_MAJOR__ < 12\n#error\n#endif\n")
  execute_process(
    COMMAND "${INR_NVCC}" -std=c++17 -ccbin "${CMAKE_CXX_COMPILER}" -c probe.cu -o probe.o
    WORKING_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles"
    RESULT_VARIABLE inr_nvcc_result OUTPUT_QUIET ERROR_QUIET)
  if (NOT inr_nvcc_result EQUAL 0)
    inr_without_cuda("${INR_NVCC} is older than 12 or does not work with ${CMAKE_CXX_COMPILER}")
  endif ()
  set(CMAKE_CUDA_COMPILER "${INR_NVCC}" CACHE FILEPATH "The CUDA compiler")
  set(CMAKE_CUDA_HOST_COMPILER "${CMAKE_CXX_COMPILER}" CACHE FILEPATH "nvcc's compiler for the host")
endif ()

# What it knows: newer toolkits than this CMake drop and add generations.
execute_process(COMMAND "${CMAKE_CUDA_COMPILER}" --list-gpu-code
  RESULT_VARIABLE inr_nvcc_result OUTPUT_VARIABLE inr_gpu_code ERROR_QUIET)
if (NOT inr_nvcc_result EQUAL 0)
  inr_without_cuda("${CMAKE_CUDA_COMPILER} is no nvcc that runs")
endif ()
string(REGEX MATCHALL "sm_[0-9]+" inr_known "${inr_gpu_code}")
list(TRANSFORM inr_known REPLACE "sm_" "")
list(REMOVE_DUPLICATES inr_known)
list(SORT inr_known COMPARE NATURAL)
list(FILTER inr_known EXCLUDE REGEX "^([1-6].|7[0-4])$") # the tensor cores' instructions begin at 7.5
if (INR_CUDA_ARCHITECTURES STREQUAL "all")
  list(FILTER inr_known EXCLUDE REGEX "^1[2-9][1-9]$|^1[3-9].$") # 7.5 to 12.0
  set(inr_architectures "${inr_known}")
else ()
  set(inr_architectures "${INR_CUDA_ARCHITECTURES}")
endif ()
foreach (architecture IN LISTS inr_architectures)
  if (NOT architecture IN_LIST inr_known)
    message(FATAL_ERROR "INR_CUDA_ARCHITECTURES: '${architecture}' is not among what "
      "${CMAKE_CUDA_COMPILER} builds for: ${inr_known} (or all)")
  endif ()
endforeach ()
list(TRANSFORM inr_architectures APPEND "-real" OUTPUT_VARIABLE INR_CUDA_TARGETS)
list(GET inr_architectures -1 inr_last)
list(APPEND INR_CUDA_TARGETS "${inr_last}-virtual")

set(CMAKE_CUDA_ARCHITECTURES "${INR_CUDA_TARGETS}")
if (INR_CCACHE AND NOT CMAKE_CUDA_COMPILER_LAUNCHER)
  set(CMAKE_CUDA_COMPILER_LAUNCHER "${INR_CCACHE}")
endif ()
enable_language(CUDA)
find_package(CUDAToolkit 12 REQUIRED)
set(CMAKE_CUDA_STANDARD 17)
set(CMAKE_CUDA_STANDARD_REQUIRED ON)
message(STATUS "CUDA ${CUDAToolkit_VERSION}: building for ${INR_CUDA_TARGETS}")
