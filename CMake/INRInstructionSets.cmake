# inr_add_kernels(TARGET SOURCES...): builds each source once per instruction set into TARGET.
# INR_ISA is the namespace of a build; the right one is chosen at run time.
function (inr_add_kernels target)
  inr_add_build(${target} baseline "" ${ARGN})
  if (INR_X86)
    target_compile_definitions(${target} PRIVATE INR_X86_KERNELS)
    inr_add_build(${target} avx2 "-mavx2;-mfma" ${ARGN})
    inr_add_build(${target} avx512 "${INR_AVX512_FLAGS}" ${ARGN})
  endif ()
endfunction ()

# inr_add_bfloat16_kernels(TARGET SOURCES...): builds them once more, with INR_BFLOAT16, for
# processors that multiply bfloat16 numbers.
function (inr_add_bfloat16_kernels target)
  if (INR_X86)
    inr_add_build(${target} avx512bf16 "${INR_AVX512_FLAGS};-mavx512bf16" ${ARGN})
    target_compile_definitions(${target}_avx512bf16 PRIVATE INR_BFLOAT16)
  endif ()
endfunction ()

# inr_add_tile_kernels(TARGET SOURCES...): and twice more, for processors with tile registers for such
# numbers (AMX): of these as they are, and, with INR_SPLIT, of sums of two. INR_TILES is the header of
# the tile unit. Nothing in there throws; what would clean up behind exceptions refers to a symbol
# that builds would share.
function (inr_add_tile_kernels target)
  if (INR_X86)
    foreach (isa amx amxsplit)
      inr_add_build(${target} ${isa}
        "${INR_AVX512_FLAGS};-mavx512bf16;-mamx-tile;-mamx-bf16;-fno-exceptions" ${ARGN})
      target_compile_definitions(${target}_${isa} PRIVATE INR_TILES="Core/Inference/ProcessorTiles.h")
    endforeach ()
    target_compile_definitions(${target}_amxsplit PRIVATE INR_SPLIT)
  endif ()
endfunction ()

set(INR_X86 OFF)
if (CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(INR_X86 ON)
endif ()
set(INR_AVX512_FLAGS
  -mavx512f -mavx512dq -mavx512bw -mavx512vl -mfma -mprefer-vector-width=512)

function (inr_add_build target isa flags)
  set(objects ${target}_${isa})
  if (NOT TARGET ${objects})
    add_library(${objects} OBJECT)
    target_include_directories(${objects} PRIVATE "${PROJECT_SOURCE_DIR}")
    target_link_libraries(${objects} PRIVATE inr_options)
    # -Wno-psabi: vectors are only passed between functions that are inlined.
    target_compile_options(${objects} PRIVATE ${INR_OPTIMISE} -Wno-psabi ${flags})
    target_compile_definitions(${objects} PRIVATE INR_ISA=${isa})
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${objects}>)
    # What becomes of a kernel is not to depend on what others a compiler sees beside it.
    set_target_properties(${objects} PROPERTIES UNITY_BUILD OFF)
  endif ()
  list(TRANSFORM ARGN PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
  target_sources(${objects} PRIVATE ${ARGN})
endfunction ()
