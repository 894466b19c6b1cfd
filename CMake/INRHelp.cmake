# The plugin's pages in ParaView's own help (F1): from README, Documentation and the XML, by
# Plugin/Help. Only where Qt's documentation tools are, as ParaView's functions need them.

# inr_help_arguments(OUTPUT XML...): what paraview_add_plugin is to be told of help.
function (inr_help_arguments output)
  find_package(Qt5 QUIET COMPONENTS Help)
  find_package(Python3 QUIET COMPONENTS Interpreter)
  find_program(qt_xmlpatterns_executable NAMES xmlpatterns-qt5 xmlpatterns # ParaView's name for it
    HINTS "${Qt5_DIR}/../../../bin" "${Qt5_DIR}/../../../qt5/bin" /usr/lib/qt5/bin)
  mark_as_advanced(qt_xmlpatterns_executable)
  if (NOT PARAVIEW_USE_QT OR NOT TARGET Qt5::qhelpgenerator OR NOT Python3_FOUND OR
      NOT qt_xmlpatterns_executable)
    message(STATUS "Help: not in ParaView's window; that takes qttools5-dev and qtxmlpatterns5-dev-tools")
    set("${output}" XML_DOCUMENTATION OFF PARENT_SCOPE)
    return ()
  endif ()

  set(scripts "${PROJECT_SOURCE_DIR}/Plugin/Help")
  set(documents "${PROJECT_SOURCE_DIR}/README.md" "${PROJECT_SOURCE_DIR}/Documentation/Guide.md"
    "${PROJECT_SOURCE_DIR}/Documentation/GPU.md")
  set(pages "${CMAKE_CURRENT_BINARY_DIR}/help")
  list(TRANSFORM ARGN PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/" OUTPUT_VARIABLE xmls)
  # ParaView's function wants the table of contents now.
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${scripts}/make_help.py" ${xmls})
  execute_process(
    COMMAND "${Python3_EXECUTABLE}" -B "${scripts}/make_help.py" --contents ${xmls}
    OUTPUT_VARIABLE contents OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  add_custom_command(
    OUTPUT "${pages}/index.html"
    COMMAND "${Python3_EXECUTABLE}" -B "${scripts}/make_help.py" "${pages}" ${documents} ${xmls}
    DEPENDS "${scripts}/make_help.py" "${scripts}/markdown_pages.py" "${scripts}/proxy_pages.py"
      ${documents} ${xmls}
    COMMENT "Writing the pages of the help")
  set_property(GLOBAL PROPERTY INR_HELP_FILE "${CMAKE_CURRENT_BINARY_DIR}/paraview_help/INRVolume.qch")
  set("${output}"
    DOCUMENTATION_DIR "${pages}"
    DOCUMENTATION_TOC "${contents}"
    DOCUMENTATION_DEPENDENCIES "${pages}/index.html"
    PARENT_SCOPE)
endfunction ()
