# The plugin for ParaView. Its VTK modules (readers, mapper, representation) are shared libraries
# beside it, so that C++ and Python programs without ParaView's client can use them too.

# RemotingCore and RemotingViews are all the plugin needs; without COMPONENTS the package asks for
# Qt, HDF5, GDAL and more.
find_package(ParaView 5.11 QUIET COMPONENTS RemotingCore RemotingViews)
if (NOT ParaView_FOUND)
  message(FATAL_ERROR
    "ParaView 5.11 or newer with its development files was not found"
    " (${ParaView_NOT_FOUND_MESSAGE}).\n"
    "On Debian 12 run CMake/install-debian-packages.sh, which lists the packages.\n"
    "Elsewhere set ParaView_DIR to the folder with paraview-config.cmake,"
    " or build without ParaView (presets vtk and core).")
endif ()
message(STATUS "ParaView ${ParaView_VERSION}: ${ParaView_DIR}")

set(BUILD_SHARED_LIBS ON)
# One layout whatever the installation prefix: ParaView's own, below lib/.
set(CMAKE_INSTALL_LIBDIR lib)
set(INR_MODULE_DIRECTORY "${CMAKE_INSTALL_LIBDIR}/${PARAVIEW_PLUGIN_SUBDIR}/INRVolume")
# Build and install tree look alike, so that both can be loaded and moved.
set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
# The plugin shares ParaView's process: nothing of our static libraries may be visible in it.
add_link_options(LINKER:--exclude-libs,ALL)

paraview_plugin_scan(
  PLUGIN_FILES "${CMAKE_CURRENT_SOURCE_DIR}/Plugin/paraview.plugin"
  PROVIDES_PLUGINS inr_plugins
  REQUIRES_MODULES inr_plugin_modules
  ENABLE_BY_DEFAULT ON
  HIDE_PLUGINS_FROM_CACHE ON)
paraview_plugin_build(
  PLUGINS ${inr_plugins}
  LIBRARY_SUBDIRECTORY "${PARAVIEW_PLUGIN_SUBDIR}"
  PLUGINS_FILE_NAME inrvolume.plugins.xml
  INSTALL_HEADERS OFF)

if (INR_WITH_PYTHON)
  include(INRPython)
endif ()
