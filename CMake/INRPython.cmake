# Python package `inrvolume`: the readers and the mapper for any Python that has VTK's own modules
# (vtkmodules), ParaView's included. Shared by the builds against ParaView and against plain VTK;
# included after the modules are built. INR_MODULE_DIRECTORY is where their libraries are, relative
# to the build and the installation folder.
if (NOT INR_WHEEL)
  set(INR_PYTHON_DIRECTORY "${CMAKE_INSTALL_LIBDIR}/python")
endif ()
find_package(Python3 REQUIRED COMPONENTS Interpreter Development.Module)

file(RELATIVE_PATH inr_python_to_modules
  "/prefix/${INR_PYTHON_DIRECTORY}/inrvolume" "/prefix/${INR_MODULE_DIRECTORY}")
set(inr_saved_install_rpath "${CMAKE_INSTALL_RPATH}")
list(APPEND CMAKE_INSTALL_RPATH "$ORIGIN/${inr_python_to_modules}")
vtk_module_wrap_python(
  MODULES INRReaders INRMapper
  TARGET INRVolume::Python
  PYTHON_PACKAGE inrvolume
  MODULE_DESTINATION "${INR_PYTHON_DIRECTORY}"
  BUILD_STATIC OFF
  INSTALL_HEADERS OFF)
set(CMAKE_INSTALL_RPATH "${inr_saved_install_rpath}")

# The package's own file; the generated modules land beside it.
configure_file("${CMAKE_CURRENT_LIST_DIR}/inrvolume-init.py"
  "${CMAKE_BINARY_DIR}/${INR_PYTHON_DIRECTORY}/inrvolume/__init__.py" COPYONLY)
install(FILES "${CMAKE_CURRENT_LIST_DIR}/inrvolume-init.py"
  DESTINATION "${INR_PYTHON_DIRECTORY}/inrvolume" RENAME __init__.py)
