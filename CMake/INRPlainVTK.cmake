# The readers and the mapper against plain VTK, for machines and programs without ParaView.
set(inr_vtk_folder "${CMAKE_BINARY_DIR}/vtk")

# An unpacked VTK in the build folder comes before an installed one; VTK_DIR before both.
find_package(VTK 9.1 QUIET
  COMPONENTS
    CommonCore CommonDataModel CommonExecutionModel CommonMath IOCore RenderingCore RenderingOpenGL2
    RenderingVolume
  OPTIONAL_COMPONENTS
    FiltersCore FiltersExtraction ImagingCore ImagingSources IOImage IOXML InteractionStyle
    RenderingUI RenderingVolumeOpenGL2 TestingRendering WrappingTools Python WrappingPythonCore
  HINTS "${inr_vtk_folder}/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/vtk-9.1")
if (NOT VTK_FOUND)
  string(REGEX REPLACE "(.+)" " (\\1)" inr_vtk_reason "${VTK_NOT_FOUND_MESSAGE}")
  message(FATAL_ERROR
    "VTK 9.1 or newer with its development files was not found${inr_vtk_reason}.\n"
    "On Debian 12 run: Testing/fetch-vtk.sh ${inr_vtk_folder}\n"
    "Elsewhere set VTK_DIR to the folder with vtk-config.cmake.")
endif ()
message(STATUS "VTK ${VTK_VERSION}: ${VTK_DIR}")

set(BUILD_SHARED_LIBS ON)
if (INR_WHEEL)
  # All in one package, which finds VTK's libraries in the package beside it that has them.
  set(CMAKE_INSTALL_LIBDIR inrvolume)
  set(INR_PYTHON_DIRECTORY .)
  get_property(inr_vtk_package
    TARGET VTK::CommonCore PROPERTY INTERFACE_vtk_module_python_package)
  list(APPEND CMAKE_INSTALL_RPATH "$ORIGIN" "$ORIGIN/../${inr_vtk_package}")
else ()
  set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
  list(APPEND CMAKE_INSTALL_RPATH "$ORIGIN") # the two libraries, wherever they are moved to
endif ()
set(INR_MODULE_DIRECTORY "${CMAKE_INSTALL_LIBDIR}")
# The modules share the host's process: nothing of our static libraries may be visible in it.
add_link_options(LINKER:--exclude-libs,ALL)
# RPATH instead of RUNPATH: an unpacked VTK's libraries find each other through ours only.
add_link_options(LINKER:--disable-new-dtags)

vtk_module_scan(
  MODULE_FILES
    "${CMAKE_CURRENT_SOURCE_DIR}/Readers/vtk.module"
    "${CMAKE_CURRENT_SOURCE_DIR}/Representations/Mapper/vtk.module"
  REQUEST_MODULES INRReaders INRMapper
  PROVIDES_MODULES inr_modules
  HIDE_MODULES_FROM_CACHE ON
  ENABLE_TESTS OFF)
vtk_module_build(MODULES ${inr_modules} INSTALL_HEADERS OFF)

if (INR_WITH_PYTHON)
  include(INRPython)
endif ()
